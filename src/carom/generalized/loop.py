"""The compiled loop: it takes steps until an event, which Python code handles.

With tolerances the estimate of the error of a step is that for bodies (`carom.dynamics.adapt`), where each
coordinate has the size 1 in its own unit. With e_q, e_v = h times the sum of E_s times the derivatives of the
stages, the error of coordinate i is

    miss_i = max(|e_q|, T |e_v|),     T = 1 / max(|v_i|, sqrt |a_i|),

and a step is accepted if miss_i <= LOCAL (atol + rtol max(1, h |v_i|)) for all of them. An acceleration is
known to the round-off of its terms, which is no error: a coordinate that a contact holds has no other, and T
grows like the root of its inverse.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.dynamics.adapt import (
    MISS_OF_OTHERS,
    allowed_error,
    crawls,
    of_kinks,
    of_two,
    part_of,
    shrunk,
)
from carom.dynamics.adapt import plan as plan_ahead
from carom.dynamics.thresholds import LEAST_STEP
from carom.generalized import layout as o
from carom.generalized.events import locate
from carom.generalized.linear import copy_row, dot
from carom.generalized.motion import evaluate, find_metric, kinetic_energy
from carom.generalized.step import take
from carom.generalized.thresholds import LEFT_OF_STEP, REVERSAL, SHORTEST_GIVEN, SLIP_TURN
from carom.geometry.thresholds import SUM_ERROR
from carom.law.friction import bound_of_stick
from carom.model import actions as a
from carom.model.records import PAUSE
from carom.status import STEP_TOO_SMALL, SUCCESS
from carom.stepping.energy_balance import note_exchanged
from carom.stepping.grid import end_of, is_saved

LONG = 20_000  # trial steps, times the square of the number of coordinates, after which the loop pauses


@entry
def time_loop(motion, x, plan, until, record):
    """Continue to step number `until`; return SUCCESS, o.EVENT (the clock has its kind) or a status of failure.

    Return PAUSE after much work, so that Ctrl-C is noticed.
    """
    system, work = motion.system, motion.work
    c = record.clock[0]
    most = c.trials + LONG // (system.n * system.n) + 1
    while c.step < until:
        if c.trials > most:
            return PAUSE
        target = end_of(plan.grid, plan.duration, c.step + 1)
        left = target - c.now
        if left > LEFT_OF_STEP * plan.step:
            part, code = take_accurately(motion, x, left, plan, c)
            if code != 0:
                return code
            s, kind, index, code = locate(motion, c.now, x, part)
            if code != 0:
                return code
            copy_row(work.end, x, x.size)
            c.loads += work.spent[0]
            c.friction += work.spent[1]
            note_exchanged(c, work.spent[2])
            if kind != a.NO_EVENT:
                c.now += s
                c.kind, c.index = kind, index
                return o.EVENT
            if part < left:
                c.now += part
                continue
        c.now = target
        c.step += 1
        if is_saved(plan.grid, c.step):
            save(system, x, record, work)
    return SUCCESS


@kernel
def take_accurately(motion, x, left, plan, c):
    """Take a step whose estimated error is within the tolerances; without these, one in which no slip turns.

    Return its length and a status.
    """
    part, again = left if plan.order == 0 else part_of(left, c.ahead), False
    while True:
        code = take(motion, c.now, x, part)
        c.trials += 1
        if plan.order == 0:
            if code != 0 or part <= SHORTEST_GIVEN * plan.step or not turns(motion):
                return part, code
            part *= 0.5
            continue
        if crawls(c, plan.duration - c.now, part, plan.step):
            return part, STEP_TOO_SMALL
        error = math.inf if code != 0 else step_error(motion, part, plan, c)
        if error <= 1.0:
            plan_ahead(c, part, error, again, plan.order, plan.step)
            return part, 0
        if not part > LEAST_STEP * plan.duration:
            return part, code if code != 0 else STEP_TOO_SMALL
        again = True
        c.rejected += 1
        part *= shrunk(error, plan.order)


@kernel
def turns(motion):
    """Return whether a slip turns by more than an angle in the step that was taken, and does not only stop.

    The slips are those of the velocities of all stages, in the rows at the end: where friction turns a slow
    slip faster than the step follows, that of a stage is far off.
    """
    active, work, n = motion.active, motion.work, motion.system.n
    for c in range(motion.system.contacts):
        if active[c].mode != a.MODE_SLIP or not bound_of_stick(motion.system.laws, c) > 0.0:
            continue
        e1, e2 = active[c].heading[0], active[c].heading[1]
        for s in range(1, motion.method.b.size + 1):
            v = work.stages[s] if s < motion.method.b.size else work.end[n:]
            u1, u2 = dot(work.G[c, 1], v, n), dot(work.G[c, 2], v, n)
            along, across = u1 * e1 + u2 * e2, abs(u1 * e2 - u2 * e1)
            if across > (SLIP_TURN * along if along > 0.0 else REVERSAL * abs(along)):
                return True
    return False


@kernel
def step_error(motion, h, plan, clock):
    """Return the greatest error of the step h whose stages are in the workspace; up to 1 it is accepted."""
    E, stages, n = motion.method.E, motion.work.stages, motion.system.n
    first, second, most = 0.0, 0.0, 0.0
    for i in range(n):
        pace, speed, known = 0.0, 0.0, SUM_ERROR * motion.work.sum[i]
        for s in range(E.shape[1]):
            speed = max(speed, abs(stages[s, i]))
            pace = max(pace, math.sqrt(max(0.0, abs(stages[s, n + i]) - known)))
        pace = max(pace, speed)
        T = 1.0 / pace if pace > 0.0 else 0.0
        allowed = allowed_error(plan.rtol, plan.atol, 1.0, h * speed)
        for e in range(E.shape[0]):
            q, v = dot(E[e], stages[:, i], E.shape[1]), dot(E[e], stages[:, n + i], E.shape[1])
            miss = h * max(abs(q), T * max(0.0, abs(v) - known)) / allowed
            if e == 0 and not miss <= first and first == first:
                first = miss
            if e == 1:
                second = max(second, miss)
            else:
                most = max(most, miss)
    error = of_two(first, second)
    return of_kinks(clock, error, most, second) if E.shape[0] > MISS_OF_OTHERS else error


@kernel
def save(system, x, record, work):
    """Write the state and its energies into the next row."""
    clock = record.clock[0]
    find_metric(system, clock.now, x, work)
    evaluate(system, o.CALL_LOADS, clock.now, x, work.loads, work)
    clock.kinetic, clock.potential = kinetic_energy(system, x, work), work.loads[0]
    note_exchanged(clock, clock.kinetic)
    record.series[clock.saved] = clock
    copy_row(x, record.states[clock.saved], x.size)
    clock.saved += 1


@entry
def save_now(system, x, record, work):
    """Write the state and its energies as `save` does, for Python: at the start, and after a failure."""
    save(system, x, record, work)
