"""When a contact becomes persistent, whether it slips or sticks, and when it is at rest.

After an impact with exit speed u_n, a contact whose free acceleration of approach is g_i bounces on for

    t_i = 2 u_n / (g_i (1 - e)),

exactly, as long as g_i is constant. If that ends within the present step the contact is persistent from now
on: u_n is taken out in the kinetic metric and the energy this takes goes to the ledger. There is no threshold
of speed: with a smaller step it becomes so later. Of several closed points each is judged by the acceleration
that it has while those that do not leave are kept.
"""

from __future__ import annotations

from carom._compiled.units import unit
from carom.contact.closed_points import gather_closed
from carom.persistent.active_set import regroup, set_anchor, together
from carom.persistent.one_point import hold_one, settle_one
from carom.persistent.several_points import hold_several

TOO_MANY_POINTS = 10


@unit
def hold_contact(model, data, c, horizon):
    """Let the closed points in the group of contact c persist that do not approach and fulfil the rule."""
    system, controls = model.system, model.controls
    held, state, cluster, work = data.held, data.state, data.cluster, data.work
    contact, hit = system.contacts[c], work.hit[0]
    hit.code = 0
    k = gather_closed(system, controls, held, c, state, cluster, work, False)
    group = work.body[contact.body].group
    for i in range(held.count[0]):
        hold = held.points[i]
        if work.body[hold.body].group == group:
            if hold.several == 0:  # from now on it stays where it is
                set_anchor(system, hold, state, work)
            hold.rest, hold.several = 0, 1  # together with the new one
    if k < 0:
        hit.code = TOO_MANY_POINTS
    elif k == 1 and cluster.seats[0].held < 0 and not together(contact):
        hold_one(model, data, horizon)
    elif k > 0:
        hold_several(model, data, k, group, horizon)
    regroup(system, held, work)


@unit
def settle(model, data, i):
    """Find anew how point i, the only one of its body, goes on: its slip has come to a stop or has turned."""
    held = data.held
    settle_one(model, data, held.points[i])
