"""The energy balance of a piece of a step: its error is removed, or assigned to entries of the ledger."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.energy import energies, kinetic_of, spin_momentum
from carom.dynamics.rotors import energy_of_change
from carom.geometry.rotation import norm
from carom.persistent.step_control import lost_by, weigh
from carom.stepping.crowd.response import velocity_of
from carom.stepping.thresholds import CROWD_ERROR, CROWD_GAIN


@kernel
def energy_gained(model, data, h, loaded):
    """Return the gain of kinetic and potential energy of the bodies."""
    system, start, end, step = model.system, data.state, data.work.trial, data.work.step[0]
    if not loaded:
        return gained_in_flight(system, start, end)
    t = step.begin + step.spent
    before, low, _ = energies(system, start, t)
    after, high, _ = energies(system, end, t + h)
    return (after + high) - (before + low)


@kernel
def gained_in_flight(system, start, end):
    """Return the gain of energy of bodies on which only gravity acts."""
    gained = 0.0
    for b in range(start.shape[0]):
        gained -= lost_by(system, b, start, end)
    return gained


@kernel
def breaks_balance(model, data, k, gained):
    """Return whether a group gains too much energy, or the return to the surfaces changes it too much."""
    system, start, end, crowd = model.system, data.state, data.work.trial, data.crowd
    size, work = 0.0, 0.0
    for b in range(start.shape[0]):
        size += kinetic_of(system.bodies[b], start[b]) + weigh(system, b, start, end)
    for i in range(k):
        u, p = crowd.closed[i].before, crowd.closed[i].impulse
        w = velocity_of(system, crowd.points[0][i], crowd, end)
        for j in range(3):
            work += 0.5 * p[j] * (u[j] + w[j])
    return not (gained <= CROWD_GAIN * size and abs(gained - work) <= CROWD_ERROR * size)


@kernel
def remove_energy(system, gained, flight, end):
    """Remove the energy `gained` by scaling the impulses of all moving bodies; return the energy removed.

    One factor scales all of them, so that their directions do not change; if no factor does, return 0.
    """
    if not gained > 0.0:
        return 0.0
    # dE = a s^2 + b s for velocities v + s (v - v_f)
    a, b = energy_of_change(system, flight, end)
    for m in range(end.shape[0]):
        body, q, v, w = system.bodies[m], end[m].Q, end[m].v, end[m].w
        d, t = flight[m].v, flight[m].w
        l = spin_momentum(body, q, w)
        k = spin_momentum(body, q, (w[0] - t[0], w[1] - t[1], w[2] - t[2]))
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
def assign_energy(gained, impacts, friction, bounces, clock):
    """Assign an energy error to the entries of a piece, which began with these; return the rest.

    No entry rises in the piece. The error has a reason: a body that stops within a piece comes back to the
    surface from the depth to which it would have sunk, so that its impact has lost less.
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
def scale_velocity(system, gained, end):
    """Remove energy from the motion of a body by one factor, so that its points continue to stick and slide.

    A body that turns far within a piece gains this energy when it comes back to the surface.
    """
    energy = kinetic_of(system.bodies[0], end)
    if not gained > 0.0 or not energy > 0.0:
        return
    factor = math.sqrt(max(0.0, 1.0 - gained / energy))
    for j in range(3):
        end.v[j] *= factor
        end.w[j] *= factor
