r"""A plank on two rollers
======================

Two rollers turn against each other, and a plank lies across them. It presses more on the nearer one, whose
friction pushes it back: it swings, whatever the speed of the rollers, and so kinetic friction is measured
(Timoshenko's device). If the rollers turn outwards, it leaves.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, mu, apart, radius, thick, start, m = 9.81, 0.25, 0.8, 0.12, 0.02, 0.15, 2.0

# %%
# The rollers do not move: their surfaces turn in themselves. A positive rate turns the tops inwards.


def plank_on_rollers(rate):
    scene = carom.Scene(gravity=(0, 0, -g))
    box = carom.Box(2.4, 0.2, thick)
    plank = scene.add_body(box, mass=m, position=(start, 0, radius + thick / 2), name="plank")
    for side, name in ((-1, "left"), (1, "right")):
        roller = scene.add_static(
            carom.Cylinder(radius, 0.3), position=(side * apart / 2, 0, 0),
            orientation=carom.euler("x", 90), surface_spin=((0, 1, 0), -side * rate), name=name,
        )  # fmt: skip
        scene.add_contact(plank, roller, friction=mu, restitution=0.0)
    return scene


# %%
# With the distance L of the rollers the plank is an oscillator,
#
# .. math:: \ddot x = \mp \omega^2 x, \quad \omega^2 = \frac{2 \mu g}{L \mp \mu h},
#
# where the thickness h is there because friction acts below the mass centre. The drives give what friction
# takes: :math:`\mu m g` times the speed of the surfaces.


def main(out="out/examples"):
    inwards = carom.simulate(plank_on_rollers(20.0), 4.0)
    outwards = carom.simulate(plank_on_rollers(-20.0), 0.6)
    w, k = (np.sqrt(2 * mu * g / (apart - s * mu * thick)) for s in (1, -1))
    swings, leaves = (s["plank"].position[:, 0] for s in (inwards, outwards))
    error = np.max(np.abs(swings - start * np.cos(w * inwards.t)))
    other = np.max(np.abs(leaves - start * np.cosh(k * outwards.t)))
    power = (inwards.surface_power("left") + inwards.surface_power("right"))[1:].mean()
    print(f"inwards within {error:.0e} m, outwards within {other:.0e} m")
    print(f"power of the drives {power:.4f} W, exact {mu * m * g * 20.0 * radius:.4f} W")

    with picture(f"{out}/plank_on_rollers.png") as axes:
        axes.plot(inwards.t, swings, label="inwards")
        axes.plot(outwards.t, leaves, label="outwards")
        axes.set(xlabel="time / s", ylabel="place of the plank / m"), axes.legend()
    assert max(error, other) < 1e-5
    return inwards


if __name__ == "__main__":
    main()
