"""Adhesion: a contact that holds together while it is closed, with a force A (theory, X.1).

The set of its forces is the cone of friction shifted by A: N >= -A, |T| <= mu (N + A). With N + A for N it is
the cone itself, so all solvers stay as they are, beside a given force -A along the normal. The points of a
contact share A by the weights of their springs. Once one of them has let go, the others hold no more until
the contact is pressed together or struck anew: else what is left of A would hold with the share of all, and at
N = -A round-off would close again what it has opened.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.kinematics.contact_point import contact_velocity
from carom.model.laws import PERSISTENT
from carom.model.workspace import MOTION_POINT
from carom.persistent.by_bodies import knows_arms, move_bodies, rate_of_row, rest_bodies


@kernel
def write_pulls(system, active, k, state, group):
    """Write the parts of adhesion of k entries of a group; a point that leaves has none."""
    for i in range(k):
        one, whole = group.closed[i], 0.0
        one.pull = 0.0
        if one.motion != MOTION_POINT or active.contact_states[one.contact].broken == 1:
            continue
        contact = system.contacts[one.contact]
        adhesion = system.laws.table[contact.law[PERSISTENT]].adhesion
        if adhesion == 0.0 or (one.active < 0 and leaves(system, contact, i, state, group)):
            continue
        for j in range(k):
            other = group.closed[j]
            if other.motion == MOTION_POINT and other.contact == one.contact:
                whole += other.weight
        one.pull = adhesion * one.weight / whole if whole > 0.0 else 0.0


@kernel
def leaves(system, contact, i, state, group):
    """Return whether closed point i parts with a speed."""
    return contact_velocity(system, group.points[0][i], state)[0] > slow(contact, state)


@kernel
def any_pulls(k, group):
    """Return whether one of k points has a pull."""
    for i in range(k):
        if group.closed[i].pull > 0.0:
            return True
    return False


@kernel
def pull_rows(k, share, group, out):
    """Subtract the effect of adhesion in all rows, times `share`: W times the pulls."""
    by_bodies = any_pulls(k, group) and knows_arms(group.equations)
    if by_bodies:
        rest_bodies(group.equations)
        for i in range(k):
            arm = group.equations.arms[3 * i]
            move_bodies(arm, arm.motion, group.closed[i].pull, group.equations.tree.body)
        for row in range(3 * k):
            out[row] -= share * rate_of_row(group.equations.arms[row], group.equations)
    for i in range(k):
        pull = 0.0 if by_bodies else group.closed[i].pull
        for row in range(3 * k if pull > 0.0 else 0):
            out[row] -= share * group.problem.W[row, 3 * i] * pull


@kernel
def pulled(i, group):
    """Return the acceleration of entry i by its part of an adhesion: what cancels it leaves its round-off."""
    return group.closed[i].pull * group.own[3 * i, 0]


@kernel
def take_pulls(k, share, group):
    """Take `share` of the pulls from the forces in `p`."""
    for i in range(k):
        group.p[3 * i] -= share * group.closed[i].pull
