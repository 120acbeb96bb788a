"""A step of a crowd, taken whole: free flight, one contact problem, back to the surfaces (Moreau 1988).

With rows G of the middle of the free flight from (q_0, v_0) to (q_f, v_f), and the inverse mass P at its end,

    w = G v_f + G P G^T p,    0 <= p_n _|_ w_n - b >= 0,    p_t in -mu p_n d|w_t|,
    pi_1 = pi_f + G^T p,      q_1 = Exp_q_f(h/2 P G^T p),

b = e |u_n| where a contact strikes, 0 where it stays (`pose.set_bound`). So q_1 goes with the mean of the
velocities, and the energy changes by p . (G v_0 + G v_1)/2, up to what the return to the surfaces moves.
Order 1. (Mathematics page, VI.9.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.explicit import copy_state
from carom.geometry.rotation import norm, rotate, rotate_back
from carom.kinematics.contact_point import contact_velocity
from carom.kinematics.flight import free_flight
from carom.model import records as r
from carom.persistent.middle_state import halfway, spin_momentum
from carom.persistent.step_control import affordable, kinetic, lost_by, weigh
from carom.stepping.crowd.finish import finish
from carom.stepping.crowd.layout import SPOTS
from carom.stepping.crowd.pose import note_drift, pose
from carom.stepping.crowd.solve import solve
from carom.stepping.crowd.spots import gather, place_all
from carom.stepping.crowd.surface import move, onto_surfaces
from carom.stepping.record import grow

FINE = 0.1  # of the speed below which bodies rest: to be reached, or they never would
# of its ball: a body goes no further in a piece of the step; alone it turns no more [rad]. Bodies of a group go
# no further than this part of their thickness either, or THIN of the way before where that is more
FAR, THIN = 0.25, 1.0 / 32.0
MISSED = -1  # a piece that is too long
# pieces of a step that may be cut for that, where it can afford them; of the step: none is shorter
CAREFUL, SHORTEST = 300, 1e-4
ALONE = 16  # pieces of a step of a body that is alone: they cost little
# of a group: what a piece may gain, and what it may be off by besides, as parts of the kinetic energy and of
# m g times the size of its bodies
GAINS, OFF = 1e-7, 1e-4


@unit
def step_crowd(model, data):
    """Move all bodies of an island to the end of the step; a code for `run` goes to `work.result`.

    Few of them, which could not go from event to event, in pieces that are cut where that does not do.
    """
    system, controls = model.system, model.controls
    now, work, clocks = data.state, data.work, data.clocks
    clock, result, search = clocks[0], work.result[0], work.search[0]
    few = now.shape[0] < controls.heap
    result.code = 0 if data.crowd.spots.shape[0] >= SPOTS else grow(clock, r.FULL_SPOTS)
    if result.code != 0:
        return
    if clock.spent == 0.0:
        search.pace = math.inf
    while clock.spent < clock.length:
        if clock.since > r.LONG:
            result.code = r.PAUSE
            return
        dt = min(piece(system, now, controls.step, clock.length - clock.spent, few), search.pace)
        while True:
            clock.tries += 1
            patient = few and clock.tries <= CAREFUL and clock.effort <= affordable(controls, clock)
            careful = patient and dt > SHORTEST * controls.step
            result.code = move_on(model, data, dt, patient, careful)
            if result.code != MISSED:
                break
            dt *= 0.5
        if result.code != 0:
            return
        search.pace = 2.0 * dt
        if dt == clock.length - clock.spent:
            clock.spent = clock.length
        else:
            clock.spent += dt


@kernel
def piece(system, now, step, left, few):
    """Return the time of the next piece: what is left in equal parts, so that no body goes too far in one."""
    g, n = norm(system.gravity), now.shape[0]
    parts = math.ceil(ALONE * left / step) if n == 1 else 1.0
    for b in range(n):
        body, turn = system.bodies[b], norm(now[b].w) * left
        way, far = (norm(now[b].v) + g * left) * left, FAR * body.ball
        if n == 1:
            parts = max(parts, math.ceil(turn / FAR))
        elif few:
            way += turn * body.ball
            far = max(THIN * far, min(far, FAR * thickness(body)))
        parts = max(parts, math.ceil(way / far))
    return min(left, max(left / parts, SHORTEST * step))


@kernel
def thickness(body):
    """Return the least of the lengths of a box that has the moments of the body: 6 (J_1 + J_2 - J_3)/m."""
    J = body.inertia
    least = J[0] + J[1] + J[2] - 2.0 * max(J[0], max(J[1], J[2]))
    return math.sqrt(6.0 * max(0.0, least) / body.mass)


@kernel
def move_on(model, data, h, patient, careful):
    """Make one piece of the step; return 0 or a code: MISSED if it was to be `careful` and is too long."""
    system, controls = model.system, model.controls
    active, now, crowd, work, clock, records = (
        data.active,
        data.state,
        data.crowd,
        data.work,
        data.clocks[0],
        data.records,
    )
    n, fall = now.shape[0], norm(system.gravity)
    k = gather(system, active, h, fall, now, crowd, work)
    if k < 0:
        return grow(clock, r.FULL_SPOTS)
    rows = r.MARGIN + k + active.count[0]
    if max(clock.event, clock.struck) + rows > records.event.shape[0]:
        return grow(clock, r.FULL_EVENTS)
    for b in range(n):
        free_flight(system.bodies[b], system.gravity, h, now[b], crowd.flight[b], work.body[b])
        halfway(now[b], crowd.flight[b], work.stage[b])
        copy_state(crowd.flight[b], work.trial[b])
    place_all(system, k, crowd.flight, crowd, crowd.points[1], work)
    for i in range(k):
        crowd.spots[i].left = crowd.points[1][i].gap
    place_all(system, k, work.stage, crowd, crowd.points[0], work)
    if 1 < n < controls.heap:
        place_all(system, k, now, crowd, crowd.points[1], work)
    note_drift(active, k, 1 < n < controls.heap, now, crowd)
    pose(system, active, k, h, fall, now, crowd)
    gamma, residual = solve(
        system, crowd, k, n, FINE * controls.rest * fall * h, patient and n > 1, clock
    )
    for i in range(k):
        for j in range(3):
            crowd.spots[i].impulse[j] = crowd.p[3 * i + j]
    clock.trials += 1
    clock.contact_steps += 1
    clock.since += 10.0 * (k + n)
    clock.effort += 10.0 * (k + n)
    if careful and misses_bounce(system, k, h, fall, crowd):
        return MISSED
    gain(system, gamma, crowd, work.trial)
    move(n, 0.5 * h * gamma, work.trial, crowd.problem)
    respin(system, crowd.flight, work.trial)
    onto_surfaces(system, k, n, work.trial, crowd, work)
    if careful and n > 1 and off(system, k, now, work.trial, crowd):
        return MISSED
    clock.residual = max(clock.residual, residual)
    clock.now = clock.begin + clock.spent + h
    impacts, friction, bounces = clock.impacts, clock.friction, clock.bounces
    named = finish(model, data, k, h, fall, residual)
    if k > 0:
        gained = energy_gained(system, now, work.trial)
        if n < controls.heap:  # alone it gains nothing beside what is named, a group nothing at all
            most = named if n == 1 else 0.0
            gained -= take_out(system, gained - most, crowd.flight, work.trial)
        left = take_over(gained - named, impacts, friction, bounces, clock)
        if n == 1:
            slow_down(system, left, work.trial[0])
    for b in range(n):
        copy_state(work.trial[b], now[b])
    return 0


@kernel
def energy_gained(system, start, end):
    """Return what bodies that only gravity acts on have gained, kinetic and potential."""
    gained = 0.0
    for b in range(start.shape[0]):
        gained -= lost_by(system, b, start, end)
    return gained


@kernel
def off(system, k, start, end, crowd):
    """Return whether a group gains, or loses or gains by the way back to the surfaces, too much in a piece."""
    gained, size, work = energy_gained(system, start, end), 0.0, 0.0
    for b in range(start.shape[0]):
        size += kinetic(system.bodies[b], start[b]) + weigh(system, b, start, end)
    for i in range(k):
        u, p = crowd.spots[i].before, crowd.spots[i].impulse
        w = contact_velocity(crowd.points[0][i], end)
        for j in range(3):
            work += 0.5 * p[j] * (u[j] + w[j])
    return not (gained <= GAINS * size and abs(gained - work) <= OFF * size)


@kernel
def take_out(system, gained, flight, end):
    """Take an energy that was gained out of the impulses of all bodies that move; return what was taken.

    All by one factor, so that each keeps its direction, if that is possible.
    """
    if not gained > 0.0:
        return 0.0
    # dE = a s^2 + b s for velocities v + s (v - v_f)
    a, b = 0.0, 0.0
    for m in range(end.shape[0]):
        body, q, v, w = system.bodies[m], end[m].Q, end[m].v, end[m].w
        d, t = flight[m].v, flight[m].w
        l = spin_momentum(body, q, w[0], w[1], w[2])
        k = spin_momentum(body, q, w[0] - t[0], w[1] - t[1], w[2] - t[2])
        if moves(end[m]):
            for j in range(3):
                a += 0.5 * (body.mass * (v[j] - d[j]) ** 2 + k[j] * (w[j] - t[j]))
                b += body.mass * v[j] * (v[j] - d[j]) + l[j] * (w[j] - t[j])
    if not (b > 0.0 and b * b >= 4.0 * a * gained):
        return 0.0
    s = -2.0 * gained / (b + math.sqrt(b * b - 4.0 * a * gained))
    for m in range(end.shape[0]):
        v, w, d, t = end[m].v, end[m].w, flight[m].v, flight[m].w
        for j in range(3 if moves(end[m]) else 0):
            v[j] += s * (v[j] - d[j])
            w[j] += s * (w[j] - t[j])
    return gained


@kernel
def moves(state):
    """Return whether a body is not at rest."""
    return norm(state.v) > 0.0 or norm(state.w) > 0.0


@kernel
def take_over(gained, impacts, friction, bounces, clock):
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
    last = min(gained - part - other, friction - clock.friction)
    clock.friction += last
    return gained - part - other - last


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
def misses_bounce(system, k, h, fall, crowd):
    """Return whether a point that was open is struck within the piece and would bounce: no blow was written."""
    for i in range(k):
        spot = crowd.spots[i]
        contact = system.contacts[spot.contact]
        if spot.turns == 0 and spot.gap > 0.0 and spot.left > 0.0 and spot.impulse[0] > 0.0:
            e = contact.restitution
            if 2.0 * e * spot.gap / h > (1.0 - e) * fall * h + contact.still:
                return True
    return False


@kernel
def gain(system, gamma, crowd, end):
    """Add to the velocities what the impulses give, with the inertia at the end of the flight."""
    for b in range(end.shape[0]):
        xi = crowd.problem.body[b].motion
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
