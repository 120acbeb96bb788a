"""The connection of Newton's law: Euler's equations, Eq. (1), torsion, curvature, lengths."""

import numpy as np
import pytest
from geometry_strategies import components, few, inertias, moderate
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from carom.geometry import differential, quaternion
from references import connection
from references.manifold import kinetic_metric

LAW = connection.affinities()
#: Round-off of sums of some thirty products with moments up to 6.
ROUND = 2e-13


def force(L, J, v, rate, mass=1.3):
    """The left side of Newton's law for one body."""
    M = kinetic_metric([mass], [J])
    return connection.covector_derivative(L, M @ rate, M @ v, v)


def six():
    return st.tuples(components(3.0), components(3.0)).map(np.hstack)


@pytest.mark.plain
@moderate
@given(inertias(), six(), six())
def test_newtons_law_is_eulers_equation(J, v, rate):
    #   m xddot = f,   J Wdot + W x J W = tau
    W = v[3:]
    expected = np.hstack([1.3 * rate[:3], J @ rate[3:] + np.cross(W, J @ W)])
    assert_allclose(force(LAW, J, v, rate), expected, atol=ROUND)


@pytest.mark.plain
@moderate
@given(inertias(), six(), six(), st.floats(-2, 2))
def test_no_other_member_of_the_family_gives_eulers_equation(J, v, rate, c):
    # c eps gives c W x J W in place of W x J W; they agree only for c = 1 or W x J W = 0.
    gyroscopic = np.cross(v[3:], J @ v[3:])
    defect = force(connection.affinities(c=c), J, v, rate) - force(LAW, J, v, rate)
    assert_allclose(defect[:3], 0.0, atol=0)
    assert_allclose(defect[3:], (c - 1.0) * gyroscopic, atol=ROUND)


@few
@given(inertias(), six(), six())
def test_half_fails_unless_the_inertia_is_isotropic(J, v, rate):
    half = connection.affinities(c=0.5)
    gyroscopic = np.cross(v[3:], J @ v[3:])
    assume(np.linalg.norm(gyroscopic) > 1e-6)
    assert np.linalg.norm(force(half, J, v, rate) - force(LAW, J, v, rate)) > 4e-7
    ball = 0.7 * np.eye(3)
    assert_allclose(force(half, ball, v, rate), force(LAW, ball, v, rate), atol=ROUND)


@few
@given(inertias(), components(), components(), components(), components())
def test_eq_1_is_the_newton_euler_balance_in_the_world(J, a, b, c, d):
    # A smooth motion R(t) = exp(hat theta(t)), theta = a + b t + c t^2 / 2, x = d t^3. The world
    # balance: force = d(m xdot)/dt, torque = dL/dt with L = R J W. The derivatives of L and W are
    # central differences of order 6, s = 3e-3: truncation below 1e-13 times a seventh derivative
    # (of order 1e3 at the most), round-off eps / s = 1e-13.
    def motion(t):
        theta, rate = a + b * t + 0.5 * c * t * t, b + c * t
        return quaternion.exp(theta), differential.apply(theta, rate)

    def spin(t):
        Q, W = motion(t)
        return quaternion.rotate(Q, J @ W)

    def derivative(f, t, s=3e-3):
        weights = ((1, 45), (2, -9), (3, 1))
        return sum(k * (f(t + n * s) - f(t - n * s)) for n, k in weights) / (60 * s)

    t, mass = 0.4, 1.3
    Q, W = motion(t)
    v = np.hstack([3 * d * t**2, W])
    rate = np.hstack([6 * d * t, derivative(lambda t: motion(t)[1], t)])
    covariant = force(LAW, J, v, rate, mass)
    assert_allclose(covariant[:3], mass * 6 * d * t, atol=1e-14)
    assert_allclose(quaternion.rotate(Q, covariant[3:]), derivative(spin, t), atol=1e-9)


