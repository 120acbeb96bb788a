"""A time-stepping step of a crowd (Moreau 1988): free flight, one contact problem, return to the surfaces.

With rows G of the middle of the free flight from (q_0, v_0) to (q_f, v_f), and the inverse mass P at its end,

    w = G v_f + G P G^T p,    0 <= p_n _|_ w_n - b >= 0,    p_t in -mu p_n d|w_t|,
    pi_1 = pi_f + G^T p,      q_1 = Exp_q_f(h/2 P G^T p),

with b = e |u_n| for a contact that strikes, and 0 for a persistent contact (`pose.set_bound`). So q_1 follows
the mean of the velocities, and the energy changes by p . (G v_0 + G v_1)/2, except for the return to the
surfaces. The step has order 1. (Mathematics page, §3.9.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.depth import deepest
from carom.contact.operations import turning_radius
from carom.contact.thresholds import SAFE_DISPLACEMENT
from carom.dynamics.explicit import CONSTRAINTS_LOST, copy_state
from carom.dynamics.more_forces import note_turns
from carom.dynamics.project import project_velocity
from carom.geometry.rotation import norm
from carom.geometry.thresholds import RESOLUTION
from carom.geometry.vectors import dot, minus
from carom.law.restitution import restitution_at
from carom.model import records as r
from carom.model.allowance import COUNT_BLOCKS, left
from carom.model.laws import STRIKES
from carom.model.workspace import MOTION_POINT
from carom.persistent.thresholds import SHORTEST_CUT
from carom.status import BLOCKED, LEFT_CURVE, NOT_FINITE
from carom.stepping import thresholds as limits
from carom.stepping.crowd.balance import (
    assign_energy,
    breaks_balance,
    energy_gained,
    remove_energy,
    scale_velocity,
)  # fmt: skip
from carom.stepping.crowd.blocked import blocked
from carom.stepping.crowd.error import note_error
from carom.stepping.crowd.finish import finish
from carom.stepping.crowd.free_motion import (
    TOO_LONG,
    fly,
    follow_path,
    greatest_change,
    is_loaded,
    power_of_path,
    work_on_path,
)
from carom.stepping.crowd.impulses import find_impulses, find_points, impose, lift_others
from carom.stepping.crowd.layout import SPOTS
from carom.stepping.crowd.solve import greatest_speed
from carom.stepping.record import finite, grow

CUT_TRIES = 300  # greatest number of tries with pieces that may be cut
CUT_PRODUCTS = 500.0  # products with blocks per active point that are left where a piece may be cut
POINT_SEARCHES = 16  # at most, for points: a row of bodies pushes one more each time
PIECES_OF_ONE = 16  # number of pieces of a step of a single body, which are cheap


@unit
def step_crowd(model, data, method) -> int:
    """Move all bodies of an island to the end of the step; return a code for `run`.

    The step is divided into pieces; a piece that is too long is divided again while the work allowance permits
    it.
    """
    system, controls = model.system, model.controls
    now, work = data.state, data.work
    step, search = work.step[0], work.search[0]
    if data.crowd.closed.shape[0] < SPOTS:
        return grow(step, r.FULL_SPOTS)
    if step.spent == 0.0:
        search.pace = math.inf
    while step.spent < step.length:
        if step.since > r.LONG:
            return r.PAUSE
        dt = min(piece(system, now, controls, step.length - step.spent), search.pace)
        while True:
            step.tries += 1
            affordable = left(controls, step, COUNT_BLOCKS) >= CUT_PRODUCTS * data.active.count[0]
            patient = step.tries <= CUT_TRIES and affordable
            careful = patient and dt > SHORTEST_CUT * controls.interval
            code = move_on(model, data, method, dt, patient, careful)
            if code == CONSTRAINTS_LOST and dt > SHORTEST_CUT * controls.interval:
                code = TOO_LONG
            if code != TOO_LONG:
                break
            dt *= 0.5
        if code != 0:
            return code
        search.pace = 2.0 * dt
        if dt == step.length - step.spent:
            step.spent = step.length
        else:
            step.spent += dt
    return 0


@kernel
def piece(system, now, controls, left):
    """Return the length of the next piece: an equal part of the rest, in which no body moves too far."""
    g, step, n = controls.pull, controls.interval, now.shape[0]
    parts = math.ceil(PIECES_OF_ONE * left / step) if n == 1 else 1.0
    for b in range(n):
        body, turn = system.bodies[b], norm(now[b].w) * left
        if not body.ball > 0.0:  # the body has no shape
            continue
        distance, far = (norm(now[b].v) + g * left) * left, SAFE_DISPLACEMENT * body.ball
        if n == 1:
            parts = max(parts, math.ceil(turn / SAFE_DISPLACEMENT))
        else:
            distance += turn * body.ball
            far = max(limits.THIN_PART * far, min(far, SAFE_DISPLACEMENT * thickness(body)))
        parts = max(parts, math.ceil(distance / far))
    for i in range(system.flexible.bodies.shape[0]):  # modes must not turn far
        parts = max(parts, math.ceil(left * system.flexible.bodies[i].fastest))
    for i in range(system.contacts.shape[0]):  # a pin must not pass through its bush within a piece
        contact = system.contacts[i]
        far = SAFE_DISPLACEMENT * turning_radius(system, contact)
        if far < math.inf:
            speed = relative_speed(contact, now) + g * left
            parts = max(parts, speed * left / far)
    return min(left, max(left / parts, SHORTEST_CUT * step))


@kernel
def relative_speed(contact, state):
    """Return a bound of the speed of any points of two bodies beside each other."""
    a, b = state[contact.body], contact.other
    v, speed = (a.v[0], a.v[1], a.v[2]), contact.extent * norm(a.w)
    if b >= 0:
        o = state[b]
        v = minus(v, (o.v[0], o.v[1], o.v[2]))
        speed += contact.other_extent * norm(o.w)
    return math.sqrt(dot(v, v)) + speed


@kernel
def thickness(body):
    """Return the shortest edge of a box with the body's moments of inertia, (6 (J_1 + J_2 - J_3)/m)^1/2."""
    J = body.inertia
    least = J[0] + J[1] + J[2] - 2.0 * max(J[0], max(J[1], J[2]))
    return math.sqrt(6.0 * max(0.0, least) / body.mass)


