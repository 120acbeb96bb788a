"""Accelerations at the end of a step, kept for the first stage of the next one.

A last stage without weight is at the end of the step, after the return to the joints. It serves for the
estimate of the error, and is the first stage of the step that starts there ("first same as last"). Its
accelerations are kept where they depend on the state alone: without active contacts, and without what
`Relations` contains (functions of the user, motors, forces along coordinates). They are
used if all bodies are in that state, bit by bit, and are forgotten when the loop is entered, because loads may
be set between its calls. Worked out anew they are the same numbers.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def of_state_alone(system, active):
    """Return whether accelerations depend on the state of the bodies alone."""
    return active.count[0] == 0 and system.relations.there == 0


@kernel
def forget_end(work):
    """Forget the accelerations that are kept."""
    if work.known.shape[0] > 0:
        work.known[0].x[0] = math.nan


@kernel
def keep_end(state, rates, power, work):
    """Keep the accelerations of a state, and the power of its loads."""
    work.known[0].power = power
    for b in range(state.shape[0]):
        here, known, rate = state[b], work.known[b], rates[b].rate
        for k in range(3):
            known.x[k], known.v[k], known.w[k] = here.x[k], here.v[k], here.w[k]
        for k in range(4):
            known.Q[k] = here.Q[k]
        for k in range(6):
            known.rate[k] = rate[k]


@kernel
def recall(state, rates, work):
    """Write the accelerations of a state if they are kept; return whether they are."""
    for b in range(state.shape[0]):
        here, known = state[b], work.known[b]
        for k in range(3):
            if not (
                here.x[k] == known.x[k] and here.v[k] == known.v[k] and here.w[k] == known.w[k]
            ):
                return False
        for k in range(4):
            if here.Q[k] != known.Q[k]:
                return False
    for b in range(state.shape[0]):
        for k in range(6):
            rates[b].rate[k] = work.known[b].rate[k]
    return True
