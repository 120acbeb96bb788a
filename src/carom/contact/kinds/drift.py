"""The rate of the rows of a point of two solids, (d/dt G) v, in closed form.

The cores touch in c_A and c_B, with c_A - c_B = d n and d = gap + r_A + r_B; the surfaces in p_A = c_A - r_A n
and p_B = c_B + r_B n. While the velocities of the bodies are constant, the velocity at the point,
u = v_A + w_A x (p_A - x_A) - v_B - w_B x (p_B - x_B), has the rate

    u' = w_A x (p_A' - v_A) - w_B x (p_B' - v_B),

so the rows have the rates n.u' + n'.u and t.u' (t is constant). The motion of n and of the points follows from
the parts of the cores on which the points lie (`carom.collision.features`).

*The normal is that of a face:* n' = w_B x n for a face of B, n' = w_A x n for one of A.

*No face owns the normal:* with v_cA, v_cB the velocities of the material points of the cores, H the change of
the farthest point of a core with the normal (`support.change_of_support`), e tau a motion along an edge,

    c_A' = v_cA - H_A (n' - w_A x n) + e_A tau_A,    c_B' = v_cB + H_B (n' - w_B x n) + e_B tau_B.

The tangential part of c_A' - c_B' = d' n + d n' is

    (d + H_A + H_B) n' = v_cA - v_cB + H_A (w_A x n) + H_B (w_B x n) + e_A tau_A - e_B tau_B,

and n stays perpendicular to each edge: n'.e = -n.(w x e). Two edges determine n'. One edge determines one of
its components, and the equation across the edge the other. Without edges there are two equations.

One of the two points, the leading one, is then known. The other follows from c_A' - c_B' = d' n + d n', where
d' is such that it stays on its face, and tau such that it stays on its edge. A sharp vertex that touches a
sharp edge or vertex has no definite n': the normal then moves with the solid of the edge, or with B.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import inlined, kernel
from carom.collision.faces import LOWEST, along_edge, normal_of_face
from carom.collision.features import EDGE, FACE, FIXED, NOBODY, OF_A, OF_B, first_of, second_of
from carom.collision.layout import CYLINDER, ELLIPSOID, Hulls
from carom.collision.support import change_of_support
from carom.collision.thresholds import LEAST_SINE
from carom.contact.kinds.partner import pose_of
from carom.geometry.rotation import rotate, rotate_back
from carom.geometry.thresholds import RESOLUTION
from carom.geometry.vectors import cross, dot, plus
from carom.kinematics.contact_point import field_along


class Core(NamedTuple):
    """The core of a solid at a point of contact, in the world."""

    solid: np.record  # SOLID
    hulls: Hulls
    q: tuple  # its attitude
    part: int  # on which the point lies
    side: float  # 1 for A, -1 for B: its outward normal is -side n
    v: tuple  # velocity of its material point
    w: tuple  # angular velocity


@inlined
def _vector(a):
    return a[0], a[1], a[2]


@inlined
def _kind(core):
    return core.part >> 30


@inlined
def _in_world(core, a):
    """Return a vector of the world, given in axes of the solid."""
    q = core.q
    return rotate(q, a)


@inlined
def own_axes(core, a):
    """Return a vector in axes of the solid, given in the world."""
    q = core.q
    return rotate_back(q, a)


@kernel
def bend_of(core, n, v):
    """Return H v, in the world."""
    kind, zero = core.solid.kind, (0.0, 0.0, 0.0)
    if kind != CYLINDER and kind != ELLIPSOID:
        return zero
    if _kind(core) == FACE or _kind(core) == FIXED:
        return zero
    if _kind(core) == EDGE and first_of(core.part) < LOWEST:  # between fixed points of a rim
        return zero
    return _in_world(core, change_of_support(core.solid, own_axes(core, n), own_axes(core, v)))


@kernel
def edge_of(core):
    """Return the direction of the edge of a core, in the world."""
    e = along_edge(core.solid, core.hulls, first_of(core.part), second_of(core.part))
    return _in_world(core, e)


@kernel
def _across(n):
    """Return a unit vector perpendicular to n."""
    e = (0.0, -n[2], n[1]) if abs(n[0]) < 0.6 else (n[2], 0.0, -n[0])
    f = 1.0 / math.sqrt(dot(e, e))
    return f * e[0], f * e[1], f * e[2]


@kernel
def _two_edges(a, b, n):
    """Return n' of two edges, and whether they are not parallel."""
    e, f = edge_of(a), edge_of(b)
    s = cross(n, e)
    along, other, sine = -dot(n, cross(a.w, e)), -dot(n, cross(b.w, f)), dot(s, f)
    if not abs(sine) > LEAST_SINE:
        return n, False
    across = (other - along * dot(e, f)) / sine
    return plus((across * s[0], across * s[1], across * s[2]), along, e), True


