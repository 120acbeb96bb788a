"""A group as one contact problem: Coulomb's cones at the velocity after (mathematics page, §2.6).

If all e are 0 this is the plastic event. If the passage of the layer fails or does not end, each contact obeys
Newton's law, 0 <= p_n _|_ u_n+ + e u_n- >= 0 (Moreau 1988). There is no path, so the order in which contacts
load and slip is lost. It is the limit of the passage if masses are far apart, because light bodies then stay in
equilibrium between the slow contacts of heavy ones. If there is no such velocity (a body trapped between two
walls), or if the energy would rise, the least e is used for all contacts, and then e = 0, which always has a
solution and never raises the energy.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.layout import CONE, ENOUGH, SOLVED
from carom.friction.solve import solve_cones
from carom.friction.strategy import allow
from carom.impact.layout import AT_ONCE, PLASTIC
from carom.impact.multiple import layout as o
from carom.impact.multiple.layer import set_velocity, start

_ROUNDS = 4
# greatest approach that Newton's law may leave, in units of the speed before, and growth of energy by sum |p u|
_LEFT, _GROWTH = 1e-6, 1e-9
_ROUND_OFF = 1e-14


@unit
def solve_group(k, work):
    """Resolve the group; the clock gets its marks and the change of energy in a plastic event."""
    clock, vector, W, least, most = work.clock[0], work.vector, work.matrix[o.MASS], 1.0, 0.0
    for i in range(k):
        least = min(least, work.contact[i].restitution)
        most = max(most, work.contact[i].restitution)
    clock.change = 0.0
    for turn in range(2 if most > 0.0 else 0):
        start(k, work)
        for i in range(k):
            work.contact[i].e = work.contact[i].restitution if turn == 0 else least
        _once(k, work, 0)
        if sound(W, vector[o.U0], vector[o.NOW_U], vector[o.NOW_P], 1.0, (3 * k, _LEFT, _GROWTH)):
            clock.code = AT_ONCE if turn == 0 else AT_ONCE | o.MISSED
            return
    start(k, work)
    for i in range(k):
        work.contact[i].e = 0.0
    clock.code = PLASTIC
    for turn in range(_ROUNDS):
        clock.change += _once(k, work, turn)
        least = 0.0
        for i in range(k):
            least = min(least, vector[o.NOW_U, 3 * i])
        if least >= -1e-10:
            break


@kernel
def sound(W, before, after, impulse, scale, limits):
    """Return whether a result is possible: energy does not grow and no contact approaches, beyond round-off.

    `before` and `after` are velocities, `scale` their unit, and `limits` the number of rows, the greatest
    approach that is left, and the greatest growth of energy by the sum of |impulse|.
    """
    n, left, growth = limits
    gain, allowed, approach = 0.0, 0.0, 0.0
    for a in range(n):
        own = round_off(n, W[a], impulse)
        gain += 0.5 * impulse[a] * (before[a] + after[a])
        allowed += abs(impulse[a]) * (growth * scale + own)
        if a % 3 == 0:
            approach = max(approach, -after[a] - own)
    return math.isfinite(gain) and gain <= allowed and approach <= left * scale


@kernel
def round_off(n, row, impulse):
    """Return the round-off of the product of a row of W with n impulses.

    It is visible if a light body is between heavy ones, whose great impulses nearly cancel on it.
    """
    total = 0.0
    for b in range(n):
        total += abs(row[b] * impulse[b])
    return _ROUND_OFF * total


@kernel
def _once(k, work, turn):
    """Solve the contact problem once; from the third turn on without friction. Return the change of energy."""
    n, u, before, impulse = 3 * k, work.vector[o.NOW_U], work.vector[o.SCRATCH], work.vector[o.TRY]
    for i in range(n):
        before[i] = u[i]
        impulse[i] = 0.0
    mu, kind = work.vector[o.WEIGHT], work.index[o.STACK]
    for i in range(k):
        u[3 * i] += work.contact[i].e * min(0.0, u[3 * i])
        mu[i] = work.contact[i].mu if turn < 2 else 0.0
        kind[i] = CONE
    heading = work.matrix[o.FACTOR]  # cones do not use it, but it must be finite
    for i in range(k):
        heading[i, 0], heading[i, 1] = 0.0, 0.0
    work.cones.mismatch[ENOUGH] = 0.0
    allow(work.cones, k)
    status, _, _ = solve_cones(k, work.matrix[o.MASS], u, mu, kind, heading, impulse, work.cones)
    change = _take(k, work, status == SOLVED)
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
def _take(k, work, solved):
    """Add the impulse P, or if it is no solution and adds energy its part with the least; return the change.

    The energy of a part s is s P.u + s^2 P.W P/2, with u before.
    """
    before, impulse, slope, curve, part = work.vector[o.SCRATCH], work.vector[o.TRY], 0.0, 0.0, 1.0
    _add(k, work, 1.0)
    for i in range(3 * k):
        slope += impulse[i] * before[i]
        curve += impulse[i] * (work.vector[o.NOW_U, i] - before[i])
    if not solved and slope + 0.5 * curve > 0.0:
        part = min(1.0, max(0.0, -slope / curve)) if curve > 0.0 else 0.0
        _add(k, work, part - 1.0)
        for i in range(3 * k):
            impulse[i] *= part
    return part * (slope + 0.5 * part * curve)


@kernel
def _add(k, work, part):
    """Add a part of the impulse."""
    for i in range(3 * k):
        work.vector[o.NOW_P, i] += part * work.vector[o.TRY, i]
    set_velocity(k, work)
