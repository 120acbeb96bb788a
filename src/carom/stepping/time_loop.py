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
from carom.persistent.active_set import regroup
from carom.stepping.crowd.step import step_heap
from carom.stepping.energy_balance import watch_step
from carom.stepping.event_step import LOCATE, NOT_FINITE, advance, is_whole, strayed
from carom.stepping.islands import one_island, parts
from carom.stepping.islands.layout import Islands, NoIslands
from carom.stepping.record import finite, save, still


@entry
def run(
    system, method, controls, held, now, work, islands, cluster, corner, heap, clocks, records,
    watch, until,
):  # fmt: skip
    """Go on from `now` to step number `until`, or to that time if the length of steps is chosen.

    Returns 0, what the caller is to do, or a `Status`.
    """
    clock = clocks[0]
    clock.since = 0.0
    while (clock.now if controls.order > 0 else clock.step) < until:
        if clock.since > r.LONG:
            return r.PAUSE
        clock.since += 0.1 * now.shape[0]
        if controls.order > 0:
            if clock.saved >= records.series.shape[0]:
                return r.NEEDS_ROWS
            begin_step(controls, clock)
            begin, length = clock.begin, clock.length
        else:
            begin = clock.step * controls.step
            length = min(controls.step, controls.duration - begin)
        if not start(islands, system, held, now, length, clocks, work):
            return r.NEEDS_ROOM
        code = 0
        while code == 0 and some_left(islands, length, clock):
            part, own, here, scratch = take(islands, system, held, now, work)
            part, own, scratch = refer(part), refer(own), refer(scratch)
            enter(islands, part, own, held, scratch, begin, clock)
            code = move(
                islands, part, method, controls, own, here, begin, length, cluster, corner, heap,
                scratch, clocks, records, watch[0],
            )  # fmt: skip
            if controls.order > 0:
                length = clock.length
            if code == 0:
                leave(islands, own)
                clock.credit, clock.effort = max(0.0, clock.credit - clock.effort), 0.0
        if code != 0:
            if not lost(islands, system, controls, code, held, now, clocks, work):
                return code
            continue
        if clock.touched + held.points.shape[0] > records.touch.shape[0]:
            return r.FULL
        end(islands, system, held, now, length, clock, work)
        clock.spent = 0.0
        settle_up(clock)
        clock.step += 1
        clock.in_step = 0
        earn(now, clock, work)
        clock.now = begin + length
        clock.still = min(clock.still, clock.now) if still(now) else math.inf
        last = clock.step == controls.last
        if controls.order > 0 and length == controls.duration - begin:
            clock.now, last = controls.duration, True
        if not finite(now):
            return NOT_FINITE
        watch_step(system, now, clock, records, watch[0])
        if clock.step % controls.save_every == 0 or last:
            if controls.location == LOCATE:
                watch_depth(system, now, clock.now, work, watch[0])
            save(system, held, now, clock, work, records)
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
def _start_all(islands, system, held, now, length, clocks, work):
    """Begin a step of all bodies together."""
    one_island.begin_together(system, held, now, clocks, islands)
    return True


@kernel
def _start_islands(islands, system, held, now, length, clocks, work):
    """Begin a step: find its islands, unless it has begun already; return False if there is no room."""
    if islands.plan[0].planned == 1:
        return True
    islands.plan[0].widen = max(1.0, islands.plan[0].widen)
    return parts.begin_step(system, held, now, length, clocks, work, islands)


@kernel
def _all_left(islands, length, clock):
    """Return whether the step has not ended."""
    return clock.spent < length


@kernel
def _islands_left(islands, length, clock):
    """Return whether an island has not been moved."""
    return islands.plan[0].at < islands.plan[0].count


@kernel
def _take_all(islands, system, held, now, work):
    """Return what there is."""
    return system, held, now, work


@kernel
def _take_island(islands, system, held, now, work):
    """Return the island at hand as a system, with what it holds, its state and its scratch."""
    i = islands.plan[0].at
    state = islands.state[islands.first[0, i] : islands.first[0, i + 1]]
    return (
        parts.part_system(system, islands, i),
        parts.part_held(held, islands, i),
        state,
        parts.part_work(work, islands, i),
    )


@kernel
def _enter_all(islands, part, own, held, work, begin, clock):
    """All bodies are there already."""


