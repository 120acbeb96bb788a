"""The central path alone, from nothing: it ends near a solution, after few factors."""

import numpy as np
import pytest
from contact_problems import STEP, G, pile, random_island, stack, wall

from references.island_arrays import new_island_work
from references.island_graph import island_graph
from references.solve_path import follow_island


def follow(isle, mu, most=100):
    """Return the residual, the number of factors, and the impulses (k, 3)."""
    k = len(isle.body)
    work = new_island_work(island_graph(len(isle.inverse_mass), isle.body), isle.body)
    p = np.zeros(3 * k)
    kind = np.zeros(k, dtype=np.int64)
    worst, steps = follow_island(
        k, isle, np.full(k, float(mu)), kind, np.zeros((k, 2)), p, work, most
    )
    return worst, steps, p.reshape(k, 3)


@pytest.mark.plain
@pytest.mark.parametrize("count", [1, 5])
def test_stack(count):
    worst, steps, p = follow(stack(count), 0.3)
    assert worst <= 1e-9 * G * STEP
    assert steps <= 20
    np.testing.assert_allclose(p[:4, 0].sum(), count * G * STEP, rtol=1e-7)


@pytest.mark.parametrize("count", [20, 50])
def test_tall_stack(count):
    worst, steps, p = follow(stack(count), 0.3)
    assert worst <= 1e-6 * G * STEP
    assert steps <= 40
    np.testing.assert_allclose(p[:4, 0].sum(), count * G * STEP, rtol=1e-5)


@pytest.mark.parametrize("ratio", [1e2, 1e4, 1e6])
def test_mass_ratios(ratio):
    worst, _, p = follow(stack(5, masses=[1, 1, 1, 1, ratio]), 0.3)
    np.testing.assert_allclose(p[:4, 0].sum(), (4 + ratio) * G * STEP, rtol=1e-5)
    assert worst <= 1e-6 * G * STEP


@pytest.mark.parametrize("slope", [0.0, 0.1, 0.3, 0.5])
def test_wall(slope):
    worst, steps, p = follow(wall(8, 8, slope), 0.3)
    assert worst <= 1e-6 * G * STEP
    assert steps <= 40
    # impulses lie within their cones
    assert np.all(np.hypot(p[:, 1], p[:, 2]) <= 0.3 * p[:, 0] * (1.0 + 1e-12))


@pytest.mark.parametrize("mu", [0.0, 0.1, 0.3, 0.6])
def test_pile_of_spheres(mu):
    worst, steps, _ = follow(pile(6), mu)
    assert worst <= 1e-5 * G * STEP
    assert steps <= 40


@pytest.mark.parametrize("mu", [0.1, 0.5, 1.0])
def test_random_islands(mu):
    # some are cages that jam: a few have no end nearby
    solved = 0
    for seed in range(60):
        isle = random_island(seed)
        worst, _, p = follow(isle, mu)
        assert np.all(np.isfinite(p))
        solved += worst <= 1e-5 * np.abs(isle.c).max()
    assert solved >= 58
