r"""A ladder slides down a wall, and lets go of it
==============================================

Without friction the centre of a ladder goes on a circle until the wall would have to pull: that is when its top
has come down to 2/3 of the height from which it was let go, with :math:`\dot\theta^2 = \frac{3 g}{l}
(\sin\theta_0 - \sin\theta)` until then. The contact opens by itself; nobody has to look for the instant.
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

g, length, radius, theta_0 = 9.81, 2.0, 0.02, np.radians(65)


def main(out="out/examples"):
    scene = carom.Scene(gravity=(0, 0, -g))
    floor = scene.add_half_space(point=(0, 0, -radius), normal=(0, 0, 1), name="floor")
    wall = scene.add_half_space(point=(-radius, 0, 0), normal=(1, 0, 0), name="wall")
    centre = length / 2 * np.array([np.cos(theta_0), 0, np.sin(theta_0)])
    turn = (theta_0 - np.pi / 2) / 2  # from upright, about y: half of it
    ladder = scene.add_body(
        carom.Capsule(radius, length), mass=10.0, inertia=3 * [10 * length**2 / 12], position=centre,
        orientation=(np.cos(turn), 0, np.sin(turn), 0), name="ladder",
    )  # fmt: skip
    for half_space in (floor, wall):
        scene.add_contact(ladder, half_space, restitution=0.0)
    s = carom.simulate(scene, 0.75, step=1e-3)

    x, z = s.position[:, 0, 0], s.position[:, 0, 2]
    opened = s.events.time[(s.events.kind == "opens") & (s.events.contact == 1)][0]
    part = s.evaluate(opened)[0][0, 2] / centre[2]
    held = s.t < opened
    error = np.max(np.abs(np.hypot(x, z)[held] - length / 2))
    print(
        f"the ladder lets go of the wall after {opened:.4f} s, at {part:.6f} of its height (exact 2/3)"
    )
    print(f"until then its centre is on the circle to {error:.0e} m")

    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.8, columns=2, width_ratios=(1, 1.5))
        for t in np.linspace(0, 0.75, 9):
            middle = s.evaluate(t)[0][0]
            arm = 2 * np.arctan2(*s.evaluate(t)[1][0, [2, 0]])  # from upright
            ends = middle[:, None] + length / 2 * np.array([[1, -1], [0, 0], [1, -1]]) * [
                [np.sin(arm)], [0], [np.cos(arm)]]  # fmt: skip
            left.plot(*ends[[0, 2]], color=style.BLUE if t < opened else style.RED, lw=1.5)
        left.plot(x, z, "k", lw=0.8)
        left.set(xlabel="x / m", ylabel="z / m", aspect="equal", xlim=(0, 2.1), ylim=(0, 2.1))
        for k, (name, colour) in enumerate((("floor", style.GREEN), ("wall", style.PURPLE))):
            right.plot(s.t, s.contact_force[:, k, 0], color=colour, label=name)
        right.axvline(opened, color=style.GREY, lw=0.8, ls="--")
        right.text(opened + 0.01, 85, "wall let go", color=style.GREY)
        right.set(xlabel="time / s", ylabel="force / N", ylim=(0, 95)), right.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "ladder.png", dpi=style.DPI)
    assert abs(part - 2 / 3) < 1e-6
    assert error < 1e-9


if __name__ == "__main__":
    main()
