"""Sensors of a model: readings of a solution or a state, with the conventions of MuJoCo.

Frames are those of bodies, shapes and sites; vectors of a sensor without a reference are in world axes, those
of the sensors of a site in its own. Accelerations contain the reaction to gravity, as an accelerometer shows
it, and the forces of persistent contacts, but not the impulses of impacts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from carom import checks, fields
from carom.fields import Flag, Integer, Number, Value, Vector
from carom.geometry import quaternion
from carom.results.robot import Coordinate, Motor, checked
from carom.scene.bodies import GROUND, Body, Ground


def _numbers(name: str, value) -> np.ndarray:
    return checks.finite_array(name, value, (None,))


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame fixed in a body: its place from the mass centre, in axes of the body; or in the world."""

    body: Body | Ground = GROUND
    position: Vector = fields.vector((0.0, 0.0, 0.0))
    orientation: Value[np.ndarray, Any] = Value(checks.unit_quaternion, (1.0, 0.0, 0.0, 0.0))


WORLD = Frame()


class Moving(NamedTuple):
    """The motion of a frame, world axes."""

    position: np.ndarray
    turn: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray


@dataclass(frozen=True, eq=False)
class Sensor:
    """A sensor of a model.

    Attributes
    ----------
    name : str
    kind : str
        Its element in MJCF, such as ``"gyro"``.
    frame : Frame
        Where it is.
    reference : Frame
        In which frame it sees; the world by default.
    members : tuple of Body
        Of ``force``, ``torque`` and ``subtree...``: the bodies behind it.
    terms : tuple of (Coordinate, float)
        Of joints, tendons and actuators: coordinates, and their factors in what it shows.
    motors : tuple of (Motor, float)
        Of actuators and joints: whose forces it adds, with these factors.
    at : int
        Place of the first number of a ball joint in `qpos` or `qvel`.
    values : array
        Size and kind of the site of a ``touch``; the field of a ``magnetometer``; the range of the sum of the
        forces of motors of a joint.
    cutoff : float
        Values are cut at it, 0 for none.
    positive : bool
        Whether it shows no values below 0.
    """

    name: str
    kind: str
    frame: Frame = WORLD
    reference: Frame = WORLD
    members: tuple[Body, ...] = ()
    terms: tuple[tuple[Coordinate, float], ...] = ()
    motors: tuple[tuple[Motor, float], ...] = ()
    at: Integer = fields.integer(0, least=0)
    values: Value[np.ndarray, Any] = Value(_numbers, ())
    cutoff: Number = fields.number(0.0, least=0.0)
    positive: Flag = fields.flag(False)

    def of(self, solution) -> Any:
        """Return what it shows: (T, ...) of a `Solution`, at its saved times, or of ``run.state``."""
        shown = READINGS[self.kind](self, checked(solution))
        if self.cutoff > 0.0:
            shown = np.clip(shown, 0.0 if self.positive else -self.cutoff, self.cutoff)
        return shown


def moving(frame: Frame, states) -> Moving:
    """Return the motion of a frame."""
    lead = states.position.shape[:-2]
    if isinstance(frame.body, Ground):
        parts = frame.position, frame.orientation, np.zeros(3), np.zeros(3)
        return Moving(*(np.broadcast_to(one, (*lead, len(one))) for one in parts))
    b = frame.body.index
    turn, w = states.orientation[..., b, :], states.angular_velocity[..., b, :]
    arm = quaternion.rotate(turn, frame.position)
    return Moving(
        states.position[..., b, :] + arm,
        quaternion.multiply(turn, np.broadcast_to(frame.orientation, turn.shape)),
        states.velocity[..., b, :] + np.cross(w, arm),
        w,
    )


def _position(one: Sensor, states):
    here, seen = moving(one.frame, states), moving(one.reference, states)
    return quaternion.rotate_back(seen.turn, here.position - seen.position)


def _orientation(one: Sensor, states):
    here, seen = moving(one.frame, states), moving(one.reference, states)
    return quaternion.multiply(quaternion.conjugate(seen.turn), here.turn)


