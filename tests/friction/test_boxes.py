"""Boxes on planes and on one another, with W stored whole: hyperstatic, near the cone, of unequal mass."""

import numpy as np
import pytest
from contact_problems import STEP, G, dense, solve, stack

from carom.friction.layout import SOLVED

ROUND_OFF = 1e-13  # of |c|: some 100 roundings


@pytest.mark.plain
def test_box_at_rest_stands_on_four_equal_corners():
    W, c = dense(stack(1))
    solved = solve(W, c, 0.5, spare=2)
    assert solved.status == SOLVED
    assert np.linalg.matrix_rank(W) == 6
    # m g h / 4 each. What the impulses among themselves cancel is known to rounding / eps (1e-8) only.
    np.testing.assert_allclose(solved.p[::3], G * STEP / 4, rtol=1e-7)
    np.testing.assert_allclose(solved.p.reshape(4, 3)[:, 1:], 0.0, atol=1e-7 * G * STEP)
    np.testing.assert_allclose(solved.w, 0.0, atol=ROUND_OFF * G * STEP)


@pytest.mark.parametrize("part", [2e-4, -2e-4, 0.2, -0.2])
def test_box_on_an_incline(part):
    # mu = tan(theta) (1 + part): it holds, or slides with g (sin theta - mu cos theta)
    theta = np.arctan(0.5)
    W, c = dense(stack(1, slope=theta))
    mu = 0.5 * (1.0 + part)
    solved = solve(W, c, mu)
    assert solved.status == SOLVED
    slip = max(0.0, G * STEP * (np.sin(theta) - mu * np.cos(theta)))
    w = solved.w.reshape(4, 3)
    np.testing.assert_allclose(w[:, 1], slip, atol=ROUND_OFF * G * STEP)
    np.testing.assert_allclose(w[:, [0, 2]], 0.0, atol=ROUND_OFF * G * STEP)
    assert solved.p[::3].sum() == pytest.approx(G * STEP * np.cos(theta), rel=1e-12)


@pytest.mark.parametrize("count", [5, 10, 20])
def test_stack_rests_and_each_interface_carries_what_is_above(count):
    W, c = dense(stack(count))
    solved = solve(W, c, 0.3)
    assert solved.status == SOLVED
    # rounding of w: eps |W| |p|, p the weight of all
    np.testing.assert_allclose(solved.w, 0.0, atol=ROUND_OFF * count * G * STEP)
    carried = solved.p[::3].reshape(count, 4)
    weight = G * STEP * np.arange(count, 0, -1)
    np.testing.assert_allclose(carried.sum(axis=1), weight, rtol=1e-10)
    np.testing.assert_allclose(carried, carried[:, :1] @ np.ones((1, 4)), rtol=1e-6)
    again = solve(W, 1.01 * c, 0.3, start=solved.p)
    assert again.status == SOLVED
    assert again.iterations < solved.iterations


@pytest.mark.parametrize("ratio", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("top", [True, False])
def test_heavy_box_on_light_ones_or_below(ratio, top):
    masses = np.ones(5)
    masses[-1 if top else 0] = ratio
    W, c = dense(stack(5, masses=masses))
    solved = solve(W, c, 0.3)
    assert solved.status == SOLVED
    weight = G * STEP * np.cumsum(masses[::-1])[::-1]
    # rounding of w at the light boxes, eps |p| / m, is what moves the heavy one by ratio times more
    carried = solved.p[::3].reshape(5, 4).sum(axis=1)
    np.testing.assert_allclose(carried, weight, rtol=1e-10 + 1e-13 * ratio)
    # what can be reached: some roundings of |W| |p|
    size = (np.abs(W) @ np.abs(solved.p)).max()
    assert solved.residual <= 50 * np.finfo(float).eps * max(size, G * STEP)


def test_stack_slides_and_topples():
    # slope 0.5 rad, mu 0.3: the lowest box slides, those above tilt; energy can only fall
    W, c = dense(stack(5, slope=0.5))
    solved = solve(W, c, 0.3)
    assert solved.status == SOLVED
    assert solved.residual <= ROUND_OFF * np.abs(c).max()
    assert np.any(solved.p[::3] == 0.0)  # open, exactly
    assert solved.p @ (solved.w + c) < 0.0  # work of the impulses
    assert solved.violation <= 1e-15
