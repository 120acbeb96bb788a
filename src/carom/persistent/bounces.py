"""The bounces of a contact that are not resolved: their number is infinite, and their height negligible.

After an impact with exit speed u_n, a contact whose free acceleration of approach is g_i bounces for the time

    t_i = 2 u_n / (g_i (1 - e)),

which is exact if g_i and e are constant. Where e depends on the speed, the times 2 v_k/g_i of bounces are added
up, v_0 = u_n and v_{k+1} = e(v_k) v_k, and the formula gives what is left after some. The sum is finite even
where e -> 1 for v -> 0: with 1 - e = c v^(1/5), v_k falls as k^-5. With a given step, bounces that end within
the step are not resolved. With tolerances, those that end within the time of one bounce as high as the
tolerance,

    t_i < (8 tol / g_i)^1/2,   tol = atol + rtol L,   so   u_n^2 / (2 g_i) < (1 - e)^2 tol,

with the acceleration of the contact at that moment and the size L of its smaller body.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.pair_point import smaller
from carom.impact.effective_restitution import restitution_at
from carom.persistent.thresholds import MOST_BOUNCES, PLASTIC_SPEED


@kernel
def horizon_of(contact, controls, g, horizon):
    """Return the time within which bounces must end to be left out: `horizon`, or by the tolerance."""
    if controls.order == 0:
        return horizon
    tolerance = controls.atol + controls.rtol * smaller(contact)
    if contact.restitution == 0.0:
        tolerance *= PLASTIC_SPEED
    return math.sqrt(8.0 * tolerance / g) if g > 0.0 else 0.0


@kernel
def bounces_end(system, contact, rate, g, still, horizon):
    """Return whether the bounces of a contact with exit speed `rate` and acceleration g end by `horizon`."""
    if not (g > 0.0 and rate >= -still):
        return False
    return rate <= still or time_of_bounces(system, contact, rate, g) < horizon


@kernel
def time_of_bounces(system, contact, rate, g):
    """Return the time 2 u/(g (1 - e)) that bounces take; with a law of restitution, the sum of their times."""
    time, e = 0.0, restitution_at(system, contact, rate)
    if contact.last_restitution_piece > contact.restitution_piece:
        for _ in range(MOST_BOUNCES):
            time += 2.0 * rate / g
            rate *= e
            e = restitution_at(system, contact, rate)
    return time + 2.0 * rate / (g * (1.0 - e)) if e < 1.0 else math.inf


@kernel
def spare(clock, step):
    """Return the energy that dropped bounces may add: the loss by impacts of the step minus the energy owed."""
    return max(0.0, step.impacts - clock.impacts - step.owed)


@kernel
def name_work(normal, tangential, clock, step):
    """Add the work of the impulse that removes bounces to the ledger.

    A gain belongs to friction. It is less than the loss by friction in persistent contact until the time at
    which the bounces would have ended, and is owed until then (`carom.stepping.time_loop.charge_impacts`).
    """
    if normal + tangential <= 0.0:
        clock.bounces += normal + tangential
    else:
        clock.bounces += normal
        clock.friction += tangential
        step.owed += tangential
