"""Points that have passed an edge within a step: their normal jumps from that of one face to that of the next.

A normal that a face owns turns with its body. Where it does not, the point has gone from this face to another,
or, of sharp solids, to edges on edges (the tip of a saw tooth at the end of a pawl).
Beyond an edge of a convex piece the next face recedes: to keep the point on it would take a pull.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.features import NOBODY, OF_A
from carom.contact.operations import are_sharp
from carom.contact.thresholds import EDGE_JUMP, NORMAL_ERROR
from carom.geometry.rotation import rotate, rotate_back
from carom.kinematics.contact_point import contact_velocity
from carom.model.workspace import MOTION_POINT


@kernel
def note_normal(point, active_point):
    """Keep the normal of a point at the start of a step."""
    active_point.owner, active_point.passes = point.owner, 0
    for r in range(3):
        active_point.normal[r] = point.axes[0, r]


@kernel
def note_passed(system, active, k, group, start, end):
    """Mark the points of two bodies that have passed an edge, from their places at the end of a step."""
    for i in range(k):
        closed_point, point = group.closed[i], group.points[0][i]
        if closed_point.motion != MOTION_POINT or closed_point.listed == 0:
            continue
        active_point = active.points[closed_point.active]
        contact, least = system.contacts[active_point.contact], NORMAL_ERROR
        jumps = active_point.found == 1 and active_point.owner != NOBODY
        if jumps and point.owner == NOBODY:
            jumps, least = are_sharp(system, contact), EDGE_JUMP
        jumps = jumps and jump_of_normal(active_point, point, start, end) > least
        active_point.passes = 1 if jumps and contact_velocity(system, point, end)[0] > 0.0 else 0


@kernel
def jump_of_normal(active_point, point, start, end):
    """Return the greatest change of a component of a normal that turns with the body whose face owns it."""
    owner = point.owner if point.owner != NOBODY else active_point.owner
    b, n, m = point.a if owner == OF_A else point.b, active_point.normal, point.axes[0]
    x, y, z = n[0], n[1], n[2]
    if b >= 0:
        q, Q = start[b].Q, end[b].Q
        x, y, z = rotate_back(q, (x, y, z))
        x, y, z = rotate(Q, (x, y, z))
    return max(abs(x - m[0]), max(abs(y - m[1]), abs(z - m[2])))


@kernel
def has_passed(active, i, group):
    """Return whether closed point i has passed an edge."""
    closed_point = group.closed[i]
    return closed_point.listed == 1 and active.points[closed_point.active].passes == 1