@kernel
def move_on(model, data, method, h, patient, careful):
    """Make one piece of the step; return 0 or a code, TOO_LONG if `careful` and the piece is too long."""
    system, now, crowd, work = model.system, data.state, data.crowd, data.work
    clock, n, end, loaded = data.clocks[0], now.shape[0], work.trial, is_loaded(system)

    # the motion without contacts, then the impulses
    shortest = h <= SHORTEST_CUT * model.controls.interval
    code, loads, rubbing = fly(model, data, method, h, loaded, not shortest)
    if code == 0 and loaded and shortest and not finite(crowd.flight):
        code = NOT_FINITE  # a force without a value: no piece is short enough
    if code != 0:
        return code
    fall = norm(system.gravity)
    if loaded:
        fall = max(fall, greatest_change(system, now, crowd.flight) / h)
    code, k, residual, driven = collide(model, data, h, fall, patient, careful)
    if code == 0 and loaded and k > 0 and follow_path(system, h, now, end, crowd, work):
        code, k, residual, driven = collide(model, data, h, fall, patient, careful)
    if code != 0:
        return code

    # the work of loads and of friction in joints, on the actual path
    applied, rubbed = driven, 0.0
    if loaded:
        search = work.search[0]
        taken, rubbed = power_of_path(system, h, now, end, crowd.middle, work)
        applied = driven + work_on_path(search.applied, h, loads, taken)
        rubbed = work_on_path(search.friction, h, rubbing, rubbed)
    gained = energy_gained(model, data, h, loaded) - applied - rubbed
    if careful and n > 1 and breaks_balance(model, data, k, gained):
        return TOO_LONG

    # the energy balance, and the persistent contacts from now on
    clock.residual = max(clock.residual, residual)
    clock.now = work.step[0].begin + work.step[0].spent + h
    impacts, friction, bounces = clock.impacts, clock.friction, clock.bounces
    named = finish(model, data, k, h, fall, residual)
    if k > 0:
        # compute the gain again, because bodies may have come to rest
        gained = energy_gained(model, data, h, loaded) - applied - rubbed
        taken = remove_energy(system, gained - (named if n == 1 else 0.0), crowd.flight, end)
        if taken > 0.0:
            project_velocity(system, end, False, work)
        gained -= taken
        left = assign_energy(gained - named, impacts, friction, bounces, clock)
        if n == 1 and not loaded:
            scale_velocity(system, left, end[0])
    clock.loads += applied
    clock.friction += rubbed
    if model.controls.order > 0:
        note_error(system, clock.now, h, now, end, work)
    for b in range(n):
        copy_state(end[b], now[b])
    return LEFT_CURVE if note_turns(system, now, h) else 0


