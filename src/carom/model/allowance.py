"""Bounds of the work of an island. Work is counted, never timed, so a run is the same on every machine.

Each island counts four kinds of work (`COUNTS`). In each part of a run it may use so much of each as `PART`
says; what it has not used is saved, at most for `SAVED` parts. A part is a step of given length, but at least
1 / PARTS of the duration, because where few states are saved a step takes more work. With tolerances it is
1 / PARTS of the duration, because a limit must not depend on the saved times; trial steps of a chosen length
are more than those of given length.

An island that has used more of the first three gives its step up, and moves as a crowd
(`stepping.time_loop`). The last gives no step up: it says whether the step of a crowd may be cut, or its
contact problem be solved with patience.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

#: trial steps; searches for nearest points of two solids; products of factors of W of persistent contact, in
#: units of which a full one has the cube of the number of points, with the passes over W around them, and steps
#: through impacts of several points; products with blocks of 3x6 or 6x6 numbers in contact problems of a crowd:
#: of a sweep one for each point
COUNT_TRIALS, COUNT_SEARCHES, COUNT_FACTORS, COUNT_BLOCKS = range(4)
COUNTS = 4
#: bound of each kind in a part of a run, and that of trial steps of given length
PART, OF_STEP = (500.0, 4000.0, 3e6, 4e4), 150.0
PARTS, SAVED = 200.0, 20.0  # least number of parts of a run; parts that may be saved
# part of the work of an accepted step without an event, of the length that a tolerance permits, that counts
SMOOTH = 0.1


@kernel
def refilled(controls, t):
    """Return the number of parts of the run in the time t."""
    parts = PARTS * t / controls.duration
    return parts if controls.order > 0 else max(parts, t / controls.interval)


@kernel
def part(controls, kind):
    """Return the bound of a kind in a part of the run."""
    return OF_STEP if kind == COUNT_TRIALS and controls.order == 0 else PART[kind]


@kernel
def left(controls, step, kind):
    """Return how much work of a kind the present island may still do up to the present time."""
    return part(controls, kind) * (SAVED + refilled(controls, step.spent)) - step.counts[kind]


@kernel
def overdone(controls, step):
    """Return whether the present island has done more than it may, and can be moved as a crowd instead."""
    if controls.retry == 0:
        return False
    for kind in range(COUNT_BLOCKS):
        if left(controls, step, kind) < 0.0:
            return True
    return False


@kernel
def begin_count(controls, work):
    """Set the counts of an island to the greatest of its bodies."""
    for kind in range(COUNTS if controls.retry == 1 else 0):
        most = 0.0
        for b in range(work.body.shape[0]):
            most = max(most, work.body[b].counts[kind])
        work.step[0].counts[kind] = most


@kernel
def end_count(controls, work):
    """Store the counts for the bodies of an island, less what is allowed for the time of the step.

    A step as a crowd leaves at most one part for the next step event by event: what a large island has not used
    in many steps is not for the one in which it becomes small.
    """
    for kind in range(COUNTS if controls.retry == 1 else 0):
        each, crowd = part(controls, kind), kind < COUNT_BLOCKS and work.step[0].crowd == 1
        rest = min(work.step[0].counts[kind], each * SAVED)
        rest -= each * refilled(controls, work.step[0].length)
        least = each * (SAVED - 1.0) if crowd else 0.0
        for b in range(work.body.shape[0]):
            work.body[b].counts[kind] = max(least, rest)


@kernel
def keep_count(controls, step, memory):
    """Store the counts of a step that is given up for a body."""
    for kind in range(COUNTS):
        memory.counts[kind] = min(step.counts[kind], part(controls, kind) * SAVED + 1.0)


@kernel
def mark_count(work):
    """Store the counts before a step is proposed."""
    for kind in range(COUNTS):
        work.search[0].counts[kind] = work.step[0].counts[kind]


@kernel
def smooth_count(work):
    """Let only a part of the work since then count."""
    for kind in range(COUNTS):
        before, counts = work.search[0].counts[kind], work.step[0].counts
        counts[kind] = before + SMOOTH * (counts[kind] - before)
