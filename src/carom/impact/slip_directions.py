"""Invariant directions of slip during an impact, and the friction from which slip does not start again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom import checks
from carom.geometry.thresholds import LAST_DIGIT
from carom.impact.api import checked_inverse_mass
from carom.impact.thresholds import LEAST_TURN, NO_TURN, SAME_SLIP, UNIT_ROOT


@dataclass(frozen=True)
class InvariantDirections:
    """Directions e of slip that stay constant: e x (W_tn - mu W_tt e) = 0.

    Parameters
    ----------
    angle : ndarray, shape (K,)
        Angle of e from tangent 1, in [0, 2 pi), ascending [rad].
    rate : ndarray, shape (K,)
        d|u_t|/dp along e, (W_tn - mu W_tt e).e [1/kg].
    outgoing : ndarray of bool, shape (K,)
        Whether slip grows along e. From rest, slip can grow along at most one direction.
    """

    angle: np.ndarray
    rate: np.ndarray
    outgoing: np.ndarray


def invariant_directions(inverse_mass, friction: float) -> InvariantDirections:
    """Return all directions of slip that stay constant during an impact (mathematics page, §1.9).

    Parameters
    ----------
    inverse_mass : array_like, shape (3, 3)
        W of the contact [1/kg], normal first.
    friction : float
        Coulomb coefficient mu, at least 0.

    Returns
    -------
    InvariantDirections
        Two to four directions; none if every direction is invariant (no coupling of normal and
        tangents, and W_tt isotropic or mu = 0).
    """
    W = checked_inverse_mass(inverse_mass)
    mu = checks.number("friction", friction, least=0.0)
    a, B = W[1:, 0], W[1:, 1:]

    # With z = exp(i th), 2 z^2 f is a polynomial of degree 4, whose roots on the unit circle are sought, where
    # f = a.e' - mu (B_12 cos 2th + (B_22 - B_11)/2 sin 2th), e' = (-sin, cos).
    c = mu * complex(B[0, 1], -0.5 * (B[1, 1] - B[0, 0]))
    first = complex(a[1], a[0])
    terms = np.array([-c, first, 0.0, np.conj(first), -np.conj(c)])
    size = float(np.max(np.abs(terms)))
    scale = float(np.max(np.abs(W)))
    if not size > NO_TURN * scale * max(1.0, mu):
        return InvariantDirections(np.zeros(0), np.zeros(0), np.zeros(0, dtype=bool))
    terms[np.abs(terms) < LAST_DIGIT * size] = 0.0
    roots = np.roots(terms)
    angles = np.angle(roots[np.abs(np.abs(roots) - 1.0) < UNIT_ROOT])
    for _ in range(3):  # Newton's iteration: the roots of the polynomial have errors of about 1e-12
        turn, slope = _turning(a, mu * B, angles)
        angles = angles - np.where(np.abs(slope) > LEAST_TURN * size, turn / slope, 0.0)
    angles = np.sort(np.mod(angles, 2.0 * np.pi))
    keep = np.ones(len(angles), dtype=bool)
    keep[1:] = np.diff(angles) > SAME_SLIP
    if len(angles) > 1 and angles[-1] - angles[0] > 2.0 * np.pi - SAME_SLIP:
        keep[-1] = False
    angles = angles[keep]
    e = np.stack([np.cos(angles), np.sin(angles)])
    rate = a @ e - mu * np.einsum("ik,ij,jk->k", e, B, e)
    return InvariantDirections(angles, rate, rate > 0.0)


def critical_friction(inverse_mass) -> float:
    """Return ``mu_crit = |W_tt^-1 W_tn|``: with this friction or more, slip that stops does not start again.

    Parameters
    ----------
    inverse_mass : array_like, shape (3, 3)
        W of the contact [1/kg], normal first. If W_tt is singular, the solution of least norm is used.
    """
    from carom.friction.rays import stick_ratio

    W = checked_inverse_mass(inverse_mass)
    return float(np.hypot(*stick_ratio(W[0, 1], W[0, 2], W[1, 1], W[1, 2], W[2, 2])))


def _turning(a, B, angle):
    """Return f(theta) = |u_t| dtheta/dp and its derivative."""
    c, s = np.cos(angle), np.sin(angle)
    half, cross = 0.5 * (B[1, 1] - B[0, 0]), B[0, 1]
    c2, s2 = c * c - s * s, 2.0 * s * c
    turn = a[1] * c - a[0] * s - (cross * c2 + half * s2)
    slope = -a[1] * s - a[0] * c - 2.0 * (half * c2 - cross * s2)
    return turn, slope
