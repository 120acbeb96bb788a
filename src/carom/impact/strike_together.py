"""A multiple impact within a run: all closed points of a group together, at a corner of the manifold."""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, kernel
from carom._compiled.units import unit
from carom.contact.gap import slow, speed_of
from carom.contact.kinds.partner import closed_within
from carom.dynamics.contact_impulse import add_velocity, spread
from carom.geometry.thresholds import SUM_ERROR
from carom.impact.collapse import count_blow, effective_restitution
from carom.impact.driven import blocked
from carom.impact.hertz import stiffness
from carom.impact.layout import OK
from carom.impact.multiple.layout import SEQUENTIAL, CornerContacts, MultipleSettings
from carom.impact.multiple.resolve import fastest, resolve_multiple
from carom.impact.record import note_drive, write_share
from carom.impact.thresholds import GROUP_SEED, NO_RESTITUTION
from carom.law.friction import bound_of_stick
from carom.model.allowance import COUNT_FACTORS, left
from carom.model.laws import PERSISTENT, STRIKES
from carom.status import BLOCKED, IMPACT_FAILED

#: exponents of the normal force: if all points are on round bodies, and otherwise
HERTZ, LINEAR = 1.5, 1.0
PRODUCTS = 8  # of W with vectors, at most, in a step through an impact


@unit
def resolve_group(k, laws, group, multiple) -> int:
    """Solve the impact of k points; return its code."""
    contacts = by_reference(CornerContacts(multiple.contact, group.problem.W, group.u))
    given, exponent = multiple.settings, exponent_of(k, multiple)
    if exponent == HERTZ and all_round(k, multiple):
        stiffen(k, multiple)
    settings = MultipleSettings(
        given.multiple, given.rtol, exponent, given.max_events, given.max_steps,
        given.max_rounds,
    )  # fmt: skip
    return resolve_multiple(k, contacts, laws, settings, multiple.workspace, multiple.result)


@kernel
def exponent_of(k, multiple):
    """Return the exponent p of the normal forces: as set, or Hertz's if all k points are on round bodies."""
    if multiple.settings.exponent > 0.0:
        return multiple.settings.exponent
    return HERTZ if all_round(k, multiple) else LINEAR


@kernel
def all_round(k, multiple):
    """Return whether all k points are on balls or ellipsoids."""
    for i in range(k):
        if not multiple.hertz[i] > 0.0:
            return False
    return True


@kernel
def stiffen(k, multiple):
    """Multiply the stated stiffness of k points of round bodies by that of Hertz's law.

    Only ratios count: relative to the greatest, the factor of equal points is exactly 1.
    """
    most = 0.0
    for i in range(k):
        most = max(most, multiple.hertz[i])
    for i in range(k):
        multiple.contact[i].stiffness *= multiple.hertz[i] / most


@kernel
def pair_of(i, system, closed, all_by_pairs):
    """Return the number of the pair of point `i`; 0 if all points strike together.

    A body and all half-spaces that it touches are one pair.
    """
    own = system.contacts[closed[i].contact]
    if not (all_by_pairs or by_pair(system, own)):
        return 0
    for j in range(i):
        one = system.contacts[closed[j].contact]
        alike = all_by_pairs or by_pair(system, one)
        if alike and one.body == own.body and one.other == own.other:
            return 1 + j
    return 1 + i


@kernel
def strikes_in_turn(model, data, k):
    """Return whether one of k closed points has just struck and recedes, while others approach.

    They are the last of a sequence of blows, each over before the next, that has shrunk to the tolerance of
    ties (mathematics page, §2.6). Passed together, the layers would leave speeds that depend on it.
    """
    u, group, now = data.group.u, data.group, data.clocks[0].now
    least = NO_RESTITUTION * fastest(k, u)
    for i in range(k):
        closed = group.closed[i]
        contact, contact_state = (
            model.system.contacts[closed.contact],
            data.active.contact_states[closed.contact],
        )
        recedes = closed.active < 0 and contact_state.blows > 0 and u[3 * i] > least > 0.0
        near = closed_within(model.controls, contact, data.state)
        if recedes and u[3 * i] * (now - contact_state.struck) <= near:
            return True
    return False


@kernel
def by_pair(system, contact):
    """Return whether the pair of a contact has impacts of its own, one after another."""
    return system.laws.table[contact.law[STRIKES]].multiple == SEQUENTIAL


