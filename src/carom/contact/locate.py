"""Location of an event inside a step: the root, in the length of the step, of its event function.

For a gap the rate is known: Newton's method, kept inside the bracket. For held contacts: regula falsi
with the Illinois rule. Every trial is a step of the method itself from the start of the step, so that
an event is as exact as the method.
"""

from __future__ import annotations

from carom.contact.gap import gap, round_off, strike_point
from carom.hold.events import GAP, held_value
from carom.jit import kernel
from carom.motion.acceleration import acceleration
from carom.motion.step import step

NOT_FINITE, STEP_CUT = 4, 2


@kernel
def event_value(system, controls, held, kind, c, d1, d2, state, work):
    """Return the event function and, for a gap, its rate, at `state`."""
    contact = system.contacts[c]
    if kind == GAP:
        tie = controls.tie * contact.extent
        rho = gap(contact, system.vertices, state)
        return rho, strike_point(contact, system.vertices, state, tie, work.hit[0].point)[1]
    acceleration(system, state, held, work, work.stages[0])
    return held_value(contact, held[c], kind, d1, d2, state), 0.0


@kernel
def locate(system, method, controls, held, kind, c, d1, d2, start, low, high, work, clock):
    """Find the event between `low` and `high` after `start`; its state is left in work.trial.

    work.trial must hold the state at `high`, where the event function is negative. Returns the time,
    the works of loads and friction, and 0 or the number of a `Status`.
    """
    end = work.trial
    f_high, rate = event_value(system, controls, held, kind, c, d1, d2, end, work)
    f_low, tolerance = abs(f_high), 0.0
    if kind == GAP:
        contact = system.contacts[c]
        tolerance = max(controls.gap * contact.extent, round_off(contact, end))
    else:
        f_low, _ = event_value(system, controls, held, kind, c, d1, d2, start, work)
        f_low = max(f_low, 0.0)
        tolerance = 1e-13 * max(f_low, -f_high)
    t, f, side, width = high, f_high, 0, high
    applied, friction = 0.0, 0.0
    for _ in range(200):
        if kind == GAP and rate < 0.0:
            new = t - f / rate
        else:
            new = (low * f_high - high * f_low) / (f_high - f_low)
        if not (low < new < high):
            new = 0.5 * (low + high)
        t = new
        applied, friction, code = step(system, method, held, start, t, end, work)
        clock.trials += 1
        if code != 0:
            return t, applied, friction, code
        f, rate = event_value(system, controls, held, kind, c, d1, d2, end, work)
        if abs(f) <= tolerance or high - low <= 1e-15 * width:
            return t, applied, friction, 0
        if f < 0.0:
            high, f_high = t, f
            f_low *= 0.5 if side == 1 else 1.0
            side = 1
        elif f > 0.0:
            low, f_low = t, f
            f_high *= 0.5 if side == 2 else 1.0
            side = 2
        else:
            return t, applied, friction, NOT_FINITE
    return t, applied, friction, STEP_CUT
