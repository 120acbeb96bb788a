r"""Coordinates of your own: a bead on a torus
==========================================

A manifold that is not flat, in two angles, with the metric :math:`\mathrm{diag}(r^2, (R + r \cos a)^2)`.
Gravity points along the axis of the torus, and a level floor cuts it: so the momentum about the axis, :math:`(R
+ r \cos a)^2 \dot b` (Clairaut's integral), is kept, through all impacts.
"""

from pathlib import Path

import numpy as np
import sympy as sp
from matplotlib.figure import Figure

import carom

g, R, r, floor, e = 9.81, 1.0, 0.4, -0.3, 0.8


def main(out="out/examples"):
    a, b, da, db = sp.symbols("a b da db")
    bead = carom.GeneralizedSystem.from_sympy(
        [a, b], [da, db],
        metric=sp.diag(r**2, (R + r * sp.cos(a)) ** 2), potential=g * r * sp.sin(a),
        position=[1.2, 0.0], velocity=[0.0, 2.0],
    )  # fmt: skip
    bead.add_contact(r * sp.sin(a) - floor, restitution=e, name="floor")

    solution = carom.simulate(bead, 4.0, step=1e-3)

    ring = R + r * np.cos(solution.q[:, 0])
    momentum = ring**2 * solution.v[:, 1]
    change = np.ptp(momentum) / momentum[0]
    print(f"{len(solution.impacts)} impacts; momentum about the axis kept to {change:.1e}")
    print(
        f"energy that no entry of the ledger explains: {np.max(np.abs(solution.ledger.residual)):.1e} J"
    )

    figure = Figure(figsize=(6, 3), layout="constrained")
    above, along = figure.subplots(1, 2)
    above.plot(ring * np.cos(solution.q[:, 1]), ring * np.sin(solution.q[:, 1]), lw=0.8)
    above.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    along.plot(solution.t, r * np.sin(solution.q[:, 0]))
    along.axhline(floor, color="k", lw=0.5)
    along.set(xlabel="time [s]", ylabel="height [m]")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "own_coordinates.png", dpi=150)

    assert change < 1e-8
    assert len(solution.impacts) > 3
    assert np.min(r * np.sin(solution.q[:, 0])) > floor - 1e-12


if __name__ == "__main__":
    main()
