r"""How thin a stone arch may be
============================

A half circle of stones without mortar stands if it is thick enough (about 0.107 of its radius: Milankovitch,
1907); thinner, it folds on hinges that open at crown, haunches and feet. Of eleven stones the limit is
0.104589: below it no forces at the corners of the joints, none of which pulls, hold each stone (limit analysis,
Heyman 1966, a linear programme). The run finds it by letting arches stand or fall.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull

import carom
from carom.geometry import quaternion
from carom.visual.plots import style

g, R, count, mu, LIMIT = 9.81, 1.0, 11, 0.9, 0.104589


def corners(thickness):  # of the joints (count + 1), inner and outer (2), x and z (2)
    radii, angles = R + thickness / 2 * np.array([-R, R]), np.linspace(0, np.pi, count + 1)
    return radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None]


def simulate(thickness, duration):
    scene = carom.Scene(gravity=(0, 0, -g))
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    for a, b in pairwise(corners(thickness)):
        stone = carom.Convex([(x, y, z) for x, z in (*a, *b) for y in (-0.15, 0.15)])
        scene.add_body(stone, density=2000, position=stone.centroid)
    scene.set_contact_default(restitution=0.0, friction=mu)
    return carom.simulate(scene, duration, step=2e-3)


def thinnest(stands, low=0.09, high=0.12):
    for _ in range(9):
        middle = (low + high) / 2
        low, high = (low, middle) if stands(middle) else (middle, high)
    return middle


def main(out="out/examples"):
    found = thinnest(lambda t: not np.any(simulate(t, 4e-3).velocity[-1]))
    print(f"the thinnest arch that stands: {found:.5f} R, by limit analysis {LIMIT} R")
    with style.style():
        figure, axes = style.new(style.PAGE, 2.2, columns=2, sharey=True)
        for one, thickness, duration in ((axes[0], 0.105, 0.3), (axes[1], 0.09, 0.44)):
            s = simulate(thickness, duration)
            for x, q, body in zip(s.position[-1], s.orientation[-1], s.scene.bodies):
                arms = body.shape.points - body.shape.centroid
                p = np.array([x + quaternion.rotate(q, arm) for arm in arms])[:, [0, 2]]
                one.add_patch(Polygon(p[ConvexHull(p).vertices], fc="0.9", ec="k", lw=0.6))
            one.set(title=f"thickness {thickness:g} R, after {duration:g} s", xlabel="x / R")
            one.set(aspect="equal", xlim=(-1.25, 1.25), ylim=(0, 1.12))
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "arch.png", dpi=style.DPI)
    assert abs(found - LIMIT) < 1e-4


if __name__ == "__main__":
    main()