def _axis(k: int):
    def read(one: Sensor, states):
        return quaternion.rotate(_orientation(one, states), np.eye(3)[k])

    return read


def _velocity(one: Sensor, states):
    here, seen = moving(one.frame, states), moving(one.reference, states)
    apart = np.cross(seen.spin, here.position - seen.position)
    return quaternion.rotate_back(seen.turn, here.velocity - seen.velocity - apart)


def _spin(one: Sensor, states):
    here, seen = moving(one.frame, states), moving(one.reference, states)
    return quaternion.rotate_back(seen.turn, here.spin - seen.spin)


def _gyro(one: Sensor, states):
    here = moving(one.frame, states)
    return quaternion.rotate_back(here.turn, here.spin)


def _velocimeter(one: Sensor, states):
    here = moving(one.frame, states)
    return quaternion.rotate_back(here.turn, here.velocity)


def _magnetometer(one: Sensor, states):
    turn = moving(one.frame, states).turn
    return quaternion.rotate_back(turn, np.broadcast_to(one.values, (*turn.shape[:-1], 3)))


def _felt(one: Sensor, states):
    """Return the acceleration of a frame minus gravity: a + alpha x r + w x (w x r) - g."""
    gravity = states._scene.gravity
    if isinstance(one.frame.body, Ground):
        return np.broadcast_to(-gravity, (*states.position.shape[:-2], 3))
    b = one.frame.body.index
    w, own = states.angular_velocity[..., b, :], measured(states).accelerations[..., b, :]
    arm = quaternion.rotate(states.orientation[..., b, :], one.frame.position)
    return own[..., :3] + np.cross(own[..., 3:], arm) + np.cross(w, np.cross(w, arm)) - gravity


def _accelerometer(one: Sensor, states):
    return quaternion.rotate_back(moving(one.frame, states).turn, _felt(one, states))


def _angular(one: Sensor, states):
    if isinstance(one.frame.body, Ground):
        return np.zeros((*states.position.shape[:-2], 3))
    return measured(states).accelerations[..., one.frame.body.index, 3:]


def _coordinate(rate: bool):
    def read(one: Sensor, states):
        return sum(factor * c.of(states)[rate] for c, factor in one.terms)

    return read


def _motors(one: Sensor, states):
    total = sum((factor * motor.force(states) for motor, factor in one.motors), 0.0)
    return np.clip(total, *one.values) if len(one.values) else total


def _ball(rate: bool):
    def read(one: Sensor, states):
        robot = states._scene.robot
        q = robot.qvel(states) if rate else robot.qpos(states)
        return q[..., one.at : one.at + (3 if rate else 4)]

    return read


def _centre(one: Sensor, states, of: str = "position"):
    which, mass = _masses(one)
    return mass @ getattr(states, of)[..., which, :] / mass.sum()


def _masses(one: Sensor) -> tuple[list[int], np.ndarray]:
    return [b.index for b in one.members], np.array([b.mass for b in one.members])


def _drift(one: Sensor, states):
    return _centre(one, states, "velocity")


def _momentum(one: Sensor, states):
    centre, drift, total = _centre(one, states), _drift(one, states), 0.0
    for body in one.members:
        b = body.index
        arm, speed = states.position[..., b, :] - centre, states.velocity[..., b, :] - drift
        total = (
            total
            + body.mass * np.cross(arm, speed)
            + _turned(body, states, states.angular_velocity)
        )
    return total


def _turned(body: Body, states, vectors):
    """Return the inertia of a body times a vector, world axes."""
    turn = states.orientation[..., body.index, :]
    own = quaternion.rotate_back(turn, vectors[..., body.index, :])
    return quaternion.rotate(turn, own @ body.inertia.T)


