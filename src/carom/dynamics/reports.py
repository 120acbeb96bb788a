"""What forces exert and how joints have moved, at saved states, by the kernels of a run: for reports.

The arrays are those of `carom.model.compile.compile_for_reports`. A force is added to the wrenches by the same
kernel as in the right-hand side of a run. Its wrench on its first body is stated about the point where it acts,
and its power is that of the wrenches on all its bodies.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.dynamics.applied import acts_at, add
from carom.dynamics.applied.push import acts_along
from carom.dynamics.bearing_load import load_of, take_thread_out, write_vectors
from carom.dynamics.contact_impulse import clear_wrench, clear_wrenches
from carom.dynamics.elements.relation import prescribed
from carom.dynamics.reactions import expect_turn, follow_turns, settle_turn
from carom.geometry.rotation import cross, log
from carom.kinematics.combination import first_of, push, rate
from carom.kinematics.coordinate import along
from carom.kinematics.coordinates.ball import axes_of
from carom.kinematics.coordinates.turns import angular_velocity, turn_of
from carom.kinematics.curve import can_be_left, dot, foot_of, is_on_curve
from carom.kinematics.joints import anchor_gap, anchor_speed
from carom.law.friction import bound_of_stick, depends_on_slip, in_slip
from carom.model.arrays import DISTANCE, SPHERICAL
from carom.model.forces import FRICTIONS

#: a force in reports: its place, and the range of its bodies in a list, the first of which have a row each
REPORTED = [
    ("kind", "i8"),
    # range in the table of its kind; of dry friction, its place and the column of its value
    ("first", "i8"),
    ("last", "i8"),
    ("body", "i8"),  # range of its bodies
    ("end", "i8"),
    ("row", "i8"),
    ("rows", "i8"),  # bodies with rows
]
#: what a force exerts on one of its bodies: a row of a report; NaN where a force has none of it
EXERTED = [
    ("force", "f8", 3),  # world axes
    ("torque", "f8", 3),  # about the point where it acts
    ("value", "f8"),  # along a coordinate or a line
    ("power", "f8"),
    ("length", "f8"),  # of a spring, and its rate
    ("stretching", "f8"),
]
#: the motion of a coordinate of a joint
MOTION = [
    ("value", "f8"),
    ("rate", "f8"),
    ("along", "f8", 3),  # direction in which it grows as the child moves, world axes
    ("arm", "f8", 3),  # of the child, to where a force along it acts; 0 of a torque
    ("gap", "f8"),  # of a rail that can be left
]


@kernel
def force_of_slip(laws, law, speed):
    """Return the dry friction of a joint that slips, against its motion."""
    most = bound_of_stick(laws, law)
    if depends_on_slip(laws, law):
        most = in_slip(laws, law, abs(speed))
    return -most if speed > 0.0 else most


@kernel
def add_reported(system, one, values, state, work, row):
    """Add the wrenches of a force, write its value and length, and return the arm to where it acts."""
    if one.kind == FRICTIONS:
        friction = system.relations.frictions[one.first]
        c = system.relations.coordinates[friction.coordinate]
        row.value = values[one.last]
        if math.isnan(row.value):
            slip = rate(system, c, state)
            if friction.drives == 1:
                slip -= prescribed(system.relations, friction, work.moment[0].time)[1]
            row.value = force_of_slip(system.laws, friction.law, friction.arm * slip)
        push(system, c, state, row.value, work)
        return acts_along(first_of(system, c), state)
    for i in range(one.first, one.last):
        _, row.value, row.length, row.stretching = add(one.kind, system, i, state, 0.0, work)
    return acts_at(one.kind, system, one.first, state)


@entry
def write_loads(system, saved, number, reactions, values, out):
    """Write the loads (T,) of friction `number` at saved states.

    `reactions` are those of its joint, (T, 6), on the child of the scene, `values` (T,) the friction itself.
    """
    one, vectors = system.relations.frictions[number], system.relations.memory.write
    for k in range(saved.state.shape[0]):
        state, w = saved.state[k], reactions[k]
        write_vectors(system, one, (w[0], w[1], w[2]), (w[3], w[4], w[5]), state, vectors)
        take_thread_out(system, one, values[k], state, vectors)
        out[k] = load_of(vectors)


@kernel
def take_wrenches(one, bodies, at, state, work, rows):
    """Write the wrenches on the bodies of a force to its rows, with their power, and clear them."""
    for n in range(one.body, one.end):
        own, b = min(n - one.body, one.rows - 1), bodies[n]
        row = rows[own]
        if own == n - one.body:
            row.power = 0.0
        if b < 0:
            continue
        wrench, v, w = work.body[b].wrench, state[b].v, state[b].w
        for k in range(3):
            row.power += wrench[k] * v[k] + wrench[3 + k] * w[k]
        if own == n - one.body:
            turned = cross(at[0], at[1], at[2], wrench[0], wrench[1], wrench[2])
            for k in range(3):
                row.force[k], row.torque[k] = wrench[k], wrench[3 + k] - turned[k]
        clear_wrench(work.body[b])


@entry
def write_exerted(system, saved, rows, acting, work, out):
    """Write what forces exert on their bodies, (T, R) EXERTED, at the saved states `rows[0]` to `rows[1]`.

    Earlier states must have been treated before, because whole turns of angles are counted. `acting` are the
    forces, their bodies, and the values (T, F) of dry friction, NaN where it slips.
    """
    forces, bodies, values = acting
    clear_wrenches(work)
    for k in range(rows[0], rows[1]):
        state, work.moment[0].time = saved.state[k], saved.series[k].t
        follow_turns(system, saved, k)
        for i in range(forces.shape[0]):
            one = forces[i]
            own = out[k, one.row : one.row + one.rows]
            at = add_reported(system, one, values[k], state, work, own[0])
            take_wrenches(one, bodies, at, state, work, own)


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
    out.value, out.rate = length, dot(e, u)
    out.along[0], out.along[1], out.along[2] = e


@kernel
def write_guided(system, c, state, out):
    """Write value, rate and direction of a coordinate; of a rail that can be left, those of its foot."""
    a = out.along
    a[0], a[1], a[2] = along(system, c, state)
    out.value, out.rate = turn_of(system, c).reference, rate(system, c, state)
    if not is_on_curve(c):
        return
    one, foot = system.relations.curves[c.number], foot_of(system, c)
    if can_be_left(one):  # in flight the foot has a speed of its own
        out.rate /= foot.ahead * math.sqrt(dot(foot.slope, foot.slope))
        m, n = foot.normal[0], foot.normal[1]
        a[0], a[1], a[2] = cross(m[0], m[1], m[2], n[0], n[1], n[2])
        out.gap = foot.gap[1]


@entry
def write_coordinates(system, saved, chosen, out):
    """Write the motion, (T, n) MOTION, of the n `chosen` coordinates at all saved states, with whole turns."""
    for k in range(saved.state.shape[0]):
        state = saved.state[k]
        for n in range(chosen.shape[0]):
            c, row = system.relations.coordinates[chosen[n]], out[k, n]
            if c.kind == DISTANCE or c.kind == SPHERICAL:
                write_unguided(c, state, row)
            else:
                expect_turn(system, saved, k, chosen[n])
                settle_turn(system, saved, k, chosen[n])
                write_guided(system, c, state, row)
            row.arm[0], row.arm[1], row.arm[2] = acts_along(c, state)
