"""Contacts whose direction of slip is known, and contacts that stick."""

import numpy as np
import pytest
from contact_problems import STEP, G, dense, random_singular, solve, stack

from carom.friction.layout import CONE, DISC, NOT_SOLVED, SLIDING, SOLVED, STICKING


def test_box_held_by_known_slip():
    # slides along t1 with mu = 0.3: decelerates by mu g, four equal corners' sum carries the weight
    W, c = dense(stack(1))
    c = c + np.tile([0.0, 1.0, 0.0], 4)
    solved = solve(W, c, 0.3, kind=SLIDING, heading=(1.0, 0.0))
    assert solved.status == SOLVED
    np.testing.assert_allclose(solved.w.reshape(4, 3)[:, 1], 1.0 - 0.3 * G * STEP, rtol=1e-14)
    np.testing.assert_array_equal(solved.p[1::3], -0.3 * solved.p[::3])
    cone = solve(W, c, 0.3, kind=CONE)
    np.testing.assert_allclose(cone.w, solved.w, atol=1e-14)


@pytest.mark.parametrize("radius", [0.3, 2.0])
@pytest.mark.parametrize("beside", [1.0, 20.0])
def test_a_disc_has_a_radius_in_impulses(radius, beside):
    # one row w = p - 1.6 with |p| <= radius, beside a contact that presses with any force: units do not matter
    W, c = np.diag([2.0, 2.0, 2.0, 0.0, 1.0, 0.0]), np.array([-beside, 0, 0, 0, -1.6, 0])
    heading = np.array([(0.0, 0.0), (radius, 0.0)])
    solved = solve(W, c, 0.5, kind=np.array([CONE, DISC]), heading=heading)
    assert solved.status == SOLVED
    np.testing.assert_allclose(solved.p[4], min(1.6, radius), rtol=1e-12)
    np.testing.assert_allclose(solved.p[0], beside / 2.0, rtol=1e-12)


def test_without_heading_there_is_no_friction():
    W, c = dense(stack(1))
    c = c + np.tile([0.0, 1.0, 0.0], 4)
    solved = solve(W, c, 0.3, kind=SLIDING)
    np.testing.assert_allclose(solved.w[1::3], 1.0, rtol=1e-14)


def test_sticking_holds_on_any_slope():
    W, c = dense(stack(3, slope=1.2))
    kind = np.zeros(12, dtype=np.int64)
    kind[:] = STICKING
    solved = solve(W, c, 0.0, kind=kind)
    assert solved.status == SOLVED
    np.testing.assert_allclose(solved.w.reshape(-1, 3)[:, 1:], 0.0, atol=1e-14)
    assert solved.penetration <= 1e-14


def test_sticking_is_the_convex_problem():
    # its energy is least: no admissible change of p lowers 1/2 p W p + c p
    random = np.random.default_rng(5)
    for seed in range(30):
        W, c = random_singular(seed, 6)
        k = len(c) // 3
        solved = solve(W, c, 0.0, kind=STICKING)
        assert solved.status == SOLVED
        value = 0.5 * solved.p @ W @ solved.p + c @ solved.p
        for _ in range(20):
            other = solved.p + 0.1 * random.normal(size=3 * k)
            other[::3] = np.maximum(other[::3], 0.0)
            assert 0.5 * other @ W @ other + c @ other >= value - 1e-12


def linear_complementarity(A, b):
    """Return whether x >= 0, A x + b >= 0, x (A x + b) = 0 has a solution: all active sets tried."""
    k = len(b)
    for code in range(2**k):
        on = np.array([bool(code >> i & 1) for i in range(k)])
        x = np.zeros(k)
        if on.any():
            x[on] = np.linalg.lstsq(A[np.ix_(on, on)], -b[on], rcond=None)[0]
        y = A @ x + b
        if x.min() > -1e-9 and y.min() > -1e-9 and np.abs(y[on]).max(initial=0.0) < 1e-9:
            return True
    return False


@pytest.mark.parametrize("mu", [0.1, 1.0])
def test_known_slip_is_solved_whenever_it_can_be(mu):
    # w_n = A p_n + c_n with A no longer positive: there need not be a solution (jam), and then it is said
    failed = 0
    for seed in range(80):
        W, c = random_singular(seed, 8)
        k = len(c) // 3
        heading = np.random.default_rng(seed).normal(size=(k, 2))
        heading /= np.linalg.norm(heading, axis=1)[:, None]
        solved = solve(W, c, mu, kind=SLIDING, heading=heading)
        if solved.status == NOT_SOLVED:
            failed += 1
            columns = np.empty((3 * k, k))
            for i in range(k):
                columns[:, i] = W[:, 3 * i : 3 * i + 3] @ [1.0, *(-mu * heading[i])]
            assert not linear_complementarity(columns[::3], c[::3])
    assert failed <= (0 if mu == 0.1 else 12)


def test_mixed():
    W, c = dense(stack(2, slope=0.3))
    kind = np.array([STICKING] * 4 + [SLIDING] * 4)
    heading = np.array([[0.0, 0.0]] * 4 + [[1.0, 0.0]] * 4)
    solved = solve(W, c, 0.2, kind=kind, heading=heading)
    assert solved.status == SOLVED
    # the upper box slides with g (sin - mu cos), the lower one is held
    w = solved.w.reshape(8, 3)
    np.testing.assert_allclose(w[:4], 0.0, atol=1e-14)
    np.testing.assert_allclose(w[4:, 1], G * STEP * (np.sin(0.3) - 0.2 * np.cos(0.3)), atol=1e-14)