def _interaction(one: Sensor, states) -> tuple[Any, Any]:
    """Return force and torque about the frame with which its parent acts on the bodies behind it.

    The sum of m (a - g), and of the changes of spin, less that of the forces of contacts.
    """
    at, gravity = moving(one.frame, states).position, states._scene.gravity
    force, torque, acceleration = (
        np.zeros(at.shape),
        np.zeros(at.shape),
        measured(states).accelerations,
    )
    for body in one.members:
        b, w = body.index, states.angular_velocity[..., body.index, :]
        own = body.mass * (acceleration[..., b, :3] - gravity)
        force += own
        torque += np.cross(states.position[..., b, :] - at, own)
        torque += _turned(body, states, acceleration[..., 3:])
        torque += np.cross(w, _turned(body, states, states.angular_velocity))
    for b, row, push, moment in _contacts(states):
        if any(body.index == b for body in one.members):
            force[row] -= push
            torque[row] -= np.cross(states.position[(*row, b)] - at[row], push) + moment
    turn = moving(one.frame, states).turn
    return quaternion.rotate_back(turn, force), quaternion.rotate_back(turn, torque)


class Measured(NamedTuple):
    """What sensors read beyond positions and velocities."""

    accelerations: np.ndarray  # (T, N, 6) or (N, 6)
    touch: np.ndarray  # (H,) TOUCH, of contacts and then of stops
    pairs: int  # contacts, before the stops


def measured(states) -> Measured:
    """Return the accelerations and the forces of contacts of a solution, or of the state of a run."""
    return Measured(states._accelerations, states._touch, len(states._numbers.pairs.body))


def _touches(states):
    """Yield of each touch of a contact the place of its state, and itself."""
    _, touch, pairs = measured(states)
    for one in touch[touch["contact"] < pairs]:
        yield (() if states.position.ndim == 2 else (int(one["saved"]),)), one


def _contacts(states):
    """Yield of each touch and each of its bodies: body, place of the state, force and moment."""
    for row, touch in _touches(states):
        yield int(touch["body"]), row, touch["push"], touch["moment"]
        if touch["other"] >= 0:
            yield int(touch["other"]), row, -touch["push"], touch["other_moment"]


def _touch(one: Sensor, states):
    """Return the sum of normal forces at points from which a line against the force meets the site."""
    mujoco = checks.need("mujoco", "reading a touch sensor", "models")
    total = np.zeros(states.position.shape[:-2])
    if isinstance(one.frame.body, Ground):
        return total
    here, kind, b = moving(one.frame, states), int(one.values[3]), one.frame.body.index
    for row, touch in _touches(states):
        side, force = int(touch["body"] == b) - int(touch["other"] == b), float(touch["force"][0])
        if side == 0 or force <= 0.0:
            continue
        line = -side * touch["push"] / np.linalg.norm(touch["push"])
        axes, point = quaternion.matrix(here.turn[row]).ravel(), touch["point"].astype(float)
        site = here.position[row].copy(), axes, one.values[:3].copy()
        if mujoco.mju_rayGeom(*site, point, line, kind) >= 0.0:
            total[row] += force
    return total[()]


READINGS: dict[str, Callable[[Sensor, Any], Any]] = {
    "framepos": _position, "framequat": _orientation, "framelinvel": _velocity, "frameangvel": _spin,
    "framexaxis": _axis(0), "frameyaxis": _axis(1), "framezaxis": _axis(2), "gyro": _gyro,
    "velocimeter": _velocimeter, "magnetometer": _magnetometer, "accelerometer": _accelerometer,
    "framelinacc": _felt, "frameangacc": _angular, "touch": _touch,
    "force": lambda one, states: _interaction(one, states)[0],
    "torque": lambda one, states: _interaction(one, states)[1],
    "jointpos": _coordinate(False), "jointvel": _coordinate(True), "tendonpos": _coordinate(False),
    "tendonvel": _coordinate(True), "actuatorpos": _coordinate(False), "actuatorvel": _coordinate(True),
    "actuatorfrc": _motors, "jointactuatorfrc": _motors, "ballquat": _ball(False), "ballangvel": _ball(True),
    "subtreecom": _centre, "subtreelinvel": _drift, "subtreeangmom": _momentum,
    "clock": lambda one, states: states.t, "e_kinetic": lambda one, states: states.kinetic_energy,
}  # fmt: skip