@kernel
def _bends(a, b, n, d, v):
    """Return (d + H_A + H_B) v."""
    x = plus(bend_of(a, n, v), 1.0, bend_of(b, n, v))
    return plus(x, d, v)


@inlined
def _least_and_most(e, s, first, other, stiff):
    """Return the principal directions of the matrix (first, other; other, stiff) in e, s; the greater last."""
    angle = 0.5 * math.atan2(2.0 * other, first - stiff)
    c, sine = math.cos(angle), math.sin(angle)
    most = plus((c * e[0], c * e[1], c * e[2]), sine, s)
    return plus((c * s[0], c * s[1], c * s[2]), -sine, e), most


@kernel
def _rate_of_normal(a, b, n, d, owner):
    """Return n'."""
    if owner != NOBODY:
        return cross(b.w if owner == OF_B else a.w, n)
    edges = int(_kind(a) == EDGE) + int(_kind(b) == EDGE)  # NumPy adds bools to a bool
    if edges == 2:
        rate, done = _two_edges(a, b, n)
        if done:
            return rate
    sharp = RESOLUTION * min(a.solid.extent, b.solid.extent)
    turn_a, turn_b = cross(a.w, n), cross(b.w, n)
    rate = plus(plus(a.v, -1.0, b.v), 1.0, bend_of(a, n, turn_a))
    rate = plus(rate, 1.0, bend_of(b, n, turn_b))
    if edges > 0:
        on_a = _kind(a) == EDGE
        e, turn = (edge_of(a), turn_a) if on_a else (edge_of(b), turn_b)
    else:
        e, turn = _across(n), turn_b
    s = cross(n, e)
    bent = _bends(a, b, n, d, s)
    along, other, stiff = dot(e, turn), dot(e, bent), dot(s, bent)
    if edges == 0:
        first = dot(e, _bends(a, b, n, d, e))
        determinant = first * stiff - other * other
        if determinant > sharp * max(first, stiff) and first > 0.0:
            along = (dot(e, rate) * stiff - dot(s, rate) * other) / determinant
        else:  # rims bend along themselves only: n turns with B across their tangent s
            e, s = _least_and_most(e, s, first, other, stiff)
            along, other, stiff = dot(e, turn), 0.0, first + stiff
    across = (dot(s, rate) - along * other) / stiff if stiff > sharp else dot(s, turn)
    return plus((along * e[0], along * e[1], along * e[2]), across, s)


@kernel
def _along_support(core, n, rate):
    """Return the velocity of the farthest point along the normal: v_c -+ H (n' - w x n)."""
    turn = plus(rate, -1.0, cross(core.w, n))
    return plus(core.v, -core.side, bend_of(core, n, turn))


@kernel
def _leads(a, b, owner):
    """Return whether the point of A is the leading one."""
    if owner == OF_B:
        return _kind(a) != FACE
    if owner == OF_A:
        return _kind(b) == FACE
    return _kind(a) < EDGE or _kind(b) >= EDGE


