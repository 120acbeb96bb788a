"""Pieces of a step: the islands of a run with tolerances are found anew while several groups share one.

All groups of an island take steps of one length, and a search for an event cuts the steps of all. Bodies that
could meet within the time between two saved states are one island, though they hardly do so in a part of it. So
the next piece is half as long after one in which an island of several groups took many trial steps, and twice
as long after one in which none took more than a few: at most the whole step.
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.geometry.thresholds import ROUND_OFF
from carom.stepping.grid import begin_and_length

BUSY_TRIALS, CALM_TRIALS = 6, 2  # trial steps of an island of several groups in a piece


@inlined
def piece_of(grid, controls, clock, islands):
    """Return the beginning and the length of the next piece of the present step."""
    begin, length = begin_and_length(grid, controls.duration, clock.step)
    if islands.apart == 0 or controls.order == 0:
        return begin, length
    plan = islands.plan[0]
    left = length - plan.done
    if not 0.0 < plan.piece < (1.0 - ROUND_OFF) * left:
        return begin + plan.done, left
    return begin + plan.done, 0.5 * left if 2.0 * plan.piece > left else plan.piece


@inlined
def end_piece(grid, controls, clock, length, islands):
    """Note the end of a piece, and how long the next one is; return whether the step has ended."""
    if islands.apart == 0:
        return True
    _, whole = begin_and_length(grid, controls.duration, clock.step)
    plan = islands.plan[0]
    plan.pieces += 1
    if plan.busy >= BUSY_TRIALS:
        plan.piece = 0.5 * length
    elif plan.busy <= CALM_TRIALS:
        plan.piece = 2.0 * length
    plan.done += length
    if plan.done < (1.0 - ROUND_OFF) * whole:
        return False
    plan.done = 0.0
    return True


@kernel
def wanted_trials(clock):
    """Return the number of trial steps so far that are not halves of others.

    Bodies that hardly part are unsure to have touched, whatever shares their island: steps are halved, and the
    next one is, too.
    """
    return clock.trials - 2 * clock.cuts


@kernel
def note_busy(clock, active, work, plan):
    """Note how many trial steps an island took if several of its groups move."""
    first = -1
    for i in range(active.count[0]):
        label = work.body[active.points[i].body].label
        if active.points[i].rest == 0 and label != first:
            if first >= 0:
                plan.busy = max(plan.busy, wanted_trials(clock) - plan.trials)
                return
            first = label