@kernel
def _enter_island(islands, part, own, held, work, begin, clock):
    """Begin with an island, unless that was done before the loop was left."""
    if islands.plan[0].entered == 0:
        parts.enter(part, own, held, work, islands, begin, clock)
        clock.first_touch = clock.touched


@inlined
def _move_all(
    islands, system, method, controls, held, now, begin, length, cluster, corner, heap, work,
    clocks, records, watch,
):  # fmt: skip
    """Move all bodies to the end of the step: event by event, or whole if that did not get on."""
    step = clocks[0].step
    if islands.free == 0 or not is_whole(step, work):
        parts.recover(system, step, work)
        return advance(
            system, method, controls, held, now, begin, length, cluster, corner, work, clocks,
            records, watch,
        )  # fmt: skip
    if controls.hold_at == 0:
        return r.NEEDS_HOLD
    if controls.heap_at == 0:
        return r.NEEDS_HEAP
    step_heap(
        controls.heap_at, system, controls, held, now, begin, length, heap, work, clocks, records
    )
    regroup(system, held, work)
    return work.result[0].code


@inlined
def _move_island(
    islands, part, method, controls, own, here, begin, length, cluster, corner, heap, work, clocks,
    records, watch,
):  # fmt: skip
    """Move an island to the end of the step: event by event, or whole if it is large."""
    if not parts.is_heap(part, controls.heap, clocks[0].step, work):
        if own.count[0] > 0 and controls.hold_at == 0:  # by a heap
            return r.NEEDS_HOLD
        parts.recover(part, clocks[0].step, work)
        return advance(
            part, method, controls, own, here, begin, length, cluster, corner, work, clocks, records,
            watch,
        )  # fmt: skip
    if controls.heap_at == 0:
        return r.NEEDS_HEAP
    step_heap(
        controls.heap_at, part, controls, own, here, begin, length, heap, work, clocks, records
    )
    code = work.result[0].code
    return r.STRAYED if code == 0 and strayed(part, here, length, work) else code


@kernel
def _leave_all(islands, own):
    """Nothing is to be put back."""


@kernel
def _leave_island(islands, own):
    """End with an island."""
    parts.leave(own, islands)


@kernel
def _all_lost(islands, system, controls, code, held, now, clocks, work):
    """Go back to the start of a step that could not be taken from event to event; return whether so."""
    if code >= r.FULL or code == BLOCKED or controls.retry == 0:
        return False
    if not one_island.tire_together(clocks[0].step, work):
        return False
    spent = clocks[0].effort
    one_island.forget_together(system, held, now, clocks, work, islands)
    clocks[0].whole += 1
    clocks[0].credit = max(0.0, clocks[0].credit - spent)
    return True


@kernel
def _island_lost(islands, system, controls, code, held, now, clocks, work):
    """Go back to the start of the step; return whether it is to be done again.

    With more room for bodies that have left theirs; with islands as heaps where one could not go from event
    to event.
    """
    if code >= r.FULL and code != r.STRAYED:
        return False  # the caller sees to it, and comes back
    again = code == r.STRAYED
    if again:
        islands.plan[0].widen *= 2.0
    elif controls.hold == 1:
        again = parts.tire(islands, clocks[0].step, work)
    spent = clocks[0].effort
    parts.forget_step(held, clocks, islands)
    clocks[0].credit = max(0.0, clocks[0].credit - spent)
    if again and code != r.STRAYED:
        clocks[0].whole += 1
    return again


@kernel
def _end_all(islands, system, held, now, length, clock, work):
    """All bodies are there already."""
    islands.begun[0] = 0


@kernel
def _end_islands(islands, system, held, now, length, clock, work):
    """Put all islands back."""
    parts.end_step(system, held, now, length, clock, work, islands)


start = by_method({Islands: _start_islands, NoIslands: _start_all})
some_left = by_method({Islands: _islands_left, NoIslands: _all_left})
take = by_method({Islands: _take_island, NoIslands: _take_all})
enter = by_method({Islands: _enter_island, NoIslands: _enter_all})
move = by_method({Islands: _move_island, NoIslands: _move_all})
leave = by_method({Islands: _leave_island, NoIslands: _leave_all})
lost = by_method({Islands: _island_lost, NoIslands: _all_lost})
end = by_method({Islands: _end_islands, NoIslands: _end_all})
