r"""The trammel of Archimedes draws ellipses
========================================

The ends of a rod slide in two grooves at a right angle. Each of its points then draws an ellipse, its middle a
circle; and where nothing drives it, it turns at a constant rate, for its kinetic energy is :math:`\frac{1}{2}(m
l^2/4 + I)\,\dot\theta^2` wherever it is.
"""

from pathlib import Path

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots import style

m, l, rate = 1.0, 1.0, 2.0
PARTS = np.array([-0.25, 0.0, 0.2, 0.5, 0.8])  # along the rod, from the end in the groove along x
COLOURS = (style.PURPLE, style.RED, style.GREEN, "k", style.BLUE)


def main(out="out/examples"):
    scene, start = carom.Scene(gravity=(0, 0, 0)), 0.3
    ends = l * np.array([[np.cos(start), 0, 0], [0, np.sin(start), 0]])
    rod = scene.add_body(
        mass=m, inertia=3 * [m * l**2 / 12], position=ends.mean(axis=0), name="rod",
        velocity=l / 2 * rate * np.array([-np.sin(start), np.cos(start), 0]), angular_velocity=(0, 0, -rate),
    )  # fmt: skip
    for end, groove in zip(ends, np.eye(3)):
        scene.add_joint(carom.joints.PointOnLine(end, groove), carom.GROUND, rod)
    s = carom.simulate(scene, 5.0, step=0.01, method="rk8")

    theta, errors = start + rate * s.t, []
    with style.style():
        figure, axes = style.new(style.COLUMN, 3.2)
        for part, colour in zip(PARTS, COLOURS):
            arm = (part - 0.5) * (ends[1] - ends[0])
            turned = np.array([quaternion.rotate(q, arm) for q in s.orientation[:, 0]])
            path = (s.position[:, 0] + turned)[:, :2]
            exact = l * np.stack([(1 - part) * np.cos(theta), part * np.sin(theta)], axis=1)
            errors.append(np.max(np.abs(path - exact)))
            axes.plot(*path.T, color=colour)
            axes.plot(*path[40], "o", color=colour)
        reach = np.array([PARTS[0], 1.0])
        axes.plot(
            l * (1 - reach) * np.cos(theta[40]),
            l * reach * np.sin(theta[40]),
            "k",
            lw=0.8,
            zorder=0,
        )
        for groove in (axes.axhline, axes.axvline):
            groove(0, color="0.88", lw=4, zorder=-1)
        axes.set(xlabel="x / m", ylabel="y / m", aspect="equal", xlim=(-1.4, 1.4), ylim=(-1.1, 1.1))
    print(scene.check())
    print(f"five points on their ellipses, at their time, to {max(errors):.0e} m after 5 s")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "trammel.png", dpi=style.DPI)
    assert max(errors) < 1e-10


if __name__ == "__main__":
    main()
