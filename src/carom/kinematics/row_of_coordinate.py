"""The row of a stop, or of friction in a joint: the rate of a coordinate, times the length of the point.

That of a stop is the first of the rows (n, t1, t2) of its point, that of friction the second; the others are 0.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.kinematics.combination import acceleration_along, motion_along, push, rate, rate_in
from carom.model.parts_of_system import has_relations
from carom.model.workspace import MOTION_STOP


@kernel
def in_row(point, rate):
    """Return the rate in the row of the point."""
    u = point.length * rate
    return (u, 0.0, 0.0) if point.motion == MOTION_STOP else (0.0, u, 0.0)


@kernel
def coordinate_of(system, point):
    """Return the coordinate of a point."""
    return system.relations.coordinates[point.coordinate]


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def rate_in_row(system, point, state) -> tuple[float, float, float]:
    """Return the velocity of the point."""
    return in_row(point, rate(system, coordinate_of(system, point), state))


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def rate_in_pose(system, point, pose, state) -> tuple[float, float, float]:
    """Return the velocity of the point with the positions of one state and the velocities of another."""
    return in_row(point, rate_in(system, coordinate_of(system, point), pose, state))


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def motion_in_row(system, point, state, work) -> tuple[float, float, float]:
    """Return its change by the motions that the last solve wrote."""
    return in_row(point, motion_along(system, coordinate_of(system, point), state, work))


@unit(where=has_relations, otherwise=(0.0, 0.0, 0.0))
def acceleration_in_row(system, point, state, stage) -> tuple[float, float, float]:
    """Return its acceleration by those of a stage alone."""
    return in_row(point, acceleration_along(system, coordinate_of(system, point), state, stage))


@unit(where=has_relations)
def push_in_row(system, point, state, amount, work):
    """Add the wrenches of an impulse in the row of the point."""
    push(system, coordinate_of(system, point), state, point.length * amount, work)
