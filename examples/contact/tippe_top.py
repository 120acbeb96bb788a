r"""A tippe top turns over and keeps its Jellett constant
=====================================================

A spinning ball whose mass centre is below its middle turns over and stands on its head: friction of the
slipping foot does it, and lifts the mass centre. Whatever this friction does, one number stays constant
(Jellett, 1872), and it is the check.
"""

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots.style import picture

g, radius, mass, offset, lean = 9.81, 0.02, 0.02, 0.004, 0.1
I = np.array([3.1e-6, 3.1e-6, 3.2e-6])  # about the mass centre

# %%
# The top is a large sphere, with a small one inside it that draws the mass centre down. It spins about the
# vertical, and its axis leans a little.


def spin():
    scene = carom.Scene(gravity=(0, 0, -g))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    stud = (carom.Sphere(1e-3), (0, 0, -offset))
    ball = carom.Compound([(carom.Sphere(radius), (0, 0, offset)), stud], masses=[1, 1])
    top = scene.add_body(
        ball, mass=mass, inertia=I, position=(0, 0, radius - offset * np.cos(lean)), name="top",
        orientation=(np.cos(lean / 2), np.sin(lean / 2), 0, 0), angular_velocity=(0, 0, 150),
    )  # fmt: skip
    scene.add_contact(top, table, restitution=0.0, friction=0.3)
    return carom.simulate(scene, 2.5, step=1e-3)


# %%
# Let :math:`\mathbf{L}` be the angular momentum and :math:`\mathbf{a}` the arm from the mass centre to the
# foot. The force at the foot has no moment along :math:`\mathbf{a}`, and Jellett's constant is
#
# .. math:: J = -\mathbf{L} \cdot \mathbf{a}.


def jellett(q, w):
    up = np.array([0.0, 0.0, 1.0])
    L = quaternion.rotate(q, I * quaternion.rotate_back(q, w))
    return -L @ (offset * quaternion.rotate(q, up) - radius * up)


# %%
# The energy ledger shows where the kinetic energy is in the end: friction has taken most of it, and a part
# has lifted the mass centre.


def main(out="out/examples"):
    s = spin()
    q, w = s.orientation[:, 0], s.angular_velocity[:, 0]
    J = np.array([jellett(*row) for row in zip(q, w)])
    change = np.ptp(J) / J[0]
    tilt = np.degrees(2 * np.arctan2(np.hypot(q[:, 1], q[:, 2]), np.hypot(q[:, 0], q[:, 3])))
    print(
        f"its axis is at {tilt[-1]:.1f} degrees in the end; Jellett's constant kept to {change:.1e}"
    )

    with picture(f"{out}/tippe_top.png", columns=2) as (left, right):
        left.plot(s.t, tilt)
        left.set(xlabel="time / s", ylabel="angle of its axis / degrees", ylim=(0, 180))
        rise = s.potential_energy - s.potential_energy[0]
        parts = np.stack([s.kinetic_energy, -s.ledger.friction, rise], axis=1)
        right.plot(s.t, 1e3 * parts, label=["kinetic", "taken by friction", "lifted"])
        right.set(xlabel="time / s", ylabel="energy / mJ"), right.legend()
    assert change < 1e-4
    assert tilt[-1] > 150


if __name__ == "__main__":
    main()
