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
from carom.dynamics.adapt import allowed_error, note_miss
from carom.dynamics.explicit import CONSTRAINTS_LOST, bound_accelerations_of, rubs, stages_within
from carom.dynamics.thresholds import ERROR_SHARE
from carom.model.actions import MODE_OPEN
from carom.persistent.finish import land, note_modes, review
from carom.persistent.members import closing_member, explicit_member, implicit_member
from carom.persistent.rows import beyond_stop, bodies_of
from carom.persistent.start import first_modes, first_stage
from carom.persistent.step_control import unnamed
from carom.persistent.thresholds import FALLS, STIFF_SLIP

STIFF_ORDER, CLOSING_ORDER = 4, 2


@unit
def contact_step(model, data, method, h):
    """Write the end of a step of all groups that are in persistent contact and do not rest to `work.trial`.

    The forces at the end are written to the active points; the work of friction and of loads, and a status, to
    `work.result`.
    """
    active, work, n = data.active, data.work, data.state.shape[0]
    result, joined = work.result[0], rubs(model.system)
    result.applied, result.friction, result.code = 0.0, 0.0, 0
    result.residual, result.unnamed = 0.0, 0.0
    for i in range(active.count[0]):
        label = work.body[active.points[i].body].label
        joined = joined and label != n
        if active.points[i].rest == 0 and not seen(active, i, label, work):
            step_group(model, data, method, label, h)
    if joined:  # friction in joints alone: a group without points
        step_group(model, data, method, n, h)


@kernel
def seen(active, i, label, work):
    """Return whether an earlier active point belongs to the same group."""
    for j in range(i):
        if work.body[active.points[j].body].label == label:
            return True
    return False


@kernel
def step_group(model, data, method, label, h):
    """Step one group: by the explicit member while modes last, else by the implicit one or the closing one."""
    system, controls, work, clock = model.system, model.controls, data.work, data.clocks[0]
    group, result = data.group, data.work.result[0]
    count, loaded = bodies_of(model, data, label)
    k, rate, push, friction, _ = first_stage(model, data, label, loaded, count)
    applied = result.power  # powers at the start
    had, rubbed = result.applied, result.friction
    clock.contact_steps += 1
    work.step[0].since += 5.0 * k * stages_within(method)
    order = controls.order
    if h * rate <= STIFF_SLIP and not (result.stiff == 1 and work.search[0].again == 1):
        result.applied = had + h * method.b[0] * applied
        result.friction = rubbed + h * method.b[0] * friction
        k, s = explicit_member(model, data, method, label, loaded, count, h), method.b.size
        s = s - 1 if stages_within(method) < s else s
        if k > 0 and land(model, data, loaded, k, count):
            if review(model, data, label, loaded, count, s, h, True):
                note_errors(model, data, method.E, k, count, h)
                check(model, data, loaded, count, result.friction - rubbed)
                return
        result.stiff = 1
    size = closing_size(system, controls, count, group)
    if not (order > 0 and 0.5 * h * h * push <= size):
        first_modes(data, label)
        weight = method.stiff[method.stiff.shape[0] - 1, 0]
        result.applied, result.friction = had + h * weight * applied, rubbed + h * weight * friction
        k = implicit_member(model, data, method, label, loaded, count, h)
        if k > 0:
            note_modes(model, data, k, h)
            if land(model, data, loaded, k, count):
                review(model, data, label, loaded, count, method.stiff.shape[0], h, False)
                note_errors(model, data, method.stiff_E, 0, count, h)
                if order > 0:
                    result.order = min(order, STIFF_ORDER)
                check(model, data, loaded, count, result.friction - rubbed)
                return
    first_modes(data, label)
    result.applied, result.friction = had, rubbed
    k = closing_member(model, data, label, loaded, count, h)
    note_modes(model, data, k, h)
    if k == 0 or not land(model, data, loaded, k, count):
        result.code = CONSTRAINTS_LOST
        return
    review(model, data, label, loaded, count, 2, h, False)
    lets_go = order > 0 and opens(data, label)
    if lets_go:
        note_errors(model, data, method.closing_E, 0, count, h)
    for m in range(count):
        miss, b = work.body[group.member[m]].miss, group.member[m]
        bound_accelerations_of(work, b, 2)
        miss[0], miss[1] = max(miss[0], 0.5 * h * h * push), 0.0
    if order > 0:
        result.order = 1 if lets_go else CLOSING_ORDER


@kernel
def opens(data, label):
    """Return whether a point of a group opens at the end of the step.

    Rows at the end of a closing step give the impulses of what still presses or sticks there, however friction
    has changed in between; the impulse of what has let go is known but to h times its force.
    """
    for i in range(data.active.count[0]):
        active_point = data.active.points[i]
        if data.work.body[active_point.body].label == label:
            if active_point.rest == 0 and active_point.next == MODE_OPEN:
                return True
    return False


@kernel
def closing_size(system, controls, count, group):
    """Return the displacement by friction [m] that a closing step may neglect."""
    least = math.inf
    for m in range(count):
        size = system.bodies[group.member[m]].extent
        least = min(least, ERROR_SHARE * allowed_error(controls.rtol, controls.atol, size, 0.0))
    return least


@kernel
def note_errors(model, data, E, k, count, h):
    """Write the errors of the bodies of a group by its stages, and bounds of their accelerations.

    Slip of k points that has passed its stop, under friction of its old direction, is an error of velocity.
    """
    system, controls, group, work = model.system, model.controls, data.group, data.work
    for m in range(count):
        b, longest = group.member[m], math.inf
        work.body[b].bound[:3] = 0.0
        bound_accelerations_of(work, b, E.shape[1])
        if controls.order > 0:
            work.body[b].miss[:3] = 0.0
            if controls.pull > 0.0:
                longest = FALLS * math.sqrt(system.bodies[b].extent / controls.pull)
            T = note_miss(system, E, h, longest, b, work)
            for i in range(k):
                if b == group.points[0][i].a or b == group.points[0][i].b:
                    passed = T * beyond_stop(system, data.active, i, group)
                    work.body[b].miss[0] = max(work.body[b].miss[0], passed)


@kernel
def check(model, data, loaded, count, friction):
    """Note the energy that no force explains, of bodies on which only gravity acts."""
    if loaded:
        return
    work, group = data.work, data.group
    over = unnamed(
        model.system, model.controls, data.state, work.trial, friction, count, group.member
    )
    work.result[0].unnamed = max(work.result[0].unnamed, over)
