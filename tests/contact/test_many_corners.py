"""Hulls of many corners: the farthest corner and the nearest normal are those of a scan, to the last bit."""

import math

import numpy as np
import pytest

import carom
from carom._compiled.decorators import entry
from carom.collision.farthest import NORMALS, VERTICES, farthest
from carom.collision.layout import solid_table


@entry
def numbers(solid, hulls, what, directions, value, number):
    """Write the greatest product of each direction, and the number of its vertex or face."""
    for k in range(directions.shape[0]):
        d = directions[k]
        value[k], i = farthest(solid, hulls, what, d[0], d[1], d[2])
        number[k] = hulls.candidates[i].number


def ellipsoid(n):
    points = np.random.default_rng(n).normal(size=(n, 3))
    return carom.Convex(points / np.linalg.norm(points, axis=1)[:, None] * (0.1, 0.07, 0.05))


def found(solids, hulls, k, what, directions):
    value, number = np.zeros(len(directions)), np.zeros(len(directions), dtype=np.int64)
    numbers(solids[k], hulls, what, directions, value, number)
    return value, number


@pytest.mark.plain
def test_the_same_as_a_scan():
    shapes = [ellipsoid(8), ellipsoid(60), carom.Box(1, 2, 3), ellipsoid(400)]
    solids, hulls = solid_table(shapes)
    rng = np.random.default_rng(3)
    directions = np.concatenate([rng.normal(size=(300, 3)), rng.integers(-2, 3, size=(100, 3))])
    directions = directions[np.any(directions != 0, axis=1)]
    for k in (0, 1, 3):
        piece = shapes[k].pieces[0]
        for what, points in ((VERTICES, piece.vertices), (NORMALS, piece.normals)):
            value, number = found(solids, hulls, k, what, directions)
            x, y, z = directions.T
            products = points[:, :1] * x + points[:, 1:2] * y + points[:, 2:] * z
            np.testing.assert_array_equal(number, np.argmax(products, axis=0))
            np.testing.assert_array_equal(value, np.max(products, axis=0))


@pytest.mark.plain
def test_no_direction_still_gives_a_number_of_the_hull():
    solids, hulls = solid_table([ellipsoid(60)])
    none = np.array([(a, b, c) for a in (0.0, math.nan, math.inf) for b in (0.0, math.nan, -1.0)
                     for c in (0.0, math.inf, math.nan)])  # fmt: skip
    with np.errstate(invalid="ignore"):
        for what in (VERTICES, NORMALS):
            number = found(solids, hulls, 0, what, none)[1]
            assert np.all((number >= 0) & (number < 60 + 56 * what))  # 2 * 60 - 4 triangles


def test_work_of_a_trial_step_does_not_grow_with_the_corners():
    """Candidates of the cell of a direction, on average over the sphere: what each answer compares."""
    directions = np.random.default_rng(0).normal(size=(400, 3))
    for n in (100, 800, 3000):
        solids, hulls = solid_table([ellipsoid(n)])
        across, first = int(solids[0].across[0]), int(solids[0].cell[0])
        lengths = np.diff(hulls.starts[first : first + 6 * across * across + 1])
        assert lengths.mean() < 6
        assert found(solids, hulls, 0, VERTICES, directions)[1].max() < n
