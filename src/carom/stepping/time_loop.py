"""The time loop of a run, compiled as one unit: its steps, the islands of each step, and the records."""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, entry, inlined, kernel
from carom._compiled.units import unit
from carom.contact.depth import watch_depth
from carom.contact.operations import lost_gap
from carom.dynamics.applied import part_forces
from carom.dynamics.known_end import forget_end
from carom.dynamics.local_scale import local_controls, note_scale
from carom.model import records as r
from carom.model.allowance import begin_count, end_count
from carom.model.controls import LOCATE
from carom.model.data import Data, Model
from carom.persistent.active_set import regroup
from carom.status import BLOCKED, FUNCTION_FAILED, LEFT_CURVE, OUT_OF_PLANE, STEP_TOO_SMALL
from carom.stepping.crowd.error import watch_error
from carom.stepping.crowd.layout import SPOTS
from carom.stepping.crowd.step import step_crowd
from carom.stepping.energy_balance import forget_whole, note_whole, watch_step
from carom.stepping.event_step import NOT_FINITE, advance, left_ball
from carom.stepping.grid import end_of, is_saved
from carom.stepping.islands import one_island, parts
from carom.stepping.islands.joined import part_memory, part_relations, part_solver
from carom.stepping.islands.pieces import end_piece, note_busy, piece_of
from carom.stepping.islands.plan import READY
from carom.stepping.record import finite, grow, room_of_touches, save, still

REPEAT = -1  # the step is to be repeated


@entry
def run(model, data, method, islands, grid, until):
    """Continue to step number `until`.

    Return 0, a code for the caller, or a `Status`.
    """
    begin_call(data.work)
    return take_steps(model, data, method, islands, grid, until)


@kernel
def begin_call(work):
    """Begin a call from Python: what was set since the last one may have changed the accelerations."""
    work.step[0].since = 0.0
    forget_end(work)


@kernel
def take_steps(model, data, method, islands, grid, until):
    """Continue to step number `until`; return 0, a code for the caller, or a `Status`."""
    controls, clock, step = model.controls, data.clocks[0], data.work.step[0]
    while clock.step < until:
        if step.since > r.LONG:
            return r.PAUSE
        step.since += 0.1 * data.state.shape[0]
        step.begin, step.length = piece_of(grid, controls, clock, islands)
        if islands.apart == 1:
            code = step_apart(model, data, method, islands)
        else:
            code = step_single(model, data, method, islands.single)
        if code == REPEAT:
            continue
        if code != 0:
            return code
        rows = room_of_touches(model.system, data.active.points.shape[0])
        if clock.touched + rows > data.records.touch.shape[0]:
            return grow(step, r.FULL_EVENTS)
        if islands.apart == 1:
            end_islands(model, data, islands)
        else:
            islands.single.begun[0] = 0
        code = finish_step(model, data, grid, islands)
        if code != 0:
            return code
    return 0


@kernel
def step_single(model, data, method, start):
    """Move all bodies to the end of the step together; return 0, REPEAT, or a code."""
    step = data.work.step[0]
    if start.begun[0] == 0:
        note_scale(model.system, model.controls, data.state, data.work)
        begin_count(model.controls, data.work)
        parts.choose(model.system, model.controls, data.active, data.clocks[0].step, data.work)
    one_island.begin_single(model.system, data.active, data.state, data.clocks, data.work, start)
    controls = local_controls(model.controls, step)
    local = by_reference(Model(model.system, controls))
    code = 0
    while code == 0 and step.spent < step.length:
        code = move_island(local, data, method)
        if code == 0 and data.crowd.closed.shape[0] >= SPOTS:  # a crowd leaves no groups
            regroup(model.system, data.active, data.work)
        if code == 0:
            end_count(controls, data.work)
            note_gain(controls, step, data.watch[0])
    return REPEAT if code != 0 and retry_single(model, data, start, code) else code


@unit
def step_apart(model, data, method, islands) -> int:
    """Move the bodies to the end of the step, island by island; return 0, REPEAT, or a code."""
    step, plan = data.work.step[0], islands.plan[0]
    if plan.planned == 0:
        plan.widen = max(1.0, plan.widen)
        code = parts.begin_step(
            model.system, data.active, data.state, data.clocks, data.work, islands
        )
        if code != READY:
            return grow(step, code)
    code = 0
    while code == 0 and plan.at < plan.count:
        code = move_part(model, data, method, islands)
    return REPEAT if code != 0 and retry_apart(model, data, islands, code) else code


@kernel
def move_part(model, data, method, islands):
    """Move the present island to the end of the step; return 0, or a code."""
    step, plan = data.work.step[0], islands.plan[0]
    i, k, joined = plan.at, islands.cluster[plan.at], islands.others
    joints, relations, forces, solver = (
        joined.joints,
        joined.relations,
        joined.forces,
        joined.solver,
    )
    if k >= 0:
        joined, n = islands.joined, parts.bodies_of_present(islands)
        ranges = joined.ranges[k]
        joints = joined.joints[ranges.joint[0] : ranges.joint[1]]
        memory = by_reference(part_memory(joined, ranges))
        relations = by_reference(part_relations(joined, ranges, memory))
        forces = by_reference(part_forces(joined.forces, ranges.force))
        solver = by_reference(part_solver(joined, k, n))
    system = parts.part_system(model.system, islands, i, joints, (relations, forces, solver))
    active = parts.part_active(data.active, islands, i)
    work = parts.part_work(data.work, islands, i)
    state = islands.state[islands.first[0, i] : islands.first[0, i + 1]]
    own = by_reference(
        Data(
            state=state, active=by_reference(active), work=by_reference(work), group=data.group,
            multiple=data.multiple, crowd=data.crowd, clocks=data.clocks, records=data.records,
            watch=data.watch,
        )
    )  # fmt: skip
    if plan.entered == 0:  # if the loop was left within an island, it has been entered
        parts.enter(system, own.active, data.active, own.work, islands, data.clocks[0])
        note_scale(system, model.controls, state, own.work)
        begin_count(model.controls, own.work)
        parts.choose(system, model.controls, own.active, plan.pieces, own.work)
    controls = local_controls(model.controls, step)
    part = by_reference(Model(by_reference(system), controls))
    code = move_island(part, own, method)
    if code == 0:
        end_count(controls, own.work)
        note_gain(controls, step, data.watch[0])
        note_busy(data.clocks[0], own.active, own.work, plan)
        parts.leave(own, islands)
    return code


