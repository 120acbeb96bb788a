"""A multiple impact within a run: all closed points of a group, at a corner of the manifold, together."""

from __future__ import annotations

import math

from carom._compiled.by_reference import refer
from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.gap import slow
from carom.dynamics.contact_impulse import add_velocity, spread
from carom.dynamics.several_points import inverse_masses, velocities
from carom.impact.driven import BLOCKED, blocked
from carom.impact.effective_restitution import effective_restitution
from carom.impact.layout import WEDGED
from carom.impact.multiple.layout import OK, CornerContacts
from carom.impact.multiple.resolve import resolve_contacts
from carom.impact.workspace import U

IMPACT_FAILED = 6
SEED = 1e-7  # of the slip
STEP = 30.0  # cost of a step through the layers, of a point [us]


@unit
def at_corner(k, W, u, mu, corner):
    """Resolve the impact of k points; its code goes to the clock of the scratch."""
    contacts = refer(CornerContacts(k, W, u, mu, corner.e, corner.law, corner.kappa))
    code = resolve_contacts(contacts, corner.settings, corner.scratch, corner.result)
    corner.scratch.work.clock[0].code = code


@kernel
def strike_several(model, data, c, k):
    """Resolve the impact of all k closed points; add their impulses, write a row for each that has one.

    A point that jams begins with a little approach (mathematics page, VI.6).
    """
    system = model.system
    held, state, cluster, corner = data.held, data.state, data.cluster, data.corner
    work, clock = data.work, data.clocks[0]
    hit, u = work.hit[0], cluster.v[U]
    inverse_masses(system, k, cluster.points[0], state, work, cluster.m[0])
    velocities(k, cluster.points[0], state, u)
    for i in range(k):
        contact = system.contacts[cluster.seats[i].contact]
        if abs(u[3 * i]) <= slow(contact, state):
            u[3 * i] = 0.0  # touching, not striking
        if u[3 * i] < 0.0 and blocked(system, cluster.points[0][i], cluster.m[0][3 * i, 3 * i]):
            hit.code = BLOCKED
            return
        j, brink = cluster.seats[i].held, held.brinks[cluster.seats[i].contact]
        cluster.mu[i], corner.e[i] = contact.friction, effective_restitution(contact, brink)
        if j >= 0 and held.points[j].jams == 1:
            u[3 * i] -= SEED * math.sqrt(u[3 * i + 1] ** 2 + u[3 * i + 2] ** 2)
            cluster.mu[i] = contact.friction_held
        corner.law[i], corner.kappa[i] = contact.law, contact.stiffness
    at_corner(k, cluster.m[0], u, cluster.mu, corner)
    code = corner.scratch.work.clock[0].code
    worked = STEP * k * corner.result.summary[0].steps
    clock.effort += worked
    clock.since += worked
    if code != OK:
        hit.code = IMPACT_FAILED
        return
    count_blows(held, k, cluster)
    P = corner.result.impulse
    for i in range(k):
        n, t1, t2 = P[3 * i], P[3 * i + 1], P[3 * i + 2]
        if n != 0.0:
            write_share(system, i, k, state, cluster, corner, clock, data.records)
            spread(system, cluster.points[0][i], state, n, t1, t2, work)
            add_velocity(system, cluster.points[0][i], work, state)


@kernel
def count_blows(held, k, cluster):
    """Count the blow for each contact of which a point strikes."""
    last = -1
    for i in range(k):
        c = cluster.seats[i].contact
        if cluster.v[U][3 * i] < 0.0 and c != last:
            held.brinks[c].blows += 1
            last = c


@kernel
def write_share(system, i, k, state, cluster, corner, clock, records):
    """Write the part of point i in an impact of k points."""
    row, point, result = records.impact[clock.struck], cluster.points[0][i], corner.result
    x, u = state[point.a].x, cluster.v[U]
    row.time, row.together = clock.now, k
    row.contact = system.contacts[cluster.seats[i].contact].number
    for r in range(3):
        row.point[r], row.normal[r] = x[r] + point.arm_a[r], point.axes[0, r]
        row.before[r], row.after[r] = u[3 * i + r], result.velocity[3 * i + r]
        row.impulse[r] = result.impulse[3 * i + r]
        for s in range(3):
            row.W[r, s] = cluster.m[0][3 * i + r, 3 * i + s]
    row.compression_work, row.restitution_work = result.compression[i], result.restitution[i]
    row.friction_loss = result.friction[i]
    row.energy_change = result.compression[i] + result.restitution[i] - result.friction[i]
    row.phases, row.duration = WEDGED if result.wedged[i] != 0 else 0, 0.0
    clock.impacts += row.energy_change
    clock.struck += 1
