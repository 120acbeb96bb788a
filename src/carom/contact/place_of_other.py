"""Both partners of a contact: a body, and another body, a static body, or a half-space."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.layout import CURVED_GROUND
from carom.geometry.rotation import multiply, rotate
from carom.kinematics.wrench import point_velocity


@kernel
def on_half_space(contact):
    """Return whether a body touches a half-space."""
    return contact.other < 0 and contact.static == 0


@kernel
def on_curved_ground(system, contact):
    """Return whether the other side is a surface that is not convex."""
    if on_half_space(contact):
        return False
    return system.solids[contact.other_solid].kind == CURVED_GROUND


@kernel
def pose_of(solid, b, state):
    """Return the world position and attitude of a solid; those of a static one, b < 0, are in the table."""
    p, o = solid.x, solid.Q
    if b < 0:
        return (p[0], p[1], p[2]), (o[0], o[1], o[2], o[3])
    x, q = state[b].x, state[b].Q
    r = rotate(q, p)
    turned = multiply(q, o)
    return (x[0] + r[0], x[1] + r[1], x[2] + r[2]), turned


@kernel
def centre_of_other(contact, state):
    """Return position and velocity of the mass centre of the other body, moving or static."""
    if contact.static == 1:
        c = contact.centre
        return c[0], c[1], c[2], 0.0, 0.0, 0.0
    x, v = state[contact.other].x, state[contact.other].v
    return x[0], x[1], x[2], v[0], v[1], v[2]


@kernel
def centre_of_piece(b, solid, state):
    """Return position and velocity of the centre of a piece of a body."""
    x, q, p = state[b].x, state[b].Q, solid.x
    r0, r1, r2 = rotate(q, p)
    v0, v1, v2 = point_velocity(state, b, r0, r1, r2)
    return x[0] + r0, x[1] + r1, x[2] + r2, v0, v1, v2


@kernel
def balls(system, contact, state, pieces):
    """Return the balls around both bodies, or two `pieces`: centres, with velocities, and sum of radii."""
    p, q = system.solids[contact.solid], system.solids[contact.other_solid]
    if not pieces:
        x, v, other = state[contact.body].x, state[contact.body].v, centre_of_other(contact, state)
        radii = contact.extent + contact.other_extent
        return (x[0], x[1], x[2], v[0], v[1], v[2]), other, radii
    y = (q.x[0], q.x[1], q.x[2], 0.0, 0.0, 0.0)
    if contact.static == 0:
        y = centre_of_piece(contact.other, q, state)
    return centre_of_piece(contact.body, p, state), y, p.extent + q.extent
