"""An island as a separate system: its bodies, contacts and active points are copied out and copied back."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.point_lists import mark
from carom.dynamics.explicit import copy_state, mark_active
from carom.impact.workspace import LEAST_POINTS
from carom.kinematics.flight import free_flight
from carom.model.allowance import COUNT_FACTORS, keep_count, left
from carom.model.arrays import System
from carom.model.workspace import ActiveSet, Work
from carom.persistent.active_set import regroup
from carom.stepping.islands.joined import (
    begin_joined,
    end_joined,
    enter_joined,
    let_rest,
    rest_whole,
    wake,
)
from carom.stepping.islands.layout import ASLEEP, FLIES
from carom.stepping.islands.order import comes_before
from carom.stepping.islands.pieces import wanted_trials
from carom.stepping.islands.plan import READY, number, root, seek

# of steps of given length: least number of active points of a crowd, and least average number per body
MANY, EACH = 24, 2
PRICE_OF_POINT = 100  # work of a factor by bodies for each point
FACTORS = 20  # factors of W, at least, of a step of a group from event to event


@kernel
def begin_step(system, active, now, clocks, work, islands):
    """Find the islands of a step and fill their slots; return `READY`, or the arrays that must grow first."""
    plan, member = islands.plan[0], islands.member
    mark_active(active, work)
    rest_whole(islands.joined, work)
    code = seek(system, active, now, work.step[0].length, work, islands)
    if code == READY:
        code = number(system, active, now, work, islands)
    if code != READY:
        return code
    for slot in range(islands.first[0, plan.count]):
        b = islands.body_of[slot]
        i = member[root(member, b)].island
        place, count = slot - islands.first[0, i], islands.first[0, i + 1] - islands.first[0, i]
        islands.bodies[slot] = system.bodies[b]
        islands.bodies[slot].component = place if system.bodies[b].isolated == 1 else count
        islands.state[slot] = now[b]
        islands.memory[slot] = work.body[b]
    for slot in range(plan.used):
        c = islands.which[slot]
        contact, contact_state = islands.contacts[slot], islands.contact_states[slot]
        islands.contacts[slot] = system.contacts[c]
        contact.body = local(islands, contact.body)
        if contact.other >= 0:
            contact.other = local(islands, contact.other)
        if islands.joined.stops.shape[0] > 0:
            contact.solid = islands.joined.solid[c]
        islands.contact_states[slot] = active.contact_states[c]
        if contact_state.step != plan.pieces:  # in the last piece nothing was near
            contact_state.leaving = 0
    plan.kept = 0
    for i in range(active.count[0]):
        if member[root(member, active.points[i].body)].island < 0:
            islands.points[1, plan.kept] = active.points[i]
            plan.kept += 1
    begin_joined(system, islands.joined)
    plan.at, plan.entered, plan.planned, plan.busy = 0, 0, 1, 0
    work.step[0].impacts, work.step[0].owed, work.step[0].whole = clocks[0].impacts, 0.0, 0
    islands.clock[0] = clocks[0]
    return READY


@kernel
def local(islands, b):
    """Return the place of a body in its island."""
    member = islands.member
    return member[b].place - islands.first[0, member[root(member, b)].island]


@kernel
def part_system(system, islands, i, joints, own):
    """Return island i as a system; `own` are its relations, forces and back end, by reference."""
    first, (relations, forces, solver) = islands.first, own
    return System(
        bodies=islands.bodies[first[0, i] : first[0, i + 1]], gravity=system.gravity,
        joints=joints, relations=relations, forces=forces,
        contacts=islands.contacts[first[1, i] : first[1, i + 1]], vertices=system.vertices,
        laws=system.laws, solids=system.solids, hulls=system.hulls, levels=system.levels,
        moving=system.moving, solver=solver, chart=system.chart, flexible=system.flexible,
    )  # fmt: skip


@kernel
def part_active(active, islands, i):
    """Return the active set of island i."""
    first = islands.first
    contact_states = islands.contact_states[first[1, i] : first[1, i + 1]]
    return ActiveSet(
        points=islands.points[0], contact_states=contact_states, carries=active.carries, count=islands.carried
    )  # fmt: skip


@kernel
def part_work(work, islands, i):
    """Return the workspace of island i."""
    a, b = islands.first[0, i], islands.first[0, i + 1]
    n = b - a
    return Work(
        body=islands.memory[a:b], joint=work.joint, stages=work.stages, known=work.known[:n],
        stage=work.stage[:n], trial=work.trial[:n], part=work.part[:n], middle=work.middle[:n],
        iterate=work.iterate[:n], mean=work.mean[:n], beside=work.beside[:n], origin=work.origin[:n],
        struck=work.struck, placed=work.placed, pair=work.pair, touches=work.touches,
        solid_pose=work.solid_pose, hit=work.hit, moment=work.moment, step=work.step, search=work.search,
        history=work.history,
    )  # fmt: skip


@kernel
def enter(part, own, active, work, islands, clock):
    """Begin with island `plan.at`: copy its active points, label its groups, and reset its clock."""
    i = islands.plan[0].at
    if islands.cluster[i] >= 0:
        enter_joined(islands.joined, islands.cluster[i], part.bodies.shape[0])
    own.count[0] = 0
    for k in range(islands.first[2, i], islands.first[2, i + 1]):
        active_point = own.points[own.count[0]]
        own.points[own.count[0]] = active.points[islands.active_of[k]]
        active_point.body = local(islands, active_point.body)
        if active_point.other >= 0:
            active_point.other = local(islands, active_point.other)
        active_point.contact = slot_of(islands, i, active_point)
        own.count[0] += 1
    regroup(part, own, work)
    wake(own, work)
    step = work.step[0]
    clock.now, clock.at_once, step.spent, step.tries = step.begin, 0, 0.0, 0
    step.first_touch, step.first_event = clock.touched, clock.event
    work.pair.state[0].searches = 0
    islands.plan[0].entered, islands.plan[0].trials = 1, wanted_trials(clock)


@kernel
def slot_of(islands, i, active_point):
    """Return the number in island i of the contact of an active point, whose bodies have local numbers."""
    first, last, fixed = islands.first[1, i], islands.first[1, i + 1], islands.plan[0].fixed
    low, high, c = first, last, active_point.contact
    while low < high:
        middle = (low + high) // 2
        if comes_before(fixed, islands.which[middle], islands.contacts[middle], c, active_point):
            low = middle + 1
        else:
            high = middle
    return low - first


@kernel
def choose(part, controls, active, number, work):
    """Note whether an island moves as a crowd in piece `number`: it is large, or has failed as events lately.

    With tolerances it is large if it cannot afford to move one of its groups from event to event, which takes
    factors of its equations. With given steps it is large if bodies lie on each other at many points, two per
    body or more. Bodies that roll on a table or strike in flight move from event to event.
    """
    n, step = part.bodies.shape[0], work.step[0]
    if controls.order > 0:
        price = price_of_group(part, float(largest_group(active, work)))
        crowd = FACTORS * price > left(controls, step, COUNT_FACTORS)
    else:
        crowd = active.count[0] >= max(MANY, EACH * n)
    for b in range(n):
        crowd = crowd or work.body[b].whole_until > number
    step.crowd = 1 if crowd and controls.retry == 1 else 0
    for b in range(n if step.crowd == 0 else 0):
        if work.body[b].whole_until < number:
            work.body[b].whole_for //= 2


@kernel
def price_of_group(part, k):
    """Return the work of a factor for k points: of a full matrix, or by bodies if there are no joints."""
    joined = part.joints.shape[0] > 0 or part.relations.there == 1
    return k * k * k if joined or k < LEAST_POINTS else PRICE_OF_POINT * k


@kernel
def largest_group(active, work):
    """Return the greatest number of active points of a group that moves."""
    most, joined, n = 0, 0, work.body.shape[0]
    for i in range(active.count[0]):
        label = work.body[active.points[i].body].label
        if label == n:
            joined += 1
        elif active.points[i].rest == 0:
            most = max(most, work.body[label].n_active)
    return max(most, joined)


@kernel
def bodies_of_present(islands):
    """Return the number of bodies of the present island."""
    at = islands.plan[0].at
    return islands.first[0, at + 1] - islands.first[0, at]


@kernel
def give_up(controls, islands, number, work):
    """Give the bodies of the island time-stepping steps, piece `number` and more; return False if they have.

    The number doubles with each call in a row: 1, 2, 4, ... 128.
    """
    first, at, new = islands.first, islands.plan[0].at, True
    for slot in range(first[0, at], first[0, at + 1]):
        new = new and not work.body[islands.body_of[slot]].whole_until > number
    for slot in range(first[0, at], first[0, at + 1] if new else 0):
        give_up_body(controls, number, work.step[0], work.body[islands.body_of[slot]])
    return new


@kernel
def give_up_body(controls, number, step, memory):
    """Give a body time-stepping steps: this one and some more."""
    memory.whole_for = min(128, max(1, 2 * memory.whole_for))
    memory.whole_until = number + memory.whole_for
    keep_count(controls, step, memory)


@kernel
def leave(part, islands):
    """End with island `plan.at`: store its active points for the state after the step."""
    plan, first, own = islands.plan[0], islands.first, part.active
    k = islands.cluster[plan.at]
    if k >= 0 and islands.joined.constant[k] == 1 and part.work.step[0].crowd == 0:
        let_rest(part)
    bodies, contacts = first[0, plan.at], first[1, plan.at]
    for k in range(own.count[0]):
        active_point = islands.points[1, plan.kept]
        islands.points[1, plan.kept] = own.points[k]
        active_point.body = islands.body_of[bodies + active_point.body]
        if active_point.other >= 0:
            active_point.other = islands.body_of[bodies + active_point.other]
        active_point.contact = islands.which[contacts + active_point.contact]
        plan.kept += 1
    plan.at += 1
    plan.entered = 0


@kernel
def end_step(system, active, now, work, islands):
    """Write all islands back at the end of the step; move the bodies in free flight with nothing near."""
    plan, member, length = islands.plan[0], islands.member, work.step[0].length
    for b in range(system.bodies.shape[0]):
        if member[b].kind == FLIES:
            free_flight(
                system.bodies[b], system.gravity, length, now[b], work.trial[b], work.body[b]
            )
            copy_state(work.trial[b], now[b])
        elif member[b].kind != ASLEEP:
            now[b] = islands.state[member[b].place]
            work.body[b] = islands.memory[member[b].place]
    for slot in range(plan.used):
        contact_state = active.contact_states[islands.which[slot]]
        active.contact_states[islands.which[slot]] = islands.contact_states[slot]
        contact_state.step = plan.pieces + 1
    for i in range(plan.kept):
        active.points[i] = islands.points[1, i]
    active.count[0] = plan.kept
    end_joined(system, islands.joined)
    if islands.parted.shape[0] > 0:
        islands.parted[0] = islands.parted[0] + 1 if islands.parted[1] == 1 else 0
    plan.planned, plan.widen = 0, 1.0


@kernel
def forget_step(active, clocks, work, islands):
    """Go back to the start of the step and drop all its results."""
    plan = islands.plan[0]
    for k in range(2):
        for i in range(plan.kept if k == 1 else islands.carried[0]):
            mark(active, islands.points[k, i], 0)
    for i in range(active.count[0]):
        mark(active, active.points[i], 1)
    clocks[0] = islands.clock[0]
    work.step[0].spent, work.step[0].paused = 0.0, 0
    plan.planned, plan.entered = 0, 0
    islands.carried[0] = 0
