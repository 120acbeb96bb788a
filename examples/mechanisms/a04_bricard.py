"""A04: Bricard's mechanism
========================

Five rods and the ground form a ring of six hinges. To count its freedoms gives 30 - 30 = 0, and yet the ring
moves: one of the constraints follows from the others in every position. Only gravity does work, so the sum of
kinetic and potential energy is constant; the benchmark allows a change of 1 mJ in 10 s.
"""

from itertools import pairwise

import numpy as np

import carom
from carom.visual.plots.style import picture

CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], float)

# %%
# The corners are those of a cube. Each rod lies between two of them, and the axis of each hinge is at a right
# angle to both of its rods. No option is needed for the redundant constraint.


def mechanism():
    scene = carom.Scene(gravity=(0, -9.81, 0))
    for a, b in pairwise(CORNERS):  # rods of 1 kg and 1 m, 0.1 m square
        scene.add_body(carom.Box(*(0.1 + 0.9 * abs(b - a))), mass=1.0, position=(a + b) / 2)
    ring = [carom.GROUND, *scene.bodies, carom.GROUND]
    along = CORNERS - np.roll(CORNERS, 1, axis=0)  # of the part that ends at a corner
    for k, corner in enumerate(CORNERS):
        axis = np.cross(along[k], along[(k + 1) % 6])
        pair = ring[k : k + 2] if k < 5 else ring[:4:-1]
        scene.add_joint(carom.joints.Revolute(corner, axis), *pair)
    return scene


# %%
# Three methods are run. On the left is the exchange of kinetic and potential energy, on the right the error
# of their sum.


def main(out="out/examples"):
    print(mechanism().check())
    with picture(f"{out}/a04_bricard.png", columns=2) as (motion, drift):
        for method, h in (("rk4", 0.01), ("rk5", 0.01), ("rk8", 0.02)):
            s = carom.simulate(mechanism(), 10.0, step=h, method=method)
            energy, kept = np.abs(s.ledger.residual), np.max(s.constraint_errors, axis=(1, 2))
            print(f"{method}, {h} s: energy {np.max(energy):.1e} J, constraints {kept[0]:.1e} m or rad, "
                  f"{kept[1]:.1e} m/s or rad/s")  # fmt: skip
            drift.semilogy(s.t, energy, lw=0.7, label=f"{method}, {1e3 * h:.0f} ms")
            assert np.max(energy) < 2e-8
            assert np.max(kept) < 1e-12
        motion.plot(s.t, s.kinetic_energy, label="kinetic")
        motion.plot(s.t, s.potential_energy - s.potential_energy[0], label="potential")
        motion.set(xlabel="time / s", ylabel="energy, from the start / J", ylim=(-6, 8))
        drift.set(xlabel="time / s", ylabel="change of the energy / J", ylim=(1e-16, 1e-5))
        for axes in (motion, drift):
            axes.legend(ncols=3, loc="upper center")


if __name__ == "__main__":
    main()
