"""The exact one-contact solve: the conditions themselves, on random contacts."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.baselines import solve_one_contact
from verified import agree, verifies

entry = st.floats(-2.0, 2.0, allow_nan=False).map(lambda x: round(x, 6))
factor = st.lists(entry, min_size=9, max_size=9).map(lambda x: np.reshape(x, (3, 3)))
velocity = st.lists(entry, min_size=3, max_size=3).map(np.array)


def cone_residual(W, c, mu, p):
    """Return the natural map |p - P_K(p - rho (w + mu |w_t| e_n))| / rho [m/s], rho = 3 / trace W."""
    rho, w = 3.0 / np.trace(W), W @ p + c
    w[0] += mu * np.hypot(w[1], w[2])
    return float(np.linalg.norm(p - project(p - rho * w, mu)) / rho)


def project(x, mu):
    """Return the nearest point of the cone |x_t| <= mu x_n."""
    slide = float(np.hypot(x[1], x[2]))
    if mu * slide <= -x[0]:
        return np.zeros(3)
    if slide <= mu * x[0]:
        return x
    normal = (x[0] + mu * slide) / (1.0 + mu * mu)
    return np.array([normal, *(mu * normal * x[1:] / slide)])


@settings(max_examples=150, deadline=None)
@given(factor, velocity, st.sampled_from([0.0, 0.1, 0.5, 1.0, 3.0]))
def test_conditions_hold(F, c, mu):
    """Signorini, the cone and the direction of slip, to round-off of |c| and |W||p|."""
    W = F @ F.T + 0.05 * np.eye(3)
    p = solve_one_contact(W, c, mu)
    w = W @ p + c
    scale = np.abs(c).max() + np.abs(W).max() * np.abs(p).max() + 1e-300
    slip = np.linalg.norm(w[1:])
    assert cone_residual(W, c, mu, p) <= 1e-12 * scale
    assert p[0] >= 0.0
    assert w[0] >= -1e-12 * scale
    assert p[0] * w[0] <= 1e-12 * scale * max(p[0], 1e-300)
    assert np.hypot(p[1], p[2]) <= mu * p[0] * (1 + 1e-9) + 1e-15
    if slip > 1e-6 * scale:
        np.testing.assert_allclose(p[1:], -mu * p[0] * w[1:] / slip, atol=1e-8 * (p[0] + 1e-300))


@pytest.mark.parametrize("mu", [0.0, 0.3, 2.0])
def test_empty_direction_takes_no_impulse(mu):
    """A planar body in space: nothing moves along t2."""
    W = np.array([[2.5, -1.5, 0.0], [-1.5, 2.5, 0.0], [0.0, 0.0, 0.0]])
    c = np.array([-1.5, 0.2, 0.0])
    p = solve_one_contact(W, c, mu)
    assert p[2] == 0.0
    assert cone_residual(W, c, mu, p) < 1e-14


@verifies(
    "baselines.solve_one_contact", "diagonal $W$: open, stick, slip on the cone", "closed form"
)
def test_open_stick_and_slip():
    """Diagonal W: open if c_n >= 0; stick if |c_t|/W_tt <= mu |c_n|/W_nn; else slip at the cone."""
    W = np.diag([1.0, 3.5, 3.5])
    assert np.array_equal(solve_one_contact(W, [0.1, 1.0, 1.0], 0.5), np.zeros(3))
    agree(solve_one_contact(W, [-1, 0.35, 0], 0.2), [1, -0.1, 0], atol=1e-15)
    slip = solve_one_contact(W, [-1.0, 2.1, 2.8], 0.2)
    agree(slip, [1.0, -0.12, -0.16], rtol=1e-13)


def test_residual_sees_a_wrong_impulse():
    W, c = np.diag([1.0, 3.5, 3.5]), np.array([-1.0, 2.1, 2.8])
    for wrong in ([0.0, 0.0, 0.0], [1.0, 0.12, 0.16], [1.1, -0.12, -0.16]):
        assert cone_residual(W, c, 0.2, wrong) > 0.05


@pytest.mark.parametrize(
    ("name", "W", "c", "mu"),
    [
        ("inverse_mass", np.eye(2), [0, 0, 0], 0.1),
        ("inverse_mass", [[1, 1, 0], [0, 1, 0], [0, 0, 1]], [-1, 0, 0], 0.1),
        ("inverse_mass", np.zeros((3, 3)), [-1, 0, 0], 0.1),
        ("inverse_mass", np.diag([1, -1, 1]), [-1, 0, 0], 0.1),
        ("velocity", np.eye(3), [np.nan, 0, 0], 0.1),
        ("friction", np.eye(3), [-1, 0, 0], -0.1),
    ],
)
def test_bad_input_names_the_argument(name, W, c, mu):
    with pytest.raises(ValueError, match=name):
        solve_one_contact(W, c, mu)
