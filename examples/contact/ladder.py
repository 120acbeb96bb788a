r"""A ladder slides down and leaves the wall
========================================

A ladder without friction slides down a wall. Before it reaches the floor it leaves the wall: from there on
the wall would have to pull. The run opens the contact by itself, and the instant of it is compared with its
closed form.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, length, radius, theta_0 = 9.81, 2.0, 0.02, np.radians(65)
centre = length / 2 * np.array([np.cos(theta_0), 0, np.sin(theta_0)])

# %%
# The ladder is a thin capsule that touches floor and wall and starts at rest.


def slide():
    scene = carom.Scene(gravity=(0, 0, -g))
    floor = scene.add_half_space(point=(0, 0, -radius), normal=(0, 0, 1), name="floor")
    wall = scene.add_half_space(point=(-radius, 0, 0), normal=(1, 0, 0), name="wall")
    turn = (theta_0 - np.pi / 2) / 2  # from upright, about y: half of it
    ladder = scene.add_body(
        carom.Capsule(radius, length), mass=10.0, inertia=3 * [10 * length**2 / 12], position=centre,
        orientation=(np.cos(turn), 0, np.sin(turn), 0), name="ladder",
    )  # fmt: skip
    for half_space in (floor, wall):
        scene.add_contact(ladder, half_space, restitution=0.0)
    return carom.simulate(scene, 0.75, step=1e-3)


# %%
# With both contacts closed the centre moves on a circle, and the energy gives
# :math:`\dot\theta^2 = \frac{3 g}{l} (\sin\theta_0 - \sin\theta)`. The force of the wall follows, and it is
# zero where the top has come down to 2/3 of its first height. The event ``"opens"`` must be there.


def main(out="out/examples"):
    s = slide()
    opened = s.events.time[(s.events.kind == "opens") & (s.events.contact == 1)][0]
    part = s.evaluate(opened)[0][0, 2] / centre[2]
    error = np.max(np.abs(np.linalg.norm(s.position[s.t < opened, 0], axis=1) - length / 2))
    print(
        f"the ladder leaves the wall after {opened:.4f} s, at {part:.6f} of its height (exact 2/3)"
    )
    print(f"until then its centre is on the circle to {error:.0e} m")

    with picture(f"{out}/ladder.png", height=2.8, columns=2, width_ratios=(1.1, 1)) as (
        left,
        right,
    ):
        s.plot("trajectory", outlines=9, ax=left)
        right.plot(s.t, s.contact_force[:, :2, 0], label=["floor", "wall"])
        right.axvline(opened, color="0.6", lw=0.8, ls="--")
        right.set(xlabel="time / s", ylabel="force / N", ylim=(0, 95)), right.legend()
    assert abs(part - 2 / 3) < 1e-6
    assert error < 1e-9


if __name__ == "__main__":
    main()
