"""Names and units in tables: of the constraint rows of joints and constraints, and of contacts and stops."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from carom.model.contact_kinds import is_of_joint
from carom.scene.belts import BeltRelation
from carom.scene.constraints import Constraint, ConstraintDefinition, Coupling, Driver, Gear
from carom.scene.coordinates import coordinate_kind
from carom.scene.joints import Joint, JointDefinition, Screw
from carom.scene.joints.definition import ACTIVE_POINT
from carom.scene.restitution import Restitution

UNITS = {"turn": "rad", "slide": "m"}


class ConstraintRows(NamedTuple):
    """The R rows of all joints, and then of all constraints, in the order of the scene."""

    #: (R,) name of the joint or constraint, with an index if it has several rows: ``hinge[2]``
    name: np.ndarray
    #: (R,) unit of the position error: "m", "rad", or "" if user-defined factors determine it
    unit: np.ndarray


def constrained(scene) -> list[Joint | Constraint]:
    """Return all parts with constraint rows: joints, then constraints."""
    return [*scene.joints, *scene.constraints]


def constraint_rows(scene) -> ConstraintRows:
    """Return the rows of a scene."""
    names, units = [], []
    for part in constrained(scene):
        own = row_units(part.definition)
        units += own
        many = len(own) > 1
        names += [f"{part.name}[{k}]" if many else part.name for k in range(len(own))]
    return ConstraintRows(np.array(names, dtype=str), np.array(units, dtype=str))


def row_units(definition: JointDefinition | ConstraintDefinition) -> list[str]:
    """Return the unit of each row of a joint or a constraint."""
    if isinstance(definition, JointDefinition):
        # first the rows of the anchor (`kinematics.rows.direction`); the third of a screw is along its axis
        lengths = ACTIVE_POINT.get(definition.guide, definition.rows) + isinstance(
            definition, Screw
        )
        lengths = min(lengths, definition.rows)
        return ["m"] * lengths + ["rad"] * (definition.rows - lengths)
    if isinstance(definition, Driver):
        return [UNITS[coordinate_kind(definition.joint, definition.coordinate)]]
    if isinstance(definition, Gear):  # the ratio gives the first term the unit of the second one
        joint, coordinate, _ = definition.terms[1]
        return [UNITS[coordinate_kind(joint, coordinate)]]
    if isinstance(definition, BeltRelation):
        return ["m"]
    if isinstance(definition, Coupling):
        kinds = {coordinate_kind(joint, k) for joint, k, _ in definition.terms}
        return [UNITS[kinds.pop()] if len(kinds) == 1 else ""]
    return [""] * definition.rows


class Numbers:
    """Numbers of the contacts of a run, and then of the stops, by name; `Numbers()` is the dict.

    The two sides of a contact may be named in either order, whatever it is called.
    """

    def __init__(self, scene, pairs):
        self.scene, self.pairs = scene, pairs

    def __call__(self) -> dict[str, int]:
        """Return the numbers by name."""
        return self._known

    def __getstate__(self) -> dict:  # copies of a table go without the scene
        return {"_known": self._known}

    @cached_property
    def _known(self) -> dict[str, int]:
        names = contact_names(self.scene, self.pairs)
        found: dict[str, int] = {}
        for k, name in enumerate(names.name.tolist()):
            found.setdefault(name, k)
        count = len(self.pairs.body)
        for k, (a, b) in enumerate(zip(names.body[:count].tolist(), names.other[:count].tolist())):
            found.setdefault(f"{a}-{b}", k)
            found.setdefault(f"{b}-{a}", k)
        return found


class ContactNames(NamedTuple):
    """Names of all contacts of a run in the order of their numbers, then of the stops of joints."""

    name: np.ndarray  #: (C,) name of the contact; ``body-other`` for a default pair
    body: np.ndarray  #: (C,) name of the body; for a stop the child of its joint
    #: (C,) name of the half-space or other body; for a stop the parent of its joint
    other: np.ndarray
    unit: np.ndarray  #: (C,) unit of speeds: "m/s", or "rad/s" for a stop of an angle


def contact_name(scene, pairs, number: int) -> str:
    """Return the name of one contact or stop of a run, as `contact_names` does for all."""
    own, count = len(scene.contacts), len(pairs.body)
    if not own <= number < count:
        return (scene.contacts[number] if number < own else scene.stops[number - count]).name
    plane = pairs.plane[number]
    other = scene.fixed[plane] if plane >= 0 else scene.bodies[pairs.other[number]]
    return f"{scene.bodies[pairs.body[number]].name}-{other.name}"


def restitution_of(scene, pairs, number: int) -> float | Restitution:
    """Return the restitution of a contact of a run, or of a stop, by its number."""
    if number < len(pairs):
        return pairs.laws[pairs.law[number]].restitution
    return scene.stops[number - len(pairs)].restitution


def arms(contacts) -> np.ndarray:
    """Return the lever arms (C,) that convert forces and gaps of stops of angles; 1 for all others."""
    return np.where(is_of_joint(contacts), np.abs(contacts["side"]), 1.0)


def contact_names(scene, pairs) -> ContactNames:
    """Return the names of all contacts of a scene, which are the `pairs` of the run, and of its stops."""
    bodies = [body.name for body in scene.bodies]
    planes = [part.name for part in scene.fixed]
    body = [bodies[b] for b in pairs.body.tolist()]
    other = [
        planes[h] if h >= 0 else bodies[b]
        for b, h in zip(pairs.other.tolist(), pairs.plane.tolist())
    ]
    own = [contact.name for contact in scene.contacts]
    name = own + [f"{b}-{o}" for b, o in zip(body[len(own) :], other[len(own) :])]
    joints = [stop.joint for stop in scene.stops]
    return ContactNames(
        np.array([*name, *(stop.name for stop in scene.stops)], dtype=str),
        np.array([*body, *(joint.child.name for joint in joints)], dtype=str),
        np.array([*other, *(joint.parent.name for joint in joints)], dtype=str),
        np.array(
            ["m/s"] * len(name) + ["rad/s" if stop.turns else "m/s" for stop in scene.stops],
            dtype=str,
        ),
    )
