"""Mocap bodies that move as the user says: slides and hinges that carry them, each with a driver."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from carom import checks
from carom.io.models.build import Build
from carom.io.models.links import Link, name_of
from carom.scene import constraints, joints
from carom.scene.bodies import GROUND, Body, Ground

#: the coordinates of a mocap body, by the place of their motions in what the user gives
COORDINATES = ("x", "y", "z", "turn x", "turn y", "turn z")


def motions_of(model, mocap: Mapping[str, Any] | None) -> dict[int, list[tuple[int, Any]]]:
    """Return the motions of each mocap body that moves, with their coordinates, by its number in the model."""
    checks.instance("mocap", mocap, (Mapping, type(None)))
    names = {name_of(model, "body", b): b for b in range(model.nbody) if model.body_mocapid[b] >= 0}
    found = {}
    for name, given in (mocap or {}).items():
        if name not in names:
            known = ", ".join(map(repr, names)) or "none"
            raise ValueError(
                f"mocap must have names of mocap bodies of the model ({known}), got {checks.shown(name)}"
            )
        motions = checks.listed(f"mocap[{name!r}]", given, "motions")
        if len(motions) > len(COORDINATES) or all(one is None for one in motions):
            raise ValueError(
                f"mocap[{name!r}] must have one to {len(COORDINATES)} motions, along and about x, y and z, got "
                f"{checks.shown(given)}"
            )
        found[names[name]] = [
            (k, checks.function(f"mocap[{name!r}][{k}]", one))
            for k, one in enumerate(motions)
            if one is not None
        ]
    return found


def first_velocity(motions, arm) -> np.ndarray:
    """Return the first velocity and angular velocity (6,) of a centre at `arm` from the origin of its body."""
    motion = np.zeros(6)
    for k, of_time in motions:
        motion[k] = float(of_time(0.0, 1) if hasattr(of_time, "c") else of_time(0.0)[1])
    motion[:3] += np.cross(motion[3:], arm)
    return motion


def drive(build: Build, link: Link, motions) -> None:
    """Join a mocap body to the ground by a slide or a hinge for each of its motions, and drive these.

    Axes are those of the world at the start, through the origin of the body in the model.
    """
    origin, child = build.data.xpos[link.body].copy(), build.moving(link.body)
    parent: Body | Ground = GROUND
    for place, (k, motion) in enumerate(motions):
        name, axis = f"{link.name}:{COORDINATES[k]}", np.eye(3)[k % 3]
        carried = child
        if place + 1 < len(motions):
            start, moment = (
                first_velocity(motions[: place + 1], np.zeros(3)),
                np.trace(link.inertia),
            )
            carried = build.light_link(name, link.mass, moment / 3.0, origin, start)
        kind = joints.Prismatic(axis, origin) if k < 3 else joints.Revolute(origin, axis)
        joint = build.scene.add_joint(kind, parent, carried, name=build.names.new(name, "joint"))
        driver = constraints.Driver(joint, motion=motion)
        build.scene.add_constraint(driver, name=build.names.new(f"{name}:driver", "constraint"))
        parent = carried
