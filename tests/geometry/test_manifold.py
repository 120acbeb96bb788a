"""Autoparallel arcs on (R^3 x SO(3))^N: Exp, Log, transport, differential, length."""

import numpy as np
import pytest
from geometry_strategies import components, few, inertias, moderate, quaternions
from geometry_strategies import rotation_vectors as vectors
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from carom.geometry import quaternion
from references.manifold import Manifold, Point

MASSES = np.array([2.0, 0.5])
TWO = Manifold(MASSES, np.array([np.diag([1.0, 2.0, 2.5]), np.diag([0.3, 0.3, 0.4])]))


@st.composite
def points(draw):
    return Point(
        np.array([draw(components(5.0)), draw(components(5.0))]),
        np.array([draw(quaternions()), draw(quaternions())]),
    )


@st.composite
def arcs(draw, most=np.pi):
    return np.array([[*draw(components()), *draw(vectors(most))] for _ in range(2)])


def free_vectors():
    return st.tuples(*[components()] * 4).map(lambda c: np.array(c).reshape(2, 6))


def same_point(a, b, atol):
    assert_allclose(a.x, b.x, atol=atol)
    assert_allclose(quaternion.matrix(a.Q), quaternion.matrix(b.Q), atol=atol)


@pytest.mark.plain
@moderate
@given(points(), arcs(), points())
def test_exp_and_log_are_inverse(q, xi, other):
    # Q0* Q1 cancels: the error is eps of a unit quaternion, absolute, and eps |x| in x. Within it
    # the axis of half a turn may come out with either sign.
    end = TWO.exp(q, xi)
    back = TWO.log(q, end)
    turn = np.linalg.norm(xi[:, 3:], axis=1)
    clear = turn < np.pi - 1e-14
    assert_allclose(back[clear], xi[clear], atol=1e-14)
    assert np.all(np.linalg.norm(back[:, 3:], axis=1) <= np.pi * (1 + 1e-15))
    same_point(TWO.exp(q, back), end, atol=1e-14)
    same_point(TWO.exp(q, TWO.log(q, other)), other, atol=1e-14)


@moderate
@given(points(), arcs(), st.floats(-3, 3), st.floats(-3, 3))
def test_arcs_are_one_parameter_subgroups(q, xi, s, t):
    # Exp(Exp(q, s xi), t xi) = Exp(q, (s + t) xi): xi is constant along its own arc.
    same_point(TWO.exp(TWO.exp(q, s * xi), t * xi), TWO.exp(q, (s + t) * xi), atol=2e-14)
    assert_allclose(TWO.transport(s * xi, xi), xi, atol=1e-14)


@few
@given(points(), arcs(most=300.0))
def test_exp_stays_on_the_manifold_through_many_turns(q, xi):
    end = TWO.exp(q, xi)
    assert_allclose(np.linalg.norm(end.Q, axis=1), 1.0, atol=5e-16)
    # n equal parts of the arc make the whole; the angle 300 is rounded to 300 eps = 7e-14.
    part = q
    for _ in range(16):
        part = TWO.exp(part, xi / 16)
    same_point(part, end, atol=2e-13)


@moderate
@given(arcs(), free_vectors(), free_vectors())
def test_transport_keeps_pairings_and_lengths_of_isotropic_metrics(xi, a, p):
    v, w = TWO.transport(xi, a), TWO.transport(xi, p)
    assert np.sum(v * w) == pytest.approx(np.sum(a * p), abs=2e-14)
    ball = Manifold(MASSES, np.array([0.7 * np.eye(3), 0.1 * np.eye(3)]))
    assert ball.inner(v, v) == pytest.approx(ball.inner(a, a), abs=2e-14)
    # back along the reversed arc
    assert_allclose(TWO.transport(-xi, v), a, atol=1e-14)


@moderate
@given(points(), arcs(), free_vectors())
def test_transport_is_fixed_in_space_and_follows_exp(q, xi, a):
    # A vector parallel along the arc has constant world components R(s) a(s).
    end, moved = TWO.exp(q, xi), TWO.transport(xi, a)
    assert_allclose(
        quaternion.rotate(end.Q, moved[:, 3:]), quaternion.rotate(q.Q, a[:, 3:]), atol=1e-14
    )
    assert_allclose(moved[:, :3], a[:, :3], atol=0)


@few
@given(points(), arcs(most=3.0), free_vectors(), free_vectors())
def test_variation_of_the_end_point(q, xi, base, rate):
    # Start moved along `base`, arc changed at `rate`: the end has the velocity
    # transport(base) + T(xi) rate. Central differences of order 4, s = 1e-3: truncation s^4
    # times a fifth derivative of order ten, round-off eps / s.
    def end(s):
        return TWO.exp(TWO.exp(q, s * base), xi + s * rate)

    s, here = 1e-3, end(0.0)
    d = {k: TWO.log(here, end(k * s)) for k in (-2, -1, 1, 2)}
    measured = (8 * (d[1] - d[-1]) - (d[2] - d[-2])) / (12 * s)
    expected = TWO.transport(xi, base) + TWO.differential(xi, rate)
    assert_allclose(measured, expected, atol=2e-10)


@moderate
@given(arcs(), inertias(), inertias())
def test_length_is_the_kinetic_norm(xi, J0, J1):
    full = Manifold(MASSES, np.array([J0, J1]))
    m = np.repeat(full.mass, 3).reshape(2, 3)
    energy = np.sum(m * xi[:, :3] ** 2) + xi[0, 3:] @ J0 @ xi[0, 3:] + xi[1, 3:] @ J1 @ xi[1, 3:]
    assert full.length(xi) == pytest.approx(np.sqrt(energy), rel=1e-14, abs=1e-150)
    # lengths of parts add up: the speed is constant
    assert 4 * full.length(xi / 4) == pytest.approx(full.length(xi), rel=1e-14)
