"""A04: Bricard's mechanism
========================

Five rods and the ground in a ring of six hinges, each across the last. Counting says 30 - 30 = 0 freedoms, but
one row follows from the others everywhere: it moves. Gravity and the hinges do no work on the whole, so the
energy is kept; the benchmark asks for 1 mJ in 10 s.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom

CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], float)


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


def main(out="out/examples"):
    print(mechanism().check())
    figure = Figure(figsize=(6.5, 3), layout="constrained")
    motion, drift = figure.subplots(1, 2)
    for method, h in (("rk4", 0.01), ("rk5", 0.01), ("rk8", 0.02)):
        s = carom.simulate(mechanism(), 10.0, step=h, method=method)
        energy, kept = np.abs(s.ledger.residual), np.max(s.constraint_errors, axis=(1, 2))
        print(f"{method}, {h} s: energy {np.max(energy):.1e} J, constraints {kept[0]:.1e} m or rad, "
              f"{kept[1]:.1e} m/s or rad/s")  # fmt: skip
        drift.semilogy(s.t, energy, lw=1, label=f"{method}, {1e3 * h:.0f} ms")
        assert np.max(energy) < 2e-8
        assert np.max(kept) < 1e-12

    for part, name in ((s.kinetic_energy, "kinetic"), (s.potential_energy, "potential")):
        motion.plot(s.t, part - (name == "potential") * part[0], lw=1, label=name)
    motion.set(xlabel="time [s]", ylabel="energy, from the start [J]", ylim=(-6, 8))
    drift.set(xlabel="time [s]", ylabel="change of the energy [J]", ylim=(1e-16, 1e-5))
    motion.legend(ncols=2, loc="upper center", frameon=False)
    drift.legend(
        ncols=3, loc="upper center", frameon=False, fontsize=7, handlelength=0.8, columnspacing=0.8
    )
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "a04_bricard.png", dpi=150)


if __name__ == "__main__":
    main()
