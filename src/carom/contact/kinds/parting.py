"""Bound of the time during which two convex cores stay separated by a plane that moves with one of them.

Let the plane move with a body O (or rest: x, v, w of O are then 0), and n be its normal now. With k = n x w_O,
a point p = x + R b of a body goes away from it along n, in the frame of O, at the rate

    n.(v - v_O) - (x - x_O).k + (c - R^T k).b,       m, c: n and n x w in axes of its body.

After a time t its height is at least n.x + m.b plus t times this rate minus a t^2/2, where a bounds its
acceleration in the frame of O. The least value over a core is a support function, h(d) = max d.b, so that the
gap is at least

    F(t) = n.(x_a - x_b) + t (rate_a - rate_b) - h_A(-(m_a + t c_a)) - h_B(m_b + t c_b) - radii - a t^2/2.

F is concave, because it is a minimum of concave functions. So chords lie below it, and the root of a chord from
a point above zero to one below comes before the root of F. All points of the two cores are apart as long as
F > 0.

A plane at rest is good at a distance, since a is small. Faces that nearly touch and turn need one that turns
with a face, whose far corners pass through a plane at rest at once.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.farthest import VERTICES, farthest
from carom.collision.features import NOBODY, OF_A
from carom.collision.layout import BOX, CYLINDER, ELLIPSOID, HULL, PROFILE, SEGMENT
from carom.collision.profile_curve import farthest_of_curve
from carom.contact.kinds.partner import centre_of_other, on_half_space, pose_of
from carom.geometry.rotation import cross, rotate, rotate_back
from carom.kinematics.flight import core_extent

MOST_HALVINGS = 30  # largest number of halvings of the step, until the bound is above zero
CHORDS = 4  # each comes nearer to the root


@kernel
def height(solid, hulls, x, y, z):
    """Return the support function of a core: the greatest d.p over its points, d in axes of its body."""
    s, o, h, kind = solid.Q, solid.x, solid.half, solid.kind
    base = o[0] * x + o[1] * y + o[2] * z
    x, y, z = rotate_back(s, (x, y, z))
    if kind == SEGMENT:
        return base + h[2] * abs(z)
    if kind == BOX:
        return base + h[0] * abs(x) + h[1] * abs(y) + h[2] * abs(z)
    if kind == CYLINDER:
        return base + h[0] * math.sqrt(x * x + y * y) + h[2] * abs(z)
    if kind == ELLIPSOID:
        return base + math.sqrt((h[0] * x) ** 2 + (h[1] * y) ** 2 + (h[2] * z) ** 2)
    if kind == HULL:
        best, _ = farthest(solid, hulls, VERTICES, x, y, z)
        return base + best
    if kind == PROFILE:  # of its convex hull
        return base + farthest_of_curve(solid, hulls, x, y) + h[2] * abs(z)
    return base


@kernel
def frame_of(contact, side, n, state):
    """Return n, and k = n x w and n.v - x.k of the body (side 0) or the other one (1): 0 at rest (2)."""
    b = contact.body if side == 0 else contact.other
    if side == 2 or b < 0:
        return n, (0.0, 0.0, 0.0), 0.0
    x, v, w = state[b].x, state[b].v, state[b].w
    k = cross(n[0], n[1], n[2], w[0], w[1], w[2])
    rate = n[0] * v[0] + n[1] * v[1] + n[2] * v[2]
    return n, k, rate - x[0] * k[0] - x[1] * k[1] - x[2] * k[2]


@kernel
def in_frame(frame, body):
    """Return n and n x w - k in body axes, and height and rate along n of the mass centre in a frame."""
    q, w, x, v, (n, k, rate) = body.Q, body.w, body.x, body.v, frame
    mx, my, mz = rotate_back(q, n)
    cx, cy, cz = cross(n[0], n[1], n[2], w[0], w[1], w[2])
    cx, cy, cz = rotate_back(q, (cx - k[0], cy - k[1], cz - k[2]))
    z = n[0] * x[0] + n[1] * x[1] + n[2] * x[2]
    rate = n[0] * v[0] + n[1] * v[1] + n[2] * v[2] - rate - x[0] * k[0] - x[1] * k[1] - x[2] * k[2]
    return mx, my, mz, cx, cy, cz, z, rate


@kernel
def least_gap(system, contact, frame, state, t, a):
    """Return F(t), negative t for the past; a bounds the relative acceleration of any two points."""
    m = in_frame(frame, state[contact.body])
    hulls, solid = system.hulls, system.solids[contact.solid]
    gap = m[6] + t * m[7] - contact.radius - 0.5 * a * t * t
    gap -= height(solid, hulls, -m[0] - t * m[3], -m[1] - t * m[4], -m[2] - t * m[5])
    if on_half_space(contact):
        return gap - contact.offset
    solid, (n, k, rate) = system.solids[contact.other_solid], frame
    if contact.static == 1:
        d = height(solid, hulls, n[0] - t * k[0], n[1] - t * k[1], n[2] - t * k[2])
        return gap + t * rate - d
    m = in_frame(frame, state[contact.other])
    gap -= m[6] + t * m[7]
    return gap - height(solid, hulls, m[0] + t * m[3], m[1] + t * m[4], m[2] + t * m[5])


@kernel
def time_parted(system, contact, frame, state, a, h):
    """Return for how long, up to h, all points of two cores stay apart along n; h < 0: in the past.

    They may touch at the beginning, for instance after an impact: because F is concave, F > 0 at a time t is
    enough for all earlier times.
    """
    g = least_gap(system, contact, frame, state, h, a)
    if g >= 0.0:
        return abs(h)
    t, end = h, h
    for _ in range(MOST_HALVINGS):
        t *= 0.5
        f = least_gap(system, contact, frame, state, t, a)
        if f > 0.0:
            for _ in range(CHORDS):
                t += (end - t) * f / (f - g)
                f = least_gap(system, contact, frame, state, t, a)
                if not f > 0.0:  # the root itself, to round-off
                    break
            return abs(t)
        end, g = t, f
    return 0.0


@kernel
def bound_in_frame(system, contact, side, bounds, state, h):
    """Return a bound of the acceleration of any point of one body in the frame of the other (side 0 or 1).

    At a distance d from the centre of that body O, with a relative speed V + w_O d + w r, it is that of the
    centres, that about its own centre, (|w_O'| + w_O^2) d, and 2 w_O times this speed; twice the last, because
    spins grow in the step. `bounds` are those of the start of the step (`relative_bound`).
    """
    a = contact.body
    x, v, y = state[a].x, state[a].v, centre_of_other(contact, state)
    speed = math.sqrt((v[0] - y[3]) ** 2 + (v[1] - y[4]) ** 2 + (v[2] - y[5]) ** 2)
    r = core_extent(system.solids[contact.other_solid if side == 0 else contact.solid])
    if contact.static == 1:  # the table has its place in the world
        r = contact.other_extent
    d = math.sqrt((x[0] - y[0]) ** 2 + (x[1] - y[1]) ** 2 + (x[2] - y[2]) ** 2) + speed * abs(h) + r
    centres, _, turn, spin, other_turn, other_spin = bounds
    if side == 1:
        turn, spin, other_turn, other_spin = other_turn, other_spin, turn, spin
    return centres + other_turn * r + turn * d + 4.0 * spin * (speed + spin * d + other_spin * r)


@kernel
def time_beside(system, contact, plane, state, bounds, h):
    """Return how long, up to h, two solids stay apart beside a plane; h < 0: in the past.

    `plane` is its normal and the owner of this. It rests, or moves with its owner, whichever lasts longer.
    `bounds` are those of `relative_bound`.
    """
    n, owner = plane
    time = time_parted(system, contact, frame_of(contact, 2, n, state), state, bounds[1], h)
    for side in range(0 if on_half_space(contact) else 2 - contact.static):
        if time < abs(h) and (owner == NOBODY or owner == OF_A + side):
            a = bound_in_frame(system, contact, side, bounds, state, h)
            frame = frame_of(contact, side, n, state)
            time = max(time, time_parted(system, contact, frame, state, a, h))
    return time


@kernel
def plane_of(touch):
    """Return the plane between the two points of a contact."""
    n = touch.normal
    return (n[0], n[1], n[2]), touch.owner


@kernel
def widest_face(system, contact, state):
    """Return the plane of the face of a box beside which two solids have most room: normal and owner.

    And the number of the face, and the room, below 0 if no face separates them. Such a plane is known without a
    search for nearest points: a body in a ring of boxes is near all of them, and touches one or two.
    """
    room, owner, face, n = -math.inf, NOBODY, 0, (0.0, 0.0, 0.0)
    own = pose_of(system.solids[contact.solid], contact.body, state)
    beside = pose_of(system.solids[contact.other_solid], contact.other, state)
    for side in range(2):
        solid = system.solids[contact.solid if side == 0 else contact.other_solid]
        if solid.kind != BOX:
            continue
        (x, q), (y, _) = (own, beside) if side == 0 else (beside, own)
        d = rotate_back(q, (y[0] - x[0], y[1] - x[1], y[2] - x[2]))
        for k in range(3):
            if abs(d[k]) <= max(room, 0.0) + solid.half[k]:  # not even its centre has more
                continue
            f = 1.0 if (d[k] > 0.0) == (side == 1) else -1.0
            e = (f if k == 0 else 0.0, f if k == 1 else 0.0, f if k == 2 else 0.0)
            m = rotate(q, e)
            gap = least_gap(system, contact, frame_of(contact, 2, m, state), state, 0.0, 0.0)
            if gap > room:
                room, owner, n = gap, OF_A + side, m
                face = k if f > 0.0 else 3 + k
    return (n, owner), face, room


@kernel
def beside_face(system, contact, state, near):
    """Return whether a face of a box shows that the gap of two solids is above `near`; modes move faces."""
    return contact.bends == 0 and widest_face(system, contact, state)[2] > near


@kernel
def stays_beside_face(system, data, contact, smooth, tiny, bounds):
    """Return whether faces of boxes show that two solids stay apart in the trial step.

    If the motion is `smooth`, the cubic with the gap and rate of both ends beside one face decides, to `tiny`:
    its control points are F(h/3), of the start and back from the end, with a = 0. Of two parallel faces now one
    has more room, now the other, by round-off: that of the start is followed to the end. Else the plane must
    separate them at both ends, for the bounds to hold on the way from there.
    """
    if contact.bends == 1:  # its modes move the faces
        return False
    start, end, h = data.state, data.work.trial, data.work.search[0].dt
    plane, face, room = widest_face(system, contact, start)
    if not room >= -tiny:
        return False
    if smooth and stays_beside_one(system, contact, (plane, face), (start, end), h, tiny):
        return True
    other, _, left = widest_face(system, contact, end)
    if not min(room, left) > 0.0:
        return False
    time = time_beside(system, contact, plane, start, bounds, h)
    return time >= h or time + time_beside(system, contact, other, end, bounds, -h) >= h


@kernel
def stays_beside_one(system, contact, beside, states, h, tiny):
    """Return whether the cubic of the gap beside a face, of both states, is nowhere below -`tiny`."""
    (plane, face), (start, end), third = beside, states, h / 3.0
    side = plane[1] - OF_A
    frame = frame_of(contact, side, plane[0], start)
    if not least_gap(system, contact, frame, start, third, 0.0) >= -tiny:
        return False
    frame = frame_of(contact, side, normal_of(system, contact, side, face, end), end)
    if not least_gap(system, contact, frame, end, 0.0, 0.0) >= -tiny:
        return False
    return least_gap(system, contact, frame, end, -third, 0.0) >= -tiny


@kernel
def normal_of(system, contact, side, face, state):
    """Return the normal of a face of a box, towards the first solid; `face` is a number of `widest_face`."""
    solid = contact.solid if side == 0 else contact.other_solid
    _, q = pose_of(system.solids[solid], contact.body if side == 0 else contact.other, state)
    f, k = (1.0, face) if face < 3 else (-1.0, face - 3)
    return rotate(q, (f if k == 0 else 0.0, f if k == 1 else 0.0, f if k == 2 else 0.0))
