"""Limits of the work of a step: in trial steps with tolerances, otherwise in about [us] for contacts.

With tolerances a limit must not depend on the saved times. A run may use TRIALS trial steps for each part
1 / PARTS of its duration. Those that it has not used are saved for later, at most those of SAVED_PARTS parts.
WORK of a contact problem or of a multiple impact counts as one trial step. An accepted step without an event,
of the length that the tolerance permits, counts only SMOOTH.

With a given step the limit is a time per step; time that is not used is saved for later steps.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

EACH, SAVED = 1e4, 3e5  # limits of the average step, and of a step after others that took less
STEPS = 200.0  # of a run, if it has fewer: where few states are saved a step takes more work
# with tolerances: trial steps of a part of the run, parts of a run, parts that may be saved for later, weight
# of a step that the tolerance ended, work [us] that counts as a trial step
TRIALS, PARTS, SAVED_PARTS, SMOOTH, WORK = 1e3, 1e2, 10.0, 0.1, 20.0


@kernel
def affordable(controls, clock):
    """Return the limit of the work of a step; with `retry`, a step that needs more is given up."""
    if controls.retry == 0:
        return SAVED
    if controls.order > 0:
        most = SAVED_PARTS * TRIALS + refilled(controls, clock.spent)
        return WORK * (most - clock.counted)
    return affordable_whole(controls, clock)


@kernel
def affordable_whole(controls, clock):
    """Return the limit of the work of a time-stepping step."""
    return max(of_step(controls), clock.credit) if controls.retry == 1 else SAVED


@kernel
def of_step(controls):
    """Return the limit of the average step."""
    return EACH * max(1.0, STEPS * controls.interval / controls.duration)


@kernel
def refilled(controls, t):
    """Return the number of trial steps that a run with tolerances may use in the time t."""
    return TRIALS * PARTS * t / controls.duration


@kernel
def counted(clock):
    """Return the number of trial steps that an island has used, with the work of its contact problems."""
    return clock.counted + clock.effort / WORK
