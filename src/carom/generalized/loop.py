"""The compiled loop: steps until one has an event, which Python code handles."""

from __future__ import annotations

from carom._compiled.decorators import entry, kernel
from carom._compiled.user_functions import call_function
from carom.generalized.events import locate, note_start, turned
from carom.generalized.layout import DONE, EVENT, LOADS, NOTHING, PAUSE, TOUCHES, N
from carom.generalized.motion import copy_row, find_metric
from carom.generalized.step import take
from carom.stepping.grid import end_of, is_saved

CUTS = 12  # most halvings of a step in which slip turns
LONG = 20_000  # trial steps, times the square of the coordinates, after which the loop is left for a moment


@entry
def time_loop(motion, x, plan, until, record):
    """Continue to step number `until`; return DONE, EVENT (the clock has its kind) or a status of failure.

    Return PAUSE after much work, so that Ctrl-C is noticed.
    """
    system, work = motion.system, motion.work
    c = record.clock[0]
    most = c.trials + LONG // (system.size[N] * system.size[N]) + 1
    while c.step < until:
        if c.trials > most:
            return PAUSE
        target = end_of(plan.grid, plan.duration, c.step + 1)
        left = target - c.now
        if left > 1e-13 * plan.step:
            note_start(system, c.now, x, work)
            part, code = first_part(motion, x, left, c)
            if code != 0:
                return code
            s, kind, index, code = locate(motion, c.now, x, part)
            if code != 0:
                return code
            copy_row(work.end, x, x.size)
            c.loads += work.spent[0]
            c.friction += work.spent[1]
            if kind != NOTHING:
                c.now += s
                c.kind, c.index = kind, index
                return EVENT
            if part < left:
                c.now += part
                continue
        c.now = target
        c.step += 1
        if is_saved(plan.grid, c.step):
            save(x, record)
    return DONE


@kernel
def first_part(motion, x, left, c):
    """Take a step, halved until slip does not turn in it; return (its length, status)."""
    part, work = left, motion.work
    for cut in range(CUTS):
        code = take(motion, c.now, x, part)
        if code != 0:
            return part, code
        c.trials += 1
        if cut + 1 == CUTS or not turned(
            motion.system, motion.active, c.now + part, work.end, work
        ):
            break
        part *= 0.5
    return part, 0


@kernel
def save(x, record):
    """Write the state into the next row."""
    clock = record.clock[0]
    row = record.series[clock.saved]
    row.t, row.loads, row.impacts = clock.now, clock.loads, clock.impacts
    row.friction, row.bounces = clock.friction, clock.bounces
    copy_row(x, record.states[clock.saved], x.size)
    clock.saved += 1


@entry
def save_now(x, record):
    """`save`, for Python: at the start, and after a failure."""
    save(x, record)


@entry
def energies(system, t, states, kinetic, potential, work):
    """Write kinetic and potential energy of the states (T, 2n)."""
    n = system.size[N]
    for k in range(t.size):
        find_metric(system, t[k], states[k], work)
        total = 0.0
        for i in range(n):
            for j in range(n):
                total += work.M[i, j] * states[k, n + i] * states[k, n + j]
        kinetic[k] = 0.5 * total
        call_function(system.address[LOADS], t[k], states[k], work.loads)
        potential[k] = work.loads[0]
    return system.size[TOUCHES]
