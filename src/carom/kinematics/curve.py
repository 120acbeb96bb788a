"""Joints of a point on a curve: the foot, its axes, and two rows across the curve.

With the point y in axes of the body of the curve, its foot c(s), (y - c) . c' = 0, d = y - c, the tangent t,
normals n_1, n_2 and the curvature vector b of the curve at its foot:

    error  n_r . d,     rate  n_r . y',     n_r . y'' = (n_r . b) s' (t . y'),     s' = t . y' / (1 - b . d).

In the world y' and y'' are those of the relative motion, whose bias has the accelerations of both arms and that
of Coriolis. The foot is found by Newton's iteration from the coordinate at the start of the trial step, which
`carom.dynamics.more_forces` keeps short enough for this.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.geometry.pieces import find_piece
from carom.geometry.rotation import cross, rotate, rotate_back
from carom.geometry.thresholds import RESOLUTION, SMALLEST
from carom.kinematics.coordinates.turns import turn_of
from carom.kinematics.joints import anchor_speed, child_arm, parent_arm
from carom.kinematics.thresholds import END_MARGIN, HEIGHT, NEAR_RAIL
from carom.kinematics.wrench import add_force
from carom.model.arrays import CURVE_ON_POINT, POINT_ON_CURVE

MOST_CORRECTIONS = 30  # of a foot


@kernel
def polynomial(c, k, s):
    """Return component k of a piece of degree 5, and its first and second derivative."""
    f, d, e = c[5, k], 0.0, 0.0
    for i in range(4, -1, -1):
        e = e * s + 2.0 * d
        d = d * s + f
        f = f * s + c[i, k]
    return f, d, e


@kernel
def to_owner(c, state, vector):
    """Return a world vector in axes of the body of the curve (-1: the ground)."""
    owner = c.parent if c.kind == POINT_ON_CURVE else c.child
    return vector if owner < 0 else rotate_back(state[owner].Q, vector)


@kernel
def to_world(c, state, vector):
    """Return a vector in axes of the body of the curve in world axes."""
    owner = c.parent if c.kind == POINT_ON_CURVE else c.child
    return vector if owner < 0 else rotate(state[owner].Q, vector)


@kernel
def point_of(c, state):
    """Return the point of the joint in axes of the body of the curve, from its centre."""
    arm = parent_arm(c, state) if c.kind == POINT_ON_CURVE else child_arm(c, state)
    return to_owner(c, state, arm)


@kernel
def is_upright(piece):
    """Return whether a piece is of a rail in space, which its point sees along the free side."""
    n = piece.normal
    return n[0] == 0.0 and n[1] == 0.0 and n[2] == 0.0


@kernel
def across_side(one, v):
    """Return a vector without its component along the free side."""
    n = one.side
    f = n[0] * v[0] + n[1] * v[1] + n[2] * v[2]
    return v[0] - f * n[0], v[1] - f * n[1], v[2] - f * n[2]


@kernel
def place_at(one, foot, pieces, i, t):
    """Write position, first and second derivative of piece i at a distance t from its start."""
    for k in range(3):
        foot.x[k], foot.slope[k], foot.second[k] = polynomial(pieces[i].c, k, t)
    if is_upright(pieces[i]):
        for v in (foot.x, foot.slope, foot.second):
            v[0], v[1], v[2] = across_side(one, v)


@kernel
def locate(one, foot, pieces, s):
    """Write the place of a coordinate on the curve, and return its piece."""
    t = s
    if one.period > 0.0:
        t -= one.period * math.floor((s - one.low) / one.period)
    place = find_piece(pieces, one.first, one.last, t)
    place_at(one, foot, pieces, place, t - pieces[place].start)
    return place


@kernel
def correction(foot, point, curved):
    """Return Newton's correction of a place on the curve, towards the foot of a point.

    Far from the foot the curvature would lead away.
    """
    along, square, bend = 0.0, 0.0, 0.0
    for k in range(3):
        d = point[k] - foot.x[k]
        along += d * foot.slope[k]
        bend += d * foot.second[k]
        square += foot.slope[k] * foot.slope[k]
    return along / max(square - (bend if curved else 0.0), 0.5 * square)


@kernel
def follow(one, foot, pieces, point, s):
    """Return the foot of a point that Newton's iteration from s finds, and its piece; NaN if there is none."""
    place, small = one.first, RESOLUTION / max(one.sharpest, 1.0 / (one.high - one.low))
    done = False
    for k in range(MOST_CORRECTIONS):
        place = locate(one, foot, pieces, s)
        if done:
            break
        step = correction(foot, point, k > 1)
        s += step
        done = abs(step) <= small  # the error after it is its square
    return s if done else math.nan, place


