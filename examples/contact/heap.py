"""A heap of balls and its chains of force
=======================================

At rest floor and walls carry the weight, shared as it may be. `python examples/contact/heap.py 500` pours more.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure

import carom

g, radius, density = 9.81, 0.01, 2500.0


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


def draw(axes, solution, row, title):
    x, size = solution.position[row], [2 * b.shape.radius for b in solution.scene.bodies]
    balls = EllipseCollection(size, size, np.zeros(len(x)), units="xy", offsets=x[:, [0, 2]],
                              transOffset=axes.transData, fc="0.9", ec="0.5", lw=0.5)  # fmt: skip
    axes.add_collection(balls)
    at = np.flatnonzero((f := solution.forces).saved == row)
    ends = np.where(f.other[at, None] >= 0, x[f.other[at]], f.point[at])
    width = np.minimum(4.0, 4.0 * f.force[at, 0] / f.force[f.saved == f.saved[-1], 0].max())
    lines = np.stack([x[f.body[at]], ends], axis=1)[:, :, [0, 2]]
    axes.add_collection(LineCollection(lines, lw=width, color="#D55E00"))
    axes.set(title=title, xlabel="x [m]", aspect="equal")


def main(out="out/examples", count=60):
    width = 0.024 * max(5, np.sqrt(count))
    solution = pour(count, width)
    figure = Figure(figsize=(9, 4), layout="constrained")
    for axes, t in zip(figure.subplots(1, 3, sharex=True, sharey=True), (0.02, 0.12, 1.5)):
        draw(axes, solution, np.searchsorted(solution.t, t - 1e-9), f"{t:g} s")
        axes.set(xlim=(-width / 2, width / 2), ylim=(0, 1.05 * solution.position[0, :, 2].max()))
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "heap.png", dpi=150)
    print(f"{count} balls, {len(solution.impacts)} impacts")
    f, weight = solution.forces, g * sum(b.mass for b in solution.scene.bodies)
    carried = f.vector[(f.saved == f.saved[-1]) & (f.other < 0), 2].sum()
    print(f"floor and walls carry {carried:.9g} N of {weight:.9g} N")
    assert abs(carried - weight) < 1e-5 * weight


if __name__ == "__main__":
    main(count=int(sys.argv[1]) if len(sys.argv) > 1 else 60)
