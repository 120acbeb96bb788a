"""A group as one contact problem: Coulomb's cones at the velocity after (mathematics page, §2.6).

If all e are 0 this is the plastic event. If the passage of the layer fails or does not end, each contact obeys
Newton's law, 0 <= p_n _|_ u_n+ + e u_n- >= 0 (Moreau 1988). There is no path, so the order in which contacts
load and slip is lost. It is the limit of the passage if masses are far apart, because light bodies then stay in
equilibrium between the slow contacts of heavy ones. If there is no such velocity (a body trapped between two
walls), or if the energy would rise, the least e is used for all contacts, and then e = 0. Where that is not
solved either, there is no friction: this problem always has a solution, which never raises the energy.

A coefficient that depends on the slip is that of the velocity after, like the cone, by iteration from the one
that bounds stick: what that holds sticks.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.layout import BUDGET, CONE, ENOUGH
from carom.friction.solve import solve_cones
from carom.friction.strategy import budget
from carom.geometry.thresholds import SUM_ERROR
from carom.impact.layout import AT_ONCE, PLASTIC
from carom.impact.multiple import layout as o
from carom.impact.multiple.layer import set_velocity, start
from carom.impact.multiple.slip_law import MOST_TURNS, by_law, by_secant, in_slip, slip_of
from carom.impact.thresholds import FREE_GAIN, GAIN, VELOCITY_LEFT, VISIBLE_ERROR, WEDGED_PART

#: in turn: each contact with its own e, all with the least, none with any, and then without friction
OWN_E, LEAST_E, NO_E, NO_FRICTION = range(4)


@unit
def solve_group(k, work, passage) -> tuple[int, float]:
    """Resolve the group; return its marks, and the change of energy in a plastic event."""
    least, most, growth = 1.0, 0.0, FREE_GAIN if passage.may_gain else GAIN
    marks, change = PLASTIC, 0.0
    for i in range(k):
        least = min(least, work.contact[i].restitution)
        most = max(most, work.contact[i].restitution)
    for tried in range(OWN_E if most > 0.0 else NO_E, NO_FRICTION + 1):
        start(k, work)
        for i in range(k):
            c = work.contact[i]
            c.e = c.restitution if tried == OWN_E else least if tried == LEAST_E else 0.0
        change, residual = _once(k, work, passage, tried == NO_FRICTION)
        marks = AT_ONCE if tried == OWN_E else AT_ONCE | o.MISSED if tried == LEAST_E else PLASTIC
        before, after, impulse = work.before, work.now.velocity, work.now.impulse
        solved = residual <= VISIBLE_ERROR and bounded(3 * k, before, after, impulse)
        if solved and sound(work.W, before, after, impulse, 1.0, (3 * k, VELOCITY_LEFT, growth)):
            break
    return marks, change if marks & PLASTIC != 0 else 0.0


@kernel
def sound(W, before, after, impulse, scale, limits):
    """Return whether a result is possible: energy does not grow and no contact approaches, beyond round-off.

    `before` and `after` are velocities, `scale` their unit, and `limits` the number of rows, the greatest
    approach that is left, and the greatest growth of energy by the sum of |impulse| `scale`.
    """
    n, left, growth = limits
    gain, allowed, approach = 0.0, 0.0, 0.0
    for a in range(n):
        own = min(VISIBLE_ERROR * scale, round_off(n, W[a], impulse))
        gain += 0.5 * impulse[a] * (before[a] + after[a])
        allowed += abs(impulse[a]) * (growth * scale + own)
        if a % 3 == 0:
            approach = max(approach, -after[a] - own)
    return math.isfinite(gain) and gain <= allowed and approach <= left * scale


@kernel
def bounded(n, before, after, impulse):
    """Return whether normal impulses are of the size of the change that they bring about.

    If friction wedges contacts against each other, their cones have impulses with W P = 0, and Newton's law may
    have no solution: what solvers find grows along these, while P.(u+ - u-) = P.W P does not.
    """
    push, change = 0.0, 0.0
    for a in range(n):
        change += impulse[a] * (after[a] - before[a])
        if a % 3 == 0:
            push += abs(impulse[a]) * (abs(before[a]) + abs(after[a]))
    return push <= WEDGED_PART * change


@kernel
def round_off(n, row, impulse):
    """Return the round-off of the product of a row of W with n impulses.

    It is visible if a light body is between heavy ones, whose great impulses nearly cancel on it.
    """
    total = 0.0
    for b in range(n):
        total += abs(row[b] * impulse[b])
    return SUM_ERROR * total


@kernel
def _mu_changes(k, work, passage, u):
    """Improve mu for the slip after, where there is any; return whether it has missed that."""
    misses, mu = False, work.problem.mu
    for i in range(k):
        c, slip = work.contact[i], slip_of(u, i)
        if by_law(c) and (slip > VELOCITY_LEFT or mu[i] > c.mu):
            miss = in_slip(c, passage, slip) - mu[i]
            misses = misses or abs(miss) > GAIN
            mu[i] = by_secant(c, mu[i], miss)
    return misses


@kernel
def _once(k, work, passage, smooth):
    """Solve the contact problem, `smooth` without friction; return the change of energy and the residual."""
    problem, total, residual = work.problem, 0.0, math.inf
    before, u, impulse = work.before, work.now.velocity, work.now.impulse
    bias, mu, heading = problem.c, problem.mu, problem.heading
    for i in range(3 * k):
        bias[i] = before[i]
    for i in range(k):
        bias[3 * i] += work.contact[i].e * min(0.0, bias[3 * i])
        mu[i] = 0.0 if smooth else work.contact[i].mu
        work.contact[i].mu_before = mu[i]
        problem.kind[i], heading[i, 0], heading[i, 1] = CONE, 0.0, 0.0
    work.cones.mismatch[ENOUGH] = 0.0
    work.cones.count[BUDGET] = budget(k)
    for _ in range(MOST_TURNS):
        _, residual, _ = solve_cones(k, problem, impulse, work.cones)
        set_velocity(k, work)
        if smooth or not passage.by_slip or not _mu_changes(k, work, passage, u):
            break
    for i in range(k):
        c, a = work.contact[i], 3 * i
        normal = 0.5 * impulse[a] * (before[a] + u[a])
        rub = impulse[a + 1] * (before[a + 1] + u[a + 1])
        rub += impulse[a + 2] * (before[a + 2] + u[a + 2])
        c.sticks = o.HAS_STUCK if math.hypot(u[a + 1], u[a + 2]) <= VELOCITY_LEFT else 0
        c.absorbed, c.returned = max(0.0, -normal), max(0.0, normal)
        c.loss = max(0.0, -0.5 * rub)
        total += normal + 0.5 * rub
    return total, residual
