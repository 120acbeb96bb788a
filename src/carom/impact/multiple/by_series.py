"""One step of the layer by series, cut at the first change of mode or at the end of stick."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.impact.multiple import along, events
from carom.impact.multiple import series as taylor
from carom.impact.multiple.grip import first_slip, gather_stuck, halt
from carom.impact.multiple.layout import LANES, NOW_U, S_SIGMA, S_U1, S_U2, WEIGHT, WHEN

AT_REST = 1e-10  # slip below this velocity, or below 0.1 rtol, has ended
_FEWER = 2  # orders of the series that are left out if it reaches a change of mode without them
_SAFE = 0.01  # of the tolerance, for a series of low order: its last terms do not bound the error
_STIFF = 3000.0  # rate of a slow direction above which stages cost less, per time of the fastest


@inlined
def series_step(k, work, rtol):
    """Take a step by series, cut at the first change of mode; return its length and whether a mode changes.

    The length is -1 if the step has to be taken by stages.
    """
    clock, when, u = work.clock[0], work.vector[WHEN], work.vector[NOW_U]
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
    stretched = taylor.stretch_weights(k, work)
    closed = taylor.begin(k, work, stretched)
    clock.stretched = 1 if stretched else 0
    clock.steps += 1
    most = taylor.degree_for(rtol)
    known, degree, h = 0, most - _FEWER, 0.0
    while True:  # only as many orders as the next change of mode needs
        taylor.expand(k, z, closed, work, known, degree, stretched)
        if known == 0 and stretched and _stiff(k, work):
            return -1.0, False
        known = degree
        h = along.reach(k, work, degree, stretched, _SAFE * rtol if degree < most else 0.1 * rtol)
        if degree == most or events.any_change(k, work, degree, h):
            break
        degree = most
    first = events.find_changes(k, work, degree, h, when)
    changes, end = first <= h, min(first, h)
    if z > 0:
        slip = first_slip(z, work, degree, end)
        if slip < end:
            if slip <= 1e-9 or clock.cut == 1:  # only one more series step shares the forces anew
                clock.cut = 0
                return -1.0, False
            clock.cut = 2
            changes, end = False, slip
    if clock.cut < 2:
        turn = along.first_turn(k, work, degree, end)
        if turn < end:
            changes, end = False, turn
    clock.cut = 1 if clock.cut == 2 else 0
    along.move(k, work, degree, end)
    return end, changes


@kernel
def _stiff(k, work):
    """Return whether a contact slips so slowly that its direction is stiff, without coming to rest.

    With r = |u_t| and c the rate at which friction changes u_t, the direction relaxes in a time r/c.
    """
    S, weights = work.series, work.vector[WEIGHT]
    for i in range(k):
        if not taylor.slips(work.contact[i]):
            continue
        b, l = i // LANES, i % LANES
        x, y = S[S_U1, 0, b, l], S[S_U2, 0, b, l]
        r2 = x * x + y * y
        c = weights[i]
        if c * c > _STIFF * _STIFF * r2:
            growth = (x * S[S_U1, 1, b, l] + y * S[S_U2, 1, b, l]) / S[S_SIGMA, 0, 0, 0]
            if growth > -0.1 * c * math.sqrt(r2):
                return True
    return False
