"""Names of contacts and stops, and of the two parts of each."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.scene.constraints import coordinate_kind


class ContactNames(NamedTuple):
    """Names of all contacts of a run in the order of their numbers, then of the stops of joints."""

    name: np.ndarray  #: (C,) name of the contact; ``body-other`` for a default pair
    body: np.ndarray  #: (C,) name of the body; for a stop the child of its joint
    other: (
        np.ndarray
    )  #: (C,) name of the half-space or other body; for a stop the parent of its joint
    unit: np.ndarray  #: (C,) unit of speeds: "m/s", or "rad/s" for a stop of an angle


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
    turns = [coordinate_kind(stop.joint, stop.coordinate) == "turn" for stop in scene.stops]
    return ContactNames(
        np.array([*name, *(stop.name for stop in scene.stops)], dtype=str),
        np.array([*body, *(joint.child.name for joint in joints)], dtype=str),
        np.array([*other, *(joint.parent.name for joint in joints)], dtype=str),
        np.array(["m/s"] * len(name) + ["rad/s" if turn else "m/s" for turn in turns], dtype=str),
    )
