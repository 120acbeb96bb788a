"""What forces exert and how joints have moved, at saved states, by the kernels of a run: for reports.

The arrays are those of `carom.model.compile.compile_for_reports`. A force is added to the wrenches by the same
kernel as in the right-hand side of a run. Its wrench on its first body is stated about the point where it acts,
and its power is that of the wrenches on all its bodies.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.dynamics.bushing import add_bushing
from carom.dynamics.contact_impulse import clear_wrench, clear_wrenches
from carom.dynamics.forces import add_load, add_spring
from carom.dynamics.more_forces import add_push, add_user_force
from carom.dynamics.reactions import expect_turn, follow_turns, settle_turn
from carom.geometry.rotation import cross, log
from carom.kinematics.ball import axes_of
from carom.kinematics.coordinate import along, angular_velocity, push, rate, slides
from carom.kinematics.curve import can_be_left, dot, is_on_curve
from carom.kinematics.joints import anchor_gap, anchor_speed, arm, child_arm
from carom.model.arrays import (
    BUSHINGS,
    DISTANCE,
    FRICTIONS,
    LOADS,
    PUSHES,
    SPHERICAL,
    SPRINGS,
    USER_FORCES,
)

#: a force in reports: its place, and the range of its bodies in a list, the first of which have a row each
REPORTED = [
    ("kind", "i8"),
    (
        "first",
        "i8",
    ),  # range in the table of its kind; of dry friction, coordinate, and column of its value
    ("last", "i8"),
    ("body", "i8"),  # range of its bodies
    ("end", "i8"),
    ("row", "i8"),
    ("rows", "i8"),  # bodies with rows
]
#: numbers of a row: force and torque on the body, world axes, at the point where it acts; value along a
#: coordinate or a line; power; length of a spring, and its rate
FORCE, TORQUE, VALUE, POWER, LENGTH, STRETCHING, EXERTED = 0, 3, 6, 7, 8, 9, 10
#: numbers of a coordinate: its value and rate, the direction in which it grows, the arm of the child to where a
#: force along it acts, both in world axes, and the gap of a rail
COORDINATE, RATE, ALONG, ARM, GAP, MOTION = 0, 1, 2, 5, 8, 9


@kernel
def add_reported(system, one, values, state, work, row):
    """Add the wrenches of a force, and write its value and length, NaN where it has none."""
    for k in range(VALUE, EXERTED):
        row[k] = math.nan
    for i in range(one.first, one.last):
        if one.kind == SPRINGS:
            row[VALUE], row[LENGTH], row[STRETCHING] = add_spring(
                system, system.springs[i], state, work
            )
        elif one.kind == LOADS:
            add_load(system.loads[i], state, work)
        elif one.kind == BUSHINGS:
            add_bushing(system.bushings[i], state, work)
        elif one.kind == PUSHES:
            row[VALUE], _ = add_push(system, system.relations.pushes[i], state, work)
        elif one.kind == USER_FORCES:
            add_user_force(system, system.relations.forces[i], state, 0.0, work)
    if one.kind == FRICTIONS:
        row[VALUE] = values[one.last]
        push(system, system.relations.coordinates[one.first], state, row[VALUE], work)


@kernel
def acts_at(system, one, state):
    """Return the arm, from the centre of its first body, to the point where a force acts."""
    i = one.first
    if one.kind == SPRINGS:
        return arm(state, system.springs[i].child, system.springs[i].child_anchor)
    if one.kind == LOADS:
        return arm(state, system.loads[i].body, system.loads[i].anchor)
    if one.kind == BUSHINGS:
        return arm(state, system.bushings[i].child, system.bushings[i].child_anchor)
    if one.kind == PUSHES or one.kind == FRICTIONS:
        k = system.relations.pushes[i].coordinate if one.kind == PUSHES else i
        c = system.relations.coordinates[k]
        if slides(c):
            return child_arm(c, state)
    return 0.0, 0.0, 0.0


@kernel
def take_wrenches(system, one, bodies, state, work, rows):
    """Write the wrenches on the bodies of a force to its rows, with their power, and clear them."""
    at = acts_at(system, one, state)
    for n in range(one.body, one.end):
        b, row = bodies[n], rows[min(n - one.body, one.rows - 1)]
        if n - one.body < one.rows:
            row[POWER] = 0.0
        if b < 0:
            continue
        wrench, v, w = work.body[b].wrench, state[b].v, state[b].w
        for k in range(3):
            row[POWER] += wrench[k] * v[k] + wrench[3 + k] * w[k]
        if n - one.body < one.rows:
            f = wrench[0], wrench[1], wrench[2]
            turned = cross(at[0], at[1], at[2], f[0], f[1], f[2])
            for k in range(3):
                row[FORCE + k], row[TORQUE + k] = wrench[k], wrench[3 + k] - turned[k]
        clear_wrench(work.body[b])


@entry
def write_exerted(system, saved, rows, acting, work, out):
    """Write what forces exert on their bodies (T, R, 10) at the saved states `rows[0]` to `rows[1]`.

    Earlier states must have been treated before, because whole turns of angles are counted. `acting` are the
    forces, their bodies, and the values (T, F) of dry friction.
    """
    forces, bodies, values = acting
    clear_wrenches(work)
    for k in range(rows[0], rows[1]):
        state, work.result[0].time = saved.state[k], saved.series[k].t
        follow_turns(system, saved, k)
        for i in range(forces.shape[0]):
            one = forces[i]
            own = out[k, one.row : one.row + one.rows]
            add_reported(system, one, values[k], state, work, own[0])
            for n in range(1, one.rows):
                for m in range(VALUE, EXERTED):
                    own[n, m] = own[0, m]
            take_wrenches(system, one, bodies, state, work, own)


@kernel
def turned_by(c, state):
    """Return the rotation vector of the child relative to the parent, in axes of the parent's frame."""
    p0, q0 = axes_of(c, state, 0)
    p1, q1 = axes_of(c, state, 1)
    p2, q2 = axes_of(c, state, 2)
    x, y, z = dot(p0, q0), dot(p1, q1), dot(p2, q2)
    a, b, d = dot(p2, q1) - dot(p1, q2), dot(p0, q2) - dot(p2, q0), dot(p1, q0) - dot(p0, q1)
    s, t, u = dot(p1, q0) + dot(p0, q1), dot(p0, q2) + dot(p2, q0), dot(p2, q1) + dot(p1, q2)
    # a multiple of the quaternion: the row of 4 q q^T with the greatest diagonal
    q = (1.0 + x + y + z, a, b, d)
    if max(x, y, z) > x + y + z:
        if x >= y and x >= z:
            q = (a, 1.0 + x - y - z, s, t)
        elif y >= z:
            q = (b, s, 1.0 + y - x - z, u)
        else:
            q = (d, t, u, 1.0 + z - x - y)
    f = 1.0 / math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return log((f * q[0], f * q[1], f * q[2], f * q[3]))


