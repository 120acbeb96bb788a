"""The differential T of the exponential and its inverse: exact series, finite differences."""

from fractions import Fraction
from functools import cache
from math import comb, factorial

import numpy as np
import pytest
from geometry_strategies import ROUND, components, exact_series, few, moderate, rotation_vectors
from hypothesis import given
from numpy.testing import assert_allclose
from scipy.linalg import expm, logm

from carom.geometry import differential, quaternion
from carom.studies.gradient.body import hat


@cache
def bernoulli(n):
    """Return B_n (with B_1 = -1/2), from sum over k of binomial(n+1, k) B_k = 0."""
    if n == 0:
        return Fraction(1)
    return -sum(comb(n + 1, k) * bernoulli(k) for k in range(n)) / (n + 1)


def exact(a):
    """T(a) = sum (-hat)^k / (k+1)!."""
    return exact_series(a, lambda k: Fraction((-1) ** k, factorial(k + 1)))


def inverse_matrix(a):
    """T(a)^-1, column by column."""
    return np.array([differential.apply_inverse(a, e) for e in np.eye(3)]).T


@moderate
@given(rotation_vectors())
def test_differential_is_the_exact_series(a):
    assert_allclose(differential.matrix(a), exact(a), atol=ROUND)


@moderate
@given(rotation_vectors(most=1.5))
def test_inverse_is_the_exact_series(a):
    # sum B_k (-hat)^k / k!, which converges like (t/2pi)^k: 60 terms leave 1e-37 at 1.5.
    series = exact_series(a, lambda k: (-1) ** k * bernoulli(k) / factorial(k))
    assert_allclose(inverse_matrix(a), series, atol=ROUND)


@pytest.mark.plain
@pytest.mark.parametrize("p", range(-16, 1))
def test_coefficients_have_no_cancellation_at_small_angles(p):
    # Each coefficient on its own is right to round-off, over all decades and at the switch of
    # formula (angle 1 and 2): t2 as an exact fraction, 40 terms.
    for t2 in (10.0 ** (2 * p), 0.31 * 10.0**p, 0.999999 * 10.0**p, 3.99, 4.0, 4.01, 9.0):
        x = Fraction(t2)
        first = sum(Fraction((-1) ** k, factorial(2 * k + 2)) * x**k for k in range(40))
        second = sum(Fraction((-1) ** k, factorial(2 * k + 3)) * x**k for k in range(40))
        g = sum(
            Fraction((-1) ** k * (2 * k + 2), factorial(2 * k + 3)) * (x / 4) ** k
            for k in range(40)
        )
        sinc = sum(Fraction((-1) ** k, factorial(2 * k + 1)) * (x / 4) ** k for k in range(40))
        reference = [float(first), float(second), float(g / sinc / 4)]
        # At angle 1 and above t - sin t loses a factor 6/t^2.
        array = np.array([t2])
        got = [*differential._coefficients(array), differential._inverse(array)]
        assert_allclose(np.ravel(got), reference, rtol=1.5e-15)


@moderate
@given(rotation_vectors(), components())
def test_inverse_inverts(a, b):
    assert_allclose(differential.apply(a, differential.apply_inverse(a, b)), b, atol=ROUND)
    assert_allclose(differential.matrix(a) @ inverse_matrix(a), np.eye(3), atol=ROUND)


def test_inverse_up_to_a_whole_turn():
    # T has the singular value sin(t/2)/(t/2): the condition grows as 1/(2 pi - t).
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    for gap in (1.0, 1e-3, 1e-6):
        a = (2 * np.pi - gap) * axis
        product = differential.matrix(a) @ inverse_matrix(a)
        assert_allclose(product, np.eye(3), atol=1e-14 / gap)


@moderate
@given(rotation_vectors(), components())
def test_transpose_is_the_other_side(a, b):
    # T(-a) = T(a)^T, and exp(hat a) T(a) = T(a)^T: the world form of the same velocity.
    T = differential.matrix(a)
    assert_allclose(differential.matrix(-a), T.T, atol=ROUND)
    assert_allclose(quaternion.matrix(quaternion.exp(a)) @ T, T.T, atol=ROUND)
    assert_allclose(T @ a, a, atol=ROUND)


@few
@given(rotation_vectors(), components())
def test_differential_against_matrix_logarithm(a, b):
    # W = d/ds log(R(a)^T R(a + s b)) at s = 0, by central differences of order 4: with s = 1e-3
    # the truncation is s^4/30 times a fifth derivative of order one, round-off eps/s = 2e-13.
    def turn(s):
        skew = np.real(logm(expm(-hat(a)) @ expm(hat(a + s * b))))
        return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])

    s = 1e-3
    W = (8 * (turn(s) - turn(-s)) - (turn(2 * s) - turn(-2 * s))) / (12 * s)
    assert_allclose(differential.apply(a, b), W, atol=1e-11)


def test_shapes_broadcast():
    a = np.zeros((7, 1, 3))
    assert differential.apply(a, np.ones((2, 3))).shape == (7, 2, 3)
    assert differential.matrix(a).shape == (7, 1, 3, 3)
    assert_allclose(hat([1, 2, 3]) @ [4, 5, 6], np.cross([1, 2, 3], [4, 5, 6]))
