"""The rows (n, t1, t2) of a point that are rates of coordinates, times the length of the point.

That of a stop is the first row of its point, that of friction in a joint the second; the others are 0. A
contact in coordinates of the user's own has three, and so has a rope that rubs: the rate of its slack, and that
of its slip times the `grip` of the point.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.kinematics.combination import (
    acceleration_along,
    motion_along,
    push,
    rate,
    rate_in,
)
from carom.model.parts_of_system import has_relations
from carom.model.workspace import MOTION_STOP, MOTION_THREE


@kernel
def in_row(point, rate):
    """Return the rate in the row of the point."""
    u = point.length * rate
    return (u, 0.0, 0.0) if point.motion == MOTION_STOP else (0.0, u, 0.0)


@kernel
def coordinate_of(system, point, row):
    """Return the coordinate of a point, or that of a row of three."""
    return system.relations.coordinates[point.coordinate + row]


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def rate_in_row(system, point, state) -> tuple[float, float, float]:
    """Return the velocity of the point."""
    u = rate(system, coordinate_of(system, point, 0), state)
    if point.motion != MOTION_THREE:
        return in_row(point, u)
    t1 = rate(system, coordinate_of(system, point, 1), state)
    return point.length * u, point.grip * t1, rate(system, coordinate_of(system, point, 2), state)


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def rate_in_pose(system, point, pose, state) -> tuple[float, float, float]:
    """Return the velocity of the point with the positions of one state and the velocities of another."""
    u = rate_in(system, coordinate_of(system, point, 0), pose, state)
    if point.motion != MOTION_THREE:
        return in_row(point, u)
    t1 = rate_in(system, coordinate_of(system, point, 1), pose, state)
    return (
        point.length * u,
        point.grip * t1,
        rate_in(system, coordinate_of(system, point, 2), pose, state),
    )


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def motion_in_row(system, point, state, work) -> tuple[float, float, float]:
    """Return its change by the motions that the last solve wrote."""
    u = motion_along(system, coordinate_of(system, point, 0), state, work)
    if point.motion != MOTION_THREE:
        return in_row(point, u)
    t1 = motion_along(system, coordinate_of(system, point, 1), state, work)
    return (
        point.length * u,
        point.grip * t1,
        motion_along(system, coordinate_of(system, point, 2), state, work),
    )


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def acceleration_in_row(system, point, state, stage) -> tuple[float, float, float]:
    """Return its acceleration by those of a stage alone."""
    u = acceleration_along(system, coordinate_of(system, point, 0), state, stage)
    if point.motion != MOTION_THREE:
        return in_row(point, u)
    t1 = acceleration_along(system, coordinate_of(system, point, 1), state, stage)
    return (
        point.length * u,
        point.grip * t1,
        acceleration_along(system, coordinate_of(system, point, 2), state, stage),
    )


@unit(where=has_relations)
def push_in_row(system, point, state, p, work):
    """Add the wrenches of an impulse p = (p_n, p_t1, p_t2) in the rows of the point."""
    if point.motion != MOTION_THREE:
        amount = p[0] if point.motion == MOTION_STOP else p[1]
        push(system, coordinate_of(system, point, 0), state, point.length * amount, work)
        return
    factors = (point.length, point.grip, 1.0)
    for r in range(3):
        if p[r] != 0.0:
            push(system, coordinate_of(system, point, r), state, factors[r] * p[r], work)
