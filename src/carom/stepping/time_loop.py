"""The loop of a run, compiled as a whole: steps, each island by island, and their records."""

from __future__ import annotations

import math

from carom._compiled.by_reference import refer
from carom._compiled.choice import by_method
from carom._compiled.decorators import entry, inlined, kernel
from carom.contact.depth import watch_depth
from carom.dynamics.adapt import begin_step
from carom.impact.driven import BLOCKED
from carom.model import records as r
from carom.model.controls import LOCATE
from carom.model.data import Data, Model
from carom.persistent.active_set import regroup
from carom.stepping.crowd.step import step_heap
from carom.stepping.energy_balance import watch_step
from carom.stepping.event_step import NOT_FINITE, advance, is_whole, strayed
from carom.stepping.islands import one_island, parts
from carom.stepping.islands.layout import Islands, NoIslands
from carom.stepping.record import finite, grow, save, still


@entry
def run(model, data, method, islands, until):
    """Go on to step number `until`, or to that time if the length of steps is chosen.

    Returns 0, what the caller is to do, or a `Status`.
    """
    controls, clock = model.controls, data.clocks[0]
    clock.since = 0.0
    while (clock.now if controls.order > 0 else clock.step) < until:
        if clock.since > r.LONG:
            return r.PAUSE
        clock.since += 0.1 * data.state.shape[0]
        if controls.order > 0:
            if clock.saved >= data.records.series.shape[0]:
                return grow(clock, r.FULL_ROWS)
            begin_step(controls, clock)
        else:
            clock.begin = clock.step * controls.step
            clock.length = min(controls.step, controls.duration - clock.begin)
        if not start(islands, model, data):
            return grow(clock, r.FULL_PAIRS)
        code = move_islands(model, data, method, islands)
        if code != 0:
            if not lost(islands, model, data, code):
                return code
            continue
        if clock.touched + data.held.points.shape[0] > data.records.touch.shape[0]:
            return grow(clock, r.FULL_EVENTS)
        end(islands, model, data)
        code = finish_step(model, data)
        if code != 0:
            return code
    return 0


@inlined
def move_islands(model, data, method, islands):
    """Move one island after the other to the end of the step; return 0 or a code."""
    code, clock = 0, data.clocks[0]
    while code == 0 and some_left(islands, clock):
        system, held, state, work = take(islands, model, data)
        part = refer(Model(refer(system), model.controls))
        own = refer(
            Data(
                state, refer(held), refer(work), data.cluster, data.corner, data.heap, data.clocks,
                data.records, data.watch,
            )
        )  # fmt: skip
        enter(islands, part, own, data.held)
        code = move(islands, part, own, method)
        if code == 0:
            leave(islands, own)
            clock.credit, clock.effort = max(0.0, clock.credit - clock.effort), 0.0
    return code


@inlined
def finish_step(model, data):
    """Set the clock to the end of the step, look at its balance, and save its row if it is one of those."""
    system, controls, clock, state = model.system, model.controls, data.clocks[0], data.state
    clock.spent = 0.0
    settle_up(clock)
    clock.step += 1
    clock.in_step = 0
    earn(state, clock, data.work)
    clock.now = clock.begin + clock.length
    clock.still = min(clock.still, clock.now) if still(state) else math.inf
    last = clock.step == controls.last
    if controls.order > 0 and clock.length == controls.duration - clock.begin:
        clock.now, last = controls.duration, True
    if not finite(state):
        return NOT_FINITE
    watch_step(system, state, clock, data.records, data.watch[0])
    if clock.step % controls.save_every == 0 or last:
        if controls.location == LOCATE:
            watch_depth(system, state, clock.now, data.work, data.watch[0])
        save(system, data.held, state, clock, data.work, data.records)
    return 0


@kernel
def settle_up(clock):
    """Put down to the impacts of a step what friction gave as bounces were dropped, and has not taken back.

    Impacts, bounces and hold together have mu times their normal impulse of friction: where the hold ends early
    it is the impacts that took less.
    """
    part = min(clock.owed, max(0.0, clock.before - clock.impacts))
    clock.impacts += part
    clock.friction -= part
    clock.owed = 0.0


@kernel
def earn(now, clock, work):
    """Note that later steps may take more work, as this one was allowed some: not where it was given up."""
    for b in range(now.shape[0]):
        if work.body[b].whole_until >= clock.step:
            return
    clock.credit = min(min(r.SAVED, r.OWN * now.shape[0]), clock.credit + r.EACH)


@kernel
def _start_all(islands, model, data):
    """Begin a step of all bodies together."""
    one_island.begin_together(model.system, data.held, data.state, data.clocks, islands)
    return True