@kernel
def foot_of(system, c):
    """Return the foot of a coordinate on its curve: the last that was asked for."""
    return system.relations.memory.feet[c.number]


@unit
def find_foot(system, c, state):
    """Write the foot of the point of a joint, with its axes, to the curve; NaN if there is none nearby.

    That of a rail that can be left is the nearest one in flight.
    """
    one, pieces = system.relations.curves[c.number], system.relations.curve_pieces
    foot = foot_of(system, c)
    point, free = point_of(c, state), can_be_left(one)
    if is_upright(pieces[one.first]):
        foot.s, place = follow(
            one, foot, pieces, across_side(one, point), turn_of(system, c).reference
        )
        write_upright(system, c, pieces[place], point, state)
        return
    foot.s, place = follow(one, foot, pieces, point, turn_of(system, c).reference)
    if free and not distance(foot, point) * one.sharpest + 0.0 * foot.s <= NEAR_RAIL:
        place = find_nearest(system, c, point)
    n = pieces[place].normal
    write_axes(c, foot, (n[0], n[1], n[2]), point, state)
    if free:  # in its plane, where the centre of curvature is no place of its own
        foot.bend[0], foot.ahead = 0.0, max(foot.ahead, RESOLUTION)


@kernel
def can_be_left(one):
    """Return whether a curve is a rail with a free side."""
    return one.side[0] != 0.0 or one.side[1] != 0.0 or one.side[2] != 0.0


@kernel
def find_nearest(system, c, point):
    """Write the nearest foot on the whole curve, in the lap nearest to the last, and return its piece.

    The curve goes on straight beyond its ends. Near a centre of curvature, any near place does as the foot.
    """
    one, pieces = system.relations.curves[c.number], system.relations.curve_pieces
    foot = foot_of(system, c)
    least, near, spacing = math.inf, one.low, 0.0
    for i in range(one.first, one.last):
        end = pieces[i + 1].start if i + 1 < one.last else one.high
        t, length = 0.0, end - pieces[i].start
        place_at(one, foot, pieces, i, t)
        if distance(foot, point) > 1.01 * length + least:
            continue
        for _ in range(2):
            t = min(max(t + correction(foot, point, True), 0.0), length)
            place_at(one, foot, pieces, i, t)
        if distance(foot, point) < least:
            least, near, spacing = distance(foot, point), pieces[i].start + t, length
    foot.s = near
    for _ in range(MOST_CORRECTIONS):
        place = locate(one, foot, pieces, foot.s)
        step = correction(foot, point, True)
        if distance(foot, point) > least + RESOLUTION * spacing:  # near a centre of curvature
            place, foot.s = locate(one, foot, pieces, near), near
            break
        if abs(step) <= RESOLUTION * spacing:
            break
        foot.s += min(max(step, -spacing), spacing)
    if one.period == 0.0 and not one.low <= foot.s <= one.high:
        near = min(max(foot.s, one.low), one.high)
        place = locate(one, foot, pieces, near)
        foot.s = near + correction(foot, point, False)
    if one.period > 0.0:
        foot.s += one.period * math.floor(
            (turn_of(system, c).reference - foot.s) / one.period + 0.5
        )
    return place


@kernel
def write_axes(c, foot, across, point, state):
    """Write axes and curvature of a foot, and the gap of the point; `across` is a vector across the curve."""
    side, t, b = 1.0 if c.kind == POINT_ON_CURVE else -1.0, foot.slope, foot.second
    square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2]
    f = 1.0 / math.sqrt(square)
    tx, ty, tz = f * t[0], f * t[1], f * t[2]
    f = across[0] * tx + across[1] * ty + across[2] * tz
    nx, ny, nz = across[0] - f * tx, across[1] - f * ty, across[2] - f * tz
    f = 1.0 / math.sqrt(nx * nx + ny * ny + nz * nz)
    dx, dy, dz = point[0] - foot.x[0], point[1] - foot.x[1], point[2] - foot.x[2]
    nx, ny, nz, foot.ahead = f * nx, f * ny, f * nz, 1.0
    for r in range(2):
        if r == 1:
            nx, ny, nz = cross(tx, ty, tz, nx, ny, nz)
        foot.gap[r] = side * (nx * dx + ny * dy + nz * dz) + 0.0 * foot.s  # NaN stays
        foot.bend[r] = side * (nx * b[0] + ny * b[1] + nz * b[2]) / square
        foot.ahead -= foot.gap[r] * foot.bend[r]
        foot.normal[r, 0], foot.normal[r, 1], foot.normal[r, 2] = to_world(c, state, (nx, ny, nz))
    a = foot.along
    a[0], a[1], a[2] = to_world(c, state, (side * tx, side * ty, side * tz))


