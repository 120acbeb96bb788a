"""Adaptive steps: the error of a step in metres, and the length of the next step.

With e_x, e_theta, e_v, e_w = h sum of E_s times the derivatives of the stages (an embedded pair), the error of
a body is

    miss = max(|e_x|, L |e_theta|, T |e_v|, T L |e_w|),     T = L / max(V, sqrt(L a)),

where L is its size (`extent`), V its greatest speed and a its greatest acceleration in the step, both including
rotation at the distance L. So an error of velocity counts as the displacement that it causes while the body
moves by its own size. A step is accepted if for all bodies

    miss <= ERROR_SHARE (atol + rtol max(L, h V)),

a fraction of the tolerance of a run, because errors of steps add up. Order 8 has two estimates: miss = miss_5^2
/ sqrt(miss_5^2 + miss_3^2/100) (Hairer, Norsett and Wanner 1993). Groups in contact have the estimates of
`carom.persistent.members`; free flight has no error.

A kink of a force within a step, at the part s of it, gives every embedded error a term that is 0 at some s, so
that any of them misses the kink there. Where forces may have kinks there are three errors of order 5, which are
not 0 together: the greatest of them, miss_k, is at least a third of the error of a kink or jump. In smooth
steps of a useful length miss_k is below a tenth of miss_3, at kinks above, which tells them apart. A body that
has met a kink has miss_k in the place of miss_5 from then on (others keep longer steps), and a hundredfold of
it is an error, too: a kink near the start of a step hides behind miss_3, and flights between kinks add up what
each does to the speed.

The next step is 0.9 times the length whose error would equal the tolerance, between 0.2 and 10 times the last
length. Each island has steps of its own: `ahead` of its bodies.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.dynamics import thresholds as limits
from carom.geometry.rotation import norm
from carom.model.parts_of_system import has_metric

MISS_OF_OTHERS, MISS_SCALE = 2, 3  # places in `miss`
KINKS_IN_A_ROW = (
    2  # trial steps in a row that fail at a kink: a first step may be too long for any estimate
)


@kernel
def forget_misses(work):
    """Reset the errors of bodies."""
    for b in range(work.body.shape[0]):
        miss = work.body[b].miss
        miss[0], miss[1], miss[2], miss[MISS_SCALE] = 0.0, 0.0, 0.0, 0.0


@kernel
def note_misses(system, E, h, work):
    """Store for each body the greatest of its errors [m] by the rows of E, and its scale max(L, h V)."""
    for b in range(work.body.shape[0]):
        if system.bodies[b].ballistic == 1:
            continue
        note_miss(system, E, h, math.inf, b, work)


@kernel
def note_miss(system, E, h, longest, b, work):
    """Store the greatest errors [m] of body b by the rows of E, and its scale; T is at most `longest`.

    Return T.
    """
    L, miss = system.bodies[b].extent, work.body[b].miss
    speed, pace = pace_of(system, E, b, work)
    if has_metric(system):  # coordinates are one system: what is at rest does not wait for ever
        for other in range(work.body.shape[0]):
            pace = max(pace, pace_of(system, E, other, work)[1])
    T = min(longest, L / pace if pace > 0.0 else 0.0)
    for e in range(E.shape[0]):
        m, k = greatest_error(E[e], h, L, T, b, work), min(e, MISS_OF_OTHERS)
        if not m <= miss[k] and miss[k] == miss[k]:  # NaN stays
            miss[k] = m
    miss[MISS_SCALE] = max(miss[MISS_SCALE], max(L, abs(h) * speed))
    return T


@kernel
def pace_of(system, E, b, work):
    """Return the greatest speed of body b in a step, and its size over the time in which it moves by that."""
    L, bound = system.bodies[b].extent, work.body[b].bound
    speed = L * bound[2]
    for s in range(E.shape[1]):
        u = work.stages[s, b].speed
        speed = max(speed, math.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) + L * norm(u[3:]))
    return speed, max(speed, math.sqrt(L * (bound[0] + L * bound[1])))


@kernel
def greatest_error(weight, h, L, T, b, work):
    """Return the error [m] of body b by one row of weights."""
    x0, x1, x2, v0, v1, v2, w0, w1, w2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    q0, q1, q2, q3 = 0.0, 0.0, 0.0, 0.0
    for s in range(weight.size):
        f, stage = weight[s], work.stages[s, b]
        u, d, a = stage.speed, stage.turn, stage.rate
        x0, x1, x2 = x0 + f * u[0], x1 + f * u[1], x2 + f * u[2]
        v0, v1, v2 = v0 + f * a[0], v1 + f * a[1], v2 + f * a[2]
        w0, w1, w2 = w0 + f * a[3], w1 + f * a[4], w2 + f * a[5]
        q0, q1, q2, q3 = q0 + f * d[0], q1 + f * d[1], q2 + f * d[2], q3 + f * d[3]
    displacement = max(
        math.sqrt(x0 * x0 + x1 * x1 + x2 * x2),
        2.0 * L * math.sqrt(q0 * q0 + q1 * q1 + q2 * q2 + q3 * q3),  # half of the angle
    )
    rate = max(math.sqrt(v0 * v0 + v1 * v1 + v2 * v2), L * math.sqrt(w0 * w0 + w1 * w1 + w2 * w2))
    return abs(h) * (displacement + T * rate)


@kernel
def allowed_error(rtol, atol, extent, scale):
    """Return the tolerance for the error of a body in a step [m]."""
    return limits.ERROR_SHARE * (atol + rtol * max(extent, scale))


@kernel
def step_error(system, rtol, atol, work):
    """Return the greatest error of the bodies in a step, relative to the tolerance."""
    greatest = 0.0
    for b in range(work.body.shape[0]):
        miss = work.body[b].miss
        allowed = allowed_error(rtol, atol, system.bodies[b].extent, miss[MISS_SCALE])
        error = of_two(miss[0] / allowed, miss[1] / allowed)
        if miss[MISS_OF_OTHERS] > 0.0:
            most = max(miss[0], miss[MISS_OF_OTHERS])
            error = of_kinks(work.body[b], error, most / allowed, miss[1] / allowed)
        if not error <= greatest and greatest == greatest:  # NaN stays
            greatest = error
    return greatest


@kernel
def of_two(first, second):
    """Return the error from the two estimates of order 8; the second is 0 for methods with one estimate."""
    if second > 0.0:
        return first * first / math.sqrt(first * first + limits.THIRD_ORDER * second * second)
    return first


@kernel
def of_kinks(memory, error, most, second):
    """Return the error where forces may have kinks, and note whether the body or system has met some.

    `most` is the greatest of the estimates of order 5, and `error` the error without kinks.
    """
    if not error < math.inf:
        return error
    if memory.kinks < KINKS_IN_A_ROW:
        memory.kinks = memory.kinks + 1 if most > 1.0 and most > limits.KINK * second else 0
    if memory.kinks < KINKS_IN_A_ROW:
        return error
    return max(of_two(most, second), limits.KINK_WEIGHT * most)


@kernel
def allowed_step(left, work):
    """Return the length of the next step of an island, from the time that is left."""
    ahead = math.inf
    for b in range(work.body.shape[0]):
        ahead = min(ahead, work.body[b].ahead)
    return part_of(left, ahead)


@kernel
def part_of(left, ahead):
    """Return the next step within the time `left`: `ahead`, or half or all of it if 2 `ahead` do not fit."""
    return ahead if 2.0 * ahead <= left else 0.5 * left if ahead < limits.FINISH * left else left


@inlined
def crawls(clock, left, dt, longest):
    """Count trial steps of a length dt by which the time `left` would take too many; return whether to end.

    A force of 1e19 N m makes a body spin 1e18 times in a run: each step meets the tolerances, and there is no
    end. Steps of the longest length that was asked for do not count.
    """
    slow = left > limits.MOST_TRIALS * dt and 2.0 * dt < longest
    clock.slow = clock.slow + 1 if slow else max(0, clock.slow - 1)
    return clock.slow > limits.SLOW_TRIALS


@kernel
def shrunk(error, order):
    """Return the factor for the length of a step whose error was too large."""
    factor = limits.SAFETY * error ** (-1.0 / order)
    return factor if factor > limits.SHRINKAGE else limits.SHRINKAGE  # if the error is NaN, too


@kernel
def shorter(dt, error, clock, work):
    """Return the length to try after a step whose error was too large."""
    factor = shrunk(error, work.search[0].order)
    clock.rejected += 1
    for b in range(work.body.shape[0]):
        work.body[b].ahead = factor * dt
    return factor * dt


@kernel
def plan(memory, dt, error, again, order, longest):
    """Store in `memory` the length `ahead` of the next step; the others are as in `plan_next`."""
    factor = limits.GROWTH
    if error > 0.0:
        factor = min(limits.GROWTH, limits.SAFETY * error ** (-1.0 / order))
    fits = factor * dt
    trend = fits / memory.fits if memory.fits > fits else 1.0
    memory.fits = fits
    if factor == limits.GROWTH:
        ahead = max(memory.ahead, fits)
    else:
        ahead = min(dt if again else fits, max(limits.SHRINKAGE, trend) * fits)
    memory.ahead = min(ahead, longest)


@kernel
def plan_next(dt, error, again, controls, work):
    """Store the length of the next step after one of length dt; `again` is true if a trial was rejected before.

    A short step (the rest of the time after an event) does not shorten the next. If the length that fits the
    tolerance has shrunk since the last step, as it does before slip stops, it is expected to shrink by as much
    again (Gustafsson 1994).
    """
    for b in range(work.body.shape[0]):
        plan(work.body[b], dt, error, again, work.search[0].order, controls.interval)


def complete(rtol: float, atol: float | None, system) -> tuple[float, float]:
    """Return (rtol, atol [m]); the default of `atol` is `rtol` times the size of the smallest body."""
    return rtol, rtol * float(system.bodies["extent"].min()) if atol is None else atol


def time_of_bounces(system, tolerances: tuple[float, float], longest: float) -> float:
    """Return the time of a bounce as high as the tolerance, sqrt(8 tol/g): shorter ones are not resolved.

    It replaces the step where this is a measure of time, for persistent contacts and for bodies at rest.
    """
    g = math.sqrt(system.gravity @ system.gravity)
    if not system.contacts.size or g == 0.0:
        return longest
    rtol, atol = tolerances
    size = float(system.bodies["extent"][system.contacts["body"]].min())
    return min(longest, math.sqrt(8.0 * (atol + rtol * size) / g))
