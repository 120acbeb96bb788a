r"""How thin a stone arch may be
============================

A half circle of stones without mortar stands if it is thick enough. A thinner one folds: hinges open at its
crown, at its haunches and at its feet. Arches are run until the least thickness is found, and it is compared
with that of limit analysis.
"""

from itertools import pairwise

import numpy as np

import carom
from carom.visual.plots.style import picture

g, R, count, mu, LIMIT = 9.81, 1.0, 11, 0.9, 0.104589

# %%
# Each stone lies between two joints of the arch, whose corners are on the inner and on the outer circle.


def corners(thickness):  # of the joints (count + 1), inner and outer (2), x and z (2)
    radii, angles = R + thickness / 2 * np.array([-R, R]), np.linspace(0, np.pi, count + 1)
    return radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None]


# %%
# The stones are convex bodies. They touch each other and the ground with friction and without restitution.


def simulate(thickness, duration):
    scene = carom.Scene(gravity=(0, 0, -g))
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    for a, b in pairwise(corners(thickness)):
        stone = carom.Convex([(x, y, z) for x, z in (*a, *b) for y in (-0.15, 0.15)])
        scene.add_body(stone, density=2000, position=stone.centroid)
    scene.set_contact_default(restitution=0.0, friction=mu)
    rough = carom.Options(energy_tolerance=1e-3)  # of the energy of a motion that has just begun
    return carom.simulate(scene, duration, step=2e-3, options=rough)


# %%
# An arch that stands has no velocity after the first steps. Bisection finds the thickness that just stands.


def thinnest(halvings, low=0.1, high=0.11):
    for _ in range(halvings):
        middle = (low + high) / 2
        falls = np.any(simulate(middle, 4e-3).velocity[-1])
        low, high = (middle, high) if falls else (low, middle)
    return middle


# %%
# A continuous arch needs the thickness 0.107 R (Milankovitch, 1907). For eleven stones the limit is 0.104589
# R: below it no forces at the corners of the joints, none of which pulls, support each stone. This is a
# linear programme (limit analysis: Heyman, 1966). The pictures show an arch above this limit and one below
# it, the film shows how the second one folds.


def main(out="out/examples", halvings=8):
    found = thinnest(halvings)
    print(f"the thinnest arch that stands: {found:.5f} R, by limit analysis {LIMIT} R")
    with picture(f"{out}/arch.png", columns=2) as panels:
        for axes, thickness, duration in zip(panels, (0.105, 0.09), (0.3, 0.44)):
            s = simulate(thickness, duration)
            axes.imshow(carom.films.still(s, size=(800, 600), view=(-75, 10), clock=False))
            axes.set(title=f"thickness {thickness:g} R, after {duration:g} s"), axes.axis("off")
    carom.film(s, f"{out}/arch.gif", size=(400, 300), fps=20, speed=0.2)
    assert abs(found - LIMIT) < 0.01 / 2**halvings + 2e-5  # 6e-5 after eight


if __name__ == "__main__":
    main()
