"""Contact that slips and jams (Painleve): no finite force keeps it closed (mathematics page, §3.6).

While a point slips along e its force is N (1, -mu e), and its normal acceleration a_n + k N with

    k = W_nn - mu W_nt.e.

k > 0: N = -a_n/k. k <= 0: where a_n < 0 no force is enough, the slip ends in an impact without collision;
where a_n >= 0 the point opens. Slip that comes to k = 0 with a_n < 0 has a force that grows without bound on
its way, which no step follows: it jams a little before, at k = `JAMMED` W_nn.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.layout import SLIDING, SOLVED

JAMMED = 1e-6


@kernel
def yields(W, mu, u1, u2):
    """Return k, how the normal acceleration of a point that slips along (u1, u2) answers its normal force."""
    speed = math.sqrt(u1 * u1 + u2 * u2)
    if not speed > 0.0:
        return W[0, 0]
    return W[0, 0] - mu * (W[0, 1] * u1 + W[0, 2] * u2) / speed


@kernel
def presses(active_point, k):
    """Return whether a_n = -k N < 0, from the N that this would take."""
    return active_point.force[0] * k > 0.0


@kernel
def note_jam(active, active_point):
    """Have the impact of a point that jams resolved before anything else."""
    active_point.jams = 1
    (
        active.contact_states[active_point.contact].jams,
        active.contact_states[active_point.contact].near,
    ) = 1, 1


@kernel
def jams_among(active_point, i, status, group):
    """Return whether point i of several jams: it slips, k <= 0, and there are no forces for all of them."""
    if status == SOLVED or group.kind[i] != SLIDING or group.closed[i].turns > 0:
        return 0
    if group.closed[i].stays == 0:
        return 0
    q, W = 3 * i, group.m[0]
    along = W[q, q + 1] * group.heading[i, 0] + W[q, q + 2] * group.heading[i, 1]
    return 1 if W[q, q] - group.mu[i] * along <= 0.0 else 0
