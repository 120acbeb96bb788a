"""A step of bodies in persistent contact: one right-hand side, three members, for every group.

"The contact is modeled as a bilateral constraint up to a point where separation of the contacting bodies
occurs": between events a group in contact moves as Eq. (4) with more rows (`carom.persistent.rows`). The
explicit member takes a step while modes last, the implicit one where slip is stiff, begins, ends or turns about
a corner, and where its step falls below the length in which friction cannot move a body by its tolerance, one
time-stepping step closes. (Mathematics page, persistent contact; `docs/development/a_step.md`.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.groups import members
from carom.dynamics.adapt import MISS_SCALE, allowed_error, note_miss
from carom.dynamics.explicit import CONSTRAINTS_LOST, bound_accelerations_of, rubs, stages_within
from carom.dynamics.thresholds import ERROR_SHARE
from carom.model.actions import (
    EVENT_CONE,
    EVENT_GAP,
    EVENT_JAM,
    EVENT_KINK,
    EVENT_SEPARATE,
    EVENT_STOP,
    MODE_OPEN,
)
from carom.persistent.by_bodies import FACTORED
from carom.persistent.finish import (
    SLIP_CHANGES,
    SLIP_STAYS,
    SLIP_TURNS,
    check_end,
    copy_to_stage,
    note_modes,
    write_end,
)
from carom.persistent.members import explicit_member, implicit_member
from carom.persistent.return_to_surfaces import note_undetermined
from carom.persistent.rows import beyond_stop, bodies_of
from carom.persistent.springs import count_factors
from carom.persistent.start import first_modes, first_stage
from carom.persistent.step_control import first_acceleration, lost_in_stop, note_unnamed
from carom.persistent.stops import concerned, is_sought, note_left
from carom.persistent.thresholds import FALLS, STIFF_SLIP
from carom.status import TOO_MANY_POINTS

STIFF_ORDER, CLOSING_ORDER = 4, 2


@unit
def contact_step(model, data, method, h) -> tuple[float, float, int]:
    """Write the end of a step of all groups that are in persistent contact and do not rest to `work.trial`.

    In a search for an event that concerns a part of the groups only this part is moved. The forces at the end
    are written to the active points. Return the work of loads and of friction, and a status.
    """
    active, work, n = data.active, data.work, data.state.shape[0]
    data.group.equations.iterations[FACTORED], data.group.count[1] = 0, 0
    search, joined = work.search[0], rubs(model.system)
    applied, friction, code = 0.0, 0.0, 0
    search.residual, search.unnamed = 0.0, 0.0
    for i in range(active.count[0]):
        label = work.body[active.points[i].body].label
        joined = joined and label != n
        if not is_sought(label, work):
            continue
        if active.points[i].rest == 0 and not was_visited(active, i, label, work):
            own = step_group(model, data, method, label, h)
            applied, friction, code = applied + own[0], friction + own[1], max(code, own[2])
    if joined:  # friction in joints alone: a group without points
        own = step_group(model, data, method, n, h)
        applied, friction, code = applied + own[0], friction + own[1], max(code, own[2])
    count_factors(data.group, work.step[0])
    if data.group.count[1] > 0:
        code = TOO_MANY_POINTS
    return applied, friction, code


@kernel
def seek_in_groups(system, active, work):
    """Note which groups the search for an event concerns: of the bodies that meet, of the points that stop.

    Each trial of the search then moves these groups only; where the event is found, all go there together.
    """
    search = work.search[0]
    search.part, search.many = 0, 0
    for b in range(work.body.shape[0]):
        work.body[b].sought = 0
    if search.kind == EVENT_GAP:
        contact = system.contacts[search.contact]
        seek_in(contact.body, work)
        if contact.other >= 0:
            seek_in(contact.other, work)
            search.many = 1 if work.body[contact.body].label < work.body.shape[0] else 0
    elif search.kind in (EVENT_SEPARATE, EVENT_CONE, EVENT_JAM, EVENT_KINK):
        seek_in(active.points[search.contact].body, work)
    elif search.kind == EVENT_STOP:
        for i in range(active.count[0]):
            if active.points[i].rest == 0 and active.points[i].left < 0.0:
                seek_in(active.points[i].body, work)
    else:
        return
    for i in range(active.count[0]):
        point, label = active.points[i], work.body[active.points[i].body].label
        if point.rest == 0 and not concerned(label, work):
            search.part = 1
        if point.other >= 0 and label < work.body.shape[0] and work.body[label].sought == 1:
            search.many = 1


@kernel
def seek_in(b, work):
    """Note that the search for an event concerns the group of body b."""
    label = work.body[b].label
    if label < work.body.shape[0]:
        work.body[label].sought = 1


@kernel
def was_visited(active, i, label, work):
    """Return whether an earlier active point belongs to the same group."""
    for j in range(i):
        if work.body[active.points[j].body].label == label:
            return True
    return False


@kernel
def step_group(model, data, method, label, h):
    """Step one group: by the explicit member while modes last, else by the implicit one or the closing one.

    Return the work of loads and of friction, and a status.
    """
    work, search = data.work, data.work.search[0]
    k, rate, push, powers, _ = first_stage(model, data, label)
    data.clocks[0].contact_steps += 1
    work.step[0].since += 5.0 * k * stages_within(method)
    if h * rate <= STIFF_SLIP and not (search.stiff == 1 and search.again == 1):
        k, applied, friction = explicit_member(model, data, method, label, h, (k, powers))
        s = stages_within(method)
        closes, driven = write_end(model, data, label, k) if k > 0 else (False, 0.0)
        applied += driven
        lasts, driven, rubbed = False, 0.0, 0.0
        if closes:
            lasts, driven, rubbed = check_end(model, data, label, s, h, True)
        applied, friction = applied + driven, friction + rubbed
        if lasts:
            note_errors(model, data, method.E, label, k, h)
            note_unnamed(model, data, label, friction + applied, 0.0, push)
            return applied, friction, 0
        search.stiff = 1
    return step_stiffly(model, data, method, label, h, (push, powers))


@kernel
def step_stiffly(model, data, method, label, h, start):
    """Step one group by the implicit member, or in short steps by the closing one; return as `step_group`.

    A short step is closed first. The implicit member follows where there is no such end, or where slip turns
    and the error of the closing step is not allowed; a closing step is the last, unless there was none. `start`
    has the greatest acceleration and the powers there.
    """
    search, order, (push, powers) = data.work.search[0], model.controls.order, start
    applied, friction = 0.0, 0.0
    falls = 0.5 * h * h * max(push, greatest_first(model, data, label))
    short = order > 0 and falls <= closing_size(model, data, label)
    lost = False
    for attempt in range(0 if short else 1, 3):
        closes = attempt != 1
        if lost and closes:
            break
        A, E = (method.closing, method.closing_E) if closes else (method.stiff, method.stiff_E)
        first_modes(model.system, data, label)
        ended, does, applied, friction = end_implicitly(model, data, (A, closes), label, h, powers)
        if not ended:
            lost = lost or closes
            continue
        does = SLIP_CHANGES if opens(data, label) else does
        changes = order > 0 and does != SLIP_STAYS
        if changes or not closes:
            note_errors(model, data, E, label, 0, h)
        if attempt == 0 and does == SLIP_TURNS and not is_allowed(model, data, label):
            continue
        if not closes:
            search.order = min(order, STIFF_ORDER)
            note_unnamed(model, data, label, friction + applied, 0.0, push)
            return applied, friction, 0
        note_closed(model, data, label, falls)
        note_unnamed(model, data, label, friction + applied, h, push)
        friction -= lost_in_stop(model, data, label, friction + applied)
        search.order = 1 if changes else min(order, CLOSING_ORDER)
        return applied, friction, 0
    return applied, friction, CONSTRAINTS_LOST


@kernel
def is_allowed(model, data, label):
    """Return whether the errors of a step are allowed in each body of a group."""
    controls, member, work = model.controls, data.group.bodies.member, data.work
    for m in range(members(work, label, member)):
        miss, size = work.body[member[m]].miss, model.system.bodies[member[m]].extent
        if not miss[0] <= allowed_error(controls.rtol, controls.atol, size, miss[MISS_SCALE]):
            return False
    return True


@kernel
def note_closed(model, data, label, falls):
    """Write the errors of a closing step for the bodies of a group, which `falls` misplaces."""
    member, work = data.group.bodies.member, data.work
    for m in range(members(work, label, member)):
        miss = work.body[member[m]].miss
        bound_accelerations_of(model.system, work, member[m], 2)
        miss[0], miss[1], miss[2] = max(miss[0], falls), 0.0, 0.0


@kernel
def greatest_first(model, data, label):
    """Return the greatest acceleration of the free bodies of a group at the start of the step.

    Implicit Euler misplaces a body by half of that times h^2, also one that falls beside a wall. Joined bodies
    are judged by friction alone: a foot that is about to slip would take eight times the steps.
    """
    greatest, member = 0.0, data.group.bodies.member
    count, loaded = bodies_of(model, data, label)
    for m in range(0 if loaded else count):
        greatest = max(greatest, first_acceleration(model.system, member[m], data.work.stages))
    return greatest


@kernel
def end_implicitly(model, data, method, label, h, powers):
    """Step a group by a stiff method, and write its end, as `implicit_member` says.

    Return whether there is one, what slip does (`note_modes`), and the work of loads and of friction.
    """
    k, applied, friction = implicit_member(model, data, method, label, h, powers)
    (A, closes), member = method, data.group.bodies.member
    if k == 0:
        return False, SLIP_STAYS, applied, friction
    if not closes:
        note_left(model, data, k)
    does = note_modes(model, data, k, h)
    joined, driven = write_end(model, data, label, k)
    applied += driven
    if not joined:
        return False, SLIP_STAYS, applied, friction
    if closes and model.controls.order > 0:
        note_undetermined(model.system, data, k, label)
        copy_to_stage(members(data.work, label, member), data.work.trial, data.group, data.work)
    _, driven, rubbed = check_end(model, data, label, A.shape[0], h, False)
    return True, does, applied + driven, friction + rubbed


@kernel
def opens(data, label):
    """Return whether a point of a group opens at the end of the step."""
    for i in range(data.active.count[0]):
        active_point = data.active.points[i]
        if data.work.body[active_point.body].label == label:
            if active_point.rest == 0 and active_point.next == MODE_OPEN:
                return True
    return False


@kernel
def closing_size(model, data, label):
    """Return the displacement by friction [m] that a closing step may neglect."""
    controls, member, least = model.controls, data.group.bodies.member, math.inf
    for m in range(members(data.work, label, member)):
        size = model.system.bodies[member[m]].extent
        least = min(least, ERROR_SHARE * allowed_error(controls.rtol, controls.atol, size, 0.0))
    return least


@kernel
def note_errors(model, data, E, label, k, h):
    """Write the errors of the bodies of a group by its stages, and bounds of their accelerations.

    Slip of k points that has passed its stop, under friction of its old direction, is an error of velocity.
    """
    system, controls, group, work = model.system, model.controls, data.group, data.work
    for m in range(members(work, label, group.bodies.member)):
        b, longest = group.bodies.member[m], math.inf
        work.body[b].bound[:3] = 0.0
        bound_accelerations_of(system, work, b, E.shape[1])
        if controls.order > 0:
            work.body[b].miss[:4] = 0.0
            if controls.pull > 0.0:
                longest = FALLS * math.sqrt(system.bodies[b].extent / controls.pull)
            T = note_miss(system, E, h, longest, b, work)
            for i in range(k):
                if b == group.points[0][i].a or b == group.points[0][i].b:
                    passed = T * beyond_stop(system, data.active, i, group)
                    work.body[b].miss[0] = max(work.body[b].miss[0], passed)