@kernel
def write_upright(system, c, piece, point, state):
    """Write the axes of a rail in space: across it, as seen along the free side, and towards the free side.

    The point stays above the rail, N . (y - c) over a foot that it sees along N. With the unit tangent
    t = (t.h) h + (t.N) N, the gap is (t.h) N . (y - c), and the normal n = (t.h) N - (t.N) h.
    """
    one, foot = system.relations.curves[c.number], foot_of(system, c)
    t = foot.s - piece.start
    if one.period > 0.0:
        t -= one.period * math.floor((foot.s - one.low) / one.period)
    n, h, s = one.side, foot.slope, 1.0 / math.sqrt(dot(foot.slope, foot.slope))
    across = cross(n[0], n[1], n[2], h[0], h[1], h[2])
    write_axes(c, foot, across, across_side(one, point), state)
    rise, height, bend, square, along = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        x, slope, second = polynomial(piece.c, k, t)
        rise += n[k] * slope
        square += slope * slope
        height += n[k] * (point[k] - x)
        bend += n[k] * second
        along += s * h[k] * second
    f = 1.0 / math.sqrt(square)
    run, rise = f / s, f * rise
    foot.gap[1], foot.bend[1] = run * height, (run * bend - rise * along) / square
    m, a = foot.normal[1], foot.along
    for k in range(3):
        m[k] = run * m[k] - rise * a[k]


@kernel
def height_above(one, piece, t, point):
    """Return how far a point is from a place on a rail, along its free side."""
    total = 0.0
    for k in range(3):
        x, _, _ = polynomial(piece.c, k, t)
        total += one.side[k] * (point[k] - x)
    return total


@unit
def seek_foot(system, c, state):
    """Set the coordinate of a joint to that of its foot on the whole curve, in the lap nearest to the last.

    Where the curve crosses itself, the branch is that along the motion, or that nearest to the last coordinate.
    A rail in space may lie above itself, as a helix does: the branch is the highest one below the point.
    """
    one, pieces = system.relations.curves[c.number], system.relations.curve_pieces
    foot = foot_of(system, c)
    place, before = point_of(c, state), turn_of(system, c).reference
    point, upright = place, is_upright(pieces[one.first])
    if upright:
        point = across_side(one, place)
    u = to_owner(c, state, anchor_speed(c, state))
    speed, least, found = dot(u, u), math.inf, before
    for i in range(one.first, one.last):
        end = pieces[i + 1].start if i + 1 < one.last else one.high
        t, spacing = 0.0, end - pieces[i].start
        place_at(one, foot, pieces, i, t)
        if distance(foot, point) > 1.01 * spacing + math.sqrt(least):
            continue
        for _ in range(2):
            t = min(max(t + correction(foot, point, False), 0.0), spacing)
            place_at(one, foot, pieces, i, t)
        lap, along = abs(pieces[i].start + t - before), dot(u, foot.slope)
        if one.period > 0.0:
            lap -= one.period * math.floor(lap / one.period + 0.5)
        turned = max(0.0, 1.0 - along * along / speed) if speed > SMALLEST else 0.0
        away = distance(foot, point) ** 2 + spacing * spacing * turned + (RESOLUTION * lap) ** 2
        if upright:
            height = height_above(one, pieces[i], t, place)
            if height < -2.0 * spacing:
                continue
            away += (HEIGHT * height) ** 2
        if away < least:
            least, found = away, pieces[i].start + t
    turn_of(system, c).reference = found
    find_foot(system, c, state)
    laps = math.floor((before - foot.s) / one.period + 0.5) if one.period > 0.0 else 0.0
    turn_of(system, c).reference = foot.s + laps * one.period


