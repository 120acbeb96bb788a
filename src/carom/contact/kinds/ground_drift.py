"""The rate of the rows of a point of a solid on a surface that is not convex, (d/dt G) v, in closed form.

With c the nearest point of the core, q its foot on the surface B, c - q = d n, and S the shape operator at the
foot, the normal turns beside that of the body B by m = n' - w_B x n = S (q' - v_B(q)). The core point moves by
c' = v_c - H (n' - w_A x n) + e tau (`carom.contact.kinds.drift`), the foot by q' = c' - d' n - d n'. So

    (I + S (d + H)) m = S (v_c - v_B(c) - H (w_B - w_A) x n + e tau),

both sides in the tangent plane. A point between the ends of an edge e keeps n.e = 0: m.e = (w_A - w_B) x n . e.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.features import EDGE
from carom.collision.implicit import shape_operator, turn_of_normal
from carom.collision.layout import ELLIPSOID
from carom.contact.kinds.drift import bend_of, cores_at, edge_of, rates_of_rows
from carom.contact.kinds.partner import pose_of
from carom.geometry.rotation import rotate, rotate_back
from carom.geometry.vectors import cross, dot, minus, plus


@kernel
def _shape_at(system, contact, point, state):
    """Return `shape_operator` at the foot of a point, in the world; S is 0 on a plane of the surface."""
    solid = system.solids[contact.other_solid]
    x, q = pose_of(solid, contact.other, state)
    foot = point.arm_b[0], point.arm_b[1], point.arm_b[2]
    if contact.other >= 0:
        foot = plus(foot, 1.0, state[contact.other].x)
    surface = system.hulls.surfaces[solid.surface]
    _, e, f, S = shape_operator(surface, system.hulls, rotate_back(q, minus(foot, x)))
    if point.parts[1] > 0:
        S = (0.0, 0.0, 0.0)
    n = point.axes[0]
    return (n[0], n[1], n[2]), rotate(q, e), rotate(q, f), S


@kernel
def _turn_of_normal(at, a, n, d, v):
    """Return (I + S (d + H))^-1 S v."""
    if a.solid.kind != ELLIPSOID:
        return turn_of_normal(at, d, v)
    _, e, f, S = at
    He, Hf = plus(bend_of(a, n, e), d, e), plus(bend_of(a, n, f), d, f)
    u, w = dot(e, v), dot(f, v)
    u, w = S[0] * u + S[2] * w, S[2] * u + S[1] * w
    i, j, k, m = dot(e, He), dot(f, He), dot(e, Hf), dot(f, Hf)  # columns of d + H
    p, q = 1.0 + S[0] * i + S[2] * j, S[0] * k + S[2] * m
    r, s = S[2] * i + S[1] * j, 1.0 + S[2] * k + S[1] * m
    determinant = p * s - q * r
    x, y = (s * u - q * w) / determinant, (p * w - r * u) / determinant
    return plus((x * e[0], x * e[1], x * e[2]), y, f)


@kernel
def drift_on_surface(system, contact, point, state):
    """Return (d/dt G) v, in contact axes, of a point on a surface that `pair_point.write_touch` wrote."""
    a, b = cores_at(system, contact, contact.other_solid, point, state)
    at = _shape_at(system, contact, point, state)
    n, radius = at[0], a.solid.radius
    d, turn_a, turn_b = point.gap + radius, cross(a.w, n), cross(b.w, n)
    there = plus(b.v, d, turn_b)  # velocity of B at the core point
    v = plus(minus(a.v, there), -1.0, bend_of(a, n, minus(turn_b, turn_a)))
    m, slide = _turn_of_normal(at, a, n, d, v), (0.0, 0.0, 0.0)
    if a.part >> 30 == EDGE:
        e = edge_of(a)
        more = turn_of_normal(at, d, e)
        stiff = dot(e, more)
        if stiff > 0.0:
            tau = (dot(e, minus(turn_a, turn_b)) - dot(e, m)) / stiff
            m, slide = plus(m, tau, more), (tau * e[0], tau * e[1], tau * e[2])
    rate = plus(m, 1.0, turn_b)
    core = plus(plus(a.v, 1.0, slide), -1.0, bend_of(a, n, minus(rate, turn_a)))
    foot = plus(core, -d, rate)
    foot = plus(foot, -dot(n, minus(foot, b.v)), n)
    return rates_of_rows(contact, point, state, plus(core, -radius, rate), foot, rate)
