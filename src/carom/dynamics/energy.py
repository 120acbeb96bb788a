"""Energies of a state: kinetic, potential, and the size of their terms, which bounds the round-off."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.forces import potential_energy
from carom.dynamics.rotors import rotor_energy
from carom.dynamics.stiff import stiff_energy
from carom.geometry.rotation import norm, rotate_back


@kernel
def kinetic_energy(system, state):
    """Return the kinetic energy of all bodies, and of inertia along coordinates of joints [J]."""
    total = 0.0
    for b in range(state.shape[0]):
        body, q, v, w = system.bodies[b], state[b].Q, state[b].v, state[b].w
        W, J = rotate_back(q[0], q[1], q[2], q[3], w[0], w[1], w[2]), body.inertia
        total += body.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        total += J[0] * W[0] * W[0] + J[1] * W[1] * W[1] + J[2] * W[2] * W[2]
    return 0.5 * total + rotor_energy(system, state)


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