@kernel
def dot(a, b):
    """Return the product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def distance(foot, point):
    """Return the distance of a point from the last place on the curve."""
    x = foot.x
    return math.sqrt((point[0] - x[0]) ** 2 + (point[1] - x[1]) ** 2 + (point[2] - x[2]) ** 2)


@kernel
def is_on_curve(c):
    """Return whether a coordinate is arc length along a curve."""
    return c.kind == POINT_ON_CURVE or c.kind == CURVE_ON_POINT


@kernel
def seek_feet(system, state):
    """Set all coordinates along curves to those of a state that does not follow the last one."""
    for i in range(system.relations.coordinates.shape[0]):
        if is_on_curve(system.relations.coordinates[i]):
            seek_foot(system, system.relations.coordinates[i], state)


@kernel
def is_beyond(one, s):
    """Return whether a coordinate is beyond the ends of an open curve, by more than stops there allow."""
    return one.period == 0.0 and max(one.low - s, s - one.high) > END_MARGIN * (one.high - one.low)


@kernel
def curve_error(joint, foot, out):
    """Write the error of position of the last foot: out[3 + r] for row r."""
    for k in range(6):
        out[k] = 0.0
    for r in range(joint.rows):
        out[3 + r] = foot.gap[r]


@kernel
def curve_speed(c, foot, state, out):
    """Write the error of velocity at the last foot: out[3 + r] for row r."""
    u = anchor_speed(c, state)
    for k in range(6):
        out[k] = 0.0
    for r in range(c.rows):
        out[3 + r] = dot(foot.normal[r], u)


@kernel
def curve_bias(c, foot, state, out):
    """Write the bias of the acceleration at the last foot: out[3 + r] for row r."""
    bias, speed = relative_bias(c, state), dot(foot.along, anchor_speed(c, state))
    for k in range(6):
        out[k] = 0.0
    for r in range(c.rows):
        out[3 + r] = dot(foot.normal[r], bias) + foot.bend[r] * speed * speed / foot.ahead


@kernel
def speed_beside(c, state):
    """Return the speed of the point relative to the curve."""
    u = anchor_speed(c, state)
    return math.sqrt(dot(u, u))


@kernel
def rail_drift(c, foot, state):
    """Return (d/dt G) v of the contact of a rail, at the last foot: normal, tangent, across."""
    bias, u, n, e = relative_bias(c, state), anchor_speed(c, state), foot.normal[1], foot.normal[0]
    t, ahead = cross(e[0], e[1], e[2], n[0], n[1], n[2]), dot(foot.along, u)
    speed, across = dot(t, u), foot.bend[0] * ahead * ahead / foot.ahead
    turn = foot.bend[1] * speed / foot.ahead  # rate at which n turns back, t ahead
    return -dot(n, bias) - turn * speed, -dot(t, bias) + turn * dot(n, u), -dot(e, bias) - across


@kernel
def relative_bias(c, state):
    """Return the bias of the relative acceleration without the curvature, for arms that end at the point."""
    w = state[c.child].w
    rx, ry, rz = child_arm(c, state)
    tx, ty, tz = cross(w[0], w[1], w[2], rx, ry, rz)
    sx, sy, sz = cross(w[0], w[1], w[2], tx, ty, tz)
    lx, ly, lz = -sx, -sy, -sz
    if c.parent >= 0:
        o = state[c.parent].w
        rx, ry, rz = parent_arm(c, state)
        tx, ty, tz = cross(o[0], o[1], o[2], rx, ry, rz)
        sx, sy, sz = cross(o[0], o[1], o[2], tx, ty, tz)
        lx, ly, lz = lx + sx, ly + sy, lz + sz
    owner = c.parent if c.kind == POINT_ON_CURVE else c.child
    if owner >= 0:
        o = state[owner].w
        ux, uy, uz = anchor_speed(c, state)
        sx, sy, sz = cross(o[0], o[1], o[2], 2.0 * ux, 2.0 * uy, 2.0 * uz)
        lx, ly, lz = lx + sx, ly + sy, lz + sz
    return lx, ly, lz


@kernel
def curve_rows(c, foot, state, side):
    """Write A of both rows at the last foot, for one body of the joint."""
    s, arm = 1.0, child_arm(c, state)
    if side.body != c.child:
        s, arm = -1.0, parent_arm(c, state)
    for r in range(c.rows):
        n, A = foot.normal[r], side.A
        tx, ty, tz = cross(arm[0], arm[1], arm[2], n[0], n[1], n[2])
        A[r, 0], A[r, 1], A[r, 2] = s * n[0], s * n[1], s * n[2]
        A[r, 3], A[r, 4], A[r, 5] = s * tx, s * ty, s * tz


@kernel
def push_across(c, foot, state, multiplier, work):
    """Add the wrenches of the multipliers of both rows at the last foot."""
    f = force_across(foot, multiplier)
    add_force(work, c.child, child_arm(c, state), f)
    add_force(work, c.parent, parent_arm(c, state), (-f[0], -f[1], -f[2]))


@kernel
def force_across(foot, multiplier):
    """Return the force on the child of the multipliers of both rows at the last foot."""
    m, n, f, g = foot.normal[0], foot.normal[1], multiplier[0], multiplier[1]
    return f * m[0] + g * n[0], f * m[1] + g * n[1], f * m[2] + g * n[2]
