"""One contact with Coulomb friction, solved exactly: ``w = W p + c`` with p in the friction cone.

Conditions (normal first): ``0 <= p_n  _|_  w_n >= 0``, ``|p_t| <= mu p_n``, and if the contact slides (w_t not
0) ``p_t = -mu p_n w_t/|w_t|``. Coulomb's law holds for the velocity w AFTER the impulse. This is the algebraic
law of time stepping; there is no impulse path with reversals of slip as in an impact.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from carom import checks


def solve_one_contact(inverse_mass, velocity, friction) -> np.ndarray:
    """Return the impulse p (3,) [N s] that satisfies the conditions of Signorini and Coulomb.

    If ``c_n >= 0`` the contact opens, p = 0. Otherwise the normal row is eliminated by w_n = 0::

        A = W_tt - W_tn W_nt / W_nn ,   b = c_t - W_tn c_n / W_nn ,   w_t = A p_t + b

    The contact sticks, ``p_t = -A^-1 b``, if this is inside the cone. Otherwise it slides, ``w_t = -alpha p_t``
    with alpha > 0, hence ``p_t = -(A + alpha I)^-1 b``; alpha is a root of ``|p_t| - mu p_n``, which is
    positive at 0 and negative for large alpha, so a root exists (several only if mu is large).

    Parameters
    ----------
    inverse_mass : array_like, shape (3, 3)
        Delassus matrix W, symmetric, positive semi-definite with W_nn > 0 [1/kg]. Tangential
        directions that cannot move (zero rows) get no impulse.
    velocity : array_like, shape (3,)
        c: the velocity without impulse, with the restitution term in its normal entry [m/s].
    friction : float
        Coefficient mu >= 0.
    """
    W = checks.finite_array("inverse_mass", inverse_mass, (3, 3), "1/kg")
    c = checks.finite_array("velocity", velocity, (3,), "m/s")
    mu = checks.number("friction", friction, least=0.0)
    if not np.allclose(W, W.T, rtol=0.0, atol=1e-12 * np.abs(W).max()):
        raise ValueError(f"inverse_mass must be symmetric, got {checks.shown(inverse_mass)}")
    if not W[0, 0] > 0.0:
        raise ValueError(f"inverse_mass[0, 0] must be above 0 [1/kg], got {W[0, 0]!r}")
    if c[0] >= 0.0:
        return np.zeros(3)
    coupling = W[1:, 0] / W[0, 0]
    stiffness, axes = np.linalg.eigh(W[1:, 1:] - np.outer(coupling, W[0, 1:]))
    if stiffness[0] < -1e-12 * np.trace(W):
        raise ValueError(
            f"inverse_mass must be positive semi-definite, got {checks.shown(inverse_mass)}"
        )
    b = axes.T @ (c[1:] - coupling * c[0])
    empty = stiffness <= 1e-13 * np.trace(W)
    b[empty], stiffness[empty] = 0.0, W[0, 0]

    def impulse(alpha):
        tangential = axes @ (-b / (stiffness + alpha))
        return np.array([-(c[0] + W[0, 1:] @ tangential) / W[0, 0], *tangential])

    def excess(alpha):
        p = impulse(alpha)
        return np.hypot(p[1], p[2]) - mu * p[0]

    if excess(0.0) <= 0.0:
        return impulse(0.0)  # stick
    if mu == 0.0:
        return np.array([-c[0] / W[0, 0], 0.0, 0.0])
    high = stiffness.max()
    while excess(high) > 0.0:
        if not high < 1e300:  # round-off cannot distinguish so narrow a cone from a line
            return np.array([-c[0] / W[0, 0], 0.0, 0.0])
        high *= 4.0
    return impulse(brentq(excess, 0.0, high, xtol=1e-16 * high))
