"""A step of a heap, taken whole: free flight, one contact problem, back to the surfaces (Moreau 1988).

With rows G of the middle of the free flight from (q_0, v_0) to (q_f, v_f), and the inverse mass P at its end,

    w = G v_f + G P G^T p,    0 <= p_n _|_ w_n - b >= 0,    p_t in -mu p_n d|w_t|,
    pi_1 = pi_f + G^T p,      q_1 = Exp_q_f(h/2 P G^T p),

b = e |u_n| where a contact strikes, 0 where it stays (`pose.set_bound`). So q_1 goes with the mean of the
velocities, and the energy changes by p . (G v_0 + G v_1)/2, up to what the return to the surfaces moves.
Order 1. (Mathematics page, VI.9.)
"""

from __future__ import annotations

import math

from carom.dispatch import by_address
from carom.geometry.rotation import norm, rotate, rotate_back
from carom.heap.finish import finish
from carom.heap.pose import pose
from carom.heap.solve import solve
from carom.heap.spots import gather, place_all
from carom.heap.surface import move, onto_surfaces
from carom.hold.balance import kinetic
from carom.hold.middle import halfway, spin_momentum
from carom.jit import kernel, unit
from carom.motion.explicit import keep
from carom.motion.free import free_flight
from carom.system import records as r

FINE = 0.1  # of the speed below which bodies rest: to be reached, or they never would
FAR = (
    0.25  # of its ball: a body goes no further in a piece of the step; alone it turns no more [rad]
)
MISSED = -1  # an impact within a piece
CAREFUL, SHORTEST = (
    300,
    1e-4,
)  # pieces of a step that may be cut for that; of the step: none is shorter
ALONE = 16  # pieces of a step of a body that is alone: they cost little


@unit
def heap_unit(system, controls, held, now, begin, length, heap, work, clocks, records):
    """Move all bodies of an island to the end of the step; a code for `run` goes to `work.result`."""
    clock, result = clocks[0], work.result[0]
    result.code = 0
    while clock.spent < length:
        if clock.since > r.LONG:
            result.code = r.PAUSE
            return
        dt = piece(system, now, controls.step, length - clock.spent)
        while True:
            clock.tries += 1
            careful = now.shape[0] == 1 and clock.tries <= CAREFUL and dt > SHORTEST * controls.step
            result.code = move_on(
                system, controls, held, now, begin, dt, careful, heap, work, clock, records
            )
            if result.code != MISSED:
                break
            dt *= 0.5
        if result.code != 0:
            return
        if dt == length - clock.spent:
            clock.spent = length
        else:
            clock.spent += dt


#: step_heap(address, system, controls, held, now, begin, length, heap, work, clocks, records)
step_heap = by_address(heap_unit)


@kernel
def piece(system, now, step, left):
    """Return the time of the next piece: what is left in equal parts, so that no body goes too far in one."""
    g = norm(system.gravity)
    parts = math.ceil(ALONE * left / step) if now.shape[0] == 1 else 1.0
    for b in range(now.shape[0]):
        way = (norm(now[b].v) + g * left) * left
        parts = max(parts, math.ceil(way / (FAR * system.bodies[b].ball)))
        if now.shape[0] == 1:
            parts = max(parts, math.ceil(norm(now[b].w) * left / FAR))
    return min(left, max(left / parts, SHORTEST * step))


@kernel
def move_on(system, controls, held, now, begin, h, careful, heap, work, clock, records):
    """Make one piece of the step; return 0 or a code: MISSED if it was to be `careful` and is too long."""
    n, fall = now.shape[0], norm(system.gravity)
    k = gather(system, held, h, fall, now, heap, work)
    if k < 0:
        return r.NEEDS_SPOTS
    rows = r.MARGIN + k + held.count[0]
    if max(clock.event, clock.struck) + rows > records.event.shape[0]:
        return r.FULL
    for b in range(n):
        free_flight(system.bodies[b], system.gravity, h, now[b], heap.flight[b], work.body[b])
        halfway(now[b], heap.flight[b], work.stage[b])
        keep(heap.flight[b], work.trial[b])
    place_all(system, k, heap.flight, heap, heap.points[1], work)
    for i in range(k):
        heap.spots[i].left = heap.points[1][i].gap
    place_all(system, k, work.stage, heap, heap.points[0], work)
    pose(system, held, k, h, fall, now, heap)
    gamma, residual = solve(system, heap, k, n, FINE * controls.rest * fall * h, clock)
    for i in range(k):
        for j in range(3):
            heap.spots[i].impulse[j] = heap.p[3 * i + j]
    clock.trials += 1
    clock.pressed += 1
    clock.since += 10.0 * (k + n)
    if careful and misses_bounce(system, k, h, fall, heap):
        return MISSED
    clock.residual = max(clock.residual, residual)
    gain(system, gamma, heap, work.trial)
    move(n, 0.5 * h * gamma, work.trial, heap.problem)
    respin(system, heap.flight, work.trial)
    onto_surfaces(system, k, n, work.trial, heap, work)
    clock.now = begin + clock.spent + h
    impacts, bounces = clock.impacts, clock.bounces
    named = finish(
        system, controls, held, k, h, fall, residual, now, work.trial, heap, work, clock, records
    )
    if n == 1 and k > 0:
        gained = balance(system, now[0], heap.flight[0], work.trial[0], named)
        slow_down(system, take_over(gained, impacts, bounces, clock), work.trial[0])
    for b in range(n):
        keep(work.trial[b], now[b])
    return 0


