"""The contact problem of a crowd: sweeps, then Newton on the graph of the bodies as far as that pays.

Sweeps go on well from the last step's impulses where bodies move about, and hardly get on where one stands on
the other (a tower of twenty boxes: 1e-2 of g h after 200, and it falls). Newton does the latter in a few
factors, and needs hundreds of them where a thousand contacts slip and open.
"""

from __future__ import annotations

from carom._compiled.decorators import by_reference, kernel
from carom.friction import layout as o
from carom.friction.layout import BY_BODIES, ContactWork
from carom.friction.solve import scale_vectors
from carom.friction.strategy import copy, polished, release
from carom.stepping.crowd.graph import find_order
from carom.stepping.crowd.sweeps import sweep_until

FIRST, FEW, MOST = (
    40,
    2,
    200,
)  # sweeps before Newton on the graph, and on a W stored whole, and in all
SWEEP, UPDATE, CONTACT = 60.0, 130.0, 1000.0  # cost [ns] of a contact in a sweep, of factors
ENTRY = 9.0  # cost [ns] of the entries of a block in a sweep of a W stored whole
ITERATION = 0.3  # cost [us] of an iteration with it, by k^2
STEPS, ITERATIONS = 30, 150  # of them at most: of one call of Newton, and in all, about
PRECISE, AGREED = 1e-10, 1e-8  # of the largest velocity: wanted, and good enough if that is hard
RELEASE = 100  # iterations: with fewer a release of the proximal term gets nowhere
SHARE = 2.0  # of what all sweeps cost: for Newton
PATIENT = 10  # times as many of both, for a few bodies that stand on each other, while the step can afford it


@kernel
def solve(system, crowd, k, n, tolerance, effort, clock):
    """Solve for the scaled impulses; return the factor that they are to have, and the residual [m/s].

    `effort`: whether the bodies are few and may have more, and the work [us] that the step can afford.
    """
    patient, left = effort
    work, most = crowd.problem, MOST * (PATIENT if patient else 1)
    work.count[o.ITERATIONS] = 0
    gamma = scale_vectors(work, k, crowd.c, crowd.p)
    first = FIRST if work.kind == BY_BODIES else FEW
    r, goal, done = sweep_until(system, crowd, k, tolerance / gamma, first)
    speed = greatest_speed(crowd, k) / gamma
    enough = max(tolerance / gamma, goal, PRECISE * speed)
    if r > enough and not_turning(crowd, k):
        if work.kind == BY_BODIES:
            r = newton_on_graph(crowd, k, n, r, enough, (most, left))
        else:
            enough, most = max(enough, AGREED * speed), MOST
            r = newton_on_whole(crowd, k, r, enough, clock)
    if r > enough:
        r, _, more = sweep_until(system, crowd, k, enough, most - first)
        done += more
    clock.rounds += done
    each = SWEEP * k if work.kind == BY_BODIES else ENTRY * k * k
    clock.since += 2e-3 * each * done
    clock.effort += 1e-3 * each * done
    if work.kind == BY_BODIES:
        factors = work.count[o.ITERATIONS] * (UPDATE * crowd.graph.count[2] + CONTACT * k)
        clock.effort += 1e-3 * factors
    return gamma, gamma * r


@kernel
def greatest_speed(crowd, k):
    """Return the greatest normal or tangential velocity of a point at the start [m/s]."""
    most = 0.0
    for i in range(k):
        u = crowd.spots[i].before
        most = max(most, abs(u[0]), abs(u[1]), abs(u[2]))
    return most


@kernel
def newton_on_whole(crowd, k, least, enough, clock):
    """Improve the scaled impulses at hand, W stored whole; return the residual, which was `least`.

    Where points are more than bodies can follow, what they ask for agrees to about 1e-9 only, and Newton's way
    ends there: then once more after a release of the proximal term.
    """
    work = crowd.problem
    p, best = work.vector[o.P], work.vector[o.BEST]
    copy(k, p, best)
    work.count[o.LIMIT], work.count[o.BUDGET] = STEPS, ITERATIONS
    least = newton_and_keep(work, k, least)
    if least > enough:
        copy(k, best, p)
        release(work, k, enough)
        least = newton_and_keep(work, k, least)
    copy(k, best, p)
    clock.effort += ITERATION * k * k * work.count[o.ITERATIONS]
    clock.since += ITERATION * k * k * work.count[o.ITERATIONS]
    return least


@kernel
def newton_and_keep(work, k, least):
    """Apply Newton's method; keep what is better than `least`, and return the least residual."""
    work.mismatch[o.ENOUGH] = 0.0
    r, _, _ = polished(work, k, False, True)
    if r < least:
        copy(k, work.vector[o.P], work.vector[o.BEST])
        return r
    return least


@kernel
def not_turning(crowd, k):
    """Return whether there are no torques of rolling or pivoting, whose bounds follow in sweeps only."""
    for i in range(k):
        if crowd.spots[i].turns > 0:
            return False
    return True


@kernel
def newton_on_graph(crowd, k, n, least, enough, effort):
    """Improve the scaled impulses at hand, for about as much as `most` sweeps; return the residual.

    Where that is not enough by a release of the proximal term, too, if that may take `RELEASE` iterations.
    """
    most, left = effort
    if not find_order(n, k, crowd):
        return least
    pairs, updates = crowd.graph.count[3], crowd.graph.count[2]
    each = 1e-3 * (UPDATE * updates + CONTACT * k)
    factors = 1e-3 * SHARE * most * SWEEP * k / each
    if factors < 3.0:
        return least
    work = by_reference(part(crowd.problem, n, pairs, updates))
    p, best = work.vector[o.P], work.vector[o.BEST]
    copy(k, p, best)
    work.count[o.LIMIT], work.count[o.BUDGET] = int(factors), 0
    least = newton_and_keep(work, k, least)
    more = max(factors, left / each - work.count[o.ITERATIONS])
    if least > enough and more >= RELEASE:
        work.count[o.LIMIT] = 0
        work.count[o.BUDGET] = work.count[o.ITERATIONS] + int(more)
        release(work, k, enough)
        least = newton_and_keep(work, k, least)
    copy(k, best, p)
    return least


@kernel
def part(work, n, pairs, updates):
    """Return the problem with its arrays as long as the bodies and blocks at hand are many."""
    return ContactWork(
        work.kind,
        work.contact,
        work.vector,
        work.count,
        work.mismatch,
        work.W,
        work.matrix,
        work.pivot,
        work.active,
        work.link,
        work.body[:n],
        work.place[:n],
        work.later[:pairs],
        work.target[:updates],
        work.block[: n + 2 * pairs],
    )
