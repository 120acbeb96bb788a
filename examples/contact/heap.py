"""A heap of balls and its chains of force
=======================================

Sixty balls fall between two walls and come to rest. Only some of them carry the weight of the others, along
chains of large force. At rest, floor and walls must carry the whole weight. To pour more balls:
``python examples/contact/heap.py 500``.
"""

import sys

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

import carom
from carom.visual.plots.style import RED, picture

g, radius, density = 9.81, 0.01, 2500.0

# %%
# The balls start in rows, with radii and places that are a little random. Two panes before and behind them
# leave only a little more room than one ball needs.


def pour(count, width):
    scene, rng = carom.Scene(gravity=(0, 0, -g)), np.random.default_rng(7)
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    for k, half in ((0, width / 2), (1, 1.05 * radius)):
        for side in (-1, 1):
            scene.add_half_space(side * half * np.eye(3)[k], -side * np.eye(3)[k])
    row, rough = int(width / (2.4 * radius)), carom.Options(energy_tolerance=0.01)  # of order 1
    for i in range(count):
        r, x = radius * rng.uniform(0.75, 1.0), (i % row + 0.5) * width / row - width / 2
        place = (x + rng.uniform(-0.1, 0.1) * radius, 0, (1.2 + 2.4 * (i // row)) * radius)
        mass = density * 4 / 3 * np.pi * r**3
        scene.add_body(carom.Sphere(r), mass=mass, position=place, velocity=(0, 0, -0.5))
    scene.set_contact_default(restitution=0.3, friction=0.4, rolling_friction=1e-4)
    return carom.simulate(scene, 1.5, step=1e-3, save_every=10, options=rough)


# %%
# ``solution.forces`` has the force of each persistent contact at each saved time. We draw those of the last
# time as lines between the centres, wide where the force is large.


def draw(axes, s):
    x, size = s.position[-1], [2 * b.shape.radius for b in s.scene.bodies]
    look = dict(units="xy", transOffset=axes.transData, fc="0.88", ec="0.5", lw=0.5)
    axes.add_collection(EllipseCollection(size, size, 0 * x[:, 0], offsets=x[:, [0, 2]], **look))
    f, at = s.forces, np.flatnonzero(s.forces.saved == s.forces.saved[-1])
    ends = np.where(f.other[at, None] >= 0, x[f.other[at]], f.point[at])
    lines = np.stack([x[f.body[at]], ends], axis=1)[:, :, [0, 2]]
    width = 6 * f.force[at, 0] / f.force[at, 0].max()
    axes.add_collection(LineCollection(lines, lw=width, color=RED))
    axes.set(xticks=[], yticks=[], aspect="equal", ylim=(0, 1.1 * x[:, 2].max()))
    axes.spines.right.set_visible(True)  # left and right are the walls


# %%
# The sum of the forces on floor and walls must be the weight of all balls. How a heap shares this weight
# among its contacts depends on its history. The film shows how the balls fall.


def main(out="out/examples", count=60):
    width = 0.018 * max(5, np.sqrt(count))
    s = pour(count, width)
    with picture(f"{out}/heap.png", width=3.6, height=3.4) as axes:
        draw(axes, s)
        axes.set(xlim=(-width / 2, width / 2))
    carom.film(s, f"{out}/heap.gif", size=(320, 320), fps=12, speed=0.2, end=0.4, view="front")
    print(f"{count} balls, {len(s.impacts)} impacts")
    f, weight = s.forces, g * sum(b.mass for b in s.scene.bodies)
    carried = f.vector[(f.saved == f.saved[-1]) & (f.other < 0), 2].sum()
    print(f"floor and walls carry {carried:.9g} N of {weight:.9g} N")
    assert abs(carried - weight) < 1e-5 * weight


if __name__ == "__main__":
    main(count=int(sys.argv[1]) if len(sys.argv) > 1 else 60)
