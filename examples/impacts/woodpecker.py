r"""The woodpecker toy, by two laws of friction
===========================================

A woodpecker on a spring falls down a pole in steps: its sleeve jams, the bird swings and strikes the pole with
its beak, which frees the sleeve. In the literature (Glocker and Studer, Multibody System Dynamics 13, 2005)
friction is that by the slip *after* an impact, ``impact_law="moreau"``: along the impact it makes other steps.
"""

import numpy as np
import sympy as sp

import carom
from carom.visual.plots.style import picture

m, M, J_m, J, c, g = 0.0003, 0.0045, 5e-9, 7e-7, 0.0056, 9.81  # sleeve, bird, spring
h_m, l_m, l_g, h_b, l_b = 0.0058, 0.010, 0.015, 0.02, 0.0201  # lengths
play = 0.0031 - 0.0025  # of the sleeve on the pole

# %%
# Coordinates are the height y of the sleeve, its angle a and the angle b of the bird. Both edges of the sleeve
# and the beak may touch the pole; each slips along it. ``law`` is the law of impact of all three.


def toy(**law):
    y, a, b, dy, da, db = sp.symbols("y a b dy da db")
    speed = dy + l_m * da + l_g * db  # of the bird
    toy = carom.GeneralizedSystem.from_sympy(
        [y, a, b], [dy, da, db],
        kinetic_energy=(m * dy**2 + M * speed**2 + J_m * da**2 + J * db**2) / 2,
        potential=g * (m * y + M * (y + l_m * a + l_g * b)) + c * (a - b) ** 2 / 2,
        position=[0, -play / h_m, -0.2788], velocity=[-0.3411, 0, -7.4583],
    )  # fmt: skip
    edge, beak = dy + 0.0031 * da, dy + l_m * da + (l_g - l_b) * db
    gap = l_m + l_g - l_b - 0.0025 - h_b * b
    toy.add_contact(gap, tangent=beak, restitution=0.5, friction=0.3, name="beak", **law)
    for name, side in (("lower edge", h_m * a), ("upper edge", -h_m * a)):
        toy.add_contact(play + side, tangent=edge, restitution=0.0, friction=0.3, name=name, **law)
    return toy


# %%
# By Newton's law along the impact, edges that strike at once are one contact problem
# (``Options(multiple="newton")``), so that both runs differ in nothing but friction in single impacts.

LAWS = {
    "by the slip after": ({"impact_law": "moreau"}, {}),
    "along the impact": ({}, {"options": carom.Options(multiple="newton")}),
}


def main(out="out/examples"):
    cycles = {}
    with picture(f"{out}/woodpecker.png", columns=2) as (stairs, portrait):
        for label, (law, options) in LAWS.items():
            s = carom.simulate(toy(**law), 6.0, save_at=5e-4, **options)
            struck = s.impacts.contact == 0  # the beak, once in each step down
            time, height = s.impacts.time[struck], s.impacts.position[struck, 0]
            cycles[label] = np.diff(time)[-1], -np.diff(height)[-1]
            slip = s.impacts[int(np.argmax(struck))].relative_velocity_after[1]
            told = "{:.2f} ms, {:.2f} mm".format(*1e3 * np.array(cycles[label]))
            print(f"friction {label}: a step of {told}; slip after the first beat {slip:.4f} m/s")
            first, last = s.t < 0.8, s.t > 6.0 - cycles[label][0]
            stairs.plot(s.t[first], 1e3 * s.q[first, 0], label=label)
            portrait.plot(s.q[last, 2], s.v[last, 2], lw=1.2)
            assert np.max(np.abs(s.ledger.residual)) < 1e-9
        stairs.set(xlabel="t / s", ylabel="height of the sleeve / mm")
        stairs.legend(title="friction", loc="lower left")
        portrait.set(xlabel="angle of the bird / rad", ylabel="its rate / rad s$^{-1}$")
    assert np.allclose(cycles["by the slip after"], (0.14597, 0.01944), rtol=0, atol=1e-5)
    assert np.allclose(cycles["along the impact"], (0.15121, 0.01929), rtol=0, atol=1e-5)


if __name__ == "__main__":
    main()
