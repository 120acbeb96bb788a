"""Contact that slips and jams (Painleve): no finite force keeps it closed (mathematics page, §3.6).

While a point slips along e its force is N (1, -mu e), and its normal acceleration a_n + k N with

    k = W_nn - mu W_nt.e.

If k > 0, N = -a_n/k. If k <= 0 and a_n < 0, no force is enough, and slip ends in an impact without collision;
if k <= 0 and a_n >= 0, the point opens. While slip approaches k = 0 with a_n < 0, the force grows without
bound, which no step can follow: the point jams a little earlier, at k = `JAM_MARGIN` W_nn.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.layout import SLIDING
from carom.law.friction import bound_of_stick, depends_on_slip
from carom.model.laws import PERSISTENT
from carom.model.workspace import MOTION_POINT
from carom.persistent.thresholds import JAM_MARGIN


@kernel
def jam_margin(system, active_point):
    """Return k of a point that slips along its heading, above that at which it counts as jammed."""
    d, W, contact = active_point.heading, active_point.W, system.contacts[active_point.contact]
    laws, law, force = system.laws, contact.law[PERSISTENT], active_point.force
    mu = bound_of_stick(laws, law)
    if depends_on_slip(laws, law) and force[0] > 0.0:  # as it acts
        mu = math.sqrt(force[1] ** 2 + force[2] ** 2) / force[0]
    speed = math.sqrt(d[0] * d[0] + d[1] * d[1])
    along = mu * (W[0, 1] * d[0] + W[0, 2] * d[1]) / speed if speed > 0.0 else 0.0
    return W[0, 0] - along - JAM_MARGIN * W[0, 0]


@kernel
def note_jam(active, active_point):
    """Mark a point that jams, so that its impact is resolved first."""
    active_point.jams = 1
    active.contact_states[active_point.contact].jams = 1
    active.contact_states[active_point.contact].near = 1


@kernel
def jams_among(i, found, group):
    """Return whether point i of several jams: it slips, k <= 0, and the contact problem has no solution."""
    if found or group.problem.kind[i] != SLIDING or group.closed[i].motion != MOTION_POINT:
        return 0
    w = group.own[3 * i]
    along = w[1] * group.problem.heading[i, 0] + w[2] * group.problem.heading[i, 1]
    return 1 if w[0] - group.problem.mu[i] * along <= 0.0 else 0
