"""Candidates of cells of directions: the farthest of them is the farthest of all points, to the last bit."""

import numpy as np
import pytest

from carom.geometry.cells import FEW_POINTS, cells_of

rng = np.random.default_rng(7)


def sphere(n):
    points = rng.normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


def prism(n, half):
    turn = 2.0 * np.pi * np.arange(n) / n
    rings = [np.stack([np.cos(turn), np.sin(turn), np.full(n, z)], -1) for z in (-half, half)]
    return np.concatenate(rings)


SETS = {
    "ellipsoid": sphere(800) * (0.1, 0.07, 0.05),
    "prism": prism(100, 0.2),
    "disc": prism(60, 1e-9),
    "needle": sphere(300) * (1.0, 1e-6, 1e-6),
    "lattice": rng.integers(-3, 4, size=(400, 3)).astype(float),  # many equal products
    "off the origin": sphere(200) + (3.0, -5.0, 0.5),
    "some more than few": sphere(FEW_POINTS + 1),
}


def cell_of(across, d):
    """Return the number of the cell of a direction."""
    axis = int(np.argmax(np.abs(d)))
    place = [d[(axis + k) % 3] / abs(d[axis]) for k in (1, 2)]
    i, j = (min(int(0.5 * across * (x + 1.0)), across - 1) for x in place)
    return ((2 * axis + (d[axis] < 0)) * across + i) * across + j


@pytest.mark.parametrize("kind", SETS)
def test_farthest_of_the_candidates_is_the_farthest_of_all(kind):
    points = SETS[kind]
    across, starts, members = cells_of(points)
    # along axes, diagonals and sums of small numbers many points are equally far: the first of them counts
    directions = np.concatenate([sphere(2000), rng.integers(-4, 5, size=(500, 3)), points])
    for d in directions[np.any(directions != 0, axis=1)]:
        c = cell_of(across, d)
        some = members[starts[c] : starts[c + 1]]
        of_all, of_some = ((p * d).sum(axis=1) for p in (points, points[some]))
        assert some[np.argmax(of_some)] == np.argmax(of_all)


def test_candidates_are_few():
    """A point in general position is farthest in a part of the sphere; cells are as many as points."""
    for n in (100, 1000, 5000):
        across, starts, members = cells_of(sphere(n))
        assert 6 * across * across < 4 * n
        assert len(members) < 6 * (len(starts) - 1)


def test_few_points_have_one_cell():
    across, starts, members = cells_of(sphere(FEW_POINTS))
    assert across == 0
    np.testing.assert_array_equal(starts, [0, FEW_POINTS])
    np.testing.assert_array_equal(members, np.arange(FEW_POINTS))
