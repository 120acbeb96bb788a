"""What friction keeps from step to step: mode, direction and speed of its slip, and margins.

A point in contact, and friction in a joint, have a record of the same kind (`ACTIVE_POINT`); rolling and
pivoting are kept in that of their point.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.model.actions import MODE_SLIP
from carom.model.laws import PERSISTENT
from carom.model.workspace import MOTION_JOINT, MOTION_POINT, MOTION_ROLL


@kernel
def memory_of(system, active, closed_point):
    """Return the record of a point, or of friction in a joint; of a torque that of its point."""
    if closed_point.motion == MOTION_JOINT:
        return system.relations.memory.frictions[closed_point.active]
    return active.points[closed_point.active]


@kernel
def law_of(system, closed_point):
    """Return the number of the law of a point or a joint in persistent contact."""
    if closed_point.motion == MOTION_JOINT:
        return system.relations.frictions[closed_point.active].law
    return system.contacts[closed_point.contact].law[PERSISTENT]


@kernel
def is_torque(closed_point):
    """Return whether an entry is a torque of rolling or pivoting friction."""
    return MOTION_POINT < closed_point.motion < MOTION_JOINT


@kernel
def store_slip(system, active, closed_point, d1, d2, speed):
    """Keep direction and speed of the slip of an entry for the next step; zeros if it holds."""
    memory = memory_of(system, active, closed_point)
    if is_torque(closed_point):
        turning = memory.turning[closed_point.motion - MOTION_ROLL]
        turning[0], turning[1], turning[2] = d1, d2, speed
        return
    memory.heading[0], memory.heading[1], memory.speed = d1, d2, speed


@kernel
def slip_at_start(system, active, closed_point):
    """Return whether a point slips (or rolls, or pivots), and direction and speed at the start of the step."""
    memory = memory_of(system, active, closed_point)
    if is_torque(closed_point):
        turning = memory.turning[closed_point.motion - MOTION_ROLL]
        return turning[2] > 0.0, turning[0], turning[1], turning[2]
    d = memory.heading
    return memory.next == MODE_SLIP, d[0], d[1], memory.speed


@kernel
def first_stop(system, active, closed_point):
    """Return the time to the stop of a slip that was predicted at the start of the step."""
    memory = memory_of(system, active, closed_point)
    return memory.first_stop[closed_point.motion if is_torque(closed_point) else 0]
