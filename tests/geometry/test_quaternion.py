"""Arrays of quaternions: group laws, agreement with SciPy, exponential and logarithm."""

from fractions import Fraction
from math import factorial

import numpy as np
import pytest
from geometry_strategies import ROUND, components, exact_series, moderate, quaternions
from geometry_strategies import rotation_vectors as vectors
from hypothesis import given
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from carom.geometry import quaternion, rotation
from verified import agree, verifies


def scipy_rotation(q):
    return Rotation.from_quat(np.roll(q, -1, axis=-1))


@verifies("geometry.quaternion.multiply", "associative law", "invariant")
@verifies("geometry.quaternion.conjugate", "$q q^* = 1$", "invariant")
@verifies("geometry.quaternion.rotate", "$R(ab) = R(a) R(b)$", "invariant")
@verifies("geometry.quaternion.rotate_back", "$R^T R = 1$", "invariant")
@moderate
@given(quaternions(), quaternions(), quaternions(), components())
def test_group_laws(a, b, c, v):
    product = quaternion.multiply
    agree(product(product(a, b), c), product(a, product(b, c)), atol=ROUND)
    agree(product(a, quaternion.conjugate(a)), [1, 0, 0, 0], atol=ROUND)
    agree(
        quaternion.rotate(product(a, b), v),
        quaternion.rotate(a, quaternion.rotate(b, v)),
        atol=ROUND,
    )
    agree(quaternion.rotate_back(a, quaternion.rotate(a, v)), v, atol=ROUND)


@verifies("geometry.quaternion.rotate", "rotation matrices", "other program: SciPy's Rotation")
@moderate
@given(quaternions(), components())
def test_matrix_is_a_rotation_and_agrees_with_scipy(q, v):
    R = quaternion.matrix(q)
    agree(R @ R.T, np.eye(3), atol=ROUND)
    agree(np.linalg.det(R), 1.0, atol=ROUND)
    agree(R, scipy_rotation(q).as_matrix(), atol=ROUND)
    agree(R @ v, quaternion.rotate(q, v), atol=ROUND)
    agree(quaternion.matrix(quaternion.from_matrix(R)), R, atol=ROUND)


@moderate
@given(vectors(), vectors(most=200.0))
def test_exp_agrees_with_scipy_and_the_kernel(a, many_turns):
    assert_allclose(
        quaternion.matrix(quaternion.exp(a)), Rotation.from_rotvec(a).as_matrix(), atol=ROUND
    )
    # The angle |a| is rounded once: an error of eps |a| in the angle is inherent.
    q = quaternion.exp(many_turns)
    assert_allclose(q, rotation.exp(*many_turns), atol=ROUND + 2e-16 * 200)
    assert np.linalg.norm(q) == pytest.approx(1.0, abs=ROUND)


@moderate
@given(vectors())
def test_exp_is_the_exact_series(a):
    R = exact_series(a, lambda k: Fraction(1, factorial(k)))
    assert_allclose(quaternion.matrix(quaternion.exp(a)), R, atol=ROUND)


@moderate
@given(vectors(), quaternions())
def test_log_inverts_exp_at_every_angle(a, q):
    # From the identity the relative error is round-off even for the smallest angles.
    assert_allclose(
        quaternion.log(quaternion.exp(a)), a, rtol=ROUND, atol=1e-15 * np.linalg.norm(a)
    )
    assert_allclose(rotation.log(rotation.exp(*a)), a, rtol=ROUND, atol=1e-15 * np.linalg.norm(a))
    # The other way for every rotation; its angle lies in [0, pi].
    back = quaternion.log(q)
    assert np.linalg.norm(back) <= np.pi * (1 + 1e-15)
    sign = 1.0 if q[0] >= 0 else -1.0
    assert_allclose(quaternion.exp(back), sign * q, atol=ROUND)


def test_log_at_half_a_turn_and_at_rest():
    axis = np.array([0.6, 0.0, -0.8])
    for w in (0.0, -0.0, 1e-300, -1e-300, 1e-17, -1e-17):
        a = quaternion.log(np.append(w, axis))
        assert np.linalg.norm(a) == pytest.approx(np.pi, abs=1e-15)
        assert abs(a @ axis) == pytest.approx(np.pi, abs=1e-15)
    for q in ([1, 0, 0, 0], [-1, 0, 0, 0]):
        assert_allclose(quaternion.log(q), np.zeros(3), atol=0)
    # Below the root of the smallest float the squares vanish; the vector must not.
    assert_allclose(quaternion.log([1, 1e-200, 0, 0]), [2e-200, 0, 0], rtol=1e-15)
    assert_allclose(quaternion.exp([2e-200, 0, 0]), [1, 1e-200, 0, 0], rtol=1e-15)


@moderate
@given(quaternions(), vectors(most=3.0))
def test_interpolation_turns_at_a_constant_rate(q0, a):
    q1 = quaternion.multiply(q0, quaternion.exp(a))
    s = np.linspace(0.0, 1.0, 5)
    q = quaternion.interpolate(q0, q1, s)
    assert q.shape == (5, 4)
    expected = quaternion.multiply(q0, quaternion.exp(s[:, None] * a))
    # log near half a turn: q0 and q1 are rounded, and so the axis, by eps.
    assert_allclose(quaternion.matrix(q), quaternion.matrix(expected), atol=4 * ROUND)


def test_histories_broadcast():
    t = np.linspace(0.0, 1.0, 50)
    spin = np.array([[0.0, 0.0, 20.0], [9.0, 3.0, 0.0]])
    q = quaternion.exp(t[:, None, None] * spin)  # (T, N, 4)
    R = quaternion.matrix(q)
    assert R.shape == (50, 2, 3, 3)
    assert_allclose(quaternion.matrix(quaternion.from_matrix(R)), R, atol=ROUND)
    turns = quaternion.between(q[:-1], q[1:])
    assert_allclose(turns, np.broadcast_to(spin / 49, turns.shape), atol=ROUND)


def test_bad_input_is_named():
    with pytest.raises(ValueError, match=r"q must have shape \(\.\.\., 4\), got shape \(3,\)"):
        quaternion.matrix([1, 0, 0])
    with pytest.raises(ValueError, match="reflection"):
        quaternion.from_matrix(np.diag([1.0, 1.0, -1.0]))
    with pytest.raises(ValueError, match="orthonormal"):
        quaternion.from_matrix(2 * np.eye(3))
    with pytest.raises(ValueError, match="zero quaternion"):
        quaternion.normalize([0, 0, 0, 0])


def test_nan_stays_in_its_own_entry():
    a = np.array([[np.nan, 0.0, 0.0], [0.1, 0.2, 0.3]])
    q = quaternion.exp(a)
    assert np.all(np.isnan(q[0]))
    assert_allclose(quaternion.log(q)[1], a[1], rtol=ROUND)
