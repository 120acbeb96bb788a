"""The layer at a corner, passed with steps of controlled error; each change of mode is located."""

from __future__ import annotations

import math

from carom.dispatch import by_address
from carom.impact.corner import events, law
from carom.impact.corner import series as taylor
from carom.impact.corner.grip import first_slip, gather_stuck, halt
from carom.impact.corner.implicit import advance, implicit_step, interpolate
from carom.impact.corner.layout import (
    DISC,
    DISC_T,
    FORCE,
    MASS,
    NEW_D,
    NEW_U,
    S_D,
    S_SIGMA,
    S_U,
    SAVED_D,
    SAVED_P,
    WEIGHT,
    WHEN,
    D,
    P,
    U,
)
from carom.impact.corner.motion import friction_now, gather_discs, normal_forces, set_velocity
from carom.jit import kernel, unit

ENDED, TRAPPED = 0, 1

APART = 1e-12  # velocities of approach below this part of the scale are none
_AT_REST = 1e-10  # a contact whose friction is inside its disc sticks below this velocity
_FIRST_STEP = 0.05
_STIFF = 10.0  # rate at which a slow direction relaxes, in units of the fastest contact
_STIFF_STEPS = 4  # implicit steps before series are tried again
_LEAST_STEP = 1e-9


@kernel
def start(k, work):
    """Set the clock and the state at the entry of the layer; velocities before are in U0."""
    clock = work.clock[0]
    clock.step = _FIRST_STEP
    clock.steps, clock.events, clock.idle, clock.branched, clock.stiff = 0, 0, 0, 0, 0
    for i in range(3 * k):
        work.vector[P, i] = 0.0
    for i in range(k):
        c = work.contact[i]
        c.mode, c.slope, c.rest, c.most = law.OPEN, 0.0, 0.0, 0.0
        c.d0, c.mark, c.sticks = 0.0, 0.0, 0
        c.loading, c.unloading, c.absorbed, c.returned, c.loss = 0.0, 0.0, 0.0, 0.0, 0.0
        work.vector[D, i] = 0.0
    set_velocity(k, work)
    for i in range(k):
        if work.vector[U, 3 * i] <= APART:  # those that touch begin to load, if they are driven
            law.close(work.contact[i])


@kernel
def branch(k, work):
    """Save the state at the first unloading: what came before does not depend on restitution."""
    clock = work.clock[0]
    clock.branched, clock.saved_step = 1, clock.step
    clock.saved_stiff = clock.stiff
    clock.saved_idle = clock.idle
    for i in range(3 * k):
        work.vector[SAVED_P, i] = work.vector[P, i]
    for i in range(k):
        work.saved[i] = work.contact[i]
        work.vector[SAVED_D, i] = work.vector[D, i]


@kernel
def resume(k, work):
    """Go back to the first unloading, with the coefficients e that the contacts have now."""
    clock = work.clock[0]
    clock.step, clock.idle, clock.stiff = clock.saved_step, clock.saved_idle, clock.saved_stiff
    for i in range(3 * k):
        work.vector[P, i] = work.vector[SAVED_P, i]
    for i in range(k):
        e = work.contact[i].e
        work.contact[i] = work.saved[i]
        work.contact[i].e = e
        work.vector[D, i] = work.vector[SAVED_D, i]


@kernel
def drift(k, work, p):
    """Return 1 if all is over. Where no force acts, go on with constant velocities to the next closure."""
    u, d = work.vector[U], work.vector[D]
    for i in range(k):
        c = work.contact[i]
        if c.mode != law.OPEN:
            if law.force(c, d[i], p) > events.ROUND_OFF or u[3 * i] < -APART:
                return 0
    time = math.inf
    for i in range(k):
        c = work.contact[i]
        if c.mode != law.OPEN:
            law.release(c, d[i], work.vector[P, 3 * i], p)
        if u[3 * i] < -APART:
            time = min(time, max(0.0, c.d0 - d[i]) / -u[3 * i])
    if not time < math.inf:
        return 1
    for i in range(k):
        c = work.contact[i]
        near = u[3 * i] < -APART and max(0.0, c.d0 - d[i]) / -u[3 * i] <= time + events.TOGETHER
        d[i] -= u[3 * i] * time
        if near:
            d[i] = c.d0
            law.close(c)
            c.sticks = 0
    work.clock[0].events += 1
    return 0


@kernel
def traverse(k, work, units, rtol, p, max_events, max_steps):
    """Go on to the end of the event: ENDED, or TRAPPED after too many changes of mode or steps."""
    clock = work.clock[0]
    when = work.vector[WHEN]
    set_velocity(k, work)
    first_events, first_steps = clock.events, clock.steps
    while True:
        if drift(k, work, p) == 1:
            return ENDED
        if (
            clock.events - first_events > max_events
            or clock.steps - first_steps > max_steps
            or not clock.step > 0.0
        ):
            return TRAPPED
        h, changes = -1.0, False
        if p == 1.0 and clock.stiff == 0:
            h, changes = _series(k, work, rtol)
        if h < 0.0:
            m = gather_discs(k, work)
            h, changes = _implicit(k, m, work, units, rtol, p)
            clock.stiff = max(0, clock.stiff - 1)
        if changes:
            latest = h + events.TOGETHER
            clock.idle = clock.idle + 1 if h <= events.TOGETHER else 0
            if clock.branched == 0 and events.would_unload(k, work, when, latest):
                branch(k, work)
            events.change_modes(k, work, when, latest, p, clock.idle > 2 * k)
            clock.events += 1


