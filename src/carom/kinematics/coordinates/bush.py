"""Distance of the centre of a pin from the axis of its bush, which clearance limits: q = |d - (a . d) a|.

The axis a is fixed in the parent; d goes from a point of it to the centre of the pin, a point of the child.
With n the direction of d across the axis, t = a x n, r the radius of the pin, and u the velocity of its centre
beside that of the parent there,

    q' = n . u,     n' = w_p x n + (t . u / q) t,     contact at the centre + r n.

On the axis n has no direction: there it is any.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.vectors import cross, dot, minus, plus
from carom.kinematics.joints import anchor_gap, axis, child_arm
from carom.model.workspace import MOTION_POINT


@kernel
def frame_of(c, state):
    """Return q, the direction n of the centre from the axis, and the axis a."""
    a, d = axis(state, c.parent, c.parent_frame, 0), anchor_gap(c, state)
    e = plus(d, -dot(a, d), a)
    q = math.sqrt(dot(e, e))
    if q > 0.0:
        return q, (e[0] / q, e[1] / q, e[2] / q), a
    return q, axis(state, c.parent, c.parent_frame, 1), a


@kernel
def motion_of(b, state):
    """Return place, velocity and angular velocity of a body, or of the ground."""
    if b < 0:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    s = state[b]
    x, v, w = (s.x[0], s.x[1], s.x[2]), (s.v[0], s.v[1], s.v[2]), (s.w[0], s.w[1], s.w[2])
    return x, v, w


@kernel
def speeds(c, state):
    """Return the velocities of the centre and of the parent there, and those of both bodies."""
    (x, v, w), (_, vp, wp) = motion_of(c.child, state), motion_of(c.parent, state)
    r = child_arm(c, state)
    arm = arm_of_parent(c, state, plus(x, 1.0, r))
    return plus(v, 1.0, cross(w, r)), plus(vp, 1.0, cross(wp, arm)), (v, w, vp, wp)


@kernel
def arm_of_parent(c, state, place):
    """Return the arm from the parent to a place in the world."""
    return minus(place, motion_of(c.parent, state)[0])


@kernel
def slides(c):
    """Return True."""
    return True


@kernel
def value(system, c, state):
    """Return the distance [m]."""
    return frame_of(c, state)[0]


@kernel
def along(system, c, state):
    """Return the direction from the axis to the centre."""
    return frame_of(c, state)[1]


@kernel
def rate(system, c, state):
    """Return q'."""
    there, parent, _ = speeds(c, state)
    return dot(frame_of(c, state)[1], minus(there, parent))


@kernel
def drift(system, c, state, out):
    """Return q'' for bodies without acceleration."""
    return -face_drift(system, c, state)[0]


@kernel
def counts_turns(c):
    """Return False."""
    return False


@kernel
def turn_within(system, c, start, end, h):
    """Return 0: a distance has no turns."""
    return 0.0


@kernel
def turns_with_place(c):
    """Return True."""
    return True


@kernel
def has_face(system, c):
    """Return True: pin and bush touch at a point, with friction."""
    return True


@kernel
def place_face(system, contact, c, state, point):
    """Write the contact point: its normal into the bush, one tangent round the axis and one along it."""
    q, n, a = frame_of(c, state)
    t, r = cross(a, n), plus(child_arm(c, state), c.length, n)
    s = arm_of_parent(c, state, plus(motion_of(c.child, state)[0], 1.0, r))
    point.a, point.b, point.gap = contact.body, contact.other, contact.side * q - contact.offset
    point.motion, point.length, point.moves = MOTION_POINT, 1.0, 0
    for k in range(3):
        point.core[k], point.arm_a[k], point.arm_b[k] = 0.0, r[k], s[k]
        point.axes[0, k], point.axes[1, k], point.axes[2, k] = -n[k], -t[k], a[k]


@kernel
def face_drift(system, c, state):
    """Return (d/dt G) v of the contact point, with its three axes.

    With x' the velocity of the contact point, a row is axis . (v_c(x) - v_p(x)), so its rate without
    accelerations is axis' . (v_c(x) - v_p(x)) + axis . (w_c x (x' - v_c) - w_p x (x' - v_p)).
    """
    (q, n, a), (there, parent, of_bodies) = frame_of(c, state), speeds(c, state)
    if not q > 0.0:
        return 0.0, 0.0, 0.0
    v, w, vp, wp = of_bodies
    t, u, r = cross(a, n), minus(there, parent), c.length
    turn = dot(t, u) / q
    n_rate, t_rate = plus(cross(wp, n), turn, t), plus(cross(wp, t), -turn, n)
    slip = plus(u, r, cross(minus(w, wp), n))
    moved = plus(there, r, n_rate)
    bend = minus(cross(w, minus(moved, v)), cross(wp, minus(moved, vp)))
    along_n = -dot(n_rate, slip) - dot(n, bend)
    along_t = -dot(t_rate, slip) - dot(t, bend)
    return along_n, along_t, dot(cross(wp, a), slip) + dot(a, bend)
