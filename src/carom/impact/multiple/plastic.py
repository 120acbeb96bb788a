"""The plastic event: Coulomb's cones at the velocity after (mathematics page, §2.6).

It is used if all e are 0, and to end an event that does not end by itself (a body trapped between two walls).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.layout import CONE, ENOUGH, SOLVED
from carom.friction.solve import solve_cones
from carom.friction.strategy import allow
from carom.impact.multiple import law
from carom.impact.multiple.layout import FACTOR, MASS, SCRATCH, STACK, TRY, WEIGHT, D, P, U
from carom.impact.multiple.motion import set_velocity

_ROUNDS = 4


@kernel
def plastic_event(k, work, cones, p):
    """End the event plastically from the present velocities; return the change of energy (scaled)."""
    for i in range(k):
        law.abandon(work.contact[i], work.vector[D, i], p)
    set_velocity(k, work)
    total = 0.0
    for turn in range(_ROUNDS):
        change = _once(k, work, cones, turn)
        total += change
        least = 0.0
        for i in range(k):
            least = min(least, work.vector[U, 3 * i])
        if least >= -1e-10:
            break
    return total


@unit
def end_plastically(k, work, cones, p):
    """End the event plastically; the clock gets the change of energy."""
    work.clock[0].change = plastic_event(k, work, cones, p)


@kernel
def _once(k, work, cones, turn):
    """Solve the contact problem once; from the third turn on without friction."""
    n, u, before, impulse = 3 * k, work.vector[U], work.vector[SCRATCH], work.vector[TRY]
    for i in range(n):
        before[i] = u[i]
        impulse[i] = 0.0
    mu, kind = work.vector[WEIGHT], work.index[STACK]
    for i in range(k):
        mu[i] = work.contact[i].mu if turn < 2 else 0.0
        kind[i] = CONE
    heading = work.matrix[FACTOR]  # cones do not use it, but it must be finite
    for i in range(k):
        heading[i, 0], heading[i, 1] = 0.0, 0.0
    cones.mismatch[ENOUGH] = 0.0
    allow(cones, k)
    status, _, _ = solve_cones(k, work.matrix[MASS], before, mu, kind, heading, impulse, cones)
    change = _take(k, work, 1.0)
    if status != SOLVED and change > 0.0:  # take the part of the impulse with the least energy
        part = _best_part(k, work, before, impulse)
        _take(k, work, part - 1.0)
        change = _change(k, work, before, impulse, part)
    for i in range(k):
        c = work.contact[i]
        a = 3 * i
        part_n = 0.5 * impulse[a] * (before[a] + u[a])
        if part_n < 0.0:
            c.absorbed -= part_n
        else:
            c.returned += part_n
        loss = impulse[a + 1] * (before[a + 1] + u[a + 1])
        loss += impulse[a + 2] * (before[a + 2] + u[a + 2])
        c.loss += max(0.0, -0.5 * loss)
    return change


@kernel
def _take(k, work, part):
    """Add a part of the impulse; return the change of energy, which is correct for the whole impulse."""
    impulse = work.vector[TRY]
    for i in range(3 * k):
        work.vector[P, i] += part * impulse[i]
    set_velocity(k, work)
    return _change(k, work, work.vector[SCRATCH], impulse, 1.0)


@kernel
def _change(k, work, before, impulse, part):
    total, u = 0.0, work.vector[U]
    for i in range(3 * k):
        total += part * impulse[i] * 0.5 * (before[i] + u[i])
    return total


@kernel
def _best_part(k, work, before, impulse):
    """Return the s in [0, 1] that minimizes the energy s P.u + s^2 P.W P / 2."""
    slope, curve, u = 0.0, 0.0, work.vector[U]
    for i in range(3 * k):
        slope += impulse[i] * before[i]
        curve += impulse[i] * (u[i] - before[i])
    return min(1.0, max(0.0, -slope / curve)) if curve > 0.0 else 0.0