@kernel
def balance(system, start, flight, end, named):
    """Return the energy that a body alone has gained, or lost, besides what is `named`.

    A gain is taken out of its impulses, all by one factor, if that is possible: each keeps its direction.
    """
    body, g = system.bodies[0], system.gravity
    gained = kinetic(body, end) - kinetic(body, start) - named
    for j in range(3):
        gained -= body.mass * g[j] * (end.x[j] - start.x[j])
    if not gained > 0.0:
        return gained
    # dE = a s^2 + b s for velocities v + s (v - v_f)
    q, v, w, d, t = end.Q, end.v, end.w, flight.v, flight.w
    l = spin_momentum(body, q, w[0], w[1], w[2])
    k = spin_momentum(body, q, w[0] - t[0], w[1] - t[1], w[2] - t[2])
    a, b = 0.0, 0.0
    for j in range(3):
        a += 0.5 * (body.mass * (v[j] - d[j]) ** 2 + k[j] * (w[j] - t[j]))
        b += body.mass * v[j] * (v[j] - d[j]) + l[j] * (w[j] - t[j])
    if not (b > 0.0 and b * b >= 4.0 * a * gained):
        return gained
    s = -2.0 * gained / (b + math.sqrt(b * b - 4.0 * a * gained))
    for j in range(3):
        v[j] += s * (v[j] - d[j])
        w[j] += s * (w[j] - t[j])
    return 0.0


@kernel
def take_over(gained, impacts, bounces, clock):
    """Put what has no name into the lines of a piece that began with these: none rises by it; return the rest.

    A body that stops within a piece comes back to the surface from where it would have sunk to: its impact has
    taken less.
    """
    if gained < 0.0:
        clock.bounces += gained
        return 0.0
    part = min(gained, impacts - clock.impacts)
    clock.impacts += part
    other = min(gained - part, bounces - clock.bounces)
    clock.bounces += other
    return gained - part - other


@kernel
def slow_down(system, gained, end):
    """Take energy out of the motion of a body, all of it by one factor: points keep sticking and sliding so.

    What a body gains that turns far within a piece, as it comes back to the surface.
    """
    energy = kinetic(system.bodies[0], end)
    if not gained > 0.0 or not energy > 0.0:
        return
    factor = math.sqrt(max(0.0, 1.0 - gained / energy))
    for j in range(3):
        end.v[j] *= factor
        end.w[j] *= factor


@kernel
def misses_bounce(system, k, h, fall, heap):
    """Return whether a point that was open is struck within the piece and would bounce: no blow was written."""
    for i in range(k):
        spot = heap.spots[i]
        contact = system.contacts[spot.contact]
        if spot.turns == 0 and spot.gap > 0.0 and spot.left > 0.0 and spot.impulse[0] > 0.0:
            e = contact.restitution
            if 2.0 * e * spot.gap / h > (1.0 - e) * fall * h + contact.still:
                return True
    return False


@kernel
def gain(system, gamma, heap, end):
    """Add to the velocities what the impulses give, with the inertia at the end of the flight."""
    for b in range(end.shape[0]):
        xi = heap.problem.body[b].motion
        for j in range(3):
            end[b].v[j] += gamma * xi[j]
            end[b].w[j] += gamma * xi[3 + j]


@kernel
def respin(system, flight, end):
    """Keep angular momenta as the bodies are turned on: w = J(q_1)^-1 J(q_f) w."""
    for b in range(end.shape[0]):
        if system.bodies[b].isotropic == 1:
            continue
        q, w, J = end[b].Q, end[b].w, system.bodies[b].inertia
        l = spin_momentum(system.bodies[b], flight[b].Q, w[0], w[1], w[2])
        a = rotate_back(q[0], q[1], q[2], q[3], l[0], l[1], l[2])
        w[0], w[1], w[2] = rotate(q[0], q[1], q[2], q[3], a[0] / J[0], a[1] / J[1], a[2] / J[2])
