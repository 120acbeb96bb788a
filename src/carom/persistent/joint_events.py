"""Events that end a mode of dry friction in a joint: slip stops, or a force exceeds its bound.

All frictions without speed are first assumed to stick. Then the one whose force exceeds its bound most is set
to slip, until no force exceeds its bound.
"""

from __future__ import annotations

from carom._compiled.decorators import entry, inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.acceleration import acceleration
from carom.dynamics.joint_friction import any_sticks, stay_stuck
from carom.kinematics.coordinate import drift, motion_along, rate, speeds_of

STOPS, BREAKS = 5, 6  # events, numbered after those of persistent contacts
STILL = 1e-12  # relative to the speeds of both sides: less counts as zero
ABOVE = 1e-10  # relative to a bound: less is round-off of a force


@unit
def _find_joint_event(system, state, work) -> tuple[int, int]:
    """Return (event, number) of the first friction in a joint whose mode has ended in `state`; -1 if none."""
    relations = system.relations
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        if one.mode != 0 and one.mode * rate(relations.coordinates[one.coordinate], state) < 0.0:
            return STOPS, i
    if relations.frictions.shape[0] > 0 and any_sticks(relations):
        acceleration(system, state, work, work.stages[0])
        for i in range(relations.frictions.shape[0]):
            one = relations.frictions[i]
            if one.mode == 0 and abs(one.force) > one.bound * (1.0 + ABOVE):
                return BREAKS, i
    return 0, -1


@unit
def _joint_event_value(system, kind, i, state, work) -> float:
    """Return the event function, negative after the event."""
    one = system.relations.frictions[i]
    if kind == STOPS:
        return one.mode * rate(system.relations.coordinates[one.coordinate], state)
    acceleration(system, state, work, work.stages[0])
    return one.bound - abs(one.force)


@unit
def _turn_joint(system, kind, i, now, work):
    """Carry out the event of friction i."""
    one = system.relations.frictions[i]
    if kind == BREAKS:
        acceleration(system, now, work, work.stages[0])
        one.mode = -1 if one.force > 0.0 else 1
    else:
        one.mode = -one.mode
        if not one.mode * change(system, one, now, work) > 0.0:
            one.mode = 0
            stay_stuck(system, now, work)
    let_go(system, now, work)


@kernel
def change(system, one, state, work):
    """Return q'' of the coordinate of a friction, in its present mode.

    If q'' has the direction of the mode to which slip would turn, slip turns, and does not stick. The force of
    stick decides this too, except where a loop passes its dead centre: there J P J^T and the effect of friction
    vanish, and q' = 0 in the metric of J would stop the whole motion.
    """
    acceleration(system, state, work, work.stages[0])
    for b in range(state.shape[0]):
        for k in range(6):
            work.body[b].motion[k] = work.stages[0][b].rate[k]
    c = system.relations.coordinates[one.coordinate]
    return motion_along(c, state, work) + drift(c, state, system.relations.write)


@kernel
def let_go(system, now, work):
    """Let coordinates slip, one after the other, if their friction does not suffice for stick."""
    relations = system.relations
    for _ in range(relations.frictions.shape[0]):
        acceleration(system, now, work, work.stages[0])
        worst, which = ABOVE, -1
        for i in range(relations.frictions.shape[0]):
            one = relations.frictions[i]
            if one.mode == 0:
                over = abs(one.force) - one.bound
                if over > worst * max(one.bound, abs(one.force)):
                    worst, which = over / max(one.bound, abs(one.force)), i
        if which < 0:
            return
        relations.frictions[which].mode = -1 if relations.frictions[which].force > 0.0 else 1


@unit
def _review_joints(system, now, work):
    """Find the mode of each friction again: at the start, and after velocities have jumped."""
    relations = system.relations
    if relations.frictions.shape[0] == 0:
        return
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        c = relations.coordinates[one.coordinate]
        speed = rate(c, now)
        still = STILL * speeds_of(system, c, now)
        one.mode = 1 if speed > still else -1 if speed < -still else 0
    stay_stuck(system, now, work)
    let_go(system, now, work)


@inlined
def find_joint_event(system, state, work):
    """Return (event, number) of the first friction in a joint whose mode has ended in `state`; -1 if none."""
    if system.relations.there == 1 and work.result[0].held == 0:
        return _find_joint_event(system, state, work)
    return 0, -1


@inlined
def joint_event_value(system, kind, i, state, work):
    """Return the event function, negative after the event."""
    if system.relations.there == 1:
        return _joint_event_value(system, kind, i, state, work)
    return 0.0


@inlined
def turn_joint(system, kind, i, now, work):
    """Carry out the event of friction i."""
    if system.relations.there == 1:
        _turn_joint(system, kind, i, now, work)


@inlined
def review_joints(system, now, work):
    """Find the mode of each friction again: at the start, and after velocities have jumped."""
    if system.relations.there == 1:
        _review_joints(system, now, work)


@entry
def first_modes(system, now, work):
    """Find the initial modes of all frictions in joints."""
    review_joints(system, now, work)
