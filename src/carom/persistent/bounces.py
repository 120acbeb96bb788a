"""Bounces that are left out: whether they end within a time, and the name of the energy that they take."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def bounces_end(contact, rate, g, still, horizon):
    """Return whether the bounces of a contact with exit speed `rate` and acceleration g end by `horizon`."""
    if not (g > 0.0 and rate >= -still):
        return False
    return rate <= still or time_of_bounces(contact, rate, g) < horizon


@kernel
def time_of_bounces(contact, rate, g):
    """Return the time 2 u/(g (1 - e)) that bounces take."""
    e = contact.restitution
    return 2.0 * rate / (g * (1.0 - e)) if e < 1.0 else math.inf


@kernel
def spare(clock):
    """Return the energy that dropped bounces may add: the loss by impacts of the step minus the energy owed."""
    return max(0.0, clock.before - clock.impacts - clock.owed)


@kernel
def name_work(normal, tangential, clock):
    """Add the work of the impulse that removes bounces to the ledger.

    A gain belongs to friction. It is less than the loss by friction in persistent contact until the time at
    which the bounces would have ended, and is owed until then (`carom.stepping.time_loop.charge_impacts`).
    """
    if normal + tangential <= 0.0:
        clock.bounces += normal + tangential
    else:
        clock.bounces += normal
        clock.friction += tangential
        clock.owed += tangential
