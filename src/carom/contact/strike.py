"""An impact within a run: pre-impact velocity, effective mass, boundary layer, new velocities, record."""

from __future__ import annotations

import math

from carom.contact.gap import slow
from carom.hold.lifecycle import try_hold
from carom.impact import layout
from carom.impact.layer import traverse
from carom.impact.resolve import resolve
from carom.jit import kernel
from carom.motion.acceleration import OPEN
from carom.motion.contact_point import (
    add_velocity,
    contact_arm,
    contact_velocity,
    effective_inverse_mass,
    spread,
)
from carom.motion.project import project_velocity
from carom.system.notes import begin_event, end_event
from carom.system.records import IMPACT

IMPACT_FAILED = 6


@kernel
def release(system, held, c):
    """Open all held contacts that the impact at c reaches, and have them looked at again."""
    b = system.contacts[c].body
    joined = system.bodies[b].isolated == 0
    for i in range(held.shape[0]):
        other = system.contacts[i].body
        if other == b or (joined and system.bodies[other].isolated == 0):
            held[i].mode = OPEN
            held[i].rest = 0
            held[i].near = 1
            held[i].leaving = 0


@kernel
def strike(system, controls, held, c, state, horizon, work, clock, records):
    """Resolve the impact of contact c at the core point work.hit; then hold it if its bounces are over.

    `state` is changed in its velocities only. Returns 0 or the number of a `Status`.
    """
    contact, hit = system.contacts[c], work.hit[0]
    for k in range(3):
        held[c].point[k] = hit.point[k]
    rx, ry, rz = contact_arm(contact, state, hit.point)
    u = contact_velocity(contact, state, rx, ry, rz)
    if not (u[0] < -slow(contact, state)):
        try_hold(system, controls, held, c, state, horizon, work, clock, records)
        return 0
    release(system, held, c)
    effective_inverse_mass(system, contact, state, rx, ry, rz, work, hit.W)
    hit.u[0], hit.u[1], hit.u[2] = u
    out, mu, e, law = hit.out, contact.friction, contact.restitution, contact.law
    if controls.layer == 1:
        code = traverse(
            hit.W, hit.u, mu, e, law, contact.width, contact.penetration, controls.layer_steps,
            work.history, out,
        )  # fmt: skip
    else:
        code = resolve(hit.W, hit.u, mu, e, law, out)
    if code != layout.OK:
        return IMPACT_FAILED
    write_impact(contact, c, state, rx, ry, rz, hit, clock, records)
    begin_event(c, state, clock, records)
    P = layout.IMPULSE
    spread(system, contact, state, rx, ry, rz, out[P], out[P + 1], out[P + 2], work)
    add_velocity(system, contact, work, state)
    if system.bodies[contact.body].isolated == 0:
        project_velocity(system, state, work)
    end_event(IMPACT, state, clock, records)
    try_hold(system, controls, held, c, state, horizon, work, clock, records)
    return 0


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
    row.duration = layer_time(contact, out)
    clock.impacts += out[layout.ENERGY_CHANGE]


@kernel
def layer_time(contact, out):
    """Return the duration in the layer: constant N in each phase, N_c = |A_c|/(b l), N_r = A_r/(b l)."""
    depth = -contact.width * math.log1p(-contact.penetration)
    compression, p_c = out[layout.WORK_C], out[layout.P_C]
    restitution, p_r = out[layout.WORK_R], out[layout.IMPULSE] - out[layout.P_C]
    time = 0.0
    if compression < 0.0:
        time += p_c * depth / -compression
    if restitution > 0.0:
        time += p_r * depth / restitution
    return time
