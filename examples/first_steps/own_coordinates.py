r"""Coordinates of your own: a bead on a torus
==========================================

A bead slides on a torus and strikes a level floor that cuts it. The surface is not flat, and the motion is
stated in two angles with a metric, from formulas in SymPy. No impact may change the momentum about the axis
of the torus (Clairaut's integral), which is the check.
"""

import numpy as np
import sympy as sp

import carom
from carom.visual.plots.style import picture

g, R, r, floor, e = 9.81, 1.0, 0.4, -0.3, 0.8

# %%
# The angle a turns about the tube, the angle b about the axis. The metric is
# :math:`\mathrm{diag}(r^2, (R + r \cos a)^2)`, the potential is :math:`g r \sin a`, and the contact is the
# height above the floor.


def slide():
    a, b, da, db = sp.symbols("a b da db")
    bead = carom.GeneralizedSystem.from_sympy(
        [a, b], [da, db],
        metric=sp.diag(r**2, (R + r * sp.cos(a)) ** 2), potential=g * r * sp.sin(a),
        position=[1.2, 0.0], velocity=[0.0, 2.0],
    )  # fmt: skip
    bead.add_contact(r * sp.sin(a) - floor, restitution=e, name="floor")
    return carom.simulate(bead, 4.0)


# %%
# Gravity and the floor have no moment about the axis. So :math:`(R + r \cos a)^2 \dot b` is constant, through
# all impacts. The energy ledger must close as well.


def main(out="out/examples"):
    s = slide()
    ring, height = R + r * np.cos(s.q[:, 0]), r * np.sin(s.q[:, 0])
    momentum = ring**2 * s.v[:, 1]
    change = np.ptp(momentum) / momentum[0]
    print(f"{len(s.impacts)} impacts; momentum about the axis kept to {change:.1e}")
    print(f"error of the energy ledger: {np.max(np.abs(s.ledger.residual)):.1e} J")

    x, y = ring * np.cos(s.q[:, 1]), ring * np.sin(s.q[:, 1])
    with picture(f"{out}/own_coordinates.png", height=4.0, subplot_kw={"projection": "3d"}) as axes:
        tube, about = np.meshgrid(np.linspace(-2.3, 5.5, 60), np.linspace(0, 2 * np.pi, 90))
        wide, up = R + r * np.cos(tube), np.maximum(r * np.sin(tube), floor)
        axes.plot_surface(wide * np.cos(about), wide * np.sin(about), up, color="0.9", alpha=0.3)
        axes.plot(x, y, height, lw=1.5)
        axes.set(
            xlabel="x / m", ylabel="y / m", zlabel="z / m", aspect="equal", zticks=[floor, 0, r]
        )
    assert change < 1e-8
    assert len(s.impacts) > 3
    assert np.min(height) > floor - 1e-12


if __name__ == "__main__":
    main()
