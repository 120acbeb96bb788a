"""A rattleback turns back by itself
=================================

The heavy axes of this boat of stone are turned by 10 degrees against those of its belly. Spun one way it spins
on; spun the other way it begins to rattle and turns back (Walker, 1896; Bondi, 1986). It rolls, so that no
energy is lost on the way: what the spin loses is in the rattling, and comes back.
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

m, (a, b, c), skew, spin = 0.1, (0.1, 0.02, 0.015), np.radians(10), 5.0


def boat(spin, duration=3.0):
    scene = carom.Scene()
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    shape = carom.Ellipsoid(a, b, c)
    turn = np.array([[np.cos(skew), -np.sin(skew), 0], [np.sin(skew), np.cos(skew), 0], [0, 0, 1]])
    boat = scene.add_body(
        shape, mass=m, inertia=turn @ np.diag(shape.inertia(m).diagonal()) @ turn.T,
        position=(0, 0, c), angular_velocity=(0.02, 0, spin), name="boat",
    )  # fmt: skip
    scene.add_contact(boat, table, restitution=0.0, friction=2.0)
    return carom.simulate(scene, duration, step=1e-3)


def main(out="out/examples"):
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.5, columns=2)
        for sign, colour, way in (
            (1, style.GREY, "the good way"),
            (-1, style.BLUE, "the other way"),
        ):
            s = boat(sign * spin)
            w = s.angular_velocity[:, 0]
            lost = np.max(np.abs(s.total_energy - s.total_energy[0])) / s.kinetic_energy[0]
            print(
                f"spun {way}: from {w[0, 2]:+.2f} to {w[-1, 2]:+.2f} rad/s, energy kept to {lost:.1e}"
            )
            left.plot(s.t, w[:, 2], color=colour, label=way)
            assert lost < 1e-3
            assert (w[-1, 2] > 0.9 * spin) or sign < 0
        assert np.max(w[:, 2]) > 0.9 * spin, "it turned round"
        left.axhline(0, color="k", lw=0.5)
        left.set(xlabel="time / s", ylabel="spin / rad s$^{-1}$"), left.legend(loc="center right")
        right.plot(s.t, np.linalg.norm(w[:, :2], axis=1), color=style.RED, lw=0.6)
        right.set(xlabel="time / s", ylabel="rattling / rad s$^{-1}$")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "rattleback.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