@kernel
def _start_islands(islands, model, data):
    """Begin a step: find its islands, unless it has begun already; return False if there is no room."""
    if islands.plan[0].planned == 1:
        return True
    islands.plan[0].widen = max(1.0, islands.plan[0].widen)
    return parts.begin_step(
        model.system, data.held, data.state, data.clocks[0].length, data.clocks, data.work, islands
    )


@kernel
def _all_left(islands, clock):
    """Return whether the step has not ended."""
    return clock.spent < clock.length


@kernel
def _islands_left(islands, clock):
    """Return whether an island has not been moved."""
    return islands.plan[0].at < islands.plan[0].count


@kernel
def _take_all(islands, model, data):
    """Return the whole scene unchanged: it is one island."""
    return model.system, data.held, data.state, data.work


@kernel
def _take_island(islands, model, data):
    """Return the island at hand as a system, with what it holds, its state and its scratch."""
    i = islands.plan[0].at
    state = islands.state[islands.first[0, i] : islands.first[0, i + 1]]
    return (
        parts.part_system(model.system, islands, i),
        parts.part_held(data.held, islands, i),
        state,
        parts.part_work(data.work, islands, i),
    )


@kernel
def _enter_all(islands, part, own, held):
    """All bodies are there already."""


@kernel
def _enter_island(islands, part, own, held):
    """Begin with an island, unless that was done before the loop was left."""
    if islands.plan[0].entered == 0:
        clock = own.clocks[0]
        parts.enter(part.system, own.held, held, own.work, islands, clock.begin, clock)
        clock.first_touch = clock.touched


@inlined
def _move_all(islands, model, data, method):
    """Move all bodies to the end of the step: event by event, or whole if that did not get on."""
    system, work = model.system, data.work
    step = data.clocks[0].step
    if islands.free == 0 or not is_whole(step, work):
        parts.recover(system, step, work)
        return advance(model, data, method)
    step_heap(model, data)
    regroup(system, data.held, work)
    return work.result[0].code


@inlined
def _move_island(islands, model, data, method):
    """Move an island to the end of the step: event by event, or whole if it is large."""
    system, controls, work = model.system, model.controls, data.work
    step = data.clocks[0].step
    if not parts.is_heap(system, controls.heap, step, work):
        parts.recover(system, step, work)
        return advance(model, data, method)
    step_heap(model, data)
    code = work.result[0].code
    return (
        r.STRAYED
        if code == 0 and strayed(system, data.state, data.clocks[0].length, work)
        else code
    )


@kernel
def _leave_all(islands, own):
    """Nothing is to be put back."""


@kernel
def _leave_island(islands, own):
    """End with an island."""
    parts.leave(own.held, islands)


@kernel
def _all_lost(islands, model, data, code):
    """Go back to the start of a step that could not be taken from event to event; return whether so."""
    clock = data.clocks[0]
    if code >= r.GROW or code == BLOCKED or model.controls.retry == 0:
        return False
    if not one_island.tire_together(clock.step, data.work):
        return False
    spent = clock.effort
    one_island.forget_together(model.system, data.held, data.state, data.clocks, data.work, islands)
    clock.whole += 1
    clock.credit = max(0.0, clock.credit - spent)
    return True


@kernel
def _island_lost(islands, model, data, code):
    """Go back to the start of the step; return whether it is to be done again.

    With more room for bodies that have left theirs; with islands as heaps where one could not go from event
    to event.
    """
    if code >= r.GROW and code != r.STRAYED:
        return False  # the caller sees to it, and comes back
    clock, again = data.clocks[0], code == r.STRAYED
    if again:
        islands.plan[0].widen *= 2.0
    elif model.controls.hold == 1:
        again = parts.tire(islands, clock.step, data.work)
    spent = clock.effort
    parts.forget_step(data.held, data.clocks, islands)
    clock.credit = max(0.0, clock.credit - spent)
    if again and code != r.STRAYED:
        clock.whole += 1
    return again


@kernel
def _end_all(islands, model, data):
    """All bodies are there already."""
    islands.begun[0] = 0


@kernel
def _end_islands(islands, model, data):
    """Put all islands back."""
    clock = data.clocks[0]
    parts.end_step(model.system, data.held, data.state, clock.length, clock, data.work, islands)


start = by_method({Islands: _start_islands, NoIslands: _start_all})
some_left = by_method({Islands: _islands_left, NoIslands: _all_left})
take = by_method({Islands: _take_island, NoIslands: _take_all})
enter = by_method({Islands: _enter_island, NoIslands: _enter_all})
move = by_method({Islands: _move_island, NoIslands: _move_all})
leave = by_method({Islands: _leave_island, NoIslands: _leave_all})
lost = by_method({Islands: _island_lost, NoIslands: _all_lost})
end = by_method({Islands: _end_islands, NoIslands: _end_all})
