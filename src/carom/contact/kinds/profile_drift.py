"""The rate of the rows of a point of a profile and another solid, or a half-space, (d/dt G) v, in closed form.

P is the profile, O the other side, m the normal out of P, t the tangent of its curve at the foot c, and
kappa the curvature there, positive where it is convex. In the axes of P the foot moves along its curve, and
the normal with it, c' = t s', m' = kappa t s'.

*The normal is that of a face of O:* m' = w_O x m in the world, so that s' = t . (m' - w_P x m)/kappa.

*A point q of O is at the distance d:* q = c + d m, and v is its velocity in the axes of P, so that

    s' = t . v/(1 + kappa d),   m' = w_P x m + kappa t s',

which is safe where kappa = 0. At a corner c rests: m' - w_P x m = (v - m m . v)/d. On the rim of a flat side,
q - c = D m is not in the plane of the curve, and m' - w_P x m = (v - t s' - m m . (v - t s'))/D.

The rates of the rows follow from m' and the motion of the two points, as for other solids (`drift`).

*Both are profiles*, A and B, with the normal n of B and tangents t of B and e t of A, e = +-1: the feet move
along their curves, a' = v_A - alpha t, b' = v_B + beta t, and both normals stay opposite ones:

    (w_A - w_B) x n . t = beta kappa_B - alpha kappa_A,   alpha + beta (1 + d kappa_B) = (v_A - v_B - d w_B x n)
    . t

A corner rests, alpha = 0 or beta = 0, and has any normal; two corners have n' along (v_A - v_B)/d.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import kernel
from carom.collision.features import NOBODY, OF_A, OF_B, OF_FIXED
from carom.collision.layout import CYLINDER, PROFILE, Hulls
from carom.collision.profile_curve import curve_at, place_of_part
from carom.contact.kinds.drift import motions_of, rates_of_rows
from carom.contact.kinds.partner import pose_of
from carom.geometry.rotation import rotate, rotate_back
from carom.geometry.thresholds import RESOLUTION, SMALLEST
from carom.geometry.vectors import cross, dot, minus, plus


class Foot(NamedTuple):
    """A point of a profile, in the world."""

    solid: np.record  # SOLID
    hulls: Hulls
    q: tuple  # attitude of the solid
    c: tuple  # the point, in axes of the solid
    part: int
    v: tuple  # velocity of the material point
    w: tuple  # angular velocity
    m: tuple  # normal out of the profile


@kernel
def _tangent(foot):
    """Return the tangent (world) and the curvature of the curve at a foot."""
    k, t = place_of_part(foot.solid, foot.hulls, foot.part)
    row, c, q = foot.hulls.outlines[k], foot.c, foot.q
    for _ in range(2):  # a part has a billionth of the length; the error is squared
        x, y, dx, dy, _, _ = curve_at(row, t)
        t += (c[0] - x) * dx + (c[1] - y) * dy
    _, _, dx, dy, ex, ey = curve_at(row, t)
    return rotate(q, (dx, dy, 0.0)), dx * ey - dy * ex


@kernel
def _beside_face(foot, rate):
    """Return the velocity of a foot under a face whose normal has the given rate."""
    if foot.part >= OF_FIXED:  # a corner
        return foot.v
    t, bend = _tangent(foot)
    if not bend * foot.solid.extent > RESOLUTION:
        return foot.v
    return plus(foot.v, dot(t, minus(rate, cross(foot.w, foot.m))) / bend, t)


@kernel
def _below_point(foot, d, v):
    """Return m' and the velocity of the foot of a point at the distance d with the velocity v."""
    q, m, turn = foot.q, foot.m, cross(foot.w, foot.m)
    v = minus(minus(v, foot.v), (d * turn[0], d * turn[1], d * turn[2]))  # in axes of the profile
    own, step, moves = rotate_back(q, m), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if foot.part < OF_FIXED:
        t, bend = _tangent(foot)
        pace = dot(t, v) / (1.0 + bend * d * math.sqrt(own[0] * own[0] + own[1] * own[1]))
        moves = (pace * t[0], pace * t[1], pace * t[2])
        step = (bend * moves[0], bend * moves[1], bend * moves[2])
    on_rim = abs(own[2]) > RESOLUTION
    if on_rim or foot.part >= OF_FIXED:
        v = minus(v, moves)
        v = plus(v, -dot(m, v), m)
        if not on_rim:  # the corner is a line along the axis
            z = rotate(q, (0.0, 0.0, 1.0))
            v = plus(v, -dot(z, v), z)
        f = 1.0 / d if d > SMALLEST else 0.0
        step = (f * v[0], f * v[1], f * v[2])
    return plus(turn, 1.0, step), plus(foot.v, 1.0, moves)


@kernel
def _between_corners(n, d, u):
    """Return the rate of the normal of two corners at the distance d, which move past each other with u."""
    f = 1.0 / d if d > SMALLEST else 0.0
    return plus((f * u[0], f * u[1], f * u[2]), -f * dot(n, u), n)


