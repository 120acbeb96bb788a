r"""A closed loop that strikes
==========================

A parallelogram of rods tips over onto a stop in one of its hinges, and bounces. The impulse of such an impact
reaches every hinge at once, and all bars turn back. The velocity of the first impact is compared with its
closed form, and the energy ledger must close.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, e, END = 9.81, 0.7, 1.2
out_of_plane = (0, 0, 1)

# %%
# All four hinges are spatial, so three of their constraints are redundant. `add_stop` puts a stop at 1.2 rad
# into the upper right hinge.


def mechanism():
    scene, J = carom.Scene(gravity=(0, -g, 0)), carom.joints
    upright, level = (1 / 12, 1e-3, 1 / 12), (1e-3, 1 / 12, 1 / 12)
    rows = ((0, 0.5, upright, 0.5, -1), (0.5, 1, level, 1.0, 0), (1, 0.5, upright, 0.5, -1))
    left, top, right = (
        scene.add_body(mass=1, inertia=inertia, position=(x, y, 0), velocity=(v, 0, 0),
                       angular_velocity=(0, 0, w))
        for x, y, inertia, v, w in rows
    )  # fmt: skip
    scene.add_joint(J.Revolute((0, 0, 0), out_of_plane), carom.GROUND, left, name="foot")
    scene.add_joint(J.Revolute((0, 1, 0), out_of_plane), left, top)
    stopped = scene.add_joint(J.Revolute((1, 1, 0), out_of_plane), top, right)
    scene.add_joint(J.Revolute((1, 0, 0), out_of_plane), carom.GROUND, right)
    scene.add_stop(stopped, lower=-END, restitution=e)
    return scene


# %%
# Let a be the angle of the bars from upright. The energies are :math:`T = \frac{5}{6} \dot a^2` and
# :math:`V = 2 g (\cos a - 1)`, and the motion starts with 1 rad/s. So the stop is first reached with
#
# .. math:: \dot a^2 = 1 + \frac{12}{5} g (1 - \cos 1.2).

speed = np.sqrt(1 + 12 / 5 * g * (1 - np.cos(END)))

# %%
# The plot of the energy ledger shows what each impact takes, and below the error of the sum.


def main(out="out/examples"):
    s = carom.simulate(mechanism(), 3.0, step=4e-3, method="rk8")
    found = -s.impacts.relative_velocity_before[0, 0]
    error, closed = abs(found - speed), np.max(np.abs(s.ledger.residual))
    kept = max(np.max(part) for part in s.constraint_errors)
    print(f"{len(s.impacts)} impacts; first at {found:.9f} rad/s, error {error:.0e}; "
          f"ledger closes to {closed:.0e} J, joints to {kept:.0e}")  # fmt: skip
    layout = dict(rows=3, sharex=True, height_ratios=(2, 2, 1))
    with picture(f"{out}/striking_four_bar.png", height=5.0, **layout) as (angle, *energy):
        angle.plot(s.t, -s.joint_coordinates("foot")[0])
        angle.axhspan(END, 1.35, color="0.85")
        angle.set(ylabel="angle of the bars / rad", ylim=(0, 1.35))
        s.plot("energy", ax=energy)
    assert max(error, closed, kept) < 1e-9


if __name__ == "__main__":
    main()
