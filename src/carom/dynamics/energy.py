"""Energies of a state: kinetic, potential, and the size of their terms, which bounds the round-off."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.elements.stiff import stiff_energy
from carom.dynamics.forces import potential_energy
from carom.dynamics.metric import metric_energy
from carom.dynamics.rotors import rotor_energy
from carom.geometry.rotation import norm, rotate, rotate_back
from carom.model.parts_of_system import has_metric


@kernel
def kinetic_of(body, state):
    """Return the kinetic energy of a body [J]."""
    q, v, w, J = state.Q, state.v, state.w, body.inertia
    W = rotate_back(q, w)
    total = body.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return 0.5 * (total + J[0] * W[0] * W[0] + J[1] * W[1] * W[1] + J[2] * W[2] * W[2])


@kernel
def kinetic_energy(system, state):
    """Return the kinetic energy of all bodies, and of inertia along coordinates of joints [J]."""
    if has_metric(system):
        return metric_energy(system, state)
    total = 0.0
    for b in range(state.shape[0]):
        total += kinetic_of(system.bodies[b], state[b])
    return total + rotor_energy(system, state)


@kernel
def spin_momentum(body, q, w):
    """Return the angular momentum J w of a body about its centre, world axes."""
    J, W = body.inertia, rotate_back(q, w)
    return rotate(q, (J[0] * W[0], J[1] * W[1], J[2] * W[2]))


@kernel
def energies(system, state, t):
    """Return kinetic and potential energy, and the size of their terms [J].

    The round-off of the energies is 1e-16 of this size: far from its zero a potential is a difference of large
    numbers, and positions are known to the round-off of coordinates and of the size of the bodies.
    """
    kinetic = kinetic_energy(system, state)
    potential = potential_energy(system, state, t) + stiff_energy(system, state)
    fall, size = norm(system.gravity), kinetic + abs(potential)
    for b in range(state.shape[0]):
        size += system.bodies[b].mass * fall * (norm(state[b].x) + system.bodies[b].extent)
    return kinetic, potential, size
