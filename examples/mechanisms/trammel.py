r"""The trammel of Archimedes draws ellipses
========================================

The ends of a rod slide in two grooves at a right angle. Each point of the rod then draws an ellipse, and its
middle draws a circle. Five points are compared with their closed form in space and time.
"""

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots.style import picture

m, l, rate, start = 1.0, 1.0, 2.0, 0.3
PARTS = np.array([-0.25, 0.0, 0.2, 0.5, 0.8])  # along the rod, from the end in the groove along x
ends = l * np.array([[np.cos(start), 0, 0], [0, np.sin(start), 0]])

# %%
# A `PointOnLine` keeps one end of the rod in its groove. There is no gravity, and nothing drives the rod.


def slide():
    scene = carom.Scene(gravity=(0, 0, 0))
    rod = scene.add_body(
        mass=m, inertia=3 * [m * l**2 / 12], position=ends.mean(axis=0), name="rod",
        velocity=l / 2 * rate * np.array([-np.sin(start), np.cos(start), 0]), angular_velocity=(0, 0, -rate),
    )  # fmt: skip
    for end, groove in zip(ends, np.eye(3)):
        scene.add_joint(carom.joints.PointOnLine(end, groove), carom.GROUND, rod)
    print(scene.check())
    return carom.simulate(scene, 5.0, step=0.01, method="rk8")


# %%
# The kinetic energy is :math:`\frac{1}{2}(m l^2/4 + I)\,\dot\theta^2` in every position, so the rod turns at
# a constant rate. The point at the part p of the rod is at :math:`l\,((1 - p) \cos\theta,\; p \sin\theta)`.


def exact(part, theta):
    return l * np.stack([(1 - part) * np.cos(theta), part * np.sin(theta)], axis=-1)


# %%
# The arm from the mass centre to each point turns with the rod. The picture has the five paths, and the rod
# at one time.


def main(out="out/examples"):
    s, errors = slide(), []
    theta = start + rate * s.t
    with picture(f"{out}/trammel.png", width=3.4, height=3.2) as axes:
        for part in PARTS:
            arm = (part - 0.5) * (ends[1] - ends[0])
            turned = np.array([quaternion.rotate(q, arm) for q in s.orientation[:, 0]])
            path = (s.position[:, 0] + turned)[:, :2]
            errors.append(np.max(np.abs(path - exact(part, theta))))
            (line,) = axes.plot(*path.T)
            axes.plot(*path[40], "o", color=line.get_color())
        axes.plot(*exact(np.array([PARTS[0], 1.0]), theta[40]).T, "k", lw=0.8, zorder=0)
        for groove in (axes.axhline, axes.axvline):
            groove(0, color="0.88", lw=4, zorder=-1)
        axes.set(xlabel="x / m", ylabel="y / m", aspect="equal", xlim=(-1.4, 1.4), ylim=(-1.1, 1.1))
    print(f"five points on their ellipses, at their time, to {max(errors):.0e} m after 5 s")
    assert max(errors) < 1e-10


if __name__ == "__main__":
    main()
