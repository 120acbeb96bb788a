"""Writing the record of an impact."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.impact import laws, layout
from carom.impact.layer import E_MIN

_NOT_LAW_A = layout.PHASE_JAM | layout.WEDGED


@kernel
def write_impact(contact, c, state, point, hit, clock, records):
    """Write the row of one impact: its input, and the result of the impact solver or of the layer."""
    row, x, out = records.impact[clock.struck], state[point.a].x, hit.out
    row.time = clock.now
    row.contact, row.together = contact.number, 1
    for i in range(3):
        row.point[i], row.normal[i] = x[i] + point.arm_a[i], point.axes[0, i]
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
    row.duration = layer_time(contact, hit, out)
    clock.impacts += out[layout.ENERGY_CHANGE]
    clock.struck += 1


@kernel
def layer_time(contact, hit, out):
    """Return the time that the impact takes in the layer.

    With Newton's law law A gives T_c = 2 b l/v_0, T_r = T_c/e. With the other laws, and after a jam, N is
    constant in each phase, N_c = |A_c|/(b l) and N_r = A_r/(b l). A wedged pair has no restitution.
    """
    depth = -contact.width * math.log1p(-contact.penetration)
    if contact.law == laws.NEWTON and (int(out[layout.PHASES]) & _NOT_LAW_A) == 0:
        e = hit.restitution
        return 2.0 * depth / -hit.u[0] * (1.0 + (1.0 / e if e >= E_MIN else 0.0))
    compression, p_c = out[layout.WORK_C], out[layout.P_C]
    restitution, p_r = out[layout.WORK_R], out[layout.IMPULSE] - out[layout.P_C]
    time = 0.0
    if compression < 0.0:
        time += p_c * depth / -compression
    if restitution > 0.0:
        time += p_r * depth / restitution
    return time
