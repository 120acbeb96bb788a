"""A solid on ground that is not convex: no points belong together in faces, each has an identity of its own.

No plane separates the two (`ground_room`); the normal turns with the curvature of the ground (`ground_drift`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, kernel
from carom._compiled.units import unit
from carom.collision.faces import load_face
from carom.collision.implicit import field_at
from carom.collision.layout import Pair
from carom.collision.on_surface import feature_on_surface
from carom.contact.continuous_detection import reach
from carom.contact.kinds import ground_room
from carom.contact.kinds.found_points import list_on_solid, nearest_touch, placed, touch_rate
from carom.contact.kinds.ground_drift import drift_on_surface
from carom.contact.kinds.level_surfaces import keep_counting
from carom.contact.kinds.partner import smaller
from carom.geometry.rotation import norm
from carom.geometry.vectors import dot, minus, plus
from carom.kinematics.flight import relative_bound
from carom.model.workspace import RESTS

room = ground_room.room
FACE_PARTS = 8  # of the way from the middle of a face to a corner, at which its depth is looked at


@kernel
def stays_far(system, data, contact):
    """Return the bounds of `relative_bound`, and whether the ball around the body stays above."""
    if data.work.body[contact.body].status == RESTS:
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), True
    bounds = relative_bound(system, contact, data.state, data.work)
    clear = stays_above(system, data, contact, bounds[0], False)
    if contact.part == 1 and not clear:
        clear = stays_above(system, data, contact, bounds[1], True)
    return bounds, clear


@kernel
def stays_above(system, data, contact, a, pieces):
    """Return whether the ball around a body, or the `pieces` of it that may touch, stays above in a step."""
    time = 0.0
    for side in range(2):
        state = data.state if side == 0 else data.work.trial
        above = room(system, contact, state, pieces)
        if not above > 0.0:
            return False
        body = state[contact.body]
        time += reach(above, -norm(body.v) - (contact.extent * norm(body.w) if pieces else 0.0), a)
    return time >= data.work.search[0].dt


@kernel
def time_apart(system, contact, state, bounds, h, work):
    """Return how long, up to |h|, a solid stays off the ground, and a bound of how fast a gap may close."""
    nearest = nearest_touch(work)
    gap, rate = nearest.gap, math.copysign(1.0, h) * touch_rate(contact, nearest, state)
    time, most = ground_room.time_over_surface(system, contact, state, bounds, h, work)
    return min(time, reach(gap, rate, most)), most


@kernel
def touch_of_active(system, contact, feature, p, state, work):
    """Write the point that has a feature; return its place, 0."""
    a, b = placed(system, contact, contact.other_solid, state, work)
    feature_on_surface(a, b, system.hulls, feature, work.pair, work.touches)
    return 0


@kernel
def forms_faces(contact):
    """Return False: no two points belong together."""
    return False


@unit
def drift(system, contact, feature, point, state, work) -> tuple[float, float, float]:
    """Return (d/dt G) v of a point on the ground."""
    return drift_on_surface(system, contact, point, state)


@unit
def bulge(system, contact, state, work) -> float:
    """Return how far curved ground bulges into the face turned to it, relative to the body; 0 outside.

    Faces touch it at their vertices and edges only, so that nothing else sees this.
    """
    above = room(system, contact, state, False)
    if contact.part == 1:
        above = max(above, room(system, contact, state, True))
    if above > 0.0:
        return 0.0
    list_on_solid(system, contact, contact.other_solid, state, 0.0, work)
    if keep_counting(system, contact, state, work) == 0:
        return 0.0
    a, b = system.solids[contact.solid], system.solids[contact.other_solid]
    hulls, s, n = system.hulls, work.pair.state[0], work.touches[0].normal
    w, corners = s.world, s.corner[0]
    x = w[0, 0] * n[0] + w[1, 0] * n[1] + w[2, 0] * n[2]
    y = w[0, 1] * n[0] + w[1, 1] * n[1] + w[2, 1] * n[2]
    z = w[0, 2] * n[0] + w[1, 2] * n[1] + w[2, 2] * n[2]
    load_face(
        by_reference(Pair(a, b, hulls, s, work.pair.found, work.pair.poses, work.pair.known)),
        0,
        -x,
        -y,
        -z,
    )
    count, middle, most = s.count[0], (0.0, 0.0, 0.0), 0.0
    if count < 3:
        return 0.0
    for k in range(count):
        middle = plus(middle, 1.0 / count, (corners[k, 0], corners[k, 1], corners[k, 2]))
    for k in range(count):
        to_corner = minus((corners[k, 0], corners[k, 1], corners[k, 2]), middle)
        for j in range(FACE_PARTS):
            p = plus(middle, j / FACE_PARTS, to_corner)
            value, g, _ = field_at(hulls.surfaces[b.surface], hulls, p)
            most = max(most, a.radius - value / math.sqrt(dot(g, g)))
    return most / smaller(contact)
