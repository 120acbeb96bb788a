"""A scene in the making from a model: both, the names in use, and the part that each part became."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from carom.io.models.report import Report
from carom.results.robot import Coordinate
from carom.scene.bodies import GROUND, Body, Ground, HalfSpace, StaticBody
from carom.scene.joints import Joint
from carom.scene.scene import Scene
from carom.scene.shapes.convex import Convex

UNTURNED = (1.0, 0.0, 0.0, 0.0)


class Names:
    """Names for the parts of a scene, where they are unique; in a model a body and a joint may share one."""

    def __init__(self, reserved: Iterable[str]):
        self._taken = set(reserved)

    def new(self, wanted: str, kind: str) -> str:
        """Return `wanted`, or this name with its kind and a number if another part has it."""
        name, number = wanted, 1
        while name in self._taken:
            name = f"{wanted} ({kind})" if number == 1 else f"{wanted} ({kind} {number})"
            number += 1
        self._taken.add(name)
        return name


@dataclass
class Build:
    """A scene in the making."""

    model: Any  # mujoco.MjModel
    data: Any  # mujoco.MjData, at the start
    scene: Scene
    report: Report
    names: Names
    light: float  # masses of links between two joints of one body, as a part of the body's
    most_corners: int | None  # of the hull of a mesh
    bodies: dict[int, Body | Ground] = field(default_factory=lambda: {0: GROUND})  # of links
    coordinates: dict[int, Coordinate] = field(default_factory=dict)  # of hinges and slides
    balls: dict[int, Joint] = field(default_factory=dict)  # of ball joints
    lines: list[tuple[Joint, tuple]] = field(default_factory=list)  # slides along tendons
    geoms: dict[int, Body | HalfSpace | StaticBody] = field(default_factory=dict)
    hulls: dict[int, Convex | None] = field(default_factory=dict)  # of meshes
    triangles: dict[int, tuple] = field(default_factory=dict)  # of meshes that are seen

    def moving(self, body: int) -> Body:
        """Return the body of the scene for one of the model that has joints."""
        part = self.bodies[body]
        assert isinstance(part, Body)
        return part

    def light_link(
        self, name: str, mass: float, moment: float, position, motion, orientation=UNTURNED
    ):
        """Add a body between two joints of one, so light that it does not count, with a `motion` (6,)."""
        return self.scene.add_body(
            mass=self.light * mass, inertia=(self.light * moment,) * 3, position=position,
            orientation=orientation, velocity=motion[:3], angular_velocity=motion[3:],
            name=self.names.new(f"{name}:link", "body"),
        )  # fmt: skip

    def carrier(self, body: int) -> Body | Ground:
        """Return the body of the scene that a body of the model is a part of."""
        return self.bodies[int(self.model.body_weldid[body])]
