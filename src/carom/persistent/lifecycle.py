"""Conditions under which a contact becomes persistent.

After an impact with exit speed u_n, a contact whose free acceleration of approach is g_i bounces for the time

    t_i = 2 u_n / (g_i (1 - e)),

which is exact if g_i is constant. If the bounces end within the present step, the contact becomes persistent:
u_n is removed in the kinetic metric, and its energy is added to the ledger. There is no threshold of speed:
with a smaller step the contact becomes persistent later. If several points are closed, the acceleration of each
is that with all points closed that do not leave.
"""

from __future__ import annotations

from carom._compiled.units import unit
from carom.contact.closed_points import gather_closed
from carom.persistent.active_set import regroup
from carom.persistent.several_points import activate_several
from carom.status import TOO_MANY_POINTS


@unit
def activate_contact(model, data, c, horizon):
    """Make closed points in the group of contact c persistent if they do not approach and satisfy the rule."""
    system, active, work = model.system, data.active, data.work
    contact, hit = system.contacts[c], work.hit[0]
    hit.code = 0
    k = gather_closed(model, data, c, False)
    label = work.body[contact.body].label
    for i in range(active.count[0]):
        active_point = active.points[i]
        if work.body[active_point.body].label == label:
            active_point.rest = 0  # together with the new one
    if k < 0:
        hit.code = TOO_MANY_POINTS
    elif k > 0:
        activate_several(model, data, k, label, horizon)
    regroup(system, active, work)
