"""A step of order four, implicit in friction, cut at the first change of mode: the pair ARK4(3)6L[2]SA.

C. A. Kennedy and M. H. Carpenter, Applied Numerical Mathematics 44 (2003) 139-181. At each stage the depths,
and therefore the normal forces, are known, and friction is the convex problem of §2.3 for the velocity at the
end of the stage. Stick is exact (u_t = 0 at every stage). Slip that begins from rest needs no small steps,
although its direction is stiff (rate mu N W/|u_t|), and no threshold separates stick from slip. A coefficient
that depends on the slip is that of this velocity too, by iteration.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.simd import LANES
from carom._compiled.units import unit
from carom.friction.dense import add_product
from carom.impact.multiple import normal_law as law
from carom.impact.multiple.friction import gather_discs, push, slip_of, solve_discs
from carom.impact.multiple.layer import set_velocity
from carom.impact.multiple.slip_law import (
    MOST_TURNS,
    by_law,
    crosses_rest,
    improve_mu,
    jump,
    let_go,
    pull,
)
from carom.impact.thresholds import (
    BRACKET_STEP,
    CHANGE_TOLERANCE,
    CONE_MARGIN,
    EASY_STEP,
    INSTANT,
    INSTANT_STEP,
    PULL,
    SHORTEST_PART,
    SLIP_END,
    SLIP_SHARE,
    STAGE_REST,
)
from carom.model.tableaus import KENNEDY_CARPENTER, KENNEDY_CARPENTER_EXPLICIT

EXPLICIT, IMPLICIT = KENNEDY_CARPENTER_EXPLICIT.A, KENNEDY_CARPENTER.A
GAMMA, WEIGHTS, DEFECT = float(IMPLICIT[1, 1]), KENNEDY_CARPENTER.b, KENNEDY_CARPENTER.E[0]


@unit
def by_stages(k, work, rtol, passage) -> tuple[float, bool]:
    """Take an implicit step, cut at the first change of mode; return its length and whether a mode changes."""
    clock, u = work.clock[0], work.now.velocity
    clock.stretched = 0
    if passage.by_slip:
        begin_to_stick(k, work, passage.exponent, slip_at_rest(rtol))
        let_go(k, work, passage, slip_at_rest(rtol))
    m = gather_discs(k, work, u, math.inf)
    h, slow = clock.step, slip_at_rest(rtol)
    if not passage.by_slip:
        present_forces(k, m, work, h, passage.exponent, rtol)
    while True:
        error = implicit_step(k, m, work, h, passage, rtol)
        clock.steps += 1
        allowed = rtol
        if regime_changes(m, work, slow):
            allowed *= CHANGE_TOLERANCE
            error = max(error, CHANGE_TOLERANCE * greatest_jump(m, work, passage, h))
        if not (error > allowed and h > SHORTEST_PART):
            break
        h *= max(0.2, 0.9 * (allowed / error) ** 0.25)
    clock.step = h * (5.0 if error < EASY_STEP * rtol else 0.9 * (rtol / error) ** 0.25)
    clock.step = min(clock.step, 0.5)
    interpolate(k, work, h)
    first = law.find_changes(k, work, 5, h)
    changes = first <= h
    if changes:
        if first > INSTANT:
            h = _land(k, m, work, first, passage, rtol)
            for i in range(k):  # times of changes, relative to the new length of the step
                work.contact[i].when -= first - h
        else:
            return first, True
    if passage.by_slip:
        length = break_away(k, m, work, h, passage, rtol)
        h, changes = length, changes and length == h
    advance(k, work, h)
    set_velocity(k, work)
    set_regime(m, work, slow)
    return h, changes


@kernel
def slip_at_rest(rtol):
    """Return the slip that counts as rest."""
    return max(SLIP_END, STAGE_REST * rtol)


@kernel
def _land(k, m, work, h, passage, rtol):
    """Step to the change of mode near `h`, by Newton's iteration for the length of the step."""
    lead = 0
    for i in range(k):
        if work.contact[i].when < work.contact[lead].when:
            lead = i
    c = work.contact[lead]
    for turn in range(5):
        implicit_step(k, m, work, h, passage, rtol)
        work.clock[0].steps += 1
        d, u_n = work.new.depth[lead], work.new.velocity[3 * lead]
        if c.mode == law.OPEN:
            g, rate = d - c.d0, -u_n
        elif c.mode == law.LOAD:
            row, force = work.W[3 * lead], work.stages.force[5]
            g, rate = u_n, 0.0
            for j in range(3 * k):
                rate += row[j] * force[j]
        elif c.rest - d > d - c.d0 - c.most:
            g, rate = c.rest - d, u_n
        else:
            g, rate = d - c.d0 - c.most, -u_n
        if not abs(g) > 0.1 * rtol or turn == 4:
            break
        new = h - g / rate
        if not 0.5 * h < new < 1.5 * h:
            break
        h = new
    return h