@kernel
def _follow(lead, other, n, d, rate, owner):
    """Return the velocities of the leading point and of the other one."""
    k = lead.side
    p, step = _along_support(lead, n, rate), (k * d * rate[0], k * d * rate[1], k * d * rate[2])
    if _kind(lead) == EDGE and _kind(other) == EDGE:
        e, s = edge_of(lead), cross(n, edge_of(other))
        miss = plus(plus(p, -1.0, step), -1.0, _along_support(other, n, rate))
        sine = dot(s, e)
        if abs(sine) > LEAST_SINE:
            p = plus(p, -dot(s, miss) / sine, e)
    m = n
    if _kind(other) == FACE and owner != (OF_B if k > 0.0 else OF_A):  # a face, perhaps tilted
        m = _in_world(other, normal_of_face(other.solid, other.hulls, first_of(other.part)))
    miss = plus(plus(p, -1.0, step), -1.0, other.v)
    q = plus(plus(p, -1.0, step), -dot(m, miss) / dot(m, n), n)
    return p, q


@kernel
def cores_at(system, contact, other_solid, point, state):
    """Return the two cores at a point of two solids."""
    one, two = system.solids[contact.solid], system.solids[other_solid]
    q_a, q_b = pose_of(one, contact.body, state)[1], pose_of(two, contact.other, state)[1]
    (va, wa), (vb, wb) = motions_of(contact, state)
    n = _vector(point.axes[0])
    ua = plus(va, 1.0, cross(wa, plus(point.arm_a, one.radius, n)))
    ub = plus(vb, 1.0, cross(wb, plus(point.arm_b, -two.radius, n)))
    a = Core(one, system.hulls, q_a, point.parts[0], 1.0, ua, wa)
    return a, Core(two, system.hulls, q_b, point.parts[1], -1.0, ub, wb)


@kernel
def motions_of(contact, state):
    """Return velocity and angular velocity of both bodies; a static one has none."""
    body = state[contact.body]
    va, wa, vb, wb = _vector(body.v), _vector(body.w), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if contact.other >= 0:
        body = state[contact.other]
        vb, wb = _vector(body.v), _vector(body.w)
    return (va, wa), (vb, wb)


@kernel
def rates_of_rows(contact, point, state, pa, pb, rate):
    """Return n.u' + n'.u, t.u' for the velocities of both points and the rate of the normal."""
    (va, wa), (vb, wb) = motions_of(contact, state)
    n = point.axes[0]
    du = plus(cross(wa, plus(pa, -1.0, va)), -1.0, cross(wb, plus(pb, -1.0, vb)))
    ua, ub = plus(va, 1.0, cross(wa, point.arm_a)), plus(vb, 1.0, cross(wb, point.arm_b))
    u, E = plus(ua, -1.0, ub), point.axes
    t1, t2 = dot(E[1], du), dot(E[2], du)
    if point.moves == 1:  # the place moves with p_A', `contact_acceleration` has v_A
        s = field_along(point, plus(pa, -1.0, va))
        t1, t2 = t1 - s[1], t2 - s[2]
    return dot(n, du) + dot(rate, u), t1, t2


@kernel
def drift_of_solids(system, contact, other_solid, point, state):
    """Return (d/dt G) v, in contact axes, of a point of two solids that `pair_point.write_touch` wrote."""
    a, b = cores_at(system, contact, other_solid, point, state)
    n, ra, rb = _vector(point.axes[0]), a.solid.radius, b.solid.radius
    d, owner = point.gap + ra + rb, point.owner
    rate = _rate_of_normal(a, b, n, d, owner)
    if _leads(a, b, owner):
        pa, pb = _follow(a, b, n, d, rate, owner)
    else:
        pb, pa = _follow(b, a, n, d, rate, owner)
    pa, pb = plus(pa, -ra, rate), plus(pb, rb, rate)
    return rates_of_rows(contact, point, state, pa, pb, rate)
