"""An arch of stones: thick enough to stand by limit analysis, it stands; a little thinner, it falls.

Forces at the two corners of each joint, within their friction cones, hold all stones or do not: a linear
programme (Heyman 1966). The safe theorem says that the arch then stands, the unsafe one that it else falls.
"""

import runpy
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import linprog

PATH = Path(__file__).parents[2] / "examples/contact/arch.py"
ARCH = runpy.run_path(str(PATH))


def held(thickness):
    g, mu, count = ARCH["g"], ARCH["mu"], ARCH["count"]
    corners = ARCH["corners"](thickness)
    rows, load = np.zeros((3 * count, 4 * (count + 1))), np.zeros(3 * count)
    for k, (a, b) in enumerate(pairwise(corners)):
        (area, centre), x = _trapezium(np.array([*a, *b[::-1]])), 3 * k
        load[x + 1 : x + 3] = area * g * np.array([1, centre[0]])
        for j, sign in ((k, 1), (k + 1, -1)):
            t = mu * corners[j, 0] / np.linalg.norm(corners[j, 0])
            n = np.array([-t[1], t[0]]) / mu  # onto the next stone
            edges = [(p, f) for p in corners[j] for f in (n - t, n + t)]
            columns = [(*f, p[0] * f[1] - p[1] * f[0]) for p, f in edges]
            rows[x : x + 3, 4 * j : 4 * j + 4] = sign * np.transpose(columns)
    return linprog(np.zeros(rows.shape[1]), A_eq=rows, b_eq=load).status == 0


def _trapezium(points):
    """Area and centroid of a polygon."""
    x, y = points.T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    centre = ((points + np.roll(points, -1, axis=0)) * cross[:, None]).sum(axis=0) / (
        3 * cross.sum()
    )
    return abs(cross.sum()) / 2, centre


@pytest.mark.parametrize("part", [0.9995, 1.0005])
def test_arch_stands_as_limit_analysis_says(part):
    thickness = part * ARCH["LIMIT"]
    moves = np.any(ARCH["simulate"](thickness, 4e-3).velocity[-1])
    assert held(thickness) == (not moves) == (part > 1)
