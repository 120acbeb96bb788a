"""The residual is right where it can be worked out by hand."""

import math

import numpy as np
import pytest

import carom
from carom.friction.layout import CONE, ContactProblem
from carom.friction.residual import measure

EYE, NONE = np.eye(3), np.zeros((1, 2))


def residual(c, p, mu=0.5, kind=0, heading=NONE, W=EYE):
    problem = ContactProblem(
        W, np.array(c, float), np.array([mu]), np.array([kind]), np.array(heading, float)
    )
    return measure(1, problem, np.array(p, float))


@pytest.mark.plain
def test_by_hand():
    # W = 1, so rho = 1 and w = p + c.
    r, tolerance, penetration, violation, product = residual((-1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    # nothing done: p - rho w = (1, 0, 0) is in the cone
    assert (r, penetration, violation, product) == (1.0, 1.0, 0.0, 0.0)
    assert tolerance == pytest.approx(1e-10)
    r, _, penetration, violation, product = residual((-1.0, 0.0, 0.0), (3.0, 0.0, 0.0))
    # pressed too hard: w_n = 2, p - rho w = (1, 0, 0)
    assert (r, penetration, violation, product) == (2.0, 0.0, 0.0, 6.0)
    r, _, _, violation, _ = residual((-1.0, 0.0, 0.0), (1.0, 0.7, 0.0))
    assert violation == pytest.approx(0.2)
    assert r > 0.1
    # friction forgotten: p = (1, 0, 0), w = (0, 1, 0), mu = 0.5: x = p - (w + 0.5 e_n) = (0.5, -1, 0);
    # nearest in the cone: n = (0.5 + 0.5)/(1.25) = 0.8, t = -0.4: distance |(0.2, 0.4)|
    r, *_ = residual((-1.0, 1.0, 0.0), (1.0, 0.0, 0.0))
    assert r == pytest.approx(math.hypot(0.2, 0.4))
    r, *_ = residual((-1.0, 1.0, 0.0), (1.0, -0.5, 0.0))
    assert r == 0.0


@pytest.mark.plain
def test_known_direction_and_stick():
    assert residual((-1.0, 0.0, 0.0), (1.0, -0.3, -0.4), kind=1, heading=[[0.6, 0.8]])[0] < 1e-15
    r, _, _, violation, _ = residual(
        (-1.0, 0.0, 0.0), (1.0, 0.3, 0.4), kind=1, heading=[[0.6, 0.8]]
    )
    assert r > 0.5
    assert violation == pytest.approx(1.0)
    assert residual((-1.0, 4.0, -3.0), (1.0, -4.0, 3.0), kind=2)[0] == 0.0
    assert residual((-1.0, 4.0, -3.0), (1.0, 0.0, 0.0), kind=2)[0] == pytest.approx(5.0)
    # an open contact that sticks still holds in its plane
    assert residual((1.0, 4.0, -3.0), (0.0, -4.0, 3.0), kind=2)[0] == 0.0


@pytest.mark.plain
def test_unit_of_velocity():
    # impulse and inverse mass in other units: the residual does not change
    first = residual((-1.0, 1.0, 0.2), (0.7, 0.1, 0.3))[0]
    other = residual((-1.0, 1.0, 0.2), (700.0, 100.0, 300.0), W=EYE * 1e-3)[0]
    assert other == pytest.approx(first, rel=1e-14)


@pytest.mark.plain
def test_not_a_number_stays():
    assert math.isnan(residual((-1.0, 0.0, 0.0), (math.nan, 0.0, 0.0))[0])


def test_an_open_contact_without_friction_and_slip_is_solved():
    """A stop has a normal row alone. p = 0, w_n > 0 is its solution; a pull p_n < 0 that stops w is none."""
    W, c = np.zeros((3, 3)), np.array([0.3, 0.0, 0.0])
    W[0, 0] = 2.0
    problem = ContactProblem(W, c, np.zeros(1), np.full(1, CONE), np.zeros((1, 2)))
    assert measure(1, problem, np.zeros(3))[0] == 0.0
    assert measure(1, problem, np.array([-0.15, 0.0, 0.0]))[0] > 0.05


@pytest.mark.few(5)
@pytest.mark.parametrize("seed", range(20))
def test_contacts_and_stops_together(seed):
    """Points with friction and rows of stops, of which some open and some press, to round-off."""
    rng = np.random.default_rng([18, seed])
    k, stops = int(rng.integers(2, 8)), rng.random(8) < 0.5
    G = rng.normal(size=(3 * k, 3 * k + 2))
    for i in np.flatnonzero(stops[:k]):
        G[3 * i + 1 : 3 * i + 3] = 0.0
    W = G @ G.T
    mu = np.where(stops[:k], 0.0, rng.uniform(0.0, 1.0, size=k))
    for i in np.flatnonzero(stops[:k]):
        W[3 * i + 1, 3 * i + 1] = W[3 * i + 2, 3 * i + 2] = W[3 * i, 3 * i]
    c = rng.normal(size=(k, 3))
    c[stops[:k], 1:] = 0.0
    found = carom.solve_contacts(W, c, mu)
    assert found.converged
    assert found.residual <= 1e-12 * np.abs(c).max()
    assert np.all(found.impulse[:, 0] >= 0.0)
