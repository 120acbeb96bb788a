"""Forces along joint coordinates, by characteristic curves, and by user-defined functions.

along a coordinate    Q = -k (q - rest) - c q' + F,       U = k (q - rest)^2 / 2
a spring with a curve tension F(length),                  U = integral of F from its first point
of the user's         wrenches = f(t, states),            U if a potential is given
"""

from __future__ import annotations

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.curve import curve
from carom.dynamics.thresholds import RAIL_TRAVEL, ROTATION
from carom.geometry.pieces import find_piece
from carom.geometry.rotation import conjugate, multiply
from carom.kinematics.coordinate import push, rate, speed_of_turn, value
from carom.kinematics.curve import (
    can_be_left,
    is_beyond,
    is_on_curve,
    is_upright,
    speed_beside,
)
from carom.model.arrays import PRISMATIC, REVOLUTE, TWIST
from carom.model.arrays import ROTATION as OF_BALL
from carom.model.parts_of_system import has_relations, has_turns


@kernel
def push_force(relations, one, q, speed, t):
    """Return the force along a coordinate, and the part of it that has no potential."""
    free = one.force - one.damping * speed
    if one.address != 0:
        relations.read[0], relations.read[1] = q, speed
        call_function(one.address, t, relations.read, relations.write)
        free += relations.write[0]
    return free - one.stiffness * (q - one.rest), free


@kernel
def read_states(system, force, state):
    """Write x, Q, v, w of the bodies of a user's force, in the axes of the scene."""
    relations, i = system.relations, 0
    read = relations.read
    for n in range(force.first, force.last):
        b = relations.named[n]
        Q, a = state[b].Q, system.bodies[b].axes
        for k in range(3):
            read[i + k] = state[b].x[k]
            read[i + 7 + k], read[i + 10 + k] = state[b].v[k], state[b].w[k]
        q = multiply(Q, conjugate(a))
        read[i + 3], read[i + 4], read[i + 5], read[i + 6] = q
        i += 13


@kernel
def add_push(system, one, state, work):
    """Add a force along a coordinate; return it, and the power of its part that has no potential."""
    c = system.relations.coordinates[one.coordinate]
    speed, t = rate(system, c, state), work.result[0].time
    force, free = push_force(system.relations, one, value(system, c, state), speed, t)
    push(system, c, state, force, work)
    return force, free * speed


@kernel
def add_user_force(system, one, state, power, work):
    """Add the wrenches of a function of the user's; return `power` and theirs, unless they have a potential."""
    relations, at = system.relations, 0
    read_states(system, one, state)
    call_function(one.address, work.result[0].time, relations.read, relations.write)
    for n in range(one.first, one.last):
        b = relations.named[n]
        wrench, v, w = work.body[b].wrench, state[b].v, state[b].w
        for k in range(6):
            f = relations.write[at + k]
            wrench[k] += f
            if one.energy_address == 0:
                power += f * (v[k] if k < 3 else w[k - 3])
        at += 6
    return power


@unit(where=has_relations, otherwise=0.0)
def add_more_forces(system, state, work) -> float:
    """Add the wrenches of these forces; return the power of those without potential."""
    power, relations = 0.0, system.relations
    for i in range(relations.pushes.shape[0]):
        _, lost = add_push(system, relations.pushes[i], state, work)
        power += lost
    for i in range(relations.forces.shape[0]):
        power = add_user_force(system, relations.forces[i], state, power, work)
    return power


@unit(where=has_relations, otherwise=0.0)
def more_energy(system, state, t) -> float:
    """Return the potential energy of these forces [J]."""
    total, relations = 0.0, system.relations
    for i in range(relations.pushes.shape[0]):
        one = relations.pushes[i]
        stretch = value(system, relations.coordinates[one.coordinate], state) - one.rest
        total += 0.5 * one.stiffness * stretch * stretch
    for i in range(relations.forces.shape[0]):
        one = relations.forces[i]
        if one.energy_address != 0:
            read_states(system, one, state)
            call_function(one.energy_address, t, relations.read, relations.write)
            total += relations.write[0]
    return total


@kernel
def tension(system, spring, length):
    """Return the tension of a spring, by its curve if it has one."""
    if spring.last_piece > spring.piece:
        return curve(system.relations.pieces, spring.piece, spring.last_piece, length)[0]
    return spring.stiffness * (length - spring.rest_length)


@kernel
def integral(pieces, first, last, t):
    """Return the integral of a curve from its first point to t."""
    here, total = find_piece(pieces, first, last, t), 0.0
    for i in range(first, here + 1):
        piece = pieces[i]
        s = (t if i == here else piece.end) - piece.start
        f = 0.0
        for k in range(5, -1, -1):
            f = f * s + piece.c[k] / (k + 1.0)
        total += f * s
    return total


@kernel
def spring_energy(system, spring, length):
    """Return the energy of a spring."""
    if spring.last_piece > spring.piece:
        return integral(system.relations.pieces, spring.piece, spring.last_piece, length)
    return 0.5 * spring.stiffness * (length - spring.rest_length) ** 2


@unit(where=has_turns, otherwise=False)
def note_turns(system, state, h) -> bool:
    """Store the whole turns of all angles, after a trial step of length h has been accepted.

    Return whether a point has left its curve.
    """
    left = False
    for i in range(system.relations.coordinates.shape[0]):
        c = system.relations.coordinates[i]
        if c.kind == REVOLUTE or c.kind == TWIST:  # what nothing depends on may turn far in a step
            c.reference += h * rate(system, c, state)
        c.reference = value(system, c, state)
        if is_on_curve(c):
            left = left or is_beyond(system.relations.curves[c.number], c.reference)
    return left


@kernel
def begin_turns(system):
    """Store the angles at the start of a step."""
    for i in range(system.relations.coordinates.shape[0]):
        system.relations.coordinates[i].begun = system.relations.coordinates[i].reference


@kernel
def forget_turns(system):
    """Restore the angles at the start of the step."""
    for i in range(system.relations.coordinates.shape[0]):
        system.relations.coordinates[i].reference = system.relations.coordinates[i].begun


@unit(where=has_relations, otherwise=False)
def turns_round(system, start, end, h) -> bool:
    """Return whether an angle may turn so far in a step that its whole turns are not known.

    That of a point on a curve is how far its direction may turn, so that its foot is found; above a rail that
    can be left, the point may reach it (its gap is that at the end).
    """
    for i in range(system.relations.coordinates.shape[0]):
        c = system.relations.coordinates[i]
        if c.kind == PRISMATIC:
            continue
        if c.kind >= OF_BALL:  # the angles of a ball joint may turn back within a step
            turn = h * max(speed_of_turn(c, start), speed_of_turn(c, end))
        else:
            turn = h * max(abs(rate(system, c, start)), abs(rate(system, c, end)))
        if is_on_curve(c):
            one = system.relations.curves[c.number]
            if can_be_left(one):
                travel = h * max(speed_beside(c, start), speed_beside(c, end))
                far = travel < one.gap[1] and not is_upright(
                    system.relations.curve_pieces[one.first]
                )
                turn = 0.0 if far else ROTATION / RAIL_TRAVEL * travel
            turn *= one.sharpest
        if not turn <= ROTATION:
            return True
    return False
