"""Coordinates, each that of a joint or a combination s = sum of a_k q_k of them: operations of both.

Gears, racks and keys have play in a combination: theta_1 + i theta_2 between two limits. Its row is the sum
of the rows of its terms, so it may move any number of bodies. (One coordinate: `carom.kinematics.coordinate`.)
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.kinematics import coordinate as one
from carom.model.arrays import COMBINATION


@kernel
def is_combination(c):
    """Return whether a coordinate is a combination."""
    return c.kind == COMBINATION


@kernel
def terms_of(system, c):
    """Return the range of the terms of a combination."""
    relation = system.relations.relations[c.number]
    return relation.first, relation.last


@kernel
def factor_of(system, i):
    """Return the factor of term i."""
    return system.relations.terms[i].factor


@kernel
def term_of(system, i):
    """Return the coordinate of term i."""
    return system.relations.coordinates[system.relations.terms[i].coordinate]


@kernel
def first_of(system, c):
    """Return the first coordinate of a combination, and any other coordinate itself."""
    if not is_combination(c):
        return c
    first, _ = terms_of(system, c)
    return term_of(system, first)


@kernel
def value(system, c, state):
    """Return the coordinate."""
    if not is_combination(c):
        return one.value(system, c, state)
    total, (first, last) = 0.0, terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        total += factor_of(system, i) * one.value(system, q, state)
    return total


@kernel
def rate(system, c, state):
    """Return its rate."""
    if not is_combination(c):
        return one.rate(system, c, state)
    total, (first, last) = 0.0, terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        total += factor_of(system, i) * one.rate(system, q, state)
    return total


@kernel
def rate_in(system, c, pose, state):
    """Return its rate with the positions of one state and the velocities of another."""
    if not is_combination(c):
        return one.rate_in(system, c, pose, state)
    total, (first, last) = 0.0, terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        total += factor_of(system, i) * one.rate_in(system, q, pose, state)
    return total


@kernel
def drift(system, c, state, out):
    """Return its second derivative for bodies without acceleration; `out` is workspace (6,)."""
    if not is_combination(c):
        return one.drift(system, c, state, out)
    total, (first, last) = 0.0, terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        total += factor_of(system, i) * one.drift(system, q, state, out)
    return total


@kernel
def push(system, c, state, force, work):
    """Add the wrenches of a force along the coordinate to all its bodies."""
    if not is_combination(c):
        one.push(system, c, state, force, work)
        return
    first, last = terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        one.push(system, q, state, factor_of(system, i) * force, work)


@kernel
def motion_along(system, c, state, work):
    """Return the change of its rate by the motions that the last solve wrote."""
    if not is_combination(c):
        return one.motion_along(system, c, state, work)
    total, (first, last) = 0.0, terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        total += factor_of(system, i) * one.motion_along(system, q, state, work)
    return total


@kernel
def acceleration_along(system, c, state, stage):
    """Return its second derivative by the accelerations of a stage alone, without its drift."""
    if not is_combination(c):
        return one.acceleration_along(system, c, state, stage)
    total, (first, last) = 0.0, terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        total += factor_of(system, i) * one.acceleration_along(system, q, state, stage)
    return total


@kernel
def speeds_of(system, c, state):
    """Return a bound of the speeds of which its rate is the sum."""
    if not is_combination(c):
        return one.speeds_of(system, c, state)
    total, (first, last) = 0.0, terms_of(system, c)
    for i in range(first, last):
        q = term_of(system, i)
        total += abs(factor_of(system, i)) * one.speeds_of(system, q, state)
    return total
