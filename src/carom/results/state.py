"""The state of a scene at one time, in the form for user-defined functions."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import arguments, checks
from carom.geometry import quaternion
from carom.model.arrays import STATE
from carom.results.joint_coordinates import Sides, coordinates, of_scene, sides_of
from carom.scene.bodies import Body

if TYPE_CHECKING:
    from carom.results.sensors import Measured
    from carom.scene.scene import Scene

_NONE = np.array([1.0, 0.0, 0.0, 0.0])


@arguments.attributes()
class BodyState(NamedTuple):
    """Position, orientation and velocities of one body, in world axes: at one time, or at T saved times."""

    position: np.ndarray  #: (3,) or (T, 3): mass centre [m]
    orientation: np.ndarray  #: (4,) or (T, 4): unit quaternion (w, x, y, z), body to world
    velocity: np.ndarray  #: (3,) or (T, 3) [m/s]
    angular_velocity: np.ndarray  #: (3,) or (T, 3) [rad/s]


def state_of_body(states, scene: Scene, name: str, whose: str) -> BodyState | Any:
    """Return the part of `states` that belongs to the body with this name; `whose` is for messages.

    A name that no part has may be that of a sensor of the model.
    """
    if scene.robot is not None and name not in scene._parts and name in scene.robot.sensors:
        return scene.robot.sensors[name].of(states)
    try:
        part = scene[name]
    except KeyError as error:
        raise KeyError(f"{whose}: {error.args[0]}") from None
    if not isinstance(part, Body):
        raise KeyError(f"{whose}: {name!r} must be a body, got {checks.shown(part)}")
    return BodyState(*(getattr(states, field)[..., part.index, :] for field in BodyState._fields))


@arguments.attributes()
class SystemState:
    """The N bodies of a scene at one time; ``state["die"]`` is one of them, a `BodyState`. Read only.

    Attributes
    ----------
    t : float
        Time [s].
    kinetic_energy, potential_energy : float
        Energies of the whole system [J].
    """

    def __init__(
        self,
        run,
        joints: dict[int, Sides] | None = None,
        ctrl: np.ndarray | None = None,
        measured: Measured | None = None,
    ):
        self._joints = {} if joints is None else joints  # joints prepared so far
        clock, rows = run.clock, run.now.view(np.ndarray).copy()
        rows.flags.writeable = False
        self._rows, self._scene, self._to_principal = rows, run.scene, run.to_principal
        self.t = float(clock["now"][0])
        self.kinetic_energy = float(clock["kinetic"][0])
        self.potential_energy = float(clock["potential"][0])
        self._measured = measured  # accelerations and forces of contacts, for sensors
        self._ctrl = None if ctrl is None else ctrl.copy()
        self._turns = run.compiled.system.relations.coordinates["reference"].copy()

    @classmethod
    def _of_file(cls, scene, t: float, kinetic: float, potential: float, motion) -> SystemState:
        """Return a state; `motion`: position, orientation, velocity and angular velocity (N, ...)."""
        state = cls.__new__(cls)
        rows = np.zeros(len(scene.bodies), STATE)
        rows["x"], rows["Q"], rows["v"], rows["w"] = motion
        rows.flags.writeable = False
        state._ctrl = state._measured = None
        state._turns = None  # whole turns of the coordinates that a run counts
        state._joints, state._rows, state._scene, state._to_principal = {}, rows, scene, _NONE
        state.t, state.kinetic_energy, state.potential_energy = t, kinetic, potential
        return state

    @property
    def position(self) -> np.ndarray:
        """Positions of the mass centres (N, 3), world [m]."""
        return self._rows["x"]

    @property
    def velocity(self) -> np.ndarray:
        """Velocities of the mass centres (N, 3), world axes [m/s]; at the time of an impact, after it."""
        return self._rows["v"]

    @property
    def angular_velocity(self) -> np.ndarray:
        """Angular velocities (N, 3), world axes [rad/s]; at the time of an impact, after it."""
        return self._rows["w"]

    @cached_property
    def orientation(self) -> np.ndarray:
        """Unit quaternions (N, 4), body to world."""
        if (self._to_principal == _NONE).all():
            return self._rows["Q"]
        turned = quaternion.conjugate(self._to_principal)
        out = quaternion.multiply(np.array(self._rows["Q"]), turned)
        out.flags.writeable = False
        return out

    @property
    def turns(self) -> np.ndarray | None:
        """Coordinates (C,) whose whole turns a run counts [rad or m]; None of a state from a file."""
        return self._turns

    @property
    def total_energy(self) -> float:
        """Kinetic plus potential energy [J]."""
        return self.kinetic_energy + self.potential_energy

    def __getitem__(self, name: str) -> BodyState:
        """Return the state of a body, by its name, or what a sensor of the model shows."""
        return state_of_body(self, self._scene, name, "state")

    def joint_coordinates(self, joint) -> tuple[np.ndarray, np.ndarray]:
        """Return coordinates and rates (n,) of a joint, as `Solution.joint_coordinates` does.

        Angles are from -pi to pi, because a single time has no whole turns; except those of a `Screw`.

        Parameters
        ----------
        joint : Joint or str
            A joint of the scene, or its name.
        """
        joint = of_scene(self._scene, joint)
        if joint.index not in self._joints:
            self._joints[joint.index] = sides_of(joint)
        return coordinates(self._joints[joint.index], self)

    def __repr__(self) -> str:
        return f"<SystemState: {len(self._rows)} bodies at t = {self.t:.9g} s>"
