"""The energy balance of a piece of a step: its error is removed, or assigned to entries of the ledger."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.energy import energies
from carom.dynamics.rotors import energy_of_change
from carom.geometry.rotation import norm
from carom.kinematics.contact_point import contact_velocity
from carom.persistent.middle_state import spin_momentum
from carom.persistent.step_control import kinetic, lost_by, weigh

# of a group: what a piece may gain, and what it may be off by besides, as parts of the kinetic energy and of
# m g times the size of its bodies
GAINS, OFF = 1e-7, 1e-4


@kernel
def energy_gained(model, data, h, loaded):
    """Return what the bodies have gained, kinetic and potential."""
    system, start, end, clock = model.system, data.state, data.work.trial, data.clocks[0]
    if not loaded:
        return gained_in_flight(system, start, end)
    t = clock.begin + clock.spent
    before, low, _ = energies(system, start, t)
    after, high, _ = energies(system, end, t + h)
    return (after + high) - (before + low)


@kernel
def gained_in_flight(system, start, end):
    """Return what bodies that only gravity acts on have gained."""
    gained = 0.0
    for b in range(start.shape[0]):
        gained -= lost_by(system, b, start, end)
    return gained


@kernel
def off(model, data, k, gained):
    """Return whether a group gains, or loses or gains by the way back to the surfaces, too much in a piece."""
    system, start, end, crowd = model.system, data.state, data.work.trial, data.crowd
    size, work = 0.0, 0.0
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
    a, b = energy_of_change(system, flight, end)
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
