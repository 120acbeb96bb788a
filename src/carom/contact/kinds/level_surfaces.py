"""Contacts with level surfaces: which of the points found count, and for which row of contacts.

The row of a surface is that of a half-space whose points count only where faces of the surface are below them.
A row of a static solid has its points on a level surface only at the rim, and only with normals that the whole
surface has there. So each point counts once, an edge between two level faces is nothing, and a body that
passes it moves as on one plane.

A body that moves keeps the points on its level surfaces in the rows of its solids; the others are judged alike.
Rows of two bodies with points on one surface are related: what leaves one solid goes on with the next.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.collision.features import VERTEX_A
from carom.collision.layout import BOX, CYLINDER, ELLIPSOID
from carom.collision.level_surface import (
    carries,
    continues,
    distance_from_rim,
    face_below,
    height,
    nearest_face,
)
from carom.collision.thresholds import MARGIN
from carom.contact.thresholds import BACK_SIDE, DEPTH
from carom.geometry.rotation import rotate_back
from carom.geometry.thresholds import ROUND_OFF
from carom.geometry.vectors import dot, minus


@unit
def keep_real_touches(system, contact, state, work) -> int:
    """Keep the touches that count, note their surfaces, and return their number."""
    pair, kept = work.pair.state[0], 0
    count, pair.hidden = pair.total, 0
    for i in range(count):
        touch = work.touches[i]
        touch.surface = 0
        if contact.surface > 0:
            counts = on_surface(system, contact, touch)
        else:
            hidden = hiding_surface(system, contact, touch) if contact.static == 1 else -1
            hidden = max(hidden, hiding_surface_of_moving(system, contact, touch, state))
            counts = hidden < 0
            pair.hidden = pair.hidden if counts else 1 + hidden
        if counts:
            if kept < i:
                work.touches[kept] = work.touches[i]
            kept += 1
    pair.total = kept
    return kept


@kernel
def on_surface(system, contact, touch):
    """Return whether a point of a half-space is above the faces of the row of a level surface.

    Where this surface meets another one, as a hidden side of a solid meets the top, the other one may hide it.
    """
    levels, own = system.levels, contact.surface - 1
    surface, q = levels.surfaces[own], touch.on_b
    touch.surface = contact.surface
    first, last = contact.first_level, contact.last_level
    rounding = rounding_of(system.solids[contact.solid])
    if not carries(levels, surface, first, last, touch, rounding):
        return False
    face = levels.faces[face_below(levels, first, last, q, MARGIN * surface.tolerance)]
    for k in range(face.first_own, face.last_own):
        s = levels.own[k]
        if s != own and hides(system, contact, s, touch):
            return False
    return True


@kernel
def solid_left(system, contact, q):
    """Return the static solid nearest to a point of the row of a surface that is not above it, else -1."""
    levels, surface = system.levels, system.levels.surfaces[contact.surface - 1]
    room = MARGIN * surface.tolerance
    if face_below(levels, surface.first, surface.last, q, room) >= 0:
        return -1
    return levels.faces[nearest_face(levels, contact.first_level, contact.last_level, q)].solid


@kernel
def solid_beyond(system, contact, point, state):
    """Return the static solid that a contact point of the row of a surface is on, past its rim; -1 if not."""
    if contact.surface == 0:
        return -1
    levels, surface = system.levels, system.levels.surfaces[contact.surface - 1]
    n, e, x, r = point.axes[0], surface.normal, state[contact.body].x, point.arm_a
    q = (x[0] + r[0], x[1] + r[1], x[2] + r[2])
    if n[0] * e[0] + n[1] * e[1] + n[2] * e[2] > 1.0 - ROUND_OFF:
        return solid_left(system, contact, q)
    return levels.faces[nearest_face(levels, contact.first_level, contact.last_level, q)].solid


@kernel
def rounding_of(solid):
    """Return the least radius of curvature of the lowest points of a solid."""
    round_core = solid.kind == CYLINDER or solid.kind == ELLIPSOID
    return solid.radius + (min(solid.half[0], solid.half[1]) if round_core else 0.0)


@kernel
def hiding_surface(system, contact, touch):
    """Return the surface that hides a point of a static solid, -1 for none."""
    for k in range(contact.first_level, contact.last_level):
        s = system.levels.own[k]
        if hides(system, contact, s, touch):
            return s
    return -1


@kernel
def hiding_surface_of_moving(system, contact, touch, state):
    """Return the surface of a moving body that hides a point, -1 for none; note on which one it lies."""
    own, x, Q = system.levels.own, state[contact.body].x, state[contact.body].Q
    n, p = touch.normal, touch.on_a
    q = rotate_back(Q, (p[0] - x[0], p[1] - x[1], p[2] - x[2]))
    m = rotate_back(Q, (-n[0], -n[1], -n[2]))
    for k in range(contact.first_mine, contact.last_mine):
        if hides_within(system, own[k], q, m, touch):
            return own[k]
    if contact.other < 0:
        return -1
    x, Q, p = state[contact.other].x, state[contact.other].Q, touch.on_b
    q = rotate_back(Q, (p[0] - x[0], p[1] - x[1], p[2] - x[2]))
    m = rotate_back(Q, (n[0], n[1], n[2]))
    for k in range(contact.first_level, contact.last_level):
        if hides_within(system, own[k], q, m, touch):
            return own[k]
    return -1


@kernel
def hides_within(system, s, q, m, touch):
    """Return whether surface s of a moving body hides a point q with the normal m out of it, in its axes."""
    levels, surface = system.levels, system.levels.surfaces[s]
    room, along, above = MARGIN * surface.tolerance, dot(surface.normal, m), height(surface, q)
    if above > room or along < BACK_SIDE:
        return False
    if above < -room:
        return buried(system, surface, q, m, above)
    if face_below(levels, surface.first, surface.last, q, room) < 0:
        return False
    if along > 1.0 - ROUND_OFF:
        touch.surface = s + 1
        return False
    return distance_from_rim(levels, surface, q) > 2.0 * room or continues(levels, surface, q, m)


@kernel
def hides(system, contact, s, touch):
    """Return whether surface s hides a point of a static solid, or else note that the point lies on it.

    It does if the row of the surface has the point, or if the whole surface has no such normal there.
    """
    levels, surface, q, m = system.levels, system.levels.surfaces[s], touch.on_b, touch.normal
    room, n = MARGIN * surface.tolerance, surface.normal
    along, above = n[0] * m[0] + n[1] * m[1] + n[2] * m[2], height(surface, q)
    if above > room or along < BACK_SIDE:
        return False
    if above < -room:
        return buried(system, surface, q, m, above)
    below = face_below(levels, surface.first, surface.last, q, room)
    if below < 0:
        return False
    flat = along > 1.0 - ROUND_OFF
    if flat and touch.feature >> 60 in (0, VERTEX_A):
        rounding = rounding_of(system.solids[contact.solid])
        return carries(levels, surface, surface.first, surface.last, touch, rounding)
    if distance_from_rim(levels, surface, q) > 2.0 * room or continues(levels, surface, q, m):
        return True
    if flat and levels.faces[below].solid != contact.other_solid:  # the other solid has it
        return True
    touch.surface = s + 1 if flat else touch.surface
    return False


@kernel
def buried(system, surface, q, m, above):
    """Return whether a normal at a point below a surface points into a solid with a face of the surface.

    The point must be in the upper half of that solid: below it, a side may be bare.
    """
    levels, room = system.levels, MARGIN * surface.tolerance
    p = q[0] + DEPTH * room * m[0], q[1] + DEPTH * room * m[1], q[2] + DEPTH * room * m[2]
    for i in range(surface.first, surface.last):
        face, d = levels.faces[i], minus(q, levels.faces[i].centre)
        near = dot(d, d) <= (face.reach + face.thickness) ** 2 and -above <= 0.5 * face.thickness
        if near and is_inside(system.solids[face.solid], system.hulls, p, room):
            return True
    return False


@kernel
def is_inside(solid, hulls, q, room):
    """Return whether a point in the world is in a static box or hull, or at most `room` outside."""
    x, Q, h = solid.x, solid.Q, solid.half
    px, py, pz = rotate_back(Q, (q[0] - x[0], q[1] - x[1], q[2] - x[2]))
    if solid.kind == BOX:
        return max(abs(px) - h[0], max(abs(py) - h[1], abs(pz) - h[2])) <= room
    for f in range(solid.first_face, solid.last_face):
        n = hulls.faces[f].normal
        p = hulls.vertices[solid.first + hulls.corners[hulls.faces[f].first]]
        if n[0] * (px - p[0]) + n[1] * (py - p[1]) + n[2] * (pz - p[2]) > room:
            return False
    return True


@kernel
def has_level(levels, first, last, s):
    """Return whether surface s is in a range of `Levels.own`."""
    for k in range(first, last):
        if levels.own[k] == s:
            return True
    return False


@kernel
def share_own(levels, a, b):
    """Return whether two ranges of `Levels.own` have a surface in common."""
    for k in range(a[0], a[1]):
        if has_level(levels, b[0], b[1], levels.own[k]):
            return True
    return False


@kernel
def share_surface(system, c, d):
    """Return whether two rows are the same, or of one piece of a body on one level surface of static solids."""
    if c == d:
        return True
    a, b = system.contacts[c], system.contacts[d]
    if a.body != b.body or a.solid != b.solid or max(a.other, b.other) >= 0:
        return False
    levels = system.levels
    if a.surface > 0 and b.surface > 0:
        return a.surface == b.surface
    if a.surface > 0:
        return has_level(levels, b.first_level, b.last_level, a.surface - 1)
    if b.surface > 0:
        return has_level(levels, a.first_level, a.last_level, b.surface - 1)
    return share_own(levels, (a.first_level, a.last_level), (b.first_level, b.last_level))


@kernel
def is_of_moving(contact):
    """Return whether a row is of a solid with a level surface of a body that moves."""
    return contact.first_mine < contact.last_mine or (
        contact.other >= 0 and contact.first_level < contact.last_level
    )


@kernel
def related(system, c, d):
    """Return whether two rows are of the same bodies, and of solids that are the same or share a surface."""
    if share_surface(system, c, d):
        return True
    a, b = system.contacts[c], system.contacts[d]
    if a.body != b.body or a.other != b.other or a.static != b.static:
        return False
    if not (is_of_moving(a) and is_of_moving(b)):
        return False
    levels, same = system.levels, a.other_solid == b.other_solid and a.surface == b.surface
    if not same and not (a.surface == 0 and b.surface == 0):
        return False
    mine = share_own(levels, (a.first_mine, a.last_mine), (b.first_mine, b.last_mine))
    if not (a.solid == b.solid or mine):
        return False
    others = (a.first_level, a.last_level), (b.first_level, b.last_level)
    return same or share_own(levels, others[0], others[1])


@kernel
def rides_on(system, active, c, touch):
    """Return whether a point lies on a level surface of a moving body that carries another row already."""
    if touch.surface == 0 or not is_of_moving(system.contacts[c]):
        return False
    for j in range(active.count[0]):
        d = active.points[j].contact
        if d != c and active.points[j].found == 1 and related(system, c, d):
            return True
    return False


@kernel
def keep_counting(system, contact, state, work):
    """Leave out the found points that a level surface hides; return how many are left."""
    if contact.first_level < contact.last_level or contact.first_mine < contact.last_mine:
        return keep_real_touches(system, contact, state, work)
    return work.pair.state[0].total


@kernel
def is_beside(contact, other):
    """Return whether two rows of one body are parts of one level surface, with a law of friction each."""
    same = contact.surface == other.surface and contact.body == other.body
    return contact.surface > 0 and same


@kernel
def touches_already(system, active, c):
    """Return whether a row has active points, or its body has some on the same level surface."""
    contact = system.contacts[c]
    for j in range(active.count[0]):
        d = active.points[j].contact
        if d == c:
            return True
        if contact.first_level < contact.last_level and share_surface(system, c, d):
            return True
    return False
