"""Cubic interpolation between states: ends, exact motions, order of convergence."""

import numpy as np
import pytest
from geometry_strategies import components, few, quaternions
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from carom.geometry import quaternion
from carom.geometry.spline import interpolate
from verified import agree, verifies


def states():
    return st.tuples(components(5.0), quaternions(), components(5.0), components(5.0))


def same_state(a, b, atol):
    for index in (0, 2, 3):
        assert_allclose(a[index], b[index], atol=atol)
    assert_allclose(quaternion.matrix(a[1]), quaternion.matrix(b[1]), atol=atol)


@few
@given(states(), states(), st.floats(0.05, 2.0))
def test_ends_are_met(start, end, h):
    # Any two states, near or not: so a chain of them is C^1. T^-1 at half a turn has norm pi/2.
    same_state(interpolate(1.0, 1.0, 1.0 + h, start, end), start, 1e-13)
    same_state(interpolate(1.0 + h, 1.0, 1.0 + h, start, end), end, 1e-13)


@few
@given(states(), states(), st.floats(0.1, 1.0), st.floats(0.1, 0.9))
def test_velocities_are_the_derivatives(start, end, h, s):
    # W by log of neighbours over 2 d: truncation d^2 times the third derivative of the chart's
    # cubic, (10 h / h^3) with h = 0.1, plus round-off eps / d.
    t, d = s * h, 1e-5 * h
    before, now, after = (interpolate(u, 0.0, h, start, end) for u in (t - d, t, t + d))
    assert_allclose((after[0] - before[0]) / (2 * d), now[2], atol=1e-6)
    turn = quaternion.rotate(before[1], quaternion.between(before[1], after[1]))
    assert_allclose(turn / (2 * d), now[3], atol=1e-6)
    assert np.linalg.norm(now[1]) == pytest.approx(1.0, abs=1e-15)


@few
@given(quaternions(), components(400.0), components(5.0), st.floats(0.01, 1.0))
def test_steady_rotation_is_exact_through_many_turns(Q, w, v, s):
    # Up to 110 turns; angles of 700 are rounded to 700 eps = 1.6e-13.
    h = 1.0
    states = [(t * v, quaternion.multiply(quaternion.exp(t * w), Q), v, w) for t in (0.0, h, s * h)]
    same_state(interpolate(s * h, 0.0, h, states[0], states[1]), states[2], 2e-12)


@verifies(
    "geometry.spline.interpolate",
    r"turns about one axis: $\vartheta = \omega_0 t - t^2/2$",
    "closed form",
)
def test_the_limit_of_the_fixed_chart_is_safe():
    # Turns about one axis at a changing rate, predicted and true turn on both sides of 2 rad and of
    # pi: the cubic in the angle (its second derivative constant) is exact.
    axis = np.array([0.0, 0.6, 0.8])
    for turn in (1.9, 2.0, 2.1, 3.1, 3.2, 6.2, 6.4):
        rates = (turn + 0.5, turn - 0.5)
        start, end = (
            (np.zeros(3), quaternion.exp(a * axis), np.zeros(3), r * axis)
            for a, r in zip((0.0, turn), rates)
        )
        middle = interpolate(0.5, 0.0, 1.0, start, end)
        angle = 0.5 * rates[0] - 0.125  # theta = w0 t - t^2 / 2
        agree(
            quaternion.matrix(middle[1]),
            quaternion.matrix(quaternion.exp(angle * axis)),
            atol=1e-14,
        )
        agree(middle[3], turn * axis, atol=1e-13)


def test_a_parabola_is_exact():
    # x = x0 + v0 t - g t^2 / 2
    g, t = np.array([0.0, 0.0, 9.81]), np.linspace(0.0, 2.0, 9)
    x0, v0 = np.array([1.0, 2.0, 3.0]), np.array([0.4, -1.0, 8.0])
    still = (np.array([1.0, 0, 0, 0]), np.zeros(3))

    def state(t):
        t = np.atleast_1d(t)[:, None, None]
        shape = (len(t), 1, 3)
        rest = np.broadcast_to(still[0], (len(t), 1, 4)), np.zeros(shape)
        return x0 + v0 * t - g * t * t / 2, rest[0], v0 - g * t, rest[1]

    same_state(
        interpolate(t, 0.0, 2.0, state(np.zeros(9)), state(np.full(9, 2.0))), state(t), 1e-13
    )


def test_an_interval_without_length_gives_its_first_state():
    before = (np.zeros(3), np.array([1.0, 0, 0, 0]), -np.ones(3), np.zeros(3))
    after = (np.zeros(3), np.array([1.0, 0, 0, 0]), np.ones(3), np.ones(3))
    same_state(interpolate(0.3, 0.3, 0.3, before, after), before, 0)
    with pytest.raises(ValueError, match="t1 must be at least t0"):
        interpolate(0.3, 0.3, 0.2, before, after)
    with pytest.raises(ValueError, match=r"state1: Q must have shape \(\.\.\., 4\)"):
        interpolate(0.3, 0.3, 0.4, before, (after[0], np.zeros(3), after[2], after[3]))


def tumbling():
    """Free asymmetric body in the throw of Newton and Euler, to 1e-12: a function of time."""
    J = np.array([1.0, 2.0, 2.8])

    def rate(t, y):
        Q, W = y[:4], y[4:]
        return np.hstack([quaternion.multiply(Q, np.append(0.0, 0.5 * W)), -np.cross(W, J * W) / J])

    start = np.hstack([quaternion.exp([0.2, 0.4, -0.1]), [0.1, 3.0, 0.2]])
    flow = solve_ivp(rate, (0, 4), start, "DOP853", rtol=3e-14, atol=1e-14, dense_output=True).sol

    def state(t):
        y = flow(t).T[:, None, :]
        Q = quaternion.normalize(y[..., :4])
        c, s = np.cos(2 * t)[:, None, None], np.sin(2 * t)[:, None, None]
        x = np.concatenate([c, s, 0 * s], axis=-1)
        v = 2 * np.concatenate([-s, c, 0 * s], axis=-1)
        return x, Q, v, quaternion.rotate(Q, y[..., 4:])

    return state


@verifies(
    "geometry.spline.interpolate",
    "order 4, of velocities 3, for a tumbling body",
    "own integration: SciPy",
)
def test_order_of_convergence_on_a_tumbling_body():
    # Cubic Hermite: h^4 in x and R, h^3 in their derivatives.
    state, errors = tumbling(), []
    for steps in (20, 40, 80):
        grid = np.linspace(0.0, 4.0, steps + 1)
        worst = np.zeros(4)
        for s in (0.2, 0.5, 0.8):
            t = grid[:-1] + s * np.diff(grid)
            x, Q, v, w = interpolate(t, grid[:-1], grid[1:], state(grid[:-1]), state(grid[1:]))
            X, P, V, W = state(t)
            differences = (x - X, quaternion.between(P, Q), v - V, w - W)
            worst = np.maximum(worst, [np.abs(d).max() for d in differences])
        errors.append(worst)
    order = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    agree(order, np.broadcast_to([4.0, 4.0, 3.0, 3.0], order.shape), atol=0.25)
    # And the size: h = 0.05, W = 3 rad/s: (h W)^4 / 384 = 1.3e-6.
    assert errors[-1][1] < 3e-6
