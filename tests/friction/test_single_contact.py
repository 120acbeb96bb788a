"""One contact is solved in closed form: against a scan of all slips, and known cases."""

import numpy as np
import pytest
from contact_problems import solve
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.friction.layout import NOT_SOLVED, SOLVED
from verified import agree, verifies

# Rod at 60 degrees (m = L = 1), planar: what moves in t2 is nothing.
ROD = np.array([[1.75, 1.299038105677, 0], [1.299038105677, 3.25, 0], [0, 0, 0]])


def least_slip(W, c, mu):
    """The slip with the least alpha, w_t = -alpha p_t: where mu p_n - |p_t| first becomes positive.

    10^5 values of alpha over 16 decades, then bisection; independent of the closed form.
    """
    A = W[1:, 1:] - np.outer(W[1:, 0], W[0, 1:]) / W[0, 0]
    b = c[1:] - W[1:, 0] * c[0] / W[0, 0]
    values, basis = np.linalg.eigh(A)
    b, g = basis.T @ b, basis.T @ W[1:, 0]

    def margin(alpha):
        p_t = -b / (values + alpha[:, None])
        return mu * -(c[0] + p_t @ g) / W[0, 0] - np.linalg.norm(p_t, axis=1)

    alphas = np.linalg.norm(b) / (mu * -c[0] / W[0, 0]) * np.logspace(-10, 6, 100_000)
    first = int(np.argmax(margin(alphas) > 0.0))
    low, high = (alphas[first - 1] if first else 0.0), alphas[first]
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if margin(np.array([middle]))[0] > 0.0 else (middle, high)
    p_t = basis @ (-b / (values + high))
    return np.array([-(c[0] + W[0, 1:] @ p_t) / W[0, 0], *p_t])


@verifies(
    "solve_contacts", "one contact: the least slip of all", "own integration: scan and bisection"
)
@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 10**6), mu=st.sampled_from([0.05, 0.3, 1.0, 3.0, 10.0]))
def test_against_a_scan(seed, mu):
    random = np.random.default_rng(seed)
    rows = random.normal(size=(3, 3))
    W, c = rows @ rows.T + 1e-3 * np.eye(3), random.normal(size=3)
    c[0] = -abs(c[0]) - 0.1
    solved = solve(W, c, mu)
    assert solved.status == SOLVED
    stick = -np.linalg.solve(W, c)
    if np.linalg.norm(stick[1:]) <= mu * stick[0]:
        expected = stick
    else:
        expected = least_slip(W, c, mu)
    # |W| <= 30, least eigenvalue >= 1e-3: 1e5 roundings, and the bisection's own
    agree(solved.p, expected, rtol=1e-8, atol=1e-9)


@pytest.mark.plain
def test_open_contact_has_no_impulse():
    solved = solve(np.eye(3), np.array([0.5, 1.0, -2.0]), 0.7)
    assert solved.status == SOLVED
    assert np.all(solved.p == 0.0)


def test_painleve_rod_jumps_to_rest():
    # mu = 1.6 > 1.347: sliding towards the contact there is no finite force; the impulse stops the rod.
    # P = W^-1 (0, 1): the e = 0 jump of mathematics page §3.6. The approach of 1e-12 is what gravity gives.
    solved = solve(ROD, np.array([-1e-12, 1.0, 0.0]), 1.6)
    assert solved.status == SOLVED
    np.testing.assert_allclose(solved.p, [0.3247595264, -0.4375, 0.0], atol=1e-10)
    np.testing.assert_allclose(solved.w, 0.0, atol=1e-15)
    # mu = 1.2: it goes on sliding, with p_n = 1e-12 / (W_nn - mu W_nt)
    solved = solve(ROD, np.array([-1e-12, 1.0, 0.0]), 1.2)
    assert solved.p[0] == pytest.approx(1e-12 / (1.75 - 1.2 * 1.299038105677), rel=1e-10)
    slows = (1.299038105677 - 1.2 * 3.25) * solved.p[0]
    assert solved.w[1] == pytest.approx(1.0 + slows, abs=1e-15)


def test_directions_in_which_nothing_moves():
    # a rail along t1: nothing moves in t2; then a bead on a tilted wire: W of rank one
    solved = solve(ROD, np.array([-1.0, 0.2, 0.0]), 0.3)
    assert solved.status == SOLVED
    assert solved.p[2] == 0.0
    wire = np.array([0.8, 0.6, 0.0])
    solved = solve(np.outer(wire, wire), -2.0 * wire, 0.5)
    assert solved.status == SOLVED
    np.testing.assert_allclose(solved.w, 0.0, atol=1e-15)


def test_no_solution_is_said_so():
    # a bead on a wire that friction jams: 0.8 (0.8 - mu 0.6) < 0, and c is not along the wire
    wire = np.array([0.8, 0.6, 0.0])
    solved = solve(np.outer(wire, wire), np.array([-1.0, 1.0, 0.0]), 2.0)
    assert solved.status == NOT_SOLVED
    assert solved.residual > 0.1
    # two bodies that cannot move, and approach
    solved = solve(np.zeros((3, 3)), np.array([-1.0, 0.0, 0.0]), 0.5)
    assert solved.status == NOT_SOLVED
    assert solved.residual == pytest.approx(1.0)
