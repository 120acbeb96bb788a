"""Work of motors in an impact, and contacts that prescribed motions block.

Where rows prescribe a speed, a v = b, their impulses Lambda do work, Lambda . b with b = a v before the impact:

    M (v+ - v-) = G^T Pi + a^T Lambda,     Lambda . b = v- . M (v+ - v-) - u- . Pi.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.rotors import work_of_change
from carom.geometry.rotation import rotate_back
from carom.impact.thresholds import IMPACT_ERROR
from carom.model.arrays import LOOPS
from carom.model.parts_of_system import has_relation_rows


@unit(where=has_relation_rows, otherwise=0.0)
def driven_work(system, state, first, clock, records, work) -> float:
    """Return the work of motors in the impact that is being written; its rows begin at `first`."""
    total = 0.0
    for b in range(state.shape[0]):
        before, body, q = records.snapshot[clock.snapped + b], system.bodies[b], state[b].Q
        v0, w0, v, w = before.v0, before.w0, state[b].v, state[b].w
        motion = work.body[b].motion
        s = rotate_back(q, w0)
        d = rotate_back(q, (w[0] - w0[0], w[1] - w0[1], w[2] - w0[2]))
        for k in range(3):
            total += body.mass * v0[k] * (v[k] - v0[k]) + body.inertia[k] * s[k] * d[k]
            motion[k], motion[3 + k] = v0[k], w0[k]
    total += work_of_change(system, state, work)
    for i in range(first, clock.struck):
        row = records.impact[i]
        for k in range(3):
            total -= row.before[k] * row.impulse[k]
    return total


@kernel
def blocked(system, point, inverse_mass):
    """Return whether prescribed motions block a point along its normal: W_nn is round-off of 1/m."""
    if not (system.relations.there == 1 and system.solver.kind == LOOPS):
        return False
    return inverse_mass <= IMPACT_ERROR * free_inverse_mass(system, point)


@kernel
def free_inverse_mass(system, point):
    """Return 1/m of the two bodies of a point, as if neither had joints."""
    free = 1.0 / system.bodies[point.a].mass
    if point.b >= 0:
        free += 1.0 / system.bodies[point.b].mass
    return free
