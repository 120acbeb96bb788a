"""Friction that depends on the slip, in the layer: mu at the velocity of a stage, and the memory of stick.

A contact that sticks is bounded by its static coefficient until it breaks away; in slip it has mu(|u_t|), until
friction holds it, or its slip passes through 0. In between mu jumps. Break-away is located, and a step in which
slip passes through 0 is in error by (static - mu) N W_tt h.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.friction.dense import add_product
from carom.impact.multiple import normal_law as law
from carom.impact.multiple.friction import gather_discs, push, slip_of, solve_discs
from carom.impact.thresholds import IMPACT_ERROR, INSTANT, LEAST_SLOPE, PULL
from carom.law import friction

MOST_TURNS = 30  # of the iteration of mu, and of that for the place of break-away


@inlined
def by_law(c):
    """Return whether the friction of contact `c` depends on its slip."""
    return c.by_slip == 1


@kernel
def in_slip(c, passage, slip):
    """Return mu of a contact with a law at a slip."""
    return friction.in_slip(passage.laws, c.law, slip * passage.speed)


@kernel
def set_mu(m, work, passage, u):
    """Write mu at the velocity u of `m` discs whose friction is a law."""
    for s in range(m):
        i = work.discs[s]
        c = work.contact[i]
        if by_law(c) and c.sticks == 0:
            c.slip_mu = in_slip(c, passage, slip_of(u, i))


@kernel
def improve_mu(m, work, passage, step, force, u):
    """Improve mu of `m` discs for the slip at the velocity u; return how much velocity it misses in `step`."""
    most = 0.0
    for s in range(m):
        i = work.discs[s]
        c = work.contact[i]
        if by_law(c) and c.sticks == 0:
            miss = in_slip(c, passage, slip_of(u, i)) - c.slip_mu
            most = max(most, abs(miss) * step * force[3 * i] * c.grip / c.mu)
            c.slip_mu = by_secant(c, c.slip_mu, miss)
    return most


@kernel
def by_secant(c, mu, miss):
    """Return a better mu of contact `c`, which misses its law by `miss`; a law may change steeply."""
    slope = -1.0
    if mu != c.mu_before:
        slope = min((miss - c.miss) / (mu - c.mu_before), LEAST_SLOPE)
    c.mu_before, c.miss = mu, miss
    return max(0.0, mu - miss / slope)


@kernel
def crosses_rest(work, i):
    """Return whether the slip of contact `i` turns by more than a right angle in a step."""
    u, v, a = work.now.velocity, work.new.velocity, 3 * i + 1
    return u[a] * v[a] + u[a + 1] * v[a + 1] < 0.0


@kernel
def jump(c, i, work, passage, h):
    """Return the error of a step of length h within which a law passes between its two coefficients."""
    change = abs(c.mu - in_slip(c, passage, slip_of(work.new.velocity, i)))
    return change * work.stages.force[5, 3 * i] * h * c.grip / c.mu


@unit
def pull(k, work, passage, state, slow) -> float:
    """Return the greatest acceleration of contacts with a law that are to stick, in a `LayerState`.

    It is relative to that by their own friction, and written for each. Contacts that slip by more
    than `slow` have the friction of slip; that of all others is the convex problem for accelerations.
    """
    force, a, d, u = work.scratch, work.error, state.depth, state.velocity
    z, size = gather_discs(k, work, u, slow), 0.0
    for i in range(k):
        n, c = 3 * i, work.contact[i]
        # an instant later, where a contact that closes has a force
        force[n] = law.force(c, d[i] + INSTANT * max(0.0, -u[n]), passage.exponent)
        force[n + 1], force[n + 2], mu, slip = 0.0, 0.0, c.mu, slip_of(u, i)
        if by_law(c) and c.sticks == 0:
            mu = in_slip(c, passage, slip)
        c.slip_mu = mu
        if c.sticks == 0 and slip > slow:
            force[n + 1], force[n + 2] = (
                -mu * force[n] * u[n + 1] / slip,
                -mu * force[n] * u[n + 2] / slip,
            )
        size = max(size, force[n] * c.grip)
        a[n], a[n + 1], a[n + 2], c.pull = 0.0, 0.0, 0.0, 0.0
    add_product(3 * k, work.W, force, a)
    if z > 0:
        solve_discs(z, work, 1.0, force, a, IMPACT_ERROR * size)
        push((k, z), work, 1.0, force, a)
    greatest = 0.0
    for s in range(z):
        i = work.discs[s]
        c = work.contact[i]
        if by_law(c) and c.sticks == 1 and size > 0.0:
            c.pull = slip_of(a, i) / size
            greatest = max(greatest, c.pull)
    set_mu(gather_discs(k, work, u, math.inf), work, passage, u)
    return greatest


@kernel
def let_go(k, work, passage, slow):
    """Let contacts slip that their static coefficient cannot hold; those beside them may follow.

    Write the forces of this instant.
    """
    while pull(k, work, passage, work.now, slow) > PULL:
        for i in range(k):
            if work.contact[i].pull > PULL:
                work.contact[i].sticks = 0
    for i in range(3 * k):
        work.stages.force[0, i] = work.scratch[i]
