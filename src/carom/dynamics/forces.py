"""Applied forces: the wrench on each body at its mass centre, and the power of those without potential."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.applied import BETWEEN_BODIES, added, energies
from carom.dynamics.metric import add_loads, chart_potential
from carom.dynamics.more_forces import add_more_forces, more_energy
from carom.geometry.rotation import cross, rotate, rotate_back

between_bodies, energies_between = added(BETWEEN_BODIES), energies(BETWEEN_BODIES)


@kernel
def applied_wrenches(system, state, gyroscopic, work):
    """Write gravity, all applied forces and, if `gyroscopic`, -w x I w.

    Return the power of the forces without potential: dampers and constant loads.
    """
    g = system.gravity
    for b in range(system.bodies.shape[0]):
        body, wrench = system.bodies[b], work.body[b].wrench
        for k in range(3):
            wrench[k] = body.mass * g[k]
            wrench[3 + k] = 0.0
        if gyroscopic and body.isotropic == 0:
            J, q, w = body.inertia, state[b].Q, state[b].w
            W = rotate_back(q, w)
            tx, ty, tz = cross(J[0] * W[0], J[1] * W[1], J[2] * W[2], W[0], W[1], W[2])
            wrench[3], wrench[4], wrench[5] = rotate(q, (tx, ty, tz))
    power = between_bodies(system, state, 0.0, work)
    power += add_loads(system, state, gyroscopic, work)
    return power + add_more_forces(system, state, work)


@kernel
def difference_of_loads(system, h, taken, without, work):
    """Write h times the difference of the applied forces in two states; return whether it is not zero."""
    applied_wrenches(system, taken, False, work)
    for b in range(system.bodies.shape[0]):
        wrench, kept = work.body[b].wrench, work.stages[0, b].rate
        for k in range(6):
            kept[k] = wrench[k]
    applied_wrenches(system, without, False, work)
    anything = False
    for b in range(system.bodies.shape[0]):
        wrench, kept = work.body[b].wrench, work.stages[0, b].rate
        for k in range(6):
            wrench[k] = h * (kept[k] - wrench[k])
            anything = anything or wrench[k] != 0.0
    return anything


@kernel
def potential_energy(system, state, t):
    """Return the potential energy of gravity and springs [J]."""
    g, potential = system.gravity, 0.0
    for b in range(system.bodies.shape[0]):
        x = state[b].x
        potential -= system.bodies[b].mass * (x[0] * g[0] + x[1] * g[1] + x[2] * g[2])
    potential = energies_between(system, state, t, potential)
    return potential + more_energy(system, state, t) + chart_potential(system, state, t)
