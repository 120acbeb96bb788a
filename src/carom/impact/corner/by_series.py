"""One step of the layer by series, cut at the first change of mode or at the end of stick."""

from __future__ import annotations

import math

from carom.impact.corner import events
from carom.impact.corner import series as taylor
from carom.impact.corner.grip import first_slip, gather_stuck, halt
from carom.impact.corner.layout import S_D, S_SIGMA, S_U, WEIGHT, WHEN, U
from carom.impact.corner.motion import set_velocity
from carom.jit import kernel

AT_REST = 1e-10  # slip below this velocity, and below 0.1 rtol, is over
_STIFF = 100.0  # rate at which a slow direction relaxes, in units of the fastest contact


@kernel
def series_step(k, work, rtol):
    """One step by series, cut at the first change; return its length, or -1 if stages must do it."""
    clock, when, u = work.clock[0], work.vector[WHEN], work.vector[U]
    least = max(AT_REST, 0.1 * rtol)
    captured = False
    for i in range(k):
        c = work.contact[i]
        if taylor.slips(c) and math.sqrt(u[3 * i + 1] ** 2 + u[3 * i + 2] ** 2) <= least:
            c.sticks = 1
            captured = True
    if captured:
        for i in range(k):
            c = work.contact[i]
            if taylor.slips(c) and math.sqrt(u[3 * i + 1] ** 2 + u[3 * i + 2] ** 2) <= 10.0 * least:
                c.sticks = 1
    z = gather_stuck(k, work)
    if z > 0:
        halt(k, z, work)
    degree = taylor.degree_for(rtol)
    stretched = taylor.stretch_weights(k, work)
    taylor.expand(k, z, work, degree, stretched)
    clock.stretched = 1 if stretched else 0
    clock.steps += 1
    if stretched and _stiff(k, work):
        return -1.0, False
    h = taylor.reach(k, work, degree, stretched, 0.1 * rtol)
    first = events.find_changes(
        k, work.contact, work.series[S_D], work.series[S_U], degree, h, when
    )
    if z > 0:
        slip = first_slip(z, work, degree, min(first, h))
        if slip < min(first, h):
            if slip <= 1e-9 or clock.cut == 1:  # once more with forces shared anew, not again
                clock.cut = 0
                return -1.0, False
            clock.cut = 1
            taylor.move(k, work, degree, slip)
            set_velocity(k, work)
            return slip, False
    clock.cut = 0
    turn = taylor.first_turn(k, work, degree, min(first, h))
    if turn < min(first, h):
        taylor.move(k, work, degree, turn)
        set_velocity(k, work)
        return turn, False
    changes = first <= h
    h = min(h, first)
    taylor.move(k, work, degree, h)
    set_velocity(k, work)
    return h, changes


@kernel
def _stiff(k, work):
    """Return whether a contact slips so slowly that its direction is stiff, and does not come to rest.

    With r = |u_t| and c the rate at which friction changes u_t, the direction relaxes in a time r/c.
    """
    u, weights, sigma = work.series[S_U], work.vector[WEIGHT], work.series[S_SIGMA]
    for i in range(k):
        if not taylor.slips(work.contact[i]):
            continue
        x, y = u[0, 3 * i + 1], u[0, 3 * i + 2]
        r2 = x * x + y * y
        c = weights[i]
        if c * c > _STIFF * _STIFF * r2:
            growth = (x * u[1, 3 * i + 1] + y * u[1, 3 * i + 2]) / sigma[0, 0]
            if growth > -0.1 * c * math.sqrt(r2):
                return True
    return False
