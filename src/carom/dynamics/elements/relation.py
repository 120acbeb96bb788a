"""Relations of coordinates, sum of c_k q_k = f(t): gears, couplers, screws of any joints, motors.

A relation is one holonomic row, rheonomic if f changes. With the row J_k of coordinate k and its drift d_k,

    error  sum c_k q_k - f,     rate  sum c_k q_k' - f',     sum c_k J_k a = f'' - sum c_k d_k.
"""

from __future__ import annotations

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.curve import curve
from carom.dynamics.elements.own_rows import clear
from carom.kinematics.coordinate import add_rows, drift, push, rate, value
from carom.kinematics.rows import mass_row


@kernel
def prescribed(relations, relation, t):
    """Return f, f' and f'' at the time t."""
    if relation.address != 0:
        relations.memory.read[0] = t
        call_function(relation.address, t, relations.memory.read, relations.memory.write)
        return relations.memory.write[0], relations.memory.write[1], relations.memory.write[2]
    if relation.last_piece > relation.piece:
        return curve(relations.pieces, relation.piece, relation.last_piece, t)
    return relation.constant + relation.rate * t, relation.rate, 0.0


@kernel
def of_joint(system, j):
    """Return the relation of an element."""
    return system.relations.relations[system.joints[j].number]


@unit
def write_rows(system, j, state, work):
    """Write A and A M^-1 of a relation."""
    relation, solver = of_joint(system, j), system.solver
    for s in range(solver.rows[j].first, solver.rows[j].last):
        for k in range(6):
            solver.sides[s].A[0, k] = 0.0
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        c = system.relations.coordinates[term.coordinate]
        child = solver.sides[max(0, term.child_side)].A
        add_rows(system, c, state, term.factor, child, solver.sides[max(0, term.parent_side)].A)
    for s in range(solver.rows[j].first, solver.rows[j].last):
        mass_row(system, solver.sides[s], 0, work)


@unit
def position_error(system, j, state, work):
    """Write the error of the coordinates, sum c_k q_k - f, to the bias."""
    relation = of_joint(system, j)
    total = -prescribed(system.relations, relation, work.moment[0].time)[0]
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        total += term.factor * value(system, system.relations.coordinates[term.coordinate], state)
    clear(work.joint[j].bias)
    work.joint[j].bias[0] = total


@unit
def velocity_error(system, j, state, work):
    """Write the error of the rates, sum c_k q_k' - f', to the bias."""
    relation = of_joint(system, j)
    total = -prescribed(system.relations, relation, work.moment[0].time)[1]
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        total += term.factor * rate(system, system.relations.coordinates[term.coordinate], state)
    clear(work.joint[j].bias)
    work.joint[j].bias[0] = total


@unit
def acceleration_bias(system, j, state, work):
    """Write the required value of the row times the accelerations."""
    relation = of_joint(system, j)
    total = prescribed(system.relations, relation, work.moment[0].time)[2]
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        c = system.relations.coordinates[term.coordinate]
        total -= term.factor * drift(system, c, state, work.joint[j].target)
    work.joint[j].bias[0] = total


@unit
def prescribed_speeds(system, j, state, work, out):
    """Write f' as the first of six numbers."""
    clear(out)
    out[0] = prescribed(system.relations, of_joint(system, j), work.moment[0].time)[1]


@unit
def add_wrenches(system, j, state, multiplier, work):
    """Add the wrenches of a multiplier of the row."""
    relation = of_joint(system, j)
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        c = system.relations.coordinates[term.coordinate]
        push(system, c, state, multiplier[0] * term.factor, work)
