"""Which rows a report of forces has, and their units."""

from __future__ import annotations

from typing import NamedTuple

from carom.scene.bodies import Body
from carom.scene.coordinates import Combination
from carom.scene.forces import AppliedForce
from carom.scene.joint_friction import DryFriction
from carom.scene.more_forces import UserForce

#: numbers of a row in results: force and torque on the body, world axes; value along a coordinate or a line;
#: power
COLUMNS_EACH = 8


class Row(NamedTuple):
    """A force, and a body on which it acts."""

    force: AppliedForce
    body: Body


def bodies_of(force: AppliedForce) -> tuple[Body, ...]:
    """Return the bodies of a force with a row each: its child, or all of a user's force or a combination."""
    d = force.definition
    if isinstance(d, UserForce):
        return tuple(d.bodies)
    of = getattr(d, "joint", None)
    if not isinstance(of, Combination):
        return (force.child,)
    ends = [end for joint in of.joints for end in (joint.child, joint.parent)]
    return tuple(dict.fromkeys(end for end in ends if isinstance(end, Body)))


def rows_of(scene) -> list[Row]:
    """Return the R rows of what is exerted: a force acts on its child, that of a user on each of its bodies."""
    return [Row(force, body) for force in scene.forces for body in bodies_of(force)]


def unit_of(force: AppliedForce) -> str:
    """Return the unit of the value of a force, "" if it has none."""
    return force.definition.value_unit


def rubs(force: AppliedForce) -> bool:
    """Return whether a force is dry friction, whose value follows from the reactions of joints."""
    return isinstance(force.definition, DryFriction)