@kernel
def strike_together(model, data, c, k):
    """Solve the impact of all k closed points; apply their impulses, and write a record for each impulse.

    `group` has their W and velocities. A point that jams starts with a small speed of approach (§3.6).
    """
    system = model.system
    active, state, group, multiple = data.active, data.state, data.group, data.multiple
    work, step = data.work, data.work.step[0]
    hit, u = work.hit[0], group.u
    in_turn = strikes_in_turn(model, data, k)
    count_blows(model, data, k)
    for i in range(k):
        contact = system.contacts[group.closed[i].contact]
        if abs(u[3 * i]) <= slow(contact, state):
            u[3 * i] = 0.0  # touching, not striking
        if u[3 * i] < 0.0 and blocked(system, group.points[0][i], group.problem.W[3 * i, 3 * i]):
            hit.code = BLOCKED
            return
        j, contact_state = group.closed[i].active, active.contact_states[group.closed[i].contact]
        law, given = contact.law[STRIKES], multiple.contact[i]
        given.restitution = effective_restitution(system, contact, contact_state, -u[3 * i])
        if j >= 0 and active.points[j].jams == 1:
            u[3 * i] -= GROUP_SEED * math.sqrt(u[3 * i + 1] ** 2 + u[3 * i + 2] ** 2)
            law = contact.law[PERSISTENT]
        given.friction = bound_of_stick(system.laws, law)
        given.law, given.stiffness = law, system.laws.table[law].stiffness
        multiple.hertz[i] = 0.0
        if contact.ball_like == 1:
            multiple.hertz[i] = stiffness(system, contact, group.points[0][i], state)
        all_by_pairs = multiple.settings.multiple == SEQUENTIAL
        given.pair = 1 + i if in_turn else pair_of(i, system, group.closed, all_by_pairs)
    passage = multiple.workspace.work.clock[0]
    if model.controls.retry == 1:  # the group can take a time-stepping step instead
        passage.left = int(max(0.0, left(model.controls, step, COUNT_FACTORS)) / work_of_step(k))
    code = resolve_group(k, system.laws, group, multiple)
    step.counts[COUNT_FACTORS] += work_of_step(k) * multiple.result.summary[0].steps
    step.since += k * multiple.result.summary[0].steps
    if code != OK or passage.left < 0:
        hit.code = IMPACT_FAILED
        return
    P = multiple.result.impulse
    for i in range(k):
        if P[3 * i] != 0.0:
            contact = system.contacts[group.closed[i].contact]
            write_share(data, contact, i, k)
            impulse = P[3 * i : 3 * i + 3]
            note_drive(system, group.points[0][i], state, impulse, data.clocks[0])
            spread(system, group.points[0][i], state, impulse, work)
            add_velocity(system, group.points[0][i], work, state)
    most = SUM_ERROR * greatest(3 * k, u)
    for i in range(k):
        stop_round_off(system, group.points[0][i].a, most, state)
        stop_round_off(system, group.points[0][i].b, most, state)


@kernel
def work_of_step(k):
    """Return the work of a step through an impact of k points: many of them are products with W."""
    return min(k**3, PRODUCTS * k**2)


@kernel
def greatest(n, u):
    """Return the greatest of n speeds."""
    most = 0.0
    for a in range(n):
        most = max(most, abs(u[a]))
    return most


@kernel
def stop_round_off(system, b, most, state):
    """Stop a free body whose speed is at most round-off, `most`, because it has passed its momentum on.

    Otherwise it would approach the next body that it touches, and for e = 1 such impacts would never end.
    """
    if b < 0 or system.bodies[b].ballistic == 0:
        return
    if speed_of(b, system.bodies[b].extent, state) <= most:
        for r in range(3):
            state[b].v[r], state[b].w[r] = 0.0, 0.0


@kernel
def count_blows(model, data, k):
    """Count the impact for each contact that has a striking point."""
    system, group, last, now = model.system, data.group, -1, data.clocks[0].now
    for i in range(k):
        c, approach = group.closed[i].contact, 0.0
        if c == last:
            continue
        for j in range(i, k):
            if group.closed[j].contact == c:
                approach = max(approach, -group.u[3 * j])
        contact, contact_state, last = system.contacts[c], data.active.contact_states[c], c
        if approach > slow(contact, data.state):
            count_blow(system, model.controls, contact, contact_state, approach, now)