@unit
def layer_unit(k, work, units, rtol, p, max_events, max_steps):
    """Traverse; the code goes to the clock."""
    work.clock[0].code = traverse(k, work, units, rtol, p, max_events, max_steps)


#: pass_layer(address, k, work, units, rtol, p, max_events, max_steps)
pass_layer = by_address(layer_unit)


@kernel
def _series(k, work, rtol):
    """One step by series, cut at the first change; return its length, or -1 if it is one for `_implicit`."""
    clock, when, u = work.clock[0], work.vector[WHEN], work.vector[U]
    least = max(_AT_REST, 0.01 * rtol)
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
    clock.steps += 1
    if stretched and _stiff(k, work):
        clock.stiff = _STIFF_STEPS
        return -1.0, False
    h = taylor.reach(k, work, degree, 0.1 * rtol)
    first = events.find_changes(
        k, work.contact, work.series[S_D], work.series[S_U], degree, h, when
    )
    if z > 0:
        slip = first_slip(z, work, degree, min(first, h))
        if slip <= 1e-9:
            clock.stiff = _STIFF_STEPS
            return -1.0, False
        if slip < min(first, h):
            taylor.move(k, work, degree, slip)
            set_velocity(k, work)
            clock.stiff = _STIFF_STEPS
            return slip, False
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


@kernel
def _implicit(k, m, work, units, rtol, p):
    """One implicit step, cut at the first change of mode; return its length and whether one changes."""
    clock, when = work.clock[0], work.vector[WHEN]
    tolerance = 1e-3 * rtol
    h = clock.step
    force = work.series[FORCE]
    normal_forces(k, work, work.vector[D], p, force[0])
    friction_now(k, m, work, units, 1e-7 * h, force[0])
    implicit_step(units.step, k, m, work, units, h, p, tolerance)
    error = clock.error
    clock.steps += 1
    while error > rtol and h > _LEAST_STEP:
        h *= max(0.2, 0.9 * (rtol / error) ** 0.25)
        implicit_step(units.step, k, m, work, units, h, p, tolerance)
        error = clock.error
        clock.steps += 1
    clock.step = h * (5.0 if error < 1e-3 * rtol else 0.9 * (rtol / error) ** 0.25)
    clock.step = min(clock.step, 0.5)
    interpolate(k, work, h)
    first = events.find_changes(k, work.contact, work.series[S_D], work.series[S_U], 5, h, when)
    changes = first <= h
    if changes:
        if first > events.TOGETHER:
            h = _land(k, m, work, units, first, p, tolerance, 0.01 * rtol)
            for i in range(k):  # in the time of the step as it is now
                when[i] -= first - h
        else:
            return first, True
    advance(k, work, h)
    set_velocity(k, work)
    _stick(m, work, max(_AT_REST, 0.01 * rtol))
    return h, changes


@kernel
def _land(k, m, work, units, h, p, tolerance, residual):
    """Step to the change of mode near `h`: Newton's iteration on the length of the step."""
    when, lead = work.vector[WHEN], 0
    for i in range(k):
        if when[i] < when[lead]:
            lead = i
    c = work.contact[lead]
    for _ in range(4):
        implicit_step(units.step, k, m, work, units, h, p, tolerance)
        work.clock[0].steps += 1
        d, u_n = work.vector[NEW_D, lead], work.vector[NEW_U, 3 * lead]
        if c.mode == law.OPEN:
            g, rate = d - c.d0, -u_n
        elif c.mode == law.LOAD:
            row, force = work.matrix[MASS, 3 * lead], work.series[FORCE, 5]
            g, rate = u_n, 0.0
            for j in range(3 * k):
                rate += row[j] * force[j]
        elif c.rest - d > d - c.d0 - c.most:
            g, rate = c.rest - d, u_n
        else:
            g, rate = d - c.d0 - c.most, -u_n
        if not abs(g) > residual:
            break
        new = h - g / rate
        if not 0.5 * h < new < 1.5 * h:
            break
        h = new
    return h


@kernel
def _stick(m, work, slow):
    """Note which contacts stick: their friction is inside the disc and they do not move."""
    slot, u = work.index[DISC], work.vector[U]
    t, force = work.vector[DISC_T], work.series[FORCE, 5]
    for s in range(m):
        i = slot[s]
        size = math.sqrt(t[2 * s] * t[2 * s] + t[2 * s + 1] * t[2 * s + 1])
        speed = math.sqrt(u[3 * i + 1] * u[3 * i + 1] + u[3 * i + 2] * u[3 * i + 2])
        c = work.contact[i]
        c.sticks = 1 if size < c.mu * force[3 * i] * (1.0 - 1e-9) and speed < slow else 0