@kernel
def _sticks(s, work, slow):
    """Return 1 if disc `s` ends the step at rest, with friction inside the disc.

    A law holds what sticks until it is pulled away, and it may hold a slip that would pass through 0.
    """
    t, i = work.disc_force, work.discs[s]
    u, n = work.new.velocity, work.stages.force[5, 3 * i]
    c = work.contact[i]
    if by_law(c) and (c.sticks == 1 or crosses_rest(work, i)):
        return 1
    size = math.sqrt(t[2 * s] * t[2 * s] + t[2 * s + 1] * t[2 * s + 1])
    held = size < c.slip_mu * n * (1.0 - CONE_MARGIN)
    return 1 if held and slip_of(u, i) < slow else 0


@kernel
def regime_changes(m, work, slow):
    """Return whether a contact begins or ceases to stick in the step: its error estimate is then too small."""
    for s in range(m):
        if work.contact[work.discs[s]].sticks != _sticks(s, work, slow):
            return True
    return False


@kernel
def set_regime(m, work, slow):
    """Note which contacts stick."""
    for s in range(m):
        work.contact[work.discs[s]].sticks = _sticks(s, work, slow)


@kernel
def greatest_jump(m, work, passage, h):
    """Return the greatest error of laws in whose slip a step of length h passes through 0."""
    most = 0.0
    for s in range(m):
        i = work.discs[s]
        c = work.contact[i]
        if by_law(c) and c.sticks == 0 and crosses_rest(work, i):
            most = max(most, jump(c, i, work, passage, h))
    return most


@kernel
def begin_to_stick(k, work, p, slow):
    """Let contacts with a law stick that close at rest, and others slip that close."""
    for i in range(k):
        c = work.contact[i]
        if by_law(c) and not law.force(c, work.now.depth[i], p) > slow:
            c.sticks = 0 if slip_of(work.now.velocity, i) > slow else 1


@kernel
def break_away(k, m, work, h, passage, rtol):
    """Return the length of the step to where a contact with a law breaks away, if that is within `h`; take it.

    The pull of the rest grows from 0 there: a root by secants from beyond.
    """
    slow, low, x = slip_at_rest(rtol), 0.0, h
    now, other, most = pull(k, work, passage, work.new, slow), h, 0.0
    if not now > PULL:
        return h
    for _ in range(MOST_TURNS):
        root = low
        if other > h and most > now:
            root = max(low, h - now * (other - h) / (most - now))
        if h - root <= INSTANT:
            break
        x = root + (BRACKET_STEP if x == h and other > h else 0.5) * (h - root)
        implicit_step(k, m, work, x, passage, rtol)
        work.clock[0].steps += 1
        a = pull(k, work, passage, work.new, slow)
        if a > PULL:
            other, most, h, now = h, now, x, a
        else:
            low = x
    if x != h:
        implicit_step(k, m, work, h, passage, rtol)
    return h


@unit
def implicit_step(k, m, work, h, passage, rtol) -> float:
    """Step from (d, P, u) by `h` to the new state; return the error, infinite if the friction is not found.

    Stage 0 has the present forces, and in the end stage 5 those of the new instant; `m` discs are gathered.
    """
    n = 3 * k
    force, sinking, loss = work.stages.force, work.stages.sinking, work.stages.loss
    W, worst = work.W, 0.0
    u, u1, q = work.now.velocity, work.new.velocity, work.scratch
    for i in range(k):
        sinking[0, i] = -u[3 * i]
        loss[0, i] = -(force[0, 3 * i + 1] * u[3 * i + 1] + force[0, 3 * i + 2] * u[3 * i + 2])
    for s in range(1, 6):
        d = work.new.depth
        for i in range(k):
            total = 0.0
            for j in range(s):
                total += EXPLICIT[s, j] * sinking[j, i]
            d[i] = work.now.depth[i] + h * total
        normal_forces(k, work, d, passage.exponent, force[s])
        for i in range(n):
            total = GAMMA * force[s, i]
            for j in range(s):
                total += IMPLICIT[s, j] * force[j, i]
            q[i] = h * total
            u1[i] = u[i]
        add_product(n, W, q, u1)
        if m > 0 and not add_friction((k, m), work, s, GAMMA * h, passage, rtol):
            worst = math.inf
        for i in range(k):
            a = 3 * i
            sinking[s, i] = -u1[a]
            loss[s, i] = -(force[s, a + 1] * u1[a + 1] + force[s, a + 2] * u1[a + 2])
    p0, p1, error = work.now.impulse, work.new.impulse, work.error
    for i in range(n):
        total, wrong = 0.0, 0.0
        for s in range(6):
            total += WEIGHTS[s] * force[s, i]
            wrong += DEFECT[s] * force[s, i]
        p1[i] = p0[i] + h * total
        q[i] = h * wrong
        error[i] = 0.0
    add_product(n, W, q, error)
    for i in range(n):
        worst = max(worst, abs(error[i]))
    for i in range(k):
        total, wrong = 0.0, 0.0
        for s in range(6):
            total += WEIGHTS[s] * sinking[s, i]
            wrong += DEFECT[s] * sinking[s, i]
        work.new.depth[i] = work.now.depth[i] + h * total
        worst = max(worst, h * abs(wrong))
    return worst


