"""Cost of the points of a pair of solids, by kind and by gap; and of the broad phase, by number of balls."""

from __future__ import annotations

import itertools

import numpy as np

from carom._compiled.decorators import entry
from carom.collision.layout import Placed, new_pair_work, new_points, solid_table
from carom.collision.sweep import new_sweep_work, sweep
from carom.collision.touch import touch
from carom.scene import Box, Capsule, Convex, Cylinder, Disc, Ellipsoid, Sphere
from common import report, seconds

POSES = 400
GAPS = (0.1, 1e-3, -1e-4, -1e-2)
rng = np.random.default_rng(1)


def rounded(points, half):
    """Return points on an ellipsoid."""
    return points / np.linalg.norm(points, axis=1)[:, None] * half


SHAPES = {
    "sphere": Sphere(0.3),
    "capsule": Capsule(0.2, 0.7),
    "box": Box(0.4, 0.5, 0.9),
    "rounded box": Box(0.4, 0.5, 0.9, radius=0.1),
    "hull of 8": Convex(rng.normal(size=(12, 3)) * 0.3),
    "hull of 800": Convex(rounded(rng.normal(size=(800, 3)), (0.4, 0.3, 0.2))),
    "cylinder": Cylinder(0.3, 0.6),
    "disc": Disc(0.4),
    "ellipsoid": Ellipsoid(0.2, 0.3, 0.5),
}


@entry
def touch_all(a, b, hulls, X, Q, work, out):
    """Touch A at each pose (X[k], Q[k]), B at the origin."""
    zero, one = X[-1], Q[-1]
    for k in range(len(X) - 1):
        touch(Placed(a, X[k], Q[k]), Placed(b, zero, one), hulls, 1e-3, work, out)


def pair(first, second):
    """Return microseconds a call, for each gap."""
    solids, hulls = solid_table([SHAPES[first], SHAPES[second]])
    work, out = new_pair_work(), new_points()
    Q = rng.normal(size=(POSES + 1, 4))
    Q[-1] = (1, 0, 0, 0)
    Q /= np.linalg.norm(Q, axis=1, keepdims=True)
    X = rng.normal(size=(POSES + 1, 3))
    X *= 2 / np.linalg.norm(X, axis=1, keepdims=True)
    X[-1] = 0
    touching = X.copy()
    for k in range(POSES):
        moved, fixed = Placed(solids[0], X[k], Q[k]), Placed(solids[1], X[-1], Q[-1])
        touch(moved, fixed, hulls, 0.0, work, out)
        touching[k] -= out[0].gap * out[0].normal
    result = []
    for gap in GAPS:
        away = X[:-1] - touching[:-1]
        moved = touching.copy()
        moved[:-1] += gap * away / np.linalg.norm(away, axis=1, keepdims=True)
        arguments = (*solids, hulls, moved, Q, work, out)
        cost = min(seconds(lambda given=arguments: touch_all(*given)))
        result.append(cost / POSES * 1e6)
    return result


def broad_phase(count):
    """Return nanoseconds a ball of a heap with 1.4 pairs a ball."""
    centres = rng.uniform(0, np.cbrt(count / 0.7), (count, 3))
    pairs, work = np.zeros((4 * count, 2), dtype=np.int64), new_sweep_work(count)
    arguments = (centres, np.full(count, 0.5), pairs, work)
    return min(seconds(lambda: sweep(*arguments))) / count * 1e9


def main():
    """Print the tables."""
    rows = [
        [f"{first}, {second}", *(f"{cost:.2f}" for cost in pair(first, second))]
        for first, second in itertools.combinations_with_replacement(SHAPES, 2)
    ]
    head = ["pair", *(f"gap {gap:g} m" for gap in GAPS)]
    notes = "Microseconds a call of `touch`, shapes of some 0.5 m, random poses, reach 1 mm."
    report("pairs", "Points of a pair of solids", head, rows, notes)
    rows = [[count, f"{broad_phase(count):.0f}"] for count in (500, 4000, 32000)]
    report("sweep", "Broad phase", ["balls", "ns a ball"], rows, "A heap with 1.4 pairs a ball.")


if __name__ == "__main__":
    main()
