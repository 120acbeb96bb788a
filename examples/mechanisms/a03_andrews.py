"""A03: Andrews' squeezing mechanism
=================================

Seven bodies and ten hinges form loops with one freedom, and a motor of constant torque drives them within 30
ms through several fast turns. The angles at the end are compared with those of the IVP test set, which are
known to many digits.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

# %%
# The mechanism is plane, so its points are complex numbers here. Data, start and end are those of the test
# set.

phi, torque = 0.22266839016588588, 0.033
end = [15.81077119629904, 0.04082224013073101, 0.5244099658805304, 1.048080741042263]
start = [-0.06171389001427645, 0.45527981916307037, 0.48736497954384256, 1.2305474445498212]
b, g, d, e, p = np.exp(1j * np.array([*start, phi]))  # crank, arm of the spring, left, right arm
O, A, B, C = 0, -0.06934 - 0.00227j, -0.03635 + 0.03273j, 0.014 + 0.072j
F, G, H, D, E = 0.007 * b, A + 0.04 * d, A - 0.04j * e, B + (0.02 - 0.018j) * g, -0.021 * b
BODIES = (  # mass [kg], moment [kg m^2], mass centre [m]
    (0.04325, 2.194e-6, 0.00092 * b), (0.00365, 4.410e-7, F - 0.0115 * b),
    (0.02373, 5.255e-6, B + (0.01043 - 0.01874j) * g), (0.00706, 5.667e-7, G - 0.00579j * p * d),
    (0.07050, 1.169e-5, A + (0.02308 + 0.00916j) * d), (0.00706, 5.667e-7, H + 0.00579 * e / p),
    (0.05498, 1.912e-5, A - (0.00449 + 0.01228j) * e),
)  # fmt: skip
HINGES = (  # point, parent, child; 0 is the ground
    (O, 0, 1), (F, 1, 2), (B, 0, 3), (E, 2, 3), (E, 2, 4),
    (E, 2, 6), (G, 5, 4), (A, 0, 5), (H, 7, 6), (A, 0, 7),
)  # fmt: skip

# %%
# From these tables we make the bodies, the hinges, the spring, and the torque of the motor on the crank.


def mechanism():
    scene, at = carom.Scene(gravity=(0, 0, 0)), lambda point: (np.real(point), np.imag(point), 0)
    body = [scene.add_body(mass=m, inertia=[i] * 3, position=at(x)) for m, i, x in BODIES]
    body.insert(0, carom.GROUND)
    for point, parent, child in HINGES:
        scene.add_joint(carom.joints.Revolute(at(point), (0, 0, 1)), body[parent], body[child])
    scene.add_force(carom.forces.Spring(4530.0, at(C), at(D), rest_length=0.07785), body[3])
    scene.add_force(carom.forces.Torque((0, 0, torque)), body[1])
    return scene


# %%
# Besides the angles there is a check by energy: its change must be the work of the motor, torque times angle
# of the crank.


def main(out="out/examples"):
    s = carom.simulate(mechanism(), 0.03, step=2.5e-5)
    turned = np.unwrap(2 * np.arctan2(s.orientation[..., 3], s.orientation[..., 0]), axis=0)
    angle, work = start + turned[:, [0, 2, 4, 6]], torque * turned[:, 0]
    energy = np.max(np.abs(s.total_energy - s.total_energy[0] - work))
    error, kept = np.max(np.abs(angle[-1] / end - 1)), np.max(s.constraint_errors)
    print(mechanism().check())
    print(f"angles at the end {error:.1e}, energy {energy:.1e} J, constraints {kept:.1e}")
    with picture(f"{out}/a03_andrews.png", columns=2) as (angles, energies):
        angles.plot(1e3 * s.t, angle[:, 1:], label=["spring arm", "left arm", "right arm"])
        energies.plot(1e3 * s.t, np.c_[work, s.kinetic_energy], label=["work", "kinetic"])
        for axes, what in ((angles, "angle / rad"), (energies, "energy / J")):
            axes.set(xlabel="time / ms", ylabel=what, ylim=(-0.1, 1.8))
            axes.legend(ncols=3, loc="upper center")
    assert max(error, energy / 100, kept) < 1e-9


if __name__ == "__main__":
    main()
