"""The saltation of an impact: the change of the motion after it by a change of the motion before it.

The impact of a changed motion happens at another time, t* + dt, at which its gap is zero:

    dt = -(dg/dq . dq)/gdot,   dq(t* + dt) = dq + v- dt,   dv(t* + dt) = dv + a- dt.

At this time the map of the impact is differentiated, including W and u with the point and the axes of contact.
The results are converted back to t*, so that all tangents belong to the same time (mathematics page, §5.2).
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from carom.studies.gradient.blow import UPPER, Blow
from carom.studies.gradient.body import Moving, cross, hat
from carom.studies.gradient.place import Place


class Strike(NamedTuple):
    """An impact of one or two bodies with its derivatives by P parameters; contact axes as in the run."""

    bodies: list[Moving]  # bodies after the impact
    time: np.ndarray  # (P,) time of the impact
    point: np.ndarray  # (3, P) its point, in the world
    before: np.ndarray  # (3, P) relative velocity before it
    after: np.ndarray
    impulse: np.ndarray  # (3, P)
    inputs: np.ndarray  # (11, P) W, u, mu, e
    poses: np.ndarray  # (6 B, P) poses at the impact
    velocities: list[np.ndarray]  # (6, P) velocities of each body at the impact, before it


def relative_velocity(place: Place, bodies: list[Moving]) -> np.ndarray:
    """Return u = G v (3,)."""
    return place.axes @ sum(s * _point_velocity(b, r) for s, b, r in _sides(place, bodies))


def inverse_mass(place: Place, bodies: list[Moving]) -> np.ndarray:
    """Return W = G M^-1 G^T (3, 3)."""
    return place.axes @ sum(_mobility(b, r) for _, b, r in _sides(place, bodies)) @ place.axes.T


def arrival(place: Place, bodies: list[Moving]):
    """Return dt (P,), and the tangents of poses (6 B, P) and velocities (6, P) of each body at the impact."""
    poses = np.concatenate([b.X[:6] for b in bodies])
    speeds = np.concatenate([np.concatenate([b.v, b.w]) for b in bodies])
    dt = -(place.d_gap @ poses) / (place.d_gap @ speeds)
    rates = [np.concatenate([b.gravity, b.spin_rate]) for b in bodies]
    velocities = [b.X[6:] + np.outer(rate, dt) for b, rate in zip(bodies, rates)]
    return dt, poses + np.outer(speeds, dt), velocities


def strike(place: Place, bodies: list[Moving], blow: Blow, d_mu, d_e) -> Strike:
    """Pass an impact; `bodies` are just before it, d_mu and d_e (P,) are the changes of mu and e."""
    dt, poses, velocities = arrival(place, bodies)
    axes, P = place.axes, dt.size
    d_axes = np.einsum("ijk,kp->ijp", place.d_axes, poses)
    d_arms = [place.d_arms[k] @ poses for k in range(len(bodies))]

    # u = G v and W = G M^-1 G^T along the tangents
    moving, d_moving, K, dK = np.zeros(3), np.zeros((3, P)), np.zeros((3, 3)), np.zeros((3, 3, P))
    d_inverse = []
    for k, (sign, b, r) in enumerate(_sides(place, bodies)):
        dv, dw = velocities[k][:3], velocities[k][3:]
        moving += sign * _point_velocity(b, r)
        d_moving += sign * (dv + cross(dw, r) + cross(b.w, d_arms[k]))
        d_inverse.append(_d_inverse(b, poses[6 * k + 3 : 6 * k + 6]))
        K += _mobility(b, r)
        dK += _d_mobility(b, r, d_arms[k], d_inverse[k])
    before = np.einsum("ijp,j->ip", d_axes, moving) + axes @ d_moving
    half = np.einsum("iap,ab,jb->ijp", d_axes, K, axes)
    dW = half + half.transpose(1, 0, 2) + np.einsum("ia,abp,jb->ijp", axes, dK, axes)
    inputs = np.array([*(dW[i, j] for i, j in UPPER), *before, d_mu, d_e])

    # the impulse, in contact axes and in the world
    impulse = blow.d[:3] @ inputs
    W = axes @ K @ axes.T
    after = before + W @ impulse + np.einsum("ijp,j->ip", dW, blow.impulse)
    p = axes.T @ blow.impulse
    dp = np.einsum("ijp,i->jp", d_axes, blow.impulse) + axes.T @ impulse

    out = []
    for k, (sign, b, r) in enumerate(_sides(place, bodies)):
        inverse, angular = b.inverse_inertia, np.cross(r, p)
        v, w = b.v + sign * p / b.mass, b.w + sign * inverse @ angular
        dv = velocities[k][:3] + sign * (dp / b.mass - np.outer(p, b.dm) / b.mass**2)
        turned = cross(d_arms[k], p) + cross(r, dp)
        dw = velocities[k][3:] + sign * (
            np.einsum("ijp,j->ip", d_inverse[k], angular) + inverse @ turned
        )
        hit = replace(b, v=v, w=w)
        X = np.concatenate([poses[6 * k : 6 * k + 6], dv, dw])  # at t* + dt; next, at t*
        X -= np.outer(np.concatenate([v, w, b.gravity, hit.spin_rate]), dt)
        out.append(replace(hit, X=X))
    return Strike(
        out, dt, poses[:3] + d_arms[0], before, after, impulse, inputs, poses, velocities
    )  # fmt: skip


def _sides(place: Place, bodies: list[Moving]):
    """Return sign, body and arm of each side."""
    return list(zip((1.0, -1.0), bodies, place.arms))


def _point_velocity(body: Moving, arm) -> np.ndarray:
    return body.v + np.cross(body.w, arm)


def _mobility(body: Moving, arm) -> np.ndarray:
    """Return the change of velocity at the arm by a unit impulse there, 1/m - r x I^-1 r x."""
    A = hat(arm)
    return np.eye(3) / body.mass - A @ body.inverse_inertia @ A


def _d_inverse(body: Moving, turn: np.ndarray) -> np.ndarray:
    """Return the change (3, 3, P) of R J^-1 R^T by the attitude and the moments."""
    inverse, T = body.inverse_inertia, hat(turn)
    C = (body.R / body.inertia) @ np.eye(3)
    change = np.einsum("ijp,jk->ikp", T, inverse)
    change = change + change.transpose(1, 0, 2)  # T I - I T, because T is skew
    return change - np.einsum("ia,abp,jb->ijp", C, body.dJ, C)


def _d_mobility(body: Moving, arm, d_arm, d_inverse) -> np.ndarray:
    """Return the change (3, 3, P) of `_mobility`."""
    A, dA, inverse = hat(arm), hat(d_arm), body.inverse_inertia
    change = np.einsum("ijp,jk->ikp", dA, inverse @ A)
    change = change + change.transpose(1, 0, 2)  # A I dA is the transpose of dA I A
    change = change + np.einsum("ij,jkp,kl->ilp", A, d_inverse, A)
    return -change - np.eye(3)[:, :, None] * (body.dm / body.mass**2)
