"""Broad phase against a k-d tree and against all pairs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from carom.collision.sweep import new_sweep_work, sweep


def swept(centres, radii, room=None):
    pairs = np.zeros((room or 40 * len(radii) + 100, 2), dtype=np.int64)
    count = sweep(centres, radii, pairs, new_sweep_work(len(radii)))
    return pairs[: min(count, len(pairs))], count


def all_pairs(centres, radii):
    i, j = np.triu_indices(len(radii), 1)
    apart = np.linalg.norm(centres[i] - centres[j], axis=1)
    meet = (apart <= radii[i] + radii[j]) & (radii[i] >= 0) & (radii[j] >= 0)
    return set(zip(i[meet].tolist(), j[meet].tolist()))


def as_set(pairs):
    found = {(int(i), int(j)) for i, j in pairs}
    assert len(found) == len(pairs)
    return found


def test_equal_balls_as_a_k_d_tree_finds_them():
    rng = np.random.default_rng(0)
    centres, radius = rng.uniform(-1, 1, (3000, 3)), 0.05
    expected = cKDTree(centres).query_pairs(2 * radius)
    assert as_set(swept(centres, np.full(3000, radius))[0]) == expected


@settings(max_examples=60, deadline=None)
@given(
    st.integers(0, 60),
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.0, 1.0, 3.0, 8.0]),
    st.sampled_from([1e-3, 1.0, 1e4]),
)
def test_balls_of_any_sizes(count, seed, spread, scale):
    rng = np.random.default_rng(seed)
    centres = scale * rng.normal(size=(count, 3))
    radii = 0.3 * scale * np.exp(spread * rng.uniform(-1, 0.2, count))
    radii[rng.random(count) < 0.1] = -1.0
    radii[rng.random(count) < 0.1] = 0.0
    assert as_set(swept(centres, radii, 4000)[0]) == all_pairs(centres, radii)


def test_touching_balls_on_a_lattice():
    # Balls of radius 1 at even places: each touches six neighbours, on the faces of cells.
    grid = 2.0 * np.stack(np.meshgrid(*[np.arange(-2, 4)] * 3), -1).reshape(-1, 3)
    assert as_set(swept(grid, np.ones(len(grid)))[0]) == all_pairs(grid, np.ones(len(grid)))


def test_same_order_every_time_and_in_any_scratch():
    rng = np.random.default_rng(1)
    centres, radii = rng.normal(size=(200, 3)), rng.uniform(0, 0.4, 200)
    pairs, work = np.zeros((5000, 2), dtype=np.int64), new_sweep_work(200)
    sweep(rng.normal(size=(200, 3)), radii, pairs, work)
    count = sweep(centres, radii, pairs, work)
    np.testing.assert_array_equal(pairs[:count], swept(centres, radii)[0])
    assert np.all(pairs[:count, 0] < pairs[:count, 1])


def test_counts_what_has_no_room():
    centres, radii = np.zeros((10, 3)), np.ones(10)
    pairs, count = swept(centres, radii, room=7)
    assert count == 45
    assert len(pairs) == 7


@pytest.mark.parametrize("ratio", [1.0, 30.0, 1000.0])
def test_cost_is_linear(ratio):
    # Packed at one density, sizes up to `ratio`: 8 times the balls take as many comparisons each.
    costs = []
    for count in (2000, 16000):
        rng = np.random.default_rng(2)
        radii = 0.5 / ratio ** rng.random(count)
        side = np.cbrt(np.sum((2 * radii) ** 3) / 0.7)
        centres = rng.uniform(0, side, (count, 3))
        pairs, work = np.zeros((60 * count, 2), dtype=np.int64), new_sweep_work(count)
        sweep(centres, radii, pairs, work)
        costs.append(work.made[0] / count)
    assert costs[1] < 1.4 * costs[0]  # fewer of the smaller heap lie inside it
    assert costs[1] < 150
