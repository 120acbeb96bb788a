r"""
How thin a stone arch may be
============================

A half circle of stones without mortar stands if it is thick enough (about 0.107 of its radius: Milankovitch, 1907);
thinner, it folds on hinges that open at crown, haunches and feet. Of eleven stones the limit is known from a linear
programme: forces at the corners of the joints, none of which pulls, that hold each stone (Heyman, 1966).
"""

from pathlib import Path

import numpy as np
from matplotlib.patches import Polygon
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

import carom
from carom.geometry import quaternion
from carom.paper import style

g, R, count, mu = 9.81, 1.0, 11, 0.9
angles = np.linspace(0, np.pi, count + 1)


def corners(thickness):
    """(joint, inner or outer, xz)."""
    radii = R * (1 + np.array([-0.5, 0.5]) * thickness)
    return radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None]


def simulate(thickness, duration):
    scene, c = carom.Scene(gravity=(0, 0, -g)), corners(thickness)
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    for k in range(count):
        stone = carom.Convex(
            [(x, y, z) for x, z in c[k : k + 2].reshape(4, 2) for y in (-0.15, 0.15)]
        )
        scene.add_body(stone, density=2000, position=stone.centroid)
    scene.set_contact_default(restitution=0.0, friction=mu)
    return carom.simulate(scene, duration, step=2e-3)


def possible(thickness):
    """Whether forces at the corners, in their friction cones, hold all stones."""
    stones, c = simulate(thickness, 2e-3).scene.bodies, corners(thickness)
    rows, load = np.zeros((3 * count, 4 * (count + 1))), np.zeros(3 * count)
    for k, stone in enumerate(stones):
        load[3 * k + 1 : 3 * k + 3] = stone.mass * g * np.array([1, stone.position[0]])
        for j, sign in ((k, 1), (k + 1, -1)):
            n = np.array([-np.sin(angles[j]), np.cos(angles[j])])  # onto the next stone
            edges = [n + s * mu * np.array([n[1], -n[0]]) for s in (-1, 1)]
            columns = [(*f, p[0] * f[1] - p[1] * f[0]) for p in c[j] for f in edges]
            rows[3 * k : 3 * k + 3, 4 * j : 4 * j + 4] = sign * np.transpose(columns)
    return linprog(np.zeros(rows.shape[1]), A_eq=rows, b_eq=load).status == 0


def thinnest(stands, low=0.09, high=0.12):
    for _ in range(9):
        middle = (low + high) / 2
        low, high = (low, middle) if stands(middle) else (middle, high)
    return middle


def main(out="out/examples"):
    found = thinnest(lambda t: not np.any(simulate(t, 4e-3).velocity[-1]))
    exact = thinnest(possible)
    print(f"the thinnest arch that stands: {found:.5f} R, by the linear programme {exact:.5f} R")
    with style.style():
        figure, axes = style.new(style.PAGE, 2.2, columns=2, sharey=True)
        for one, thickness, duration, colour in zip(
            axes, (0.105, 0.09), (0.3, 0.44), ("0.9", "#f5d5c0")
        ):
            s = simulate(thickness, duration)
            for x, q, c in zip(s.position[-1], s.orientation[-1], s.scene.bodies):
                k = [c.shape.points[i] for i in ConvexHull(c.shape.points[:, [0, 2]]).vertices]
                one.add_patch(
                    Polygon(
                        [(x + quaternion.rotate(q, p))[[0, 2]] for p in k],
                        fc=colour,
                        ec="k",
                        lw=0.6,
                    )
                )
            one.axhline(0, color="k", lw=1)
            one.set(aspect="equal", xlim=(-1.25, 1.25), ylim=(-0.05, 1.12), xlabel="x / R")
            one.set_title(f"thickness {thickness:g} R, after {duration:g} s")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "arch.png", dpi=style.DPI)
    assert abs(found - exact) < 2e-4


if __name__ == "__main__":
    main()