@kernel
def write_unguided(c, state, out):
    """Write value, rate and direction of the length of a rod, or of a number of a rotation vector."""
    if c.kind == DISTANCE:
        d, u = anchor_gap(c, state), anchor_speed(c, state)
        length = math.sqrt(dot(d, d))
        e = (d[0] / length, d[1] / length, d[2] / length)
    else:
        e, _ = axes_of(c, state, c.number)
        w, v = angular_velocity(state, c.child), angular_velocity(state, c.parent)
        u = (w[0] - v[0], w[1] - v[1], w[2] - v[2])
        length = turned_by(c, state)[c.number]
    out[COORDINATE], out[RATE] = length, dot(e, u)
    out[ALONG], out[ALONG + 1], out[ALONG + 2] = e


@kernel
def write_guided(system, c, state, out):
    """Write value, rate and direction of a coordinate; of a rail that can be left, those of its foot."""
    out[ALONG], out[ALONG + 1], out[ALONG + 2] = along(system, c, state)
    out[COORDINATE], out[RATE] = c.reference, rate(system, c, state)
    if not is_on_curve(c):
        return
    one = system.relations.curves[c.number]
    if can_be_left(one):  # in flight the foot has a speed of its own
        out[RATE] /= one.ahead * math.sqrt(dot(one.slope, one.slope))
        m, n = one.normal[0], one.normal[1]
        out[ALONG], out[ALONG + 1], out[ALONG + 2] = cross(m[0], m[1], m[2], n[0], n[1], n[2])
        out[GAP] = one.gap[1]


@entry
def write_coordinates(system, saved, chosen, out):
    """Write the motion (T, n, 9) of the n `chosen` coordinates at all saved states, with whole turns."""
    for k in range(saved.state.shape[0]):
        state = saved.state[k]
        for n in range(chosen.shape[0]):
            c, row = system.relations.coordinates[chosen[n]], out[k, n]
            row[GAP] = 0.0
            if c.kind == DISTANCE or c.kind == SPHERICAL:
                write_unguided(c, state, row)
            else:
                expect_turn(system, saved, k, chosen[n])
                settle_turn(system, saved, k, chosen[n])
                write_guided(system, c, state, row)
            row[ARM], row[ARM + 1], row[ARM + 2] = child_arm(c, state)
