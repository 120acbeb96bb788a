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
from carom.system import records as r

IMPACT_FAILED = 6


@kernel
def release(system, held, c):
    """Open all held contacts that the impact at c reaches, and have them looked at again."""
    bodies, contacts = system.bodies, system.contacts
    b = contacts.body[c]
    for i in range(contacts.body.size):
        other = contacts.body[i]
        if other == b or (bodies.isolated[b] == 0 and bodies.isolated[other] == 0):
            held.mode[i] = OPEN
            held.rest[i] = 0
            held.near[i] = 1
            held.leaving[i] = 0


@kernel
def strike(system, controls, held, c, state, horizon, work, clock, records):
    """Resolve the impact of contact c at core point work.point; then hold it if its bounces are over.

    `state` is changed in its velocities only. Returns 0 or the number of a `Status`.
    """
    contacts = system.contacts
    p = held.point[c]
    p[0], p[1], p[2] = work.point[0], work.point[1], work.point[2]
    rx, ry, rz = contact_arm(system, c, state.Q, p[0], p[1], p[2])
    u = contact_velocity(system, c, state.v, state.w, rx, ry, rz)
    if not (u[0] < -slow(system, c, state.x, state.v, state.w)):
        try_hold(system, controls, held, c, state, horizon, work, clock)
        return 0
    release(system, held, c)
    effective_inverse_mass(system, c, state.x, state.Q, rx, ry, rz, work, work.small)
    work.u[0], work.u[1], work.u[2] = u
    mu, e, law = contacts.friction[c], contacts.restitution[c], contacts.law[c]
    out = work.out
    if controls.layer == 1:
        code = traverse(
            work.small, work.u, mu, e, law, contacts.width[c], contacts.penetration[c],
            controls.layer_steps, work.history, out,
        )  # fmt: skip
    else:
        code = resolve(work.small, work.u, mu, e, law, out)
    if code != layout.OK:
        return IMPACT_FAILED
    k = clock.count[r.STRUCK]
    before_impact(system, c, state, rx, ry, rz, work, clock, records, k)
    P = layout.IMPULSE
    spread(system, c, state.x, state.Q, rx, ry, rz, out[P], out[P + 1], out[P + 2], work)
    add_velocity(system, c, work, state.v, state.w)
    if system.bodies.isolated[contacts.body[c]] == 0:
        project_velocity(system, state.x, state.Q, state.v, state.w, work)
    after_impact(system, c, state, work, clock, records, k)
    clock.count[r.STRUCK] += 1
    clock.count[r.IN_STEP] += 1
    clock.count[r.AT_ONCE] += 1
    clock.ledger[r.IMPACTS] += out[layout.ENERGY_CHANGE]
    try_hold(system, controls, held, c, state, horizon, work, clock)
    return 0


@kernel
def before_impact(system, c, state, rx, ry, rz, work, clock, records, k):
    """Write the first half of a record: time, place, inverse mass, state before."""
    row, b = records.impact[k], system.contacts.body[c]
    row[r.TIME] = clock.time[r.NOW]
    row[r.CONTACT] = c
    row[r.POINT] = state.x[b, 0] + rx
    row[r.POINT + 1] = state.x[b, 1] + ry
    row[r.POINT + 2] = state.x[b, 2] + rz
    for i in range(3):
        row[r.BEFORE + i] = work.u[i]
        for j in range(3):
            row[r.INVERSE_MASS + 3 * i + j] = work.small[i, j]
    records.impact_pose[k, :, :3] = state.x
    records.impact_pose[k, :, 3:] = state.Q
    records.impact_speed[k, :, 0:3] = state.v
    records.impact_speed[k, :, 3:6] = state.w


@kernel
def after_impact(system, c, state, work, clock, records, k):
    """Write the second half of a record: what the boundary layer gave, state after."""
    row, out = records.impact[k], work.out
    for i in range(3):
        row[r.AFTER + i] = out[layout.VELOCITY + i]
        row[r.IMPULSE + i] = out[layout.IMPULSE + i]
    row[r.ENERGY] = out[layout.ENERGY_CHANGE]
    row[r.WORK_C] = out[layout.WORK_C]
    row[r.WORK_R] = out[layout.WORK_R]
    row[r.FRICTION_LOSS] = out[layout.FRICTION_LOSS]
    row[r.PHASES] = out[layout.PHASES]
    row[r.DURATION] = layer_time(system, c, out)
    records.impact_speed[k, :, 6:9] = state.v
    records.impact_speed[k, :, 9:12] = state.w


@kernel
def layer_time(system, c, out):
    """Return the duration in the layer: constant N in each phase, N_c = |A_c|/(b l), N_r = A_r/(b l)."""
    contacts = system.contacts
    reach = contacts.width[c] * -math.log1p(-contacts.penetration[c])
    compression, p_c = out[layout.WORK_C], out[layout.P_C]
    restitution, p_r = out[layout.WORK_R], out[layout.IMPULSE] - out[layout.P_C]
    time = 0.0
    if compression < 0.0:
        time += p_c * reach / -compression
    if restitution > 0.0:
        time += p_r * reach / restitution
    return time


