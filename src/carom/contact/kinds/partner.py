"""Both partners of a contact: a body, and another body, a static body, or a half-space."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.continuous_detection import reach
from carom.contact.gap import round_off
from carom.geometry.rotation import multiply, rotate
from carom.geometry.thresholds import LAST_DIGIT
from carom.geometry.vectors import dot, minus
from carom.kinematics.flight import relative_bound
from carom.kinematics.wrench import point_velocity
from carom.model.thresholds import MOST_DEFLECTION
from carom.model.workspace import RESTS


@kernel
def on_half_space(contact):
    """Return whether a body touches a half-space."""
    return contact.other < 0 and contact.static == 0


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
    radii = p.extent + q.extent
    if contact.bends == 1:
        radii += MOST_DEFLECTION * (contact.extent + contact.other_extent)
    return centre_of_piece(contact.body, p, state), y, radii


@kernel
def smaller(contact):
    """Return the size of the smaller of two bodies, or that of the one."""
    if on_half_space(contact):
        return contact.extent
    return min(contact.extent, contact.other_extent)


@kernel
def round_off_of_both(contact, state):
    """Return the round-off of a gap that the coordinates of both bodies cause [m]."""
    tiny = round_off(contact, state)
    if on_half_space(contact):
        return tiny
    x = centre_of_other(contact, state)
    return max(tiny, LAST_DIGIT * (abs(x[0]) + abs(x[1]) + abs(x[2]) + contact.other_extent))


@kernel
def closed_within(controls, contact, state):
    """Return the gap up to which a point counts as closed [m]."""
    near = max(controls.tie, controls.gap) * smaller(contact)
    return max(near, 4.0 * round_off_of_both(contact, state))


@kernel
def balls_clear(system, data, contact, a, pieces):
    """Return whether the balls around both bodies, or two `pieces` of them, stay apart in the trial step."""
    time = 0.0
    for side in range(2):
        state, sign = (data.state, 1.0) if side == 0 else (data.work.trial, -1.0)
        x, y, radii = balls(system, contact, state, pieces)
        s, u = minus(x, y), (x[3] - y[3], x[4] - y[4], x[5] - y[5])
        d = math.sqrt(dot(s, s))
        if not d > radii:
            return False
        time += reach(d - radii, sign * dot(s, u) / d, a)
    return time >= data.work.search[0].dt


@kernel
def solids_stay_far(system, data, contact):
    """Return the bounds of `relative_bound`, and whether balls around two solids stay apart in a step."""
    work, a, b = data.work, contact.body, contact.other
    if work.body[a].status == RESTS and (b < 0 or work.body[b].status == RESTS):
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), True
    bounds = relative_bound(system, contact, data.state, work)
    clear = balls_clear(system, data, contact, bounds[0], False)
    if contact.part == 1 and not clear:
        clear = balls_clear(system, data, contact, bounds[1], True)
    return bounds, clear


@kernel
def has_one_normal(contact):
    """Return whether all points of a contact have one normal: that of a half-space."""
    return on_half_space(contact)
