"""Derivatives of one impact."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from carom import resolve_impact
from carom.studies.gradient import impact_derivative
from carom.studies.gradient.blow import UPPER, blow
from verified import agree, verifies

coordinate = st.floats(-1.0, 1.0)


def inverse_mass(arm, inertia):
    A = np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
    return np.eye(3) - A @ np.diag(1 / np.asarray(inertia)) @ A


@given(
    st.tuples(coordinate, coordinate, coordinate), st.tuples(coordinate, coordinate),
    st.floats(0.0, 1.5), st.floats(0.0, 1.0), st.sampled_from([0, 1, 2]),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_the_impulse_is_homogeneous(arm, slip, mu, e, law):
    # Twice the velocity: twice the impulse; twice W: half of it. So (Euler) dP/du u = P, dP/dW W = -P.
    W, u = inverse_mass(arm, (0.3, 0.5, 0.4)), np.array([-1.0, *slip])
    assume(np.hypot(*slip) > 1e-3)
    found = blow(W, u, mu, e, law)
    assert found is not None
    assume(not found.kink and found.error < 1e-9)
    size = np.linalg.norm(found.impulse)
    np.testing.assert_allclose(found.d[:3, 6:9] @ u, found.impulse, rtol=0, atol=1e-8 * size)
    packed = np.array([W[i, k] for i, k in UPPER])
    np.testing.assert_allclose(found.d[:3, :6] @ packed, -found.impulse, rtol=0, atol=1e-8 * size)


@pytest.mark.plain
def test_slip_that_keeps_its_direction_is_that_of_routh():
    # P_n = (1 + e) |u_n| / (W_nn - mu W_n1), P_1 = -mu P_n while u_1 > 0
    W = np.array([[1.5, 0.4, 0.0], [0.4, 2.0, 0.0], [0.0, 0.0, 1.8]])
    u, mu, e = np.array([-1.0, 3.0, 0.0]), 0.2, 0.6
    found = blow(W, u, mu, e, 0)
    bottom = W[0, 0] - mu * W[0, 1]
    p = (1 + e) / bottom
    expected = np.zeros((2, 11))
    expected[0, [0, 1, 6, 9, 10]] = [
        -p / bottom,
        p * mu / bottom,
        -p,
        p * W[0, 1] / bottom,
        1 / bottom,
    ]
    expected[1] = -mu * expected[0]
    expected[1, 9] -= p
    np.testing.assert_allclose(found.d[:2], expected, rtol=0, atol=1e-10)
    # u_2 turns the direction of slip, and W_12 with P_1 is what turns it on the way
    assert found.d[2, 8] < 0.0
    assert found.phases == 1


@verifies("studies.gradient.impact_derivative", "stick: $P = W^{-1} (u^+ - u^-)$", "closed form")
def test_a_point_that_sticks_takes_the_impulse_of_a_held_one():
    # u+ = (-e u_n, 0, 0), so P = W^-1 (u+ - u): Newton's law, whatever slip was on the way
    W, u, e = inverse_mass((0.3, -0.2, 0.5), (0.3, 0.5, 0.4)), np.array([-1.0, 0.02, 0.01]), 0.4
    found = blow(W, u, 2.0, e, 0)
    V = np.linalg.inv(W)
    agree(found.d[:3, 6:9], V @ np.diag([-(1 + e), -1, -1]), atol=1e-10)
    agree(found.d[:3, 10], V @ [1.0, 0, 0], atol=1e-10)
    agree(found.d[:3, 9], 0.0, atol=1e-10)
    for k, (i, j) in enumerate(UPPER):
        dW = np.zeros((3, 3))
        dW[i, j] = dW[j, i] = 1.0
        agree(found.d[:3, k], -V @ dW @ found.impulse, atol=1e-9)


def test_slip_from_rest_has_no_derivative():
    W = inverse_mass((0.6, 0.2, 0.5), (0.3, 0.5, 0.4))
    found = blow(W, np.array([-1.0, 0.0, 0.0]), 0.05, 0.5, 0)
    assert "starts from rest" in found.kink


@pytest.mark.parametrize("law", [1, 2])
def test_slip_that_stops_as_compression_ends_is_a_change_of_course(law):
    # slip stops at u_1 = mu W_11 p, compression ends at p_c = |u_n| / W_nn = 1: both at u_1 = 0.4
    W = np.diag([1.0, 2.0, 2.0])
    assert "about to change" in blow(W, np.array([-1.0, 0.4, 0.0]), 0.2, 0.5, law).kink
    for part in (1 - 1e-3, 1 + 1e-3):
        found = blow(W, np.array([-1.0, 0.4 * part, 0.0]), 0.2, 0.5, law)
        assert not found.kink
        np.testing.assert_allclose(found.d[0, 6], -1.5, atol=1e-9)
    # Newton's law does not look at the end of compression
    assert not blow(W, np.array([-1.0, 0.4, 0.0]), 0.2, 0.5, 0).kink


@given(
    st.tuples(coordinate, coordinate, coordinate), st.tuples(coordinate, coordinate),
    st.floats(0.05, 1.0), st.floats(0.05, 0.95), st.sampled_from(["newton", "poisson", "stronge"]),
)  # fmt: skip
@settings(max_examples=30, deadline=None)
def test_the_public_derivative_predicts_a_neighbour(arm, slip, mu, e, law):
    W, u = inverse_mass(arm, (0.3, 0.5, 0.4)), np.array([-1.0, *slip])
    try:
        d = impact_derivative(W, u, mu, e, law)
    except ValueError:
        return
    dW = np.array([[0.3, 0.1, -0.2], [0.1, -0.4, 0.2], [-0.2, 0.2, 0.5]])
    du, dmu, de = np.array([0.2, -0.3, 0.4]), 0.5, -0.6
    size = np.hypot(*slip)
    assume(size > 1e-3 or size == 0.0)
    h = 2e-4 * (min(1.0, size) if size > 0.0 else 1.0)  # changes of slip are measured by slip
    ends = [resolve_impact(W + s * h * dW, u + s * h * du, mu + s * h * dmu, e + s * h * de, law)
            for s in (-1, 1)]  # fmt: skip
    assume(ends[0].phases == ends[1].phases)
    for name in ("impulse", "velocity_after"):
        by = getattr(d, name)
        slope = np.einsum("ijk,jk", by.inverse_mass, dW) + by.velocity @ du
        slope = slope + by.friction * dmu + by.restitution * de
        quotient = (getattr(ends[1], name) - getattr(ends[0], name)) / (2 * h)
        # of order 2: (h / slip)^2, and what that is multiplied by near a change of course
        bound = 1e-4 * (1 + np.linalg.norm(slope) + np.linalg.norm(ends[0].impulse))
        assert np.linalg.norm(quotient - slope) < bound


def test_an_impact_without_derivative_is_refused():
    W = inverse_mass((0.6, 0.2, 0.5), (0.3, 0.5, 0.4))
    with pytest.raises(ValueError, match="starts from rest"):
        impact_derivative(W, [-1.0, 0.0, 0.0], 0.05, 0.5)
    with pytest.raises(ValueError, match="friction"):
        impact_derivative(W, [-1.0, 0.0, 0.0], -1.0, 0.5)
