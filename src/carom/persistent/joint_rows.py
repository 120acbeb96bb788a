"""Dry friction in joints as rows of a group: an interval of constant width, beside the discs of its points.

The coordinate q of a joint has the row q' and the force |F| <= bound against it. Its entry follows those of
rolling and pivoting: the same equations, with the bound in the place of mu times a normal force.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.point_lists import write_closed
from carom.dynamics.contact_impulse import clear_wrenches
from carom.dynamics.elements.relation import prescribed
from carom.dynamics.solve import free_body
from carom.geometry.thresholds import ROUND_OFF
from carom.kinematics.combination import (
    drift,
    first_of,
    is_combination,
    motion_along,
    push,
    speeds_of,
    term_of,
    terms_of,
)
from carom.kinematics.coordinate import slides
from carom.model.workspace import CONSTANT, MOTION_JOINT, MOTION_PIVOT
from carom.persistent.settle import greatest
from carom.persistent.thresholds import MOTOR_COMPLIANCE


@kernel
def add_frictions(system, label, state, k, group, work):
    """Add an entry for each dry friction in the joints of a group; return the new count."""
    if system.relations.there == 1 and label == work.body.shape[0]:
        return _add_frictions(system, state, k, group, work)
    return k


@unit
def _add_frictions(system, state, k, group, work) -> int:
    """Add the entries of all frictions in joints."""
    relations = system.relations
    for i in range(relations.frictions.shape[0]):
        if k == group.closed.shape[0]:
            group.count[1] += 1
            break
        closed_point, point = group.closed[k], group.points[0][k]
        write_closed(-1, 0, point.core, CONSTANT, closed_point)
        closed_point.motion, closed_point.active = MOTION_JOINT, i
        closed_point.load = relations.frictions[i].load
        closed_point.listed, closed_point.weight = 1, 1.0
        place_coordinate(system, i, work.moment[0].time, point)
        alone = response_alone(system, coordinate_of(system, i), state, work)
        closed_point.spring = MOTOR_COMPLIANCE * point.length * point.length * alone
        k += 1
    return k


@kernel
def coordinate_of(system, i):
    """Return the coordinate of friction i."""
    relations = system.relations
    return relations.coordinates[relations.frictions[i].coordinate]


@kernel
def place_coordinate(system, i, t, point):
    """Write the coordinate of friction i as a point at a time: its row is the second of the point.

    A drive with a limit is friction on what moves at its rate.
    """
    c, one = coordinate_of(system, i), system.relations.frictions[i]
    point.a, point.b = (c.child, c.parent) if c.child >= 0 else (c.parent, -1)
    point.core[0], point.core[1], point.core[2] = 0.0, 0.0, 0.0
    point.gap, point.length, point.moves, point.motion = 0.0, one.arm, one.drives, MOTION_JOINT
    point.coordinate = one.coordinate
    if one.drives == 1:
        _, point.field[0, 0], point.field[2, 0] = prescribed(system.relations, one, t)


@kernel
def push_in(i, push, group):
    """Return `push`, or the acceleration of entry i by its own friction: in a joint nothing else may act."""
    if group.closed[i].motion == MOTION_JOINT:
        return max(push, group.problem.mu[i] * group.own[3 * i + 1, 1])
    return push


@kernel
def still_speed(i, push, controls, group):
    """Return the speed of slip of entry i that is round-off: a part of what accelerates it in a step."""
    return controls.rest * push_in(i, push, group) * controls.step


@kernel
def greatest_load(k, group):
    """Return the greatest acceleration of the k points by all but their forces, and by drives that may slip.

    It is the scale of accelerations and of what moves in a step; in a clutch nothing else may push.
    """
    load = greatest(3 * k, group.problem.c)
    for i in range(k):
        if group.closed[i].motion == MOTION_JOINT and group.points[0][i].moves == 1:
            load = max(load, group.problem.mu[i] * group.own[3 * i + 1, 1])
    return load


@kernel
def place_drives(system, k, t, group):
    """Write the rates of drives with limits at a time."""
    for i in range(k):
        if group.closed[i].motion == MOTION_JOINT and group.points[0][i].moves == 1:
            place_coordinate(system, group.closed[i].active, t, group.points[0][i])


@kernel
def is_angle(system, point):
    """Return whether the velocity of an entry is that of an angle: of pivoting, or of a joint that turns."""
    if point.motion != MOTION_JOINT:
        return point.motion == MOTION_PIVOT
    return not slides(first_of(system, system.relations.coordinates[point.coordinate]))


@kernel
def size_of_slip(system, point):
    """Return the displacement of its body by a unit of the slip of an entry: of an angle that at its size."""
    if not is_angle(system, point):
        return 1.0
    size = system.bodies[point.a].extent
    return size / point.length if point.motion == MOTION_JOINT else size


@kernel
def set_bound(i, coefficient, group):
    """Write the friction of an entry: a coefficient, a bound, or a coefficient times the load of a joint."""
    group.problem.mu[i] = coefficient
    if is_by_load(i, group):
        group.closed[i].coefficient = coefficient
        group.problem.mu[i] *= group.closed[i].bears


@kernel
def is_by_load(i, group):
    """Return whether an entry is friction in a joint that is bounded by its load."""
    return group.closed[i].motion == MOTION_JOINT and group.closed[i].load >= 0


@kernel
def response_alone(system, c, state, work):
    """Return the acceleration of a coordinate by a unit force along it, of its bodies without joints."""
    clear_wrenches(work)
    push(system, c, state, 1.0, work)
    if is_combination(c):
        first, last = terms_of(system, c)
        for i in range(first, last):
            free_ends(system, term_of(system, i), state, work)
    else:
        free_ends(system, c, state, work)
    return motion_along(system, c, state, work)


@kernel
def free_ends(system, c, state, work):
    """Write the motions of both bodies of a joint without joints."""
    for b in (c.child, c.parent):
        if b >= 0:
            free_body(system.bodies[b], state[b].Q, work.body[b])


@kernel
def drift_of_coordinate(system, i, state, work):
    """Return q'' of the coordinate of friction i, at its arm, for bodies without acceleration."""
    along = drift(system, coordinate_of(system, i), state, work.joint[0].target)
    return system.relations.frictions[i].arm * along


@kernel
def is_driven(group, i):
    """Return whether entry i is a coordinate to which joints and motors leave no freedom."""
    closed_point = group.closed[i]
    return closed_point.motion == MOTION_JOINT and not (
        group.own[3 * i + 1, 1] > closed_point.spring
    )


@kernel
def rounding_of_rate(system, i, state):
    """Return the round-off of the rate of the coordinate of friction i, at its arm."""
    one = system.relations.frictions[i]
    return ROUND_OFF * one.arm * speeds_of(system, coordinate_of(system, i), state)


@kernel
def radius_of(group, i):
    """Return the greatest friction of an entry: mu times the force in `p` that bounds it, or a constant."""
    parent = group.closed[i].parent
    return (
        group.problem.mu[i]
        if parent == CONSTANT
        else group.problem.mu[i] * max(0.0, group.p[3 * parent])
    )
