"""An impact where several points are closed."""

from __future__ import annotations

from carom.contact.gap import slow
from carom.impact import layout
from carom.impact.resolve import resolve
from carom.impact.write import write_impact
from carom.jit import kernel
from carom.motion.contact_point import (
    add_velocity,
    contact_velocity,
    copy_point,
    effective_inverse_mass,
    spread,
)

IMPACT_FAILED = 6


@kernel
def strike_several(system, controls, k, state, cluster, work, clock, records):
    """Resolve the blows one after the other, the fastest first, until no point approaches."""
    hit, point = work.hit[0], work.point[0]
    for _ in range(200):
        worst, which = 0.0, -1
        for i in range(k):
            contact = system.contacts[cluster.seats[i].contact]
            u = contact_velocity(cluster.points[i], state)[0]
            if u < worst and u < -slow(contact, state):
                worst, which = u, i
        if which < 0 or clock.struck >= records.impact.shape[0] - 1:
            return
        c = cluster.seats[which].contact
        contact = system.contacts[c]
        copy_point(cluster.points[which], point)
        effective_inverse_mass(system, point, state, work, hit.W)
        hit.u[0], hit.u[1], hit.u[2] = contact_velocity(point, state)
        e, law = contact.restitution, contact.law
        if resolve(hit.W, hit.u, contact.friction, e, law, hit.out) != layout.OK:
            hit.code = IMPACT_FAILED
            return
        write_impact(contact, c, state, point, hit, clock, records)
        out, P = hit.out, layout.IMPULSE
        spread(system, point, state, out[P], out[P + 1], out[P + 2], work)
        add_velocity(system, point, work, state)