@inlined
def note_gain(controls, step, watch):
    """Raise the greatest speed to that which forces could have given in the step.

    Bodies that a force presses have no speed, but the residual of their contacts is a part of this one.
    """
    watch.speed = max(watch.speed, controls.pull * step.length)


@kernel
def without_gap(system, watch):
    """Return the status of a run in which a contact has no gap.

    A body has tipped beside a profile, or the function of a surface has no value.
    """
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if contact.number == watch.deep_contact and lost_gap(contact) != NOT_FINITE:
            return lost_gap(contact)
    return NOT_FINITE


@inlined
def finish_step(model, data, grid, islands):
    """Set the clock to the end of the piece, check the energy balance, and save the state if it is due."""
    system, controls, clock, state = model.system, model.controls, data.clocks[0], data.state
    step = data.work.step[0]
    charge_impacts(clock, step)
    step.spent, clock.now = 0.0, step.begin + step.length
    ends = end_piece(grid, controls, clock, step.length, islands)
    if ends:
        clock.step += 1
        clock.now = end_of(grid, controls.duration, clock.step)
    clock.still = min(clock.still, clock.now) if still(state) else math.inf
    if not finite(state):
        return NOT_FINITE
    watch_step(system, data)
    if not math.isfinite(clock.kinetic + clock.potential):
        return NOT_FINITE
    if ends and is_saved(grid, clock.step):
        if controls.location == LOCATE:
            watch_depth(system, state, clock.now, data.work, data.watch[0])
            if not data.watch[0].depth < math.inf:
                return without_gap(system, data.watch[0])
        save(model, data)
    return 0


@kernel
def charge_impacts(clock, step):
    """Assign to impacts the energy that friction gained by dropped bounces in the step and did not lose again.

    The friction of impacts, bounces and persistent contact together is mu times their normal impulse. If the
    contact ends early, the impacts have lost less.
    """
    part = min(step.owed, max(0.0, step.impacts - clock.impacts))
    clock.impacts += part
    clock.friction -= part


@inlined
def move_island(model, data, method):
    """Move an island to the end of the step: event by event, or in one time-stepping step if it is a crowd."""
    work = data.work
    if work.step[0].crowd == 0:
        return advance(model, data, method)
    code = step_crowd(model, data, method)
    if code == BLOCKED:
        forget_whole(work.step[0], data.watch[0])
    if code == 0 and left_ball(model.system, data.state, work.step[0].length, work):
        return r.LEFT_BALL
    if code == 0 and model.controls.order > 0:
        watch_error(model.system, model.controls, work, data.watch[0])
    return code


@inlined
def may_be_whole(code, data):
    """Return whether a step that ended with this code may succeed as a time-stepping step of a crowd.

    Forces that grow without bound, mechanisms that lock, ends of curves, bodies that tip beside a profile and
    gaps without a value are not mended by it. Steps that are too small are those of contacts if there is one,
    or was one in this step (a disc that rattles down to its face).
    """
    if code in (BLOCKED, LEFT_CURVE, OUT_OF_PLANE, FUNCTION_FAILED):
        return False
    touched = data.active.count[0] > 0 or data.clocks[0].event > data.work.step[0].first_event
    return code != STEP_TOO_SMALL or touched


@inlined
def retry_single(model, data, start, code):
    """Return to the start of a step that failed event by event; return whether this is done."""
    step = data.work.step[0]
    if code >= r.GROW or model.controls.retry == 0 or not may_be_whole(code, data):
        return False
    if not one_island.give_up_single(model.controls, data.clocks[0].step, data.work):
        return False
    note_whole(model.system, model.controls, step, code, data.state.shape[0], data.watch[0])
    one_island.forget_single(model.system, data.active, data.state, data.clocks, data.work, start)
    return True


@inlined
def retry_apart(model, data, islands, code):
    """Return to the start of the step; return whether it is to be repeated.

    It is repeated with larger balls for bodies that have left theirs, and with an island as a crowd if the
    island failed event by event.
    """
    if code >= r.GROW and code != r.LEFT_BALL:
        return False  # the caller handles the code, and calls again
    step, again = data.work.step[0], code == r.LEFT_BALL
    if again:
        islands.plan[0].widen *= 2.0
    elif model.controls.hold == 1 and may_be_whole(code, data):
        again = parts.give_up(model.controls, islands, islands.plan[0].pieces, data.work)
        if again:
            bodies = parts.bodies_of_present(islands)
            note_whole(model.system, model.controls, step, code, bodies, data.watch[0])
    parts.forget_step(data.active, data.clocks, data.work, islands)
    return again


@unit
def end_islands(model, data, islands):
    """Write all islands back to the whole system."""
    parts.end_step(model.system, data.active, data.state, data.work, islands)
