"""Bounds of the time during which a solid stays off a surface that is not convex.

No plane separates the two, so the bound is that of a half-space with a bend: for a point of the core with a gap
z and its rate z', z(t) >= z + z' t - a t^2/2. There a = |acceleration| + K |v|^2; K bounds the curvatures
of the surfaces phi = const that the point may reach: k at the point, k/(1 - 2 k s) within the way s of a step.
Within it a gap decreases by s at most, so points with larger gaps need no bound. An ellipsoid of radii of
curvature up to R is bounded by its nearest point: its relative curvature is K/(1 - R K), and its support
changes with its spin w by R w^2.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.collision.frame import enter, from_a, point_of_a, to_a, to_world
from carom.collision.implicit import (
    clearance,
    curvature_at,
    field_at,
    foot_of,
    may_be_nearer,
    plane_at,
    planes,
)
from carom.collision.layout import ELLIPSOID, Pair
from carom.collision.on_surface import corner, corners, lowest_of_ellipsoid, support_of_ellipsoid
from carom.collision.support import change_of_support
from carom.contact.kinds.found_points import placed
from carom.contact.kinds.partner import centre_of_piece, pose_of
from carom.contact.thresholds import CAUTION
from carom.geometry.rotation import norm, rotate_back
from carom.geometry.vectors import cross, dot, minus, plus


@unit
def room(system, contact, state, pieces) -> float:
    """Return a lower bound of the gap of a body, or of the piece of it that touches, over a surface."""
    solid = system.solids[contact.other_solid]
    x, q = pose_of(solid, contact.other, state)
    c, size = state[contact.body].x, contact.extent
    p = (c[0], c[1], c[2])
    if pieces:
        own = system.solids[contact.solid]
        y = centre_of_piece(contact.body, own, state)
        p, size = (y[0], y[1], y[2]), own.extent
    surface = system.hulls.surfaces[solid.surface]
    return clearance(surface, system.hulls, rotate_back(q, minus(p, x))) - size


@inlined
def _time(gap, rate, a):
    """Return the time during which gap + rate t - a t^2/2 is positive; 0 if a is not finite."""
    if not a < math.inf:
        return 0.0
    gap = max(gap, 0.0)
    if a <= 0.0:
        return math.inf if rate >= 0.0 else -gap / rate
    return (rate + math.sqrt(rate * rate + 2.0 * a * gap)) / a


@kernel
def _bent(k, travel, radius):
    """Return the bound K of curvatures within a way, for a body of radii of curvature up to `radius`."""
    free = 1.0 - k * (2.0 * travel + radius)
    return k / free if free > 0.0 else math.inf


@kernel
def _greatest_radius(solid):
    """Return the greatest radius of curvature of an ellipsoid; 0 for a core of points."""
    if solid.kind != ELLIPSOID:
        return 0.0
    h = solid.half
    high, low = max(h[0], h[1], h[2]), min(h[0], h[1], h[2])
    return high * high / low


@kernel
def _near_curve(system, contact, state, i, travel, work):
    """Return point i of a core, its distance from the curved part, and the normal, in axes of the surface.

    The distance is inf if it is more than `way` beyond the ball around the point.
    """
    solid, other = system.solids[contact.solid], system.solids[contact.other_solid]
    surface, hulls, s = system.hulls.surfaces[other.surface], system.hulls, work.pair.state[0]
    if solid.kind == ELLIPSOID:
        return lowest_of_ellipsoid(
            Pair(solid, other, hulls, s, work.pair.found, work.pair.poses, work.pair.known), surface
        )
    u = corner(solid, hulls, i)
    p = point_of_a(s, u[0], u[1], u[2])
    if field_at(surface, hulls, p)[0] > surface["size"][3] * (travel + contact.radius):
        return p, math.inf, (0.0, 0.0, 1.0)
    d, n = foot_of(surface, hulls, p)
    return p, d, n


@kernel
def _velocity(contact, state, s, p):
    """Return the velocity of the point p of a body in the world; p is in axes of the surface, which rests."""
    body, o = state[contact.body], s.origin
    u = to_world(s, p[0], p[1], p[2])
    arm = (u[0] + o[0] - body.x[0], u[1] + o[1] - body.x[1], u[2] + o[2] - body.x[2])
    return plus(body.v, 1.0, cross(body.w, arm))


@kernel
def _rate(contact, state, s, p, n):
    """Return the rate of the distance of such a point."""
    return dot(to_world(s, n[0], n[1], n[2]), _velocity(contact, state, s, p))


@kernel
def _speed_along(contact, state, solid, s, p, n):
    """Return the speed |v + H (w x n)| with which a nearest point passes over a surface at rest."""
    v = _velocity(contact, state, s, p)
    if solid.kind == ELLIPSOID:
        m = to_world(s, n[0], n[1], n[2])
        t = to_own(s, cross(state[contact.body].w, m))
        u = change_of_support(solid, to_a(s, -n[0], -n[1], -n[2]), to_a(s, t[0], t[1], t[2]))
        u = from_a(s, u[0], u[1], u[2])
        v = plus(v, 1.0, to_world(s, u[0], u[1], u[2]))
    return math.sqrt(dot(v, v))


@kernel
def to_own(s, v):
    """Return a vector of the world in axes of the surface."""
    W = s.world
    return (
        W[0, 0] * v[0] + W[1, 0] * v[1] + W[2, 0] * v[2],
        W[0, 1] * v[0] + W[1, 1] * v[1] + W[2, 1] * v[2],
        W[0, 2] * v[0] + W[1, 2] * v[1] + W[2, 2] * v[2],
    )


@unit
def time_over_surface(system, contact, state, bounds, h, work) -> tuple[float, float]:
    """Return how long, up to |h|, a solid stays off a surface, and the greatest a; h < 0: in the past.

    `bounds` are those of `relative_bound`. The surface rests.
    """
    solid, other = system.solids[contact.solid], system.solids[contact.other_solid]
    surface, hulls, s = system.hulls.surfaces[other.surface], system.hulls, work.pair.state[0]
    body, r = state[contact.body], contact.radius
    a, b = placed(system, contact, contact.other_solid, state, work)
    enter(s, a, b)
    spin, bend = norm(body.w), _greatest_radius(solid)
    speed = norm(body.v) + contact.extent * spin + bounds[1] * abs(h)
    turning = bounds[1] + bend * spin * spin
    travel, time, most, sign = speed * abs(h), abs(h), turning, math.copysign(1.0, h)
    for i in range(corners(solid)):
        p, d, n = _near_curve(system, contact, state, i, travel, work)
        if may_be_nearer(surface, d):
            time = min(time, CAUTION * (d - r) / speed if d > r and speed > 0.0 else 0.0)
        elif not d - r > travel:
            k = _bent(curvature_at(surface, hulls, p, d, n), travel, bend)
            a = turning + k * (_speed_along(contact, state, solid, s, p, n) + turning * abs(h)) ** 2
            time = min(time, _time(d - r, sign * _rate(contact, state, s, p, n), a))
            most = max(most, a)
        for j in range(planes(surface)):
            _, n = plane_at(surface, j, p)
            if solid.kind == ELLIPSOID:
                u = support_of_ellipsoid(solid, to_a(s, -n[0], -n[1], -n[2]))
                p = point_of_a(s, u[0], u[1], u[2])
            d, n = plane_at(surface, j, p)
            time = min(time, _time(d - r, sign * _rate(contact, state, s, p, n), turning))
    return time, most