@kernel
def present_forces(k, m, work, h, p, rtol):
    """Write the forces of this instant; `m` discs are gathered.

    For a contact that slips, T = -mu N u_t/|u_t|; for contacts at rest, T is the solution of §2.3. Both are
    limits of the friction for the velocity a moment ahead, as this moment tends to 0.
    """
    force, moment = work.stages.force[0], INSTANT_STEP * h
    u, ahead, q = work.now.velocity, work.new.velocity, work.scratch
    normal_forces(k, work, work.now.depth, p, force)
    for i in range(k):
        n = 3 * i
        slip = math.sqrt(u[n + 1] * u[n + 1] + u[n + 2] * u[n + 2])
        moves = 0.0 if work.contact[i].sticks == 1 or not slip > slip_at_rest(rtol) else 1.0
        for r in range(3):
            q[n + r] = moment * force[n + r]
            ahead[n + r] = u[n + r] if r == 0 else moves * u[n + r]
    add_product(3 * k, work.W, q, ahead)
    if m > 0:
        solve_discs(m, work, moment, force, ahead, SLIP_SHARE * rtol * INSTANT_STEP)


@kernel
def add_friction(sizes, work, s, step, passage, rtol):
    """Add friction to the forces of stage `s`, and its effect within `step` to its velocity.

    Return whether it is that of this velocity. `sizes` are the numbers of contacts and of discs.
    """
    _, m = sizes
    force, u, least = work.stages.force[s], work.new.velocity, SLIP_SHARE * rtol
    for i in range(sizes[0] if passage.by_slip else 0):
        work.contact[i].mu_before = work.contact[i].slip_mu
    for _ in range(MOST_TURNS):
        solve_discs(m, work, step, force, u, least)
        push(sizes, work, step, force, u)
        if not passage.by_slip or improve_mu(m, work, passage, step, force, u) <= least:
            return True
        push(sizes, work, -step, force, u)
    return False


@kernel
def advance(k, work, h):
    """Make the new state the present one; add the friction loss."""
    for i in range(3 * k):
        work.now.impulse[i] = work.new.impulse[i]
    for i in range(k):
        work.now.depth[i] = work.new.depth[i]
        loss = 0.0
        for s in range(6):
            loss += WEIGHTS[s] * work.stages.loss[s, i]
        work.contact[i].loss += max(0.0, h * loss)


@kernel
def interpolate(k, work, h):
    """Write depths as polynomials of degree five in time, and normal velocities as their derivatives.

    Hermite's interpolation uses depth, velocity and acceleration at both ends.
    """
    W = work.W
    a0, a1 = work.scratch, work.error
    for i in range(3 * k):
        a0[i] = 0.0
        a1[i] = 0.0
    add_product(3 * k, W, work.stages.force[0], a0)
    add_product(3 * k, W, work.stages.force[5], a1)
    d, u = work.series.depth, work.series.u[0]
    for i in range(k):
        n, b, l = 3 * i, i // LANES, i % LANES
        y0, v0, w0 = work.now.depth[i], -work.now.velocity[n], -a0[n]
        y1, v1, w1 = work.new.depth[i], -work.new.velocity[n], -a1[n]
        # Differences at the end from the Taylor polynomial at the start, times powers of h.
        e0 = y1 - y0 - h * (v0 + 0.5 * h * w0)
        e1 = h * (v1 - v0 - h * w0)
        e2 = h * h * (w1 - w0)
        d[0, b, l], d[1, b, l], d[2, b, l] = y0, v0, 0.5 * w0
        d[3, b, l] = (10.0 * e0 - 4.0 * e1 + 0.5 * e2) / h**3
        d[4, b, l] = (-15.0 * e0 + 7.0 * e1 - e2) / h**4
        d[5, b, l] = (6.0 * e0 - 3.0 * e1 + 0.5 * e2) / h**5
        for j in range(5):
            u[j, b, l] = -(j + 1) * d[j + 1, b, l]
        u[5, b, l] = 0.0


@kernel
def normal_forces(k, work, d, p, out):
    """Write (N, 0, 0) of each contact at depths `d`."""
    for i in range(k):
        n = 3 * i
        out[n] = law.force(work.contact[i], d[i], p)
        out[n + 1] = 0.0
        out[n + 2] = 0.0
