"""The Chaplygin sleigh: a planar body on a knife edge, its mass centre ahead of the blade.

Conventions. Plane x-y, heading theta (t = 0: 0), blade along e1 = (cos theta, sin theta), e2 normal
to it. Blade point P; mass centre C = P + a e1. The knife edge forbids the velocity of P along e2,
so ``v_P = u e1``, ``v_C = u e1 + a w e2``. m, I (about C) and a are 1; at t = 0 u = 0, w = 1: P is
at rest, the mass centre starts with (0, a w) = (0, 1). No other force acts in the plane::

    du/dt = a w^2 ,    (I + m a^2) dw/dt = -m a u w

with ``2 E = m u^2 + (I + m a^2) w^2`` constant; for m = 1, ``c = sqrt(2 E)``, ``k = I + a^2``::

    u = c tanh(a c t/k + c0) ,    w = c/sqrt(k) sech(a c t/k + c0) ,    c0 = 0 for u(0) = 0

The body turns until it runs straight ahead, mass centre in front, at speed c = sqrt(2). The heading
``theta = (sqrt(k)/a) gd(a c t/k)``, with the Gudermannian ``gd(z) = 2 atan(tanh(z/2))``, tends to
pi/sqrt(2).
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad

MASS, INERTIA, AHEAD = 1.0, 1.0, 1.0
K = INERTIA + MASS * AHEAD**2
C = np.sqrt(K)  # u(0) = 0, w(0) = 1


def speeds(t):
    """Return (u, w): speed of the blade point along the blade [m/s], turning rate [rad/s]."""
    z = AHEAD * C * np.asarray(t, float) / K
    return C * np.tanh(z), C / np.sqrt(K) / np.cosh(z)


def heading(t):
    """Return theta(t) [rad]."""
    return np.sqrt(K) / AHEAD * 2.0 * np.arctan(np.tanh(0.5 * AHEAD * C * t / K))


def blade_point(t):
    """Return P(t) (2,) [m], by quadrature of u e1."""

    def component(f):
        return quad(lambda s: speeds(s)[0] * f(heading(s)), 0.0, t, epsabs=1e-13, epsrel=1e-13)[0]

    return np.array([component(np.cos), component(np.sin)])


def mass_centre(t):
    """Return C(t) (2,) [m], with P(0) = 0."""
    return blade_point(t) + AHEAD * np.array([np.cos(heading(t)), np.sin(heading(t))])
