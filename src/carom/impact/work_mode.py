"""Energy across the return map: `impact_location="work"`.

A return to the boundary at constant velocity would add the energy m g pen. Here the normal velocity at the
boundary is changed so that the kinetic energy changes by the work of the applied forces along the return arc:
u_n -> u_n', with (u_n'^2 - u_n^2)/(2 W_nn) = V(before) - V(after).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.contact_impulse import add_velocity, spread
from carom.kinematics.contact_point import contact_motion, contact_velocity, place


@kernel
def restore_work(system, contact, state, drop, work):
    """Change u_n at the core point of `work.hit` by the potential energy `drop` [J] that became kinetic."""
    hit, point = work.hit[0], work.struck[0]
    place(contact, hit.point, state, point)
    un = contact_velocity(system, point, state)[0]
    if un < 0.0:
        spread(system, point, state, (1.0, 0.0, 0.0), work)
        w_nn = contact_motion(system, point, state, work)[0]
        new = -math.sqrt(max(un * un + 2.0 * w_nn * drop, 0.0))
        spread(system, point, state, ((new - un) / w_nn, 0.0, 0.0), work)
        add_velocity(system, point, work, state)
