"""Contact that slips and jams (Painleve): no finite force keeps it closed (mathematics page, VI.6).

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
def presses(hold, k):
    """Return whether a_n = -k N < 0, from the N that this would take."""
    return hold.force[0] * k > 0.0


@kernel
def note_jam(held, hold):
    """Have the impact of a point that jams resolved before anything else."""
    hold.jams = 1
    held.brinks[hold.contact].jams, held.brinks[hold.contact].near = 1, 1


@kernel
def jams_among(hold, i, status, cluster):
    """Return whether point i of several jams: it slips, k <= 0, and there are no forces for all of them."""
    if status == SOLVED or cluster.kind[i] != SLIDING or cluster.seats[i].turns > 0:
        return 0
    if cluster.seats[i].stays == 0:
        return 0
    q, W = 3 * i, cluster.m[0]
    along = W[q, q + 1] * cluster.heading[i, 0] + W[q, q + 2] * cluster.heading[i, 1]
    return 1 if W[q, q] - cluster.mu[i] * along <= 0.0 else 0
