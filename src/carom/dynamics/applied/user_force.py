"""Forces of functions of the user's: wrenches = f(t, states), with U if a potential is given."""

from __future__ import annotations

import math

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom.geometry.rotation import conjugate, multiply


@kernel
def read_states(system, force, state):
    """Write x, Q, v, w of the bodies of a user's force, in the axes of the scene."""
    relations, i = system.relations, 0
    read = relations.memory.read
    for n in range(force.first, force.last):
        b = relations.named[n]
        Q, a = state[b].Q, system.bodies[b].axes
        for k in range(3):
            read[i + k] = state[b].x[k]
            read[i + 7 + k], read[i + 10 + k] = state[b].v[k], state[b].w[k]
        q = multiply(Q, conjugate(a))
        read[i + 3], read[i + 4], read[i + 5], read[i + 6] = q
        i += 13


@kernel
def add(system, one, state, power, work):
    """Add the wrenches of a function; return `power` with theirs, unless they have a potential."""
    relations, at = system.relations, 0
    read_states(system, one, state)
    call_function(one.address, work.moment[0].time, relations.memory.read, relations.memory.write)
    for n in range(one.first, one.last):
        b = relations.named[n]
        wrench, v, w = work.body[b].wrench, state[b].v, state[b].w
        for k in range(6):
            f = relations.memory.write[at + k]
            wrench[k] += f
            if one.energy_address == 0:
                power += f * (v[k] if k < 3 else w[k - 3])
        at += 6
    return power, math.nan, math.nan, math.nan


@kernel
def acts_at(system, one, state):
    """Return the arm to where it acts: torques are about mass centres."""
    return 0.0, 0.0, 0.0


@kernel
def energy(system, one, state, t):
    """Return the energy of a potential [J], 0 without one."""
    relations = system.relations
    if one.energy_address == 0:
        return 0.0
    read_states(system, one, state)
    call_function(one.energy_address, t, relations.memory.read, relations.memory.write)
    return relations.memory.write[0]
