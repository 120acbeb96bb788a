"""`Model`: the scene made from a model, with its parts by the names of the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.io.models.report import Report
from carom.results.robot import Coordinate, Keyframe, Motor, Robot
from carom.results.sensors import Sensor
from carom.results.solution import Solution
from carom.results.state import SystemState
from carom.scene.bodies import Body, Ground, HalfSpace, StaticBody
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
    geoms : dict of str to Body, HalfSpace or StaticBody
        The part of the scene for each geom that may touch.
    restitution : float
        Restitution of all contacts.
    mujoco : mujoco.MjModel
        The model in MuJoCo.
    """

    scene: Scene
    report: Report
    bodies: dict[str, Body | Ground]
    joints: Mapping[str, Coordinate]
    geoms: dict[str, Body | HalfSpace | StaticBody]
    restitution: float
    mujoco: Any

    @property
    def actuators(self) -> Mapping[str, Motor]:
        """Actuators by name: their `length`, `control` and `force`."""
        return self._robot.actuators

    @property
    def sensors(self) -> Mapping[str, Sensor]:
        """Sensors by name; also ``solution["gyro"]`` and ``run.state["gyro"]``."""
        return self._robot.sensors

    @property
    def keyframes(self) -> Mapping[str, Keyframe]:
        """Keyframes by name: `qpos`, `qvel` and `ctrl`; for `Run.reset`."""
        return self._robot.keyframes

    def qpos(self, solution: Solution | SystemState) -> np.ndarray:
        """Return the coordinates of the model, as MuJoCo's ``data.qpos``.

        Set ``data.qpos`` to a row and call ``mujoco.mj_forward`` to draw the motion.

        Parameters
        ----------
        solution : Solution or SystemState
            A solution, also one from a file: (T, nq) at its saved times; or ``run.state``: (nq,).
        """
        return self._robot.qpos(solution)

    def qvel(self, solution: Solution | SystemState) -> np.ndarray:
        """Return the velocities of the model, as MuJoCo's ``data.qvel``: (T, nv) or (nv,), as `qpos`."""
        return self._robot.qvel(solution)

    def ctrl(self, solution: Solution | SystemState) -> np.ndarray:
        """Return the controls of the actuators, as MuJoCo's ``data.ctrl``: (T, nu) or (nu,), as `qpos`.

        Those of a saved time are the ones that acted until then.
        """
        return self._robot.ctrl(solution)

    @property
    def _robot(self) -> Robot:
        robot = self.scene.robot
        assert robot is not None
        return robot

    def __str__(self) -> str:
        return f"{self.scene}\n\nnot as in the model:\n{self.report}"

    def __repr__(self) -> str:
        return f"<Model: {self.scene!r}, {len(self.report)} entries in its report>"
