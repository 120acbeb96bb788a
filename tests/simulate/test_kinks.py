"""Forces with kinks: springs that act from a length on, and forces that jump, as functions of the user."""

from math import atan2, cos, pi, sin, sqrt

import numpy as np
import pytest
from numba import njit
from scipy.integrate import quad
from scipy.optimize import brentq

import carom
from carom.dynamics.methods.dormand_prince import rk8_with_kinks

G, HIGH, FLOOR, R = (
    9.81,
    0.4,
    0.1,
    0.1,
)  # a ball of radius R falls by HIGH until the spring acts, below FLOOR
SPEED = sqrt(2.0 * G * HIGH)


@njit
def spring(t, states):
    """A spring of 1e6 N/m below the height FLOOR: the force has a kink there."""
    out = np.zeros((1, 6))
    if states[0, 2] < 0.1:
        out[0, 2] = 1e6 * (0.1 - states[0, 2])
    return out


def place(k, t):
    """Return the height after the time t: flights, and half waves x = g/k (cos - 1) - v/w sin in the spring."""
    w, flight = sqrt(k), SPEED / G
    contact = 2.0 * (pi - atan2(SPEED * w, G)) / w
    t = (t - flight) % (2.0 * flight + contact)
    if t > contact:
        t -= contact
        return FLOOR + SPEED * t - 0.5 * G * t * t
    return FLOOR - (G / k * (1.0 - cos(w * t)) + SPEED / w * sin(w * t))


def ball(function):
    scene = carom.Scene(gravity=(0, 0, -G))
    body = scene.add_body(carom.Sphere(R), mass=1.0, position=(0, 0, FLOOR + HIGH))
    scene.add_force(carom.forces.UserForce(body, function))
    return scene


@pytest.mark.parametrize("rtol", [1e-5, 1e-8, 1e-10])
def test_a_ball_on_a_spring_that_acts_below_a_height(rtol):
    # fifty kinks; each error of speed counts .2 s a bounce
    scene = ball(spring)
    for duration in (14.6, 14.9):
        found = carom.simulate(scene, duration, rtol=rtol, save_at=duration).position[-1, 0, 2]
        assert abs(found - place(1e6, duration)) < 10.0 * 2.0 * rtol * R


@pytest.mark.parametrize("rtol", [1e-8, 1e-10])
def test_the_same_in_coordinates_of_ones_own(rtol):
    def loads(t, q, v):
        return np.array([-G + (1e4 * (FLOOR - q[0]) if q[0] < FLOOR else 0.0)])

    system = carom.GeneralizedSystem(
        lambda q: np.eye(1), position=[FLOOR + HIGH], velocity=[0.0], force=loads
    )
    found = carom.simulate(system, 5.3, rtol=rtol, save_at=5.3).q[-1, 0]
    assert abs(found - place(1e4, 5.3)) < 10.0 * 2.0 * rtol


def test_no_kink_is_missed_by_all_errors_of_order_5():
    """Of x'' = (s - s_0)_+^n in a step of length 1, the velocity is off by sum b_i (c_i - s_0)_+^n - ..."""
    method = rk8_with_kinks()
    A, b, c = method.A, method.b, method.A.sum(axis=1)
    fifth, third = method.E[[0, 2, 3]], method.E[1]
    # conditions of order 5 for stages with A c^k = c^(k+1)/(k+1), k up to 3: sums of E c^k, and of E A c^3
    for k in range(5):
        assert np.abs(fifth @ c**k).max() < 1e-14
    assert np.abs(fifth @ A @ c**3).max() < 1e-14
    at = np.linspace(0.0, 1.0, 20001)
    for n in (0, 1, 2):
        stages = np.where(c[:, None] > at, (c[:, None] - at) ** n, 0.0)
        true = np.abs(b @ stages - (1.0 - at) ** (n + 1) / (n + 1))
        most = np.abs(fifth @ stages).max(axis=0)
        counts = true > 1e-5 * true.max()
        assert (true / np.maximum(most, 1e-300))[counts].max() < 4.0
        if n < 2:  # and it is told from a smooth step
            assert np.all((most > 0.1 * np.abs(third @ stages))[counts])


def onset(k, power):
    def force(t, states):
        deep = FLOOR - states[0, 2]
        return np.array([[0, 0, k * deep**power if deep > 0.0 else 0.0, 0, 0, 0]])

    return force


def time_in_spring(k, power):
    """Return twice the integral of ds / sqrt(v^2 + 2 g s - 2 k s^(n+1)/(n+1)) up to the greatest depth."""
    if power == 0:
        return 2.0 * SPEED / (k - G)
    energy = lambda s: SPEED**2 + 2 * G * s - 2 * k * s ** (power + 1) / (power + 1)  # noqa: E731
    deep = float(brentq(energy, 1e-9, 1e3, xtol=1e-17, rtol=1e-15))  # pyright: ignore

    def rate(u):  # s = deep (1 - u^2) takes the root out
        s = deep * (1 - u * u)
        powers = sum(deep ** (power - i) * s**i for i in range(power + 1))
        return 2 * deep / sqrt(deep * (2 * k / (power + 1) * powers - 2 * G))

    return 2.0 * quad(rate, 0.0, 1.0, epsabs=1e-15, epsrel=1e-13, limit=200)[0]


@pytest.mark.slow
def test_random_onsets():
    """Jumps, kinks and bends (powers 0, 1, 2) of random forces, at random times of a later flight."""
    rng, worst = np.random.default_rng(1), []
    for _ in range(60):
        power, deep = int(rng.integers(0, 3)), 10 ** rng.uniform(-2.5, -0.7)
        k = (power + 1) * (0.5 * SPEED**2 + G * deep) / deep ** (power + 1)
        bounces, flight = int(rng.integers(1, 6)), SPEED / G
        t = rng.uniform(0.01, 0.99) * flight
        duration = bounces * (time_in_spring(k, power) + 2.0 * flight) + t
        rtol = 10.0 ** -rng.integers(5, 11)
        found = carom.simulate(ball(onset(k, power)), duration, rtol=rtol, save_at=duration)
        exact = FLOOR + HIGH - 0.5 * G * t * t
        worst.append(abs(found.position[-1, 0, 2] - exact) / (2.0 * rtol * R))
    # a bend of the second order that no step has met before may be missed once
    assert np.sum(np.array(worst) > 10.0) <= 3
    assert max(worst) < 300.0
