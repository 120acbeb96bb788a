"""The impulses of a piece of a step, and the positions of the bodies after them."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.contact_impulse import gain
from carom.dynamics.element_operations import driven_power
from carom.dynamics.energy import spin_momentum
from carom.dynamics.explicit import copy_state
from carom.dynamics.project import project_velocity, shift
from carom.dynamics.rotors import add_rates, note_rates
from carom.dynamics.thresholds import ERROR_SHARE
from carom.friction.layout import ITERATE
from carom.geometry.rotation import rotate, rotate_back
from carom.geometry.thresholds import REMAINDER, RESOLUTION
from carom.kinematics.contact_point import power_of_surface
from carom.kinematics.moving_surfaces import set_surfaces
from carom.model.allowance import COUNT_BLOCKS, left
from carom.stepping.crowd.free_motion import halfway
from carom.stepping.crowd.pose import note_drift, pose
from carom.stepping.crowd.response import respond, velocity_of, write_responses
from carom.stepping.crowd.solve import solve
from carom.stepping.crowd.spots import gather, gather_sunk, place_all
from carom.stepping.crowd.surface import onto_surfaces

LIFTS = 4  # greatest number of searches for other penetrating features


@kernel
def find_points(model, data, h, fall, wide):
    """List the points that may touch, and place them at the end of the flight and at its middle; return k."""
    now, crowd, n, step = data.state, data.crowd, data.state.shape[0], data.work.step[0]
    set_surfaces(model.system, step.begin + step.spent + 0.5 * h)
    k = gather(model, data, h, fall, wide)
    if k < 0:
        return k
    for b in range(n):
        halfway(now[b], crowd.flight[b], crowd.pose[b])
    place_all(model, data, 0, k, crowd.flight, crowd.points[1])
    for i in range(k):
        crowd.closed[i].left = crowd.points[1][i].gap
    place_all(model, data, 0, k, crowd.pose, crowd.points[0])
    if n > 1:
        place_all(model, data, 0, k, now, crowd.points[1])
    note_drift(model.system, data.active, k, n > 1, now, crowd)
    return k


@kernel
def find_impulses(model, data, k, h, fall, patient):
    """Solve the contact problem of the piece, write its end velocities to the trial state, return the residual.

    If impacts with restitution would add energy, their restitution is reduced until they add none.
    """
    system, controls, n = model.system, model.controls, data.state.shape[0]
    crowd, work, clock = data.crowd, data.work, data.clocks[0]
    pose(model, data, k, h, fall)
    tolerance = ERROR_SHARE * controls.rest * fall * h
    most = left(controls, work.step[0], COUNT_BLOCKS) if patient else 0.0
    gamma, residual = solve(system, data, k, tolerance, most)
    respond(system, k, gamma, crowd, work)
    gain_all(crowd, work)
    clock.trials += 1
    clock.contact_steps += 1
    work.step[0].since += 10.0 * (k + n)
    if n > 1 and bounces_give(system, k, crowd, work.trial):
        more = limit_bounces(system, data, k, tolerance, most)
        residual = max(residual, more)
    for i in range(k):
        for j in range(3):
            crowd.closed[i].impulse[j] = crowd.p[3 * i + j]
    return residual


@kernel
def work_of(i, p, before, after):
    """Return the work of the impulse of a point: half of it times its velocities before and after."""
    n = 3 * i
    work = p[n] * (before[0] + after[0])
    return 0.5 * (work + p[n + 1] * (before[1] + after[1]) + p[n + 2] * (before[2] + after[2]))


@kernel
def bounces_give(system, k, crowd, end):
    """Return whether the impulses add energy and some point strikes."""
    total, size, strikes = 0.0, 0.0, False
    for i in range(k):
        one = work_of(
            i, crowd.p, crowd.closed[i].before, velocity_of(system, crowd.points[0][i], crowd, end)
        )
        total, size = total + one, size + abs(one)
        strikes = strikes or crowd.closed[i].strikes == 1
    return strikes and total > REMAINDER * size


@kernel
def limit_bounces(system, data, k, tolerance, most):
    """Reduce the restitution of all impacts of the piece by one factor, so that together they add no energy.

    The impulses p_0 without restitution lose energy. p = p_0 + s (p_e - p_0) is in the cones, and with it no
    point approaches. The work of p is quadratic in s, and its root is the greatest s without a gain of energy.
    """
    crowd, work = data.crowd, data.work
    full, end, problem = crowd.bouncing, work.trial, crowd.problem
    for i in range(3 * k):
        full[i] = crowd.p[i]
    for i in range(k):  # remove the bounds of restitution, and store w with restitution
        spot = crowd.closed[i]
        w = velocity_of(system, crowd.points[0][i], crowd, end)
        if spot.strikes == 1 and spot.bound + spot.drift[0] > 0.0:
            crowd.c[3 * i] += spot.bound + spot.drift[0]
        spot.after[0], spot.after[1], spot.after[2] = w
    gamma, residual = solve(system, data, k, tolerance, most)
    respond(system, k, gamma, crowd, work)
    gain_all(crowd, work)
    a, b, c = 0.0, 0.0, 0.0  # coefficients of the work a + b s + c s^2
    for i in range(k):
        u, w = crowd.closed[i].before, velocity_of(system, crowd.points[0][i], crowd, end)
        for j in range(3):
            p, d = crowd.p[3 * i + j], full[3 * i + j] - crowd.p[3 * i + j]
            dw = crowd.closed[i].after[j] - w[j]
            a += 0.5 * p * (u[j] + w[j])
            b += 0.5 * (d * (u[j] + w[j]) + p * dw)
            c += 0.5 * d * dw
    s = 1.0
    if a + b + c > 0.0:
        root = b + math.sqrt(max(0.0, b * b - 4.0 * a * c))
        s = min(1.0, -2.0 * a / root) if a < 0.0 < root else 0.0
    for i in range(3 * k):
        p = crowd.p[i] + s * (full[i] - crowd.p[i])
        problem.vector[ITERATE, i] = p / (gamma * problem.contact[i // 3].scale)
    respond(system, k, gamma, crowd, work)
    gain_all(crowd, work)
    return residual


@kernel
def gain_all(crowd, work):
    """Write the flight with the velocities that the impulses give it to the trial state; positions stay."""
    for b in range(work.trial.shape[0]):
        copy_state(crowd.flight[b], work.trial[b])
        gain(work.body[b].motion, work.trial[b])


@kernel
def impose(model, data, k, h):
    """Move the bodies by half of the velocities gained times the step, and back to surfaces and joints.

    Return the work of prescribed motions by the impulses, and whether the joints are closed at the end.
    """
    system, crowd, work, end = model.system, data.crowd, data.work, data.work.trial
    driven, joined = 0.0, system.joints.shape[0] > 0
    for i in range(k):
        driven += power_of_surface(crowd.points[0][i], crowd.pose, crowd.closed[i].impulse)
    work.moment[0].time = work.moment[0].start + h
    if joined:
        note_rates(system, crowd.flight)
        add_rates(system, crowd.flight, work)
        driven += driven_power(system, crowd.flight, work)  # the work of an impulse
    for b in range(end.shape[0]):
        shift(work.body[b].motion, 0.5 * h, end[b])
    holds = onto_surfaces(model, data, k) <= RESOLUTION
    respin(system, crowd.flight, end)
    if joined:
        project_velocity(system, end, True, work)
        driven += driven_power(system, end, work)
    return driven, holds


@kernel
def lift_others(model, data, k, depth):
    """Move bodies apart where other features are inside by more than `depth`; keep angular momenta.

    Such a feature was no candidate and has no impulse, for example a corner that has come over an edge of a
    face. Return whether there was room, and whether the joints are closed.
    """
    system, crowd, work = model.system, data.crowd, data.work
    end, holds = work.trial, True
    for b in range(end.shape[0]):
        copy_state(end[b], crowd.pressed[b])
    for _ in range(LIFTS):
        last = gather_sunk(model, data, k, depth)
        if last < 0:
            return False, holds
        if last == k:
            break
        place_all(model, data, k, last, end, crowd.points[0])
        write_responses(system, k, last, crowd, work)
        holds = onto_surfaces(model, data, last) <= RESOLUTION
    respin(system, crowd.pressed, end)
    project_velocity(system, end, True, work)
    return True, holds


@kernel
def respin(system, flight, end):
    """Keep the angular momenta of the bodies as they turn from q_f to q_1: w = J(q_1)^-1 J(q_f) w."""
    for b in range(end.shape[0]):
        if system.bodies[b].isotropic == 1:
            continue
        q, w, J = end[b].Q, end[b].w, system.bodies[b].inertia
        l = spin_momentum(system.bodies[b], flight[b].Q, w)
        a = rotate_back(q, l)
        w[0], w[1], w[2] = rotate(q, (a[0] / J[0], a[1] / J[1], a[2] / J[2]))
