"""Relations of coordinates, sum of c_k q_k = f(t): gears, couplers, screws of any joints, motors.

A relation is one holonomic row, rheonomic if f changes. With the row J_k of coordinate k and its drift d_k,

    error  sum c_k q_k - f,     rate  sum c_k q_k' - f',     sum c_k J_k a = f'' - sum c_k d_k.
"""

from __future__ import annotations

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom.dynamics.curve import curve
from carom.kinematics.coordinate import add_rows, drift, push, rate, value
from carom.kinematics.rows import mass_row


@kernel
def prescribed(relations, relation, t):
    """Return f, f' and f'' at the time t."""
    if relation.address != 0:
        relations.read[0] = t
        call_function(relation.address, t, relations.read, relations.write)
        return relations.write[0], relations.write[1], relations.write[2]
    if relation.last_piece > relation.piece:
        return curve(relations.pieces, relation.piece, relation.last_piece, t)
    return relation.constant + relation.rate * t, relation.rate, 0.0


@kernel
def relation_rows(system, j, state, work):
    """Write A and A M^-1 of a relation."""
    number, solver = system.joints[j].number, system.solver
    relation = system.relations.relations[number]
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


@kernel
def relation_error(system, relation, state, t):
    """Return the error of the coordinates, sum c_k q_k - f."""
    total = -prescribed(system.relations, relation, t)[0]
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        total += term.factor * value(system, system.relations.coordinates[term.coordinate], state)
    return total


@kernel
def relation_speed(system, relation, state, t):
    """Return the error of the rates, sum c_k q_k' - f'."""
    total = -prescribed(system.relations, relation, t)[1]
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        total += term.factor * rate(system, system.relations.coordinates[term.coordinate], state)
    return total


@kernel
def relation_bias(system, relation, state, t, out):
    """Return the required value of the row times the accelerations; `out` is workspace (6,)."""
    total = prescribed(system.relations, relation, t)[2]
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        c = system.relations.coordinates[term.coordinate]
        total -= term.factor * drift(system, c, state, out)
    return total


@kernel
def push_relation(system, relation, state, force, work):
    """Add the wrenches of a multiplier of the row."""
    for i in range(relation.first, relation.last):
        term = system.relations.terms[i]
        c = system.relations.coordinates[term.coordinate]
        push(system, c, state, force * term.factor, work)
