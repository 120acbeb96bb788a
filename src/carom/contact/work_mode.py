"""Energy across the return map: `impact_location="work"`.

Moving back to the boundary at constant velocity would inject the work m g pen. Here the normal velocity
at the boundary is changed so that the kinetic energy changes by the work of the applied forces along the
return arc: u_n -> u_n', with (u_n'^2 - u_n^2)/(2 W_nn) = V(before) - V(after).
"""

from __future__ import annotations

import math

from carom.jit import kernel
from carom.motion.contact_point import (
    add_velocity,
    contact_arm,
    contact_velocity,
    effective_inverse_mass,
    spread,
)
from carom.motion.forces import energies


@kernel
def restore_work(system, now, work, before, c, measure):
    """With `measure`, return the potential energy now; else change u_n for what it lost since `before`."""
    _, potential = energies(system, now.x, now.Q, now.v, now.w)
    if measure:
        return potential
    p = work.point
    rx, ry, rz = contact_arm(system, c, now.Q, p[0], p[1], p[2])
    un = contact_velocity(system, c, now.v, now.w, rx, ry, rz)[0]
    if un < 0.0:
        effective_inverse_mass(system, c, now.x, now.Q, rx, ry, rz, work, work.small)
        w_nn = work.small[0, 0]
        new = -math.sqrt(max(un * un + 2.0 * w_nn * (before - potential), 0.0))
        spread(system, c, now.x, now.Q, rx, ry, rz, (new - un) / w_nn, 0.0, 0.0, work)
        add_velocity(system, c, work, now.v, now.w)
    return potential
