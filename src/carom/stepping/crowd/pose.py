"""The contact problem of a crowd: rows in the middle of the step, velocities without impulses, bounds."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.layout import CONE, DISC
from carom.kinematics.contact_point import contact_velocity
from carom.law.friction import friction_at
from carom.law.restitution import restitution_at
from carom.model.actions import MODE_STICK
from carom.model.laws import PERSISTENT, STRIKES
from carom.model.workspace import MOTION_POINT, MOTION_ROLL
from carom.stepping.crowd.response import velocity_of, write_responses
from carom.stepping.thresholds import LEAVING_SPEED


@kernel
def pose(model, data, k, h, fall):
    """Write the problem of k points whose rows are in `crowd.points[0]`; the first guess is the last forces.

    For an impact of a single body the law of the cone holds for w + e u, tangents too: p . (w + u)/2 is then
    (p . (w + e u) - (1 - e)/2 p . W p)/(1 + e), which is never positive, and 0 without friction if e = 1.
    """
    system, active, start, crowd = model.system, data.active, data.state, data.crowd
    alone = start.shape[0] == 1
    write_responses(system, 0, k, crowd, data.work)
    for i in range(k):
        spot, point = crowd.closed[i], crowd.points[0][i]
        contact, p = system.contacts[spot.contact], crowd.p
        spot.before[0], spot.before[1], spot.before[2] = velocity_of(system, point, crowd, start)
        free = velocity_of(system, point, crowd, crowd.flight)
        for r in range(3):
            crowd.c[3 * i + r], p[3 * i + r] = free[r], 0.0
        row = crowd.problem.contact[i]
        if spot.motion != MOTION_POINT:
            row.kind, row.mu = DISC, 1.0
            if spot.active >= 0:
                torque, s = active.points[spot.active].torque, h / point.length
                p[3 * i + 1] = s * (torque[1] if spot.motion == MOTION_ROLL else torque[0])
                p[3 * i + 2] = s * torque[2] if spot.motion == MOTION_ROLL else 0.0
            continue
        u = spot.before[0] - spot.drift[0]
        law = contact.law[STRIKES]
        e = restitution_at(system.laws, law, -u)
        set_bound(spot, (u, e, restitution_at(system.laws, law, -e * u)), contact, h, fall)
        crowd.c[3 * i] -= spot.bound
        crowd.c[3 * i + 1] += spot.drift[1]
        crowd.c[3 * i + 2] += spot.drift[2]
        if alone and spot.strikes == 1:
            crowd.c[3 * i + 1] += e * spot.before[1]
            crowd.c[3 * i + 2] += e * spot.before[2]
        slip = math.hypot(spot.before[1], spot.before[2])  # the law at the start of the step
        row.kind, row.mu = CONE, friction_at(system.laws, law, slip)
        if spot.active >= 0:
            holds = active.points[spot.active].mode == MODE_STICK
            row.mu = friction_at(system.laws, contact.law[PERSISTENT], 0.0 if holds else slip)
            for r in range(3):
                p[3 * i + r] = h * active.points[spot.active].force[r]


@kernel
def note_drift(system, active, k, several, start, crowd):
    """Write the velocity of an active point from rows that turn: G_m v_0 - G_0 v_0, with tangents if it sticks.

    It is for several bodies; their rows at the start are in `crowd.points[1]`. A point that stays closed has
    G_1 v_1 = 0 at the end, which is G_m v_1 = -(G_m - G_0) v_0 up to second order, and adds no energy. So the
    step has order 2 as long as there are no impacts and modes do not change.
    """
    for i in range(k):
        spot = crowd.closed[i]
        spot.drift[0], spot.drift[1], spot.drift[2] = 0.0, 0.0, 0.0
        if not (several and spot.active >= 0 and spot.motion == MOTION_POINT):
            continue
        before = contact_velocity(system, crowd.points[1][i], start)
        u = velocity_of(system, crowd.points[0][i], crowd, start)
        for r in range(3 if active.points[spot.active].mode == MODE_STICK else 1):
            spot.drift[r] = u[r] - before[r]


@kernel
def set_bound(spot, law, contact, h, fall):
    """Write the least normal velocity after the step, and whether the point strikes.

    After an impact a point leaves with e times its approach at the start (Moreau 1988), unless all its bounces,
    which last 2 e|u|/(g (1 - e)) with the e of the next one, end within the step: then it stays closed. `law`
    has u and both e. A point that is open at the end without contacts must not close faster than its gap
    allows. A point that leaves at the start, and is pressed back within the step, returns as fast as it left:
    (u + w)/2 = 0, without a gain. All this excludes `drift`.
    """
    u, e, next_e = law
    spot.bound, spot.strikes = 0.0, 0
    if spot.gap > 0.0 and spot.left > 0.0:
        spot.bound = min(-spot.gap / h, -u)
    elif u > LEAVING_SPEED * fall * h + contact.still:
        spot.bound = -u
    elif 2.0 * e * -u > (1.0 - next_e) * fall * h + contact.still:
        spot.bound, spot.strikes = -e * u, 1
    elif -u > 2.0 * fall * h + contact.still:
        spot.strikes = 1
    spot.bound -= spot.drift[0]
