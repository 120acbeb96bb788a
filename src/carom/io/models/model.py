"""`Model`: the scene made from a model, with its parts by the names of the model."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.io.models.build import Coordinate
from carom.io.models.links import Link
from carom.io.models.report import Report
from carom.results.solution import Solution
from carom.scene.bodies import Body, Ground, HalfSpace
from carom.scene.joints import Joint
from carom.scene.scene import Scene


@dataclass(frozen=True, eq=False, repr=False)
class Model:
    """A model that `load_model` has read.

    Attributes
    ----------
    scene : Scene
        The scene to simulate. Its bodies have the names of the model.
    report : Report
        The parts that were left out or changed. Print it.
    bodies : dict of str to Body or carom.GROUND
        Bodies by their names in the model. A body without joints is part of the body that carries it.
    joints : dict of str to Coordinate
        Hinges and slides by name. ``model.joints["knee"].of(solution)`` returns the angle and its rate as the
        model defines them; ``.joint`` and ``.index`` are the arguments for springs, motors and stops.
    geoms : dict of str to Body or HalfSpace
        The part of the scene for each geom that may touch.
    restitution : float
        Restitution of all contacts.
    mujoco : mujoco.MjModel
        The model in MuJoCo.
    """

    scene: Scene
    report: Report
    bodies: dict[str, Body | Ground]
    joints: dict[str, Coordinate]
    geoms: dict[str, Body | HalfSpace]
    restitution: float
    mujoco: Any
    _start: np.ndarray = field(repr=False)
    _links: list[Link] = field(repr=False)
    _coordinates: dict[int, Coordinate] = field(repr=False)
    _balls: dict[int, Joint] = field(repr=False)

    def qpos(self, solution) -> np.ndarray:
        """Return the coordinates (T, nq) of the model at the saved times of a solution, as in MuJoCo.

        Set ``data.qpos`` to a row and call ``mujoco.mj_forward`` to draw the motion, or to get sites and
        sensors.
        """
        checks.instance("solution", solution, (Solution,))
        names = [[body.name for body in scene.bodies] for scene in (solution.scene, self.scene)]
        if names[0] != names[1]:
            raise ValueError(f"solution must be of the scene of this model, got {solution!r}")
        m = self.mujoco
        q = np.tile(self._start, (len(solution.t), 1))
        for j, coordinate in self._coordinates.items():
            q[:, m.jnt_qposadr[j]] = coordinate.of(solution)[0]
        for j, joint in self._balls.items():
            first = int(m.jnt_qposadr[j])
            q[:, first : first + 4] = _ball(solution, joint, self._start[first : first + 4])
        moved = {j for j in range(m.njnt)} - self._coordinates.keys() - self._balls.keys()
        for link in self._links:
            j = int(m.body_jntadr[link.body])
            if j in moved:  # a free joint
                first, body = int(m.jnt_qposadr[j]), self.scene[link.name]
                turn = solution.orientation[:, body.index]
                origin = solution.position[:, body.index] - quaternion.rotate(turn, link.centre)
                q[:, first : first + 3], q[:, first + 3 : first + 7] = origin, turn
        return q

    def __str__(self) -> str:
        return f"{self.scene}\n\nnot as in the model:\n{self.report}"

    def __repr__(self) -> str:
        return f"<Model: {self.scene!r}, {len(self.report)} entries in its report>"


def _ball(solution, joint: Joint, start: np.ndarray) -> np.ndarray:
    """Return the quaternion (T, 4) of a ball joint: q0 C0^-1 P0 P^-1 C, of parent P and child C."""
    shape = solution.orientation[:, joint.child.index].shape
    child = solution.orientation[:, joint.child.index]
    turned = quaternion.multiply(
        np.broadcast_to(start, shape),
        np.broadcast_to(quaternion.conjugate(joint.child.orientation), shape),
    )
    if isinstance(joint.parent, Body):
        turned = quaternion.multiply(turned, np.broadcast_to(joint.parent.orientation, shape))
        back = quaternion.conjugate(solution.orientation[:, joint.parent.index])
        turned = quaternion.multiply(turned, back)
    return quaternion.multiply(turned, child)