@moderate
@given(six(), inertias())
def test_autoparallels_have_constant_components(v, J):
    assert_allclose(connection.autoparallel_rate(LAW, v), 0.0, atol=1e-14)
    assert_allclose(connection.vector_derivative(LAW, np.zeros(6), v, v), 0.0, atol=1e-14)
    # The free motions, by contrast, are autoparallels of the Levi-Civita connection.
    levi_civita = connection.levi_civita(kinetic_metric([1.3], [J]))
    euler = -np.linalg.solve(J, np.cross(v[3:], J @ v[3:]))
    scale = 1.0 + np.abs(euler).max()
    assert_allclose(connection.autoparallel_rate(levi_civita, v)[3:], euler, atol=1e-12 * scale)


@moderate
@given(six(), six())
def test_parallel_fields_are_fixed_in_space(w, v):
    # nabla_v w = 0 at wdot = -W x w: the rate of world-fixed components. Covectors alike.
    rate = np.hstack([np.zeros(3), -np.cross(v[3:], w[3:])])
    assert_allclose(connection.vector_derivative(LAW, rate, w, v), 0.0, atol=1e-14)
    assert_allclose(connection.covector_derivative(LAW, rate, w, v), 0.0, atol=1e-14)


@few
@given(six(), six(), six(), six(), six())
def test_covector_and_vector_derivatives_obey_the_product_rule(p, p_rate, w, w_rate, v):
    # d<p, w>/dt = <nabla p, w> + <p, nabla w>, for any affinities.
    L = np.random.default_rng(5).normal(size=(6, 6, 6))
    nabla_p = connection.covector_derivative(L, p_rate, p, v)
    nabla_w = connection.vector_derivative(L, w_rate, w, v)
    assert nabla_p @ w + p @ nabla_w == pytest.approx(p_rate @ w + p @ w_rate, abs=1e-11)


@pytest.mark.plain
def test_flat_with_the_bracket_as_torsion():
    C = connection.structure_constants()
    assert_allclose(connection.curvature(LAW), 0.0, atol=0)
    assert_allclose(connection.torsion(LAW), C, atol=0)
    # the mirror image c = 0: flat, torsion -[X, Y]; c = 1/2: no torsion, R(X,Y)Z = -[[X,Y],Z]/4
    assert_allclose(connection.curvature(connection.affinities(c=0.0)), 0.0, atol=0)
    assert_allclose(connection.torsion(connection.affinities(c=0.0)), -C, atol=0)
    half = connection.affinities(c=0.5)
    assert_allclose(connection.torsion(half), 0.0, atol=0)
    bracket = np.einsum("pij,mpk->mkij", C, C)
    assert_allclose(connection.curvature(half), -bracket / 4, atol=1e-16)


@few
@given(inertias())
def test_metric_only_for_isotropic_inertia(J):
    assert_allclose(
        connection.nonmetricity(LAW, kinetic_metric([1.3], [0.7 * np.eye(3)])), 0.0, atol=1e-15
    )
    M = kinetic_metric([1.3], [J])
    largest = np.abs(connection.nonmetricity(LAW, M)).max()
    anisotropy = np.ptp(np.linalg.eigvalsh(J))
    # (nabla_I g)(J, K) = -(hat_I^T J + J hat_I): its entries are of the size of the differences
    # of J's eigenvalues.
    assert 0.2 * anisotropy - ROUND <= largest <= 2.0 * anisotropy + ROUND
    levi_civita = connection.levi_civita(M)
    scale = np.abs(levi_civita).max()
    assert_allclose(connection.nonmetricity(levi_civita, M), 0.0, atol=1e-12 * scale)
    assert_allclose(connection.torsion(levi_civita), 0.0, atol=1e-12 * scale)


def test_half_is_levi_civita_only_for_isotropic_inertia():
    half = connection.affinities(c=0.5)
    ball = connection.levi_civita(kinetic_metric([2.0], [0.7 * np.eye(3)]))
    assert_allclose(ball, half, atol=1e-15)
    die = connection.levi_civita(kinetic_metric([2.0], [np.diag([1.0, 1.0, 1.2])]))
    assert np.abs(die - half).max() > 0.05


def test_bodies_do_not_mix():
    L = connection.affinities(bodies=2)
    assert L.shape == (12, 12, 12)
    assert_allclose(L[:6, :6, :6], LAW, atol=0)
    assert_allclose(L[6:, 6:, 6:], LAW, atol=0)
    assert np.count_nonzero(L) == 2 * 6
    assert_allclose(connection.curvature(L), 0.0, atol=0)
