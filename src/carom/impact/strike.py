"""An impact within a run: pre-impact velocity, effective mass, boundary layer, new velocities, record."""

from __future__ import annotations

import math

from carom.contact.gap import round_off, slow, strike_point
from carom.contact.return_map import return_map
from carom.contact.work_mode import restore_work
from carom.dispatch import by_address, by_method
from carom.impact import laws, layout
from carom.impact.layer import E_MIN, traverse
from carom.impact.resolve import resolve
from carom.jit import kernel, unit
from carom.motion.acceleration import OPEN
from carom.motion.contact_point import (
    add_velocity,
    contact_arm,
    contact_velocity,
    effective_inverse_mass,
    spread,
)
from carom.motion.explicit import Explicit
from carom.motion.forces import potential_energy
from carom.motion.project import project_velocity
from carom.motion.three_field import ThreeField
from carom.system.notes import begin_event, end_event
from carom.system.records import IMPACT

LOCATE, WORK = 0, 2
RETURN_MAP_FAILED, IMPACT_FAILED = 5, 6


@kernel
def release(system, held, c, clock):
    """Open all held contacts that the impact at c reaches, and have them looked at again."""
    b = system.contacts[c].body
    joined = system.bodies[b].isolated == 0
    for i in range(held.shape[0]):
        other = system.contacts[i].body
        if other == b or (joined and system.bodies[other].isolated == 0):
            clock.released += 1 if held[i].mode != OPEN else 0
            held[i].mode = OPEN
            held[i].rest = 0
            held[i].near = 1
            held[i].leaving = 0


@kernel
def onto_surface(system, controls, c, state, work):
    """Put the body on the surface and its striking point into work.hit. Returns 0 or a status.

    After a located impact this is the last polish; after a whole step it is the paper's return map, and the
    velocity block is solved again with the position now fixed.
    """
    contact, point = system.contacts[c], work.hit[0].point
    tie = controls.tie * contact.extent
    tolerance = max(controls.gap * contact.extent, round_off(contact, state))
    rho, _ = strike_point(contact, system.vertices, state, tie, point)
    if rho >= -(tie if controls.location == LOCATE else tolerance):
        return 0
    before = potential_energy(system, state)
    if return_map(system, contact, state, work, tie, tolerance) < 0:
        return RETURN_MAP_FAILED
    if system.joints.shape[0] > 0:
        project_velocity(system, state, work)
    strike_point(contact, system.vertices, state, tie, point)
    if controls.location == WORK:
        restore_work(system, contact, state, before - potential_energy(system, state), work)
    return 0


@unit
def strike_unit(method, system, controls, held, c, state, work, clocks, records):
    """Resolve the impact of contact c; 0 or the number of a `Status` goes to work.hit.

    Velocities of `state` change; its position only by the return map.
    """
    contact, hit, hold, clock = system.contacts[c], work.hit[0], held[c], clocks[0]
    hit.code = onto_surface(system, controls, c, state, work)
    if hit.code != 0:
        return
    rx, ry, rz = contact_arm(contact, state, hit.point)
    u = contact_velocity(contact, state, rx, ry, rz)
    if u[0] < -slow(contact, state):
        release(system, held, c, clock)
        effective_inverse_mass(system, contact, state, rx, ry, rz, work, hit.W)
        hit.u[0], hit.u[1], hit.u[2] = u
        if collide(method, controls, contact, hit, work.history) != layout.OK:
            hit.code = IMPACT_FAILED
            return
        write_impact(contact, c, state, rx, ry, rz, hit, clock, records)
        begin_event(c, state, clock, records)
        out, P = hit.out, layout.IMPULSE
        spread(system, contact, state, rx, ry, rz, out[P], out[P + 1], out[P + 2], work)
        add_velocity(system, contact, work, state)
        if system.bodies[contact.body].isolated == 0:
            project_velocity(system, state, work)
        end_event(IMPACT, state, clock, records)
    if controls.location != LOCATE:  # others may be inside as well
        for i in range(held.shape[0]):
            held[i].near = 1
    for k in range(3):
        hold.point[k] = hit.point[k]


#: strike(address, method, system, controls, held, c, state, work, clocks, records)
strike = by_address(strike_unit)


@kernel
def by_impulse(method, controls, contact, hit, history):
    """Solve the impact to round-off."""
    return resolve(hit.W, hit.u, contact.friction, contact.restitution, contact.law, hit.out)


@kernel
def by_layer(method, controls, contact, hit, history):
    """Pass the boundary layer by cubic splines, as the paper does."""
    return traverse(
        hit.W, hit.u, contact.friction, contact.restitution, contact.law, contact.width,
        contact.penetration, controls.layer_steps, history, hit.out,
    )  # fmt: skip


#: collide(method, controls, contact, hit, history): resolve the impact in work.hit the way the method does it
collide = by_method({Explicit: by_impulse, ThreeField: by_layer})


@kernel
def write_impact(contact, c, state, rx, ry, rz, hit, clock, records):
    """Write what the boundary layer was given and what it gave."""
    row, x, out = records.impact[clock.struck], state[contact.body].x, hit.out
    row.time = clock.now
    row.contact = c
    row.point[0], row.point[1], row.point[2] = x[0] + rx, x[1] + ry, x[2] + rz
    for i in range(3):
        row.before[i] = hit.u[i]
        row.after[i] = out[layout.VELOCITY + i]
        row.impulse[i] = out[layout.IMPULSE + i]
        for k in range(3):
            row.W[i, k] = hit.W[i, k]
    row.energy_change = out[layout.ENERGY_CHANGE]
    row.compression_work = out[layout.WORK_C]
    row.restitution_work = out[layout.WORK_R]
    row.friction_loss = out[layout.FRICTION_LOSS]
    row.phases = int(out[layout.PHASES])
    row.duration = layer_time(contact, hit.u[0], out)
    clock.impacts += out[layout.ENERGY_CHANGE]


@kernel
def layer_time(contact, un, out):
    """Return the duration in the layer.

    Newton: law A, T_c = 2 b l/v_0, T_r = T_c/e. Else (and after a jam): constant N in each phase,
    N_c = |A_c|/(b l), N_r = A_r/(b l).
    """
    depth = -contact.width * math.log1p(-contact.penetration)
    if contact.law == laws.NEWTON and (int(out[layout.PHASES]) & layout.JAM) == 0:
        e = contact.restitution
        return 2.0 * depth / -un * (1.0 + (1.0 / e if e >= E_MIN else 0.0))
    compression, p_c = out[layout.WORK_C], out[layout.P_C]
    restitution, p_r = out[layout.WORK_R], out[layout.IMPULSE] - out[layout.P_C]
    time = 0.0
    if compression < 0.0:
        time += p_c * depth / -compression
    if restitution > 0.0:
        time += p_r * depth / restitution
    return time
