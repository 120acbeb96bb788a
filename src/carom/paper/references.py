"""References for the runs: closed forms, and an integration without any code of carom."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from carom.paper.runs import DIE_E, DROP, EDGE, GRAVITY, MASS, SPINS


class Bounce(NamedTuple):
    """A point that falls from rest onto a plane and bounces, in closed form."""

    restitution: float
    drop: float = DROP
    gravity: float = GRAVITY

    @property
    def first(self) -> float:
        """t_1 = sqrt(2 h / g) [s]."""
        return np.sqrt(2.0 * self.drop / self.gravity)

    @property
    def speed(self) -> float:
        """Speed of the first impact, v_1 = g t_1 [m/s]."""
        return self.gravity * self.first

    def times(self, count: int) -> np.ndarray:
        """t_k = t_1 (1 + 2 e + ... + 2 e^(k-1)) [s]."""
        flights = 2.0 * self.restitution ** np.arange(1, count)
        return self.first * np.cumsum([1.0, *flights])

    @property
    def rest(self) -> float:
        """Time at which infinitely many impacts have passed, t_1 (1 + e)/(1 - e) [s]."""
        e = self.restitution
        return self.first * (1.0 + e) / (1.0 - e) if e < 1.0 else np.inf

    def motion(self, t) -> tuple[np.ndarray, np.ndarray]:
        """Return height [m] and velocity [m/s]; at the time of an impact, those after it."""
        t = np.asarray(t, dtype=float)
        hits = self.times(400)
        k = np.searchsorted(hits, t, side="right")
        since = t - hits[np.maximum(k, 1) - 1]
        up = self.speed * self.restitution**k
        height = np.where(k > 0, since * (up - 0.5 * self.gravity * since), 0.0)
        velocity = np.where(k > 0, up - self.gravity * since, -self.gravity * t)
        height = np.where(k > 0, height, self.drop - 0.5 * self.gravity * t * t)
        resting = t >= self.rest
        return np.where(resting, 0.0, height), np.where(resting, 0.0, velocity)


class DieImpact(NamedTuple):
    """The first impact of the die."""

    time: float
    velocity: np.ndarray  # before [m/s]
    spin: np.ndarray  # [rad/s]
    jacobian: np.ndarray  # G (3, 6): n, t1, t2 = z, x, y
    inverse_mass: np.ndarray  # W (3, 3)
    approach: np.ndarray  # u- (3,)


_MASSES = np.array([MASS] * 3 + [MASS * EDGE**2 / 6.0] * 3)
_CORNERS = 0.5 * EDGE * np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, 8).T


def root(function, low: float, high: float) -> float:
    """Return the root of a function between two points of opposite sign, to round-off."""
    return float(np.asarray(brentq(function, low, high, xtol=1e-16, rtol=np.float64(1e-15))))


@cache
def die_impact(kind: str) -> DieImpact:
    """Return the first impact after the free flight of the die, and the corner or edge that strikes.

    A cube is isotropic: it turns about a fixed axis, and its centre moves on a parabola.
    """
    w = np.array(SPINS[kind])
    rate = np.linalg.norm(w)
    hat = np.cross(np.eye(3), w / rate)  # hat(k) a = k x a

    def arms(t):
        turn = np.eye(3) + np.sin(rate * t) * hat + (1.0 - np.cos(rate * t)) * hat @ hat
        return _CORNERS @ turn.T

    def gap(t):
        return 0.3 - 0.5 * t - 0.5 * GRAVITY * t * t + arms(t)[:, 2].min()

    t = root(gap, 0.1, 0.25)
    corners = arms(t)
    tied = corners[:, 2] < corners[:, 2].min() + 1e-9
    r = corners[tied].mean(axis=0)
    axes = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])
    G = np.hstack([axes, np.cross(r, axes)])
    v = np.array([0.5, 0.0, -0.5 - GRAVITY * t])
    return DieImpact(t, v, w, G, (G / _MASSES) @ G.T, G @ np.concatenate([v, w]))


@cache
def die_after(kind: str, friction: float) -> np.ndarray:
    """Return (v, w) (6,) after the first impact with Newton's law.

    In the plane it is Routh's closed form: slip keeps its direction, so N grows from 0 to
    (1 + e) |u_n| / (W_nn - mu s W_nt). In space the Darboux-Keller equation is integrated over u_n,
    du_t/du_n = (W_tn + W_tt tau)/(W_nn + W_nt.tau), tau = -mu u_t/|u_t|, by a
    Runge-Kutta method of order 8.
    """
    at = die_impact(kind)
    W, u = at.inverse_mass, at.approach
    end = -DIE_E * u[0]
    if kind == "planar":
        tau = np.array([-friction * np.sign(u[1]), 0.0])
        impulse = (end - u[0]) / (W[0, 0] + W[0, 1:] @ tau) * np.array([1.0, *tau])
        assert np.sign((u + W @ impulse)[1]) == np.sign(u[1]), "slip must not stop on the way"
    else:

        def slip(_, y):
            tau = -friction * y / np.hypot(*y)
            return (W[1:, 0] + W[1:, 1:] @ tau) / (W[0, 0] + W[0, 1:] @ tau)

        path = solve_ivp(slip, (u[0], end), u[1:], method="DOP853", rtol=1e-13, atol=1e-15)
        impulse = np.linalg.solve(W, np.array([end, *path.y[:, -1]]) - u)
    return np.concatenate([at.velocity, at.spin]) + (at.jacobian.T @ impulse) / _MASSES