@kernel
def collide(model, data, h, fall, patient, careful):
    """Find the impulses of all points that may touch in the piece, and again if other points have penetrated.

    Return a code, the number of points, the residual, and the work of prescribed motions.
    """
    system, crowd, work, clock = model.system, data.crowd, data.work, data.clocks[0]
    wide, n, times, before = 1.0, data.state.shape[0], 0, -1
    while True:
        k = find_points(model, data, h, fall, wide)
        if k < 0:
            return grow(work.step[0], r.FULL_SPOTS), k, 0.0, 0.0
        rows = r.MARGIN + k + data.active.count[0]
        if max(clock.event, clock.struck) + rows > data.records.event.shape[0]:
            return grow(work.step[0], r.FULL_EVENTS), k, 0.0, 0.0
        residual = find_impulses(model, data, k, h, fall, patient)
        speed = greatest_speed(crowd, k) + fall * h
        if careful and residual > limits.RESIDUAL_LIMIT * speed:
            return TOO_LONG, k, residual, 0.0  # a shorter piece is a different problem
        if blocked(system, k, h, limits.SLOW_RESIDUAL * speed, crowd, work.trial):
            return TOO_LONG if careful else BLOCKED, k, residual, 0.0
        if careful and misses_bounce(system, k, h, fall, crowd):
            return TOO_LONG, k, residual, 0.0
        driven, holds = impose(model, data, k, h)
        if not holds:
            return CONSTRAINTS_LOST, k, residual, driven
        # candidates are on the surface; another feature may be inside, as a corner that came over an edge
        sunk = deepest(system, work.trial, work)[0] if n > 1 else 0.0
        times += 1
        if sunk <= RESOLUTION:
            return 0, k, residual, driven
        if times >= POINT_SEARCHES or (wide == limits.SEARCH_LIMIT and k == before):
            if sunk > limits.MISSED_DEPTH and h > limits.MISSED_PIECE * model.controls.interval:
                return TOO_LONG, k, residual, driven
            room, holds = lift_others(model, data, k, RESOLUTION)
            if not room:
                return grow(work.step[0], r.FULL_SPOTS), k, residual, driven
            return 0 if holds else CONSTRAINTS_LOST, k, residual, driven
        wide, before = min(limits.SEARCH_LIMIT, wide * limits.SEARCH_GROWTH), k


@kernel
def misses_bounce(system, k, h, fall, crowd):
    """Return whether a point closes within the piece and would bounce, so that an impact is missing."""
    for i in range(k):
        spot = crowd.closed[i]
        contact = system.contacts[spot.contact]
        between = spot.gap > 0.0 and spot.left > 0.0
        if spot.motion == MOTION_POINT and between and spot.impulse[0] > 0.0:
            e = restitution_at(system.laws, contact.law[STRIKES], spot.gap / h)
            if 2.0 * e * spot.gap / h > (1.0 - e) * fall * h + contact.still:
                return True
    return False
