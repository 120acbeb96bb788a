"""A rattleback turns back by itself
=================================

A rattleback is a boat of stone. Spun in one direction it keeps its spin; spun in the other it begins to
rattle, stops, and turns back (Walker, 1896; Bondi, 1986). It rolls without slip, so its energy must be
constant: what the spin loses is in the rattling, and comes back.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

m, (a, b, c), skew, spin = 0.1, (0.1, 0.02, 0.015), np.radians(10), 5.0

# %%
# The boat is an ellipsoid. Its axes of inertia are turned by 10 degrees against the axes of its shape: this
# couples spin and rattling. The friction is so large that it never slips.


def launch(spin, duration=3.0):
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


# %%
# We launch it in both directions, and look at its spin and at its rattling, which is the horizontal part of
# its angular velocity. The film shows the second launch.


def main(out="out/examples"):
    with picture(f"{out}/rattleback.png", columns=2, sharex=True) as (left, right):
        for sign, name in ((1, "one direction"), (-1, "the other")):
            s = launch(sign * spin)
            w = s.angular_velocity[:, 0]
            lost = np.max(np.abs(s.total_energy - s.total_energy[0])) / s.kinetic_energy[0]
            print(
                f"{name}: from {w[0, 2]:+.2f} to {w[-1, 2]:+.2f} rad/s, energy kept to {lost:.1e}"
            )
            left.plot(s.t, w[:, 2], label=name)
            right.plot(s.t, np.linalg.norm(w[:, :2], axis=1), lw=0.6)
            assert lost < 1e-3
            assert (w[-1, 2] > 0.9 * spin) or sign < 0
        left.set(xlabel="time / s", ylabel="spin / rad s$^{-1}$"), left.legend()
        right.set(xlabel="time / s", ylabel="rattling / rad s$^{-1}$")
    assert np.max(w[:, 2]) > 0.9 * spin, "it turned round"
    carom.film(s, f"{out}/rattleback.gif", size=(360, 240), fps=15, speed=0.8)


if __name__ == "__main__":
    main()