@kernel
def _two_feet(a, b, d):
    """Return the rate of the normal of B, and the velocities of both feet."""
    n, u = b.m, minus(a.v, b.v)
    if a.part >= OF_FIXED and b.part >= OF_FIXED:
        return _between_corners(n, d, u), a.v, b.v
    t, bend_a, bend_b = n, 0.0, 0.0
    if a.part < OF_FIXED:
        t, bend_a = _tangent(a)
    if b.part < OF_FIXED:
        t, bend_b = _tangent(b)
    turn_a, turn_b = dot(cross(a.w, n), t), dot(cross(b.w, n), t)
    past = dot(u, t)
    if a.part >= OF_FIXED:
        alpha, beta = 0.0, (past - d * turn_b) / (1.0 + d * bend_b)
        rate = plus(cross(b.w, n), beta * bend_b, t)
    elif b.part >= OF_FIXED:
        alpha, beta = (past - d * turn_a) / (1.0 + d * bend_a), 0.0
        rate = plus(cross(a.w, n), alpha * bend_a, t)
    else:
        det = bend_a + bend_b + d * bend_a * bend_b
        f, past = 1.0 / det if det != 0.0 else 0.0, past - d * turn_b
        turn = turn_b - turn_a
        alpha = f * (turn * (1.0 + d * bend_b) + bend_b * past)
        beta = f * (bend_a * past - turn)
        rate = plus(cross(b.w, n), beta * bend_b, t)
    return rate, plus(a.v, -alpha, t), plus(b.v, beta, t)


@kernel
def drift_of_two_profiles(system, contact, other_solid, point, state):
    """Return (d/dt G) v, in contact axes, of a point of two profiles."""
    one, two = system.solids[contact.solid], system.solids[other_solid]
    (va, wa), (vb, wb) = motions_of(contact, state)
    n, ra, rb = point.axes[0], point.arm_a, point.arm_b
    n = (n[0], n[1], n[2])
    ua, ub = plus(va, 1.0, cross(wa, ra)), plus(vb, 1.0, cross(wb, rb))
    p, o = state[contact.body].x, (0.0, 0.0, 0.0)
    if contact.other >= 0:
        y = state[contact.other].x
        o = (y[0], y[1], y[2])
    x, q = pose_of(one, contact.body, state)
    c = rotate_back(q, minus((p[0] + ra[0], p[1] + ra[1], p[2] + ra[2]), x))
    a = Foot(one, system.hulls, q, c, point.parts[0], ua, wa, (-n[0], -n[1], -n[2]))
    x, q = pose_of(two, contact.other, state)
    c = rotate_back(q, minus((o[0] + rb[0], o[1] + rb[1], o[2] + rb[2]), x))
    b = Foot(two, system.hulls, q, c, point.parts[1], ub, wb, n)
    rate, pa, pb = _two_feet(a, b, point.gap)
    return rates_of_rows(contact, point, state, pa, pb, rate)


@kernel
def drift_of_profile(system, contact, other_solid, point, state):
    """Return (d/dt G) v, in contact axes, of a point of a profile; `other_solid` < 0: on a half-space."""
    one, n, ra, rb = system.solids[contact.solid], point.axes[0], point.arm_a, point.arm_b
    first = one.kind == PROFILE
    (va, wa), (vb, wb) = motions_of(contact, state)
    ua, ub = plus(va, 1.0, cross(wa, ra)), plus(vb, 1.0, cross(wb, rb))
    # the profile, and the radius of the other side
    sign, r, p = -1.0 if first else 1.0, 0.0, (0.0, 0.0, 0.0)
    own = contact.body if first else contact.other
    m, arm = (sign * n[0], sign * n[1], sign * n[2]), ra if first else rb
    solid = one if first else system.solids[other_solid]
    if not first or other_solid >= 0:
        two = system.solids[other_solid] if first else one
        r = two.half[0] if two.kind == CYLINDER else two.radius
    if own >= 0:
        x = state[own].x
        p = (x[0], x[1], x[2])
    x, q = pose_of(solid, own, state)
    c = rotate_back(q, minus(plus(p, 1.0, arm), x))
    v, w, vo, wo = (ua, wa, ub, wb) if first else (ub, wb, ua, wa)
    foot = Foot(solid, system.hulls, q, c, point.parts[0] if first else point.parts[1], v, w, m)
    # the motion of the normal and of the two points, pp on the profile and po
    owner, gap_rate = point.owner, dot(m, minus(vo, v))
    d = point.gap + r
    core = plus(vo, r, cross(wo, m))
    if other_solid < 0 or owner == (OF_B if first else OF_A):
        rate = cross(wo, m)
        pp = _beside_face(foot, rate)
        po = plus(plus(pp, point.gap, rate), gap_rate, m)
    elif owner == NOBODY:
        rate, pp = _below_point(foot, d, core)
        po = plus(core, -r, rate)
    else:  # a ball on a flat side
        rate = cross(w, m)
        po = plus(core, -r, rate)
        pp = plus(plus(po, -point.gap, rate), -gap_rate, m)
    rate = (sign * rate[0], sign * rate[1], sign * rate[2])
    pa, pb = (pp, po) if first else (po, pp)
    return rates_of_rows(contact, point, state, pa, pb, rate)
