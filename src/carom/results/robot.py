"""A model in its own coordinates: its `qpos`, `qvel`, controls and sensors, in the order of MuJoCo.

A scene that `load_model` has made has a `Robot`, which is stored with it. A hinge or a slide has the coordinate
``q = start + sign * coordinate of the scene``; a ball joint has the quaternion of its child relative to its
parent, and the angular velocity in axes of the child; a free joint has position and quaternion of the axes of
its body, the velocity of their origin in world axes, and the angular velocity in axes of the body.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, is_dataclass
from functools import cached_property
from typing import Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Integer, Number, Value, Vector, keep
from carom.geometry import quaternion
from carom.results.forward_kinematics import Motion, put_ball, put_child, relative, sides_of
from carom.scene.actuators import Controlled
from carom.scene.bodies import Body, Ground
from carom.scene.coordinates import counted, terms_of
from carom.scene.forces import AppliedForce
from carom.scene.joints import Joint


def _array(name: str, value) -> np.ndarray:
    return checks.finite_array(name, value, (None,))


@arguments.known
@dataclass(frozen=True, eq=False)
class Coordinate:
    """A coordinate of a hinge or a slide of the model: ``q = start + sign * coordinate of the scene``.

    Attributes
    ----------
    name : str
        Name of the joint in the model.
    joint : Joint
        Joint of the scene.
    index : int
        Index of the coordinate of this joint.
    sign : float
        1 or -1.
    start : float
        q at the start [rad or m].
    row : int
        Its number among the coordinates of the model; -1 of one that no model has.
    position, velocity : int
        Its places in `qpos` and in `qvel`.
    """

    name: str
    joint: Joint
    index: Integer = fields.integer(least=0)
    sign: Number = fields.number()
    start: Number = fields.number()
    row: Integer = fields.integer(least=-1)
    position: Integer = fields.integer(least=0)
    velocity: Integer = fields.integer(least=0)

    def of(self, solution) -> tuple[Any, Any]:
        """Return q and its rate, as the model defines them.

        Parameters
        ----------
        solution : Solution or SystemState
            For a solution, also one from a file, q and rate are arrays (T,); for the state of a run they are
            numbers. Whole turns are those that the run has counted.
        """
        states = checked(solution)
        q, rate = states.joint_coordinates(self.joint.name)
        q, rate = q[..., self.index], rate[..., self.index]
        return self.start + self.sign * q, self.sign * rate


@dataclass(frozen=True, eq=False)
class Ball:
    """A ball joint of the model, with the places of its first numbers in `qpos` and in `qvel`."""

    name: str
    joint: Joint
    position: Integer = fields.integer(least=0)
    velocity: Integer = fields.integer(least=0)


@dataclass(frozen=True, eq=False)
class FreeBody:
    """A body with a free joint: its mass centre in the axes of the model, and its places as of a `Ball`."""

    name: str
    body: Body
    centre: Vector = fields.vector()
    position: Integer = fields.integer(least=0)
    velocity: Integer = fields.integer(least=0)


@dataclass(frozen=True, eq=False)
class Motor:
    """An actuator of a model.

    Attributes
    ----------
    name : str
    parts : tuple of AppliedForce
        The force of the scene, a `forces.Actuator`; none of an actuator that the scene does not represent.
    terms : tuple of (Coordinate, float)
        Coordinates and their factors in the length, ``sum of factor q``; none of one along a path.
    force_range : (2,) or None
        Its own, without that of its joint.
    start : float
        Of one along a path: its length where the coordinate of its force is 0 [m].
    """

    name: str
    parts: tuple[AppliedForce, ...]
    terms: tuple[tuple[Coordinate, float], ...]
    force_range: Value[np.ndarray | None, Any] = Value(_array, None)
    start: Number = fields.number(0.0)

    def length(self, solution) -> tuple[Any, Any]:
        """Return the length and its rate, as of `Coordinate.of`."""
        states = checked(solution)
        if not self.terms and self.parts:
            gear, along = _actuator(self).gear, states.force(self.parts[0].name)
            return self.start + gear * along.coordinate, gear * along.rate
        if not self.terms:
            return 0.0, 0.0
        pairs = [one.of(states) for one, _ in self.terms]
        factors = [factor for _, factor in self.terms]
        length, rate = (sum(f * x for f, x in zip(factors, column)) for column in zip(*pairs))
        return length, rate

    def control(self, solution) -> Any:
        """Return the control, which is not clipped, as of `Coordinate.of`."""
        states = checked(solution)
        names = [one.name for one in commands(states._scene)]
        return controls(states)[..., names.index(self.name)]

    def force(self, solution) -> Any:
        """Return the force of the actuator [N] or [N m], before its gear, as of `Coordinate.of`."""
        states = checked(solution)
        control = self.control(states)
        if not self.parts:
            return 0.0 * control
        d, (length, rate) = _actuator(self), self.length(states)
        length -= self.start + sum(factor * one.start for one, factor in self.terms)
        if d.control_range is not None:
            control = np.clip(control, *d.control_range)
        force = d.affine(control, length, rate)
        return force if self.force_range is None else np.clip(force, *self.force_range)


def checked(solution):
    """Return a solution, or the state of a run."""
    from carom.results.solution import Solution
    from carom.results.state import SystemState

    hint = "; of a run give run.state or run.solution"
    checks.instance("solution", solution, (Solution, SystemState), hint)
    return solution


def _actuator(motor: Motor) -> Controlled:
    d = motor.parts[0].definition
    assert isinstance(d, Controlled)
    return d


def commands(scene) -> list[Motor]:
    """Return the actuators of a scene: those of its model, then others."""
    own = [] if scene.robot is None else list(scene.robot.motors)
    known = {part.index for one in own for part in one.parts}
    for force in scene.forces:
        d = force.definition
        if isinstance(d, Controlled) and force.index not in known:
            terms = tuple(
                (Coordinate(force.name, joint, int(k), 1.0, 0.0, -1, 0, 0), factor * d.gear)
                for joint, k, factor in terms_of(d.joint, d.coordinate)
                if isinstance(joint, Joint)
            )
            own.append(Motor(force.name, (force,), terms, d.force_range))
    return own


def first_controls(motors: list[Motor]) -> np.ndarray:
    """Return the controls (nu,) that actuators have until they are set."""
    return np.array([_actuator(one).control if one.parts else 0.0 for one in motors])


def columns(motors: list[Motor]) -> dict[int, int]:
    """Return the place of each actuator among the controls by the index of its force."""
    return {part.index: k for k, one in enumerate(motors) for part in one.parts}


def controls(states) -> np.ndarray:
    """Return the controls (nu,) of a state, or (T, nu) of a solution: those that acted until each time."""
    motors = commands(states._scene)
    first, place = first_controls(motors), columns(motors)
    if np.ndim(states.t) == 0:
        for index in place.keys() & states._given.keys():
            first[place[index]] = states._given[index]
        return first
    u = np.full((len(states.t), len(motors)), np.nan)
    u[0] = first
    for row, index, value in getattr(states._run, "history", None) or ():
        if row < len(u) and index in place:
            u[row, place[index]] = value
    since = np.maximum.accumulate(np.where(np.isnan(u), 0, np.arange(len(u))[:, None]), axis=0)
    return np.take_along_axis(u, since, axis=0)


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A named state of a model.

    Attributes
    ----------
    name : str
    qpos : (nq,)
    qvel : (nv,)
    ctrl : (nu,)
    """

    name: str
    qpos: Value[np.ndarray, Any] = Value(_array)
    qvel: Value[np.ndarray, Any] = Value(_array)
    ctrl: Value[np.ndarray, Any] = Value(_array)


@dataclass(frozen=True, eq=False, repr=False)
class Robot:
    """A model in its own coordinates, which its scene has as `Scene.robot`.

    Its methods take a solution, also one from a file, and give arrays with time first; or ``run.state``, and
    give the values at that time.

    Attributes
    ----------
    start : (nq,)
        `qpos` at the start.
    coordinates : tuple of Coordinate
    balls, frees : tuples
        Ball joints and bodies with free joints.
    keys : tuple of Keyframe
    motors : tuple of Motor
    readings : tuple of Sensor
    lines : tuple
        Slides of the scene by the lengths of tendons, each with its coordinates and their factors.
    """

    start: Value[np.ndarray, Any] = Value(_array)
    coordinates: tuple[Coordinate, ...] = ()
    balls: tuple[Ball, ...] = ()
    frees: tuple[FreeBody, ...] = ()
    keys: tuple[Keyframe, ...] = ()
    motors: tuple[Motor, ...] = ()
    readings: tuple[Any, ...] = ()
    lines: tuple[tuple[Joint, tuple[tuple[Coordinate, float], ...]], ...] = ()

    def __post_init__(self):
        places = [(one, 1, 1) for one in self.coordinates] + [(one, 4, 3) for one in self.balls]
        for one, wide, quick in (*places, *((one, 7, 6) for one in self.frees)):
            if one.position + wide > len(self.start) or one.velocity + quick > self.nv:
                raise ValueError(
                    f"the place of {one.name!r} must be one in qpos and qvel, got {one.position}"
                )

    @cached_property
    def joints(self) -> Mapping[str, Coordinate]:
        """Hinges and slides by name."""
        return Named("hinge or slide", {one.name: one for one in self.coordinates})

    @cached_property
    def keyframes(self) -> Mapping[str, Keyframe]:
        """Keyframes by name."""
        return Named("keyframe", {one.name: one for one in self.keys})

    @cached_property
    def actuators(self) -> Mapping[str, Motor]:
        """Actuators by name."""
        return Named("actuator", {one.name: one for one in self.motors})

    @cached_property
    def sensors(self) -> Mapping[str, Any]:
        """Sensors by name."""
        return Named("sensor", {one.name: one for one in self.readings})

    def ctrl(self, solution) -> np.ndarray:
        """Return the controls (T, nu) or (nu,), as MuJoCo's ``data.ctrl``; (T, nu): of the step before."""
        return controls(self._checked(solution))

    @property
    def nv(self) -> int:
        """Number of velocities."""
        return len(self.coordinates) + 3 * len(self.balls) + 6 * len(self.frees)

    def qpos(self, solution) -> np.ndarray:
        """Return the coordinates (T, nq) or (nq,) of a solution or state, as MuJoCo's ``data.qpos``."""
        states = self._checked(solution)
        q = np.empty((*states.position.shape[:-2], len(self.start)))
        q[...] = self.start
        for one in self.coordinates:
            q[..., one.position] = one.of(states)[0]
        for one in self.balls:
            turned = relative(one.joint, states)
            q[..., one.position : one.position + 4] = quaternion.multiply(
                np.broadcast_to(self._ball_start(one), turned.shape), turned
            )
        for one in self.frees:
            turn = states.orientation[..., one.body.index, :]
            origin = states.position[..., one.body.index, :] - quaternion.rotate(turn, one.centre)
            q[..., one.position : one.position + 3] = origin
            q[..., one.position + 3 : one.position + 7] = turn
        return q

    def qvel(self, solution) -> np.ndarray:
        """Return the velocities (T, nv) or (nv,) of a solution or state, as MuJoCo's ``data.qvel``."""
        states = self._checked(solution)
        rates = np.empty((*states.position.shape[:-2], self.nv))
        for one in self.coordinates:
            rates[..., one.velocity] = one.of(states)[1]
        spin = states.angular_velocity
        for one in self.balls:
            child, parent = one.joint.child, one.joint.parent
            relative = spin[..., child.index, :]
            if isinstance(parent, Body):
                relative = relative - spin[..., parent.index, :]
            own = quaternion.rotate_back(states.orientation[..., child.index, :], relative)
            rates[..., one.velocity : one.velocity + 3] = own
        for one in self.frees:
            turn, w = (part[..., one.body.index, :] for part in (states.orientation, spin))
            arm, first = quaternion.rotate(turn, one.centre), one.velocity
            rates[..., first : first + 3] = states.velocity[..., one.body.index, :] - np.cross(
                w, arm
            )
            rates[..., first + 3 : first + 6] = quaternion.rotate_back(turn, w)
        return rates

    @property
    def _parts_by_name(self) -> list[tuple[str, int]]:
        """Names and indices of the joints and bodies that coordinates move."""
        parts = [one.joint for one in (*self.coordinates, *self.balls)]
        return [(part.name, part.index) for part in (*parts, *(one.body for one in self.frees))]

    def _ball_start(self, one: Ball) -> np.ndarray:
        return self.start[one.position : one.position + 4]

    def _followed(self, find) -> Robot | None:
        """Return the model of a scene whose parts may have been replaced; None if one has been removed."""
        try:
            return _followed(self, find)
        except LookupError:
            return None

    def _checked(self, solution):
        """Return states of a scene with the joints and bodies of this model."""
        other = checked(solution)._scene.robot
        if other is not self and (other is None or other._parts_by_name != self._parts_by_name):
            raise ValueError(f"solution must be of the scene of this model, got {solution!r}")
        return solution

    def _placed(self, base, qpos, qvel) -> Motion:
        """Return the motion of all bodies for coordinates of the model, None for those of the state `base`.

        Bodies that are not moved by coordinates of the model stay as in `base`.

        Raises
        ------
        ValueError
            If an array has a wrong length, or a quaternion is 0.
        """
        q = (
            self.qpos(base)
            if qpos is None
            else checks.finite_array("qpos", qpos, (len(self.start),))
        )
        v = self.qvel(base) if qvel is None else checks.finite_array("qvel", qvel, (self.nv,))
        moved = Motion(
            base.position.copy(), base.orientation.copy(), base.velocity.copy(),
            base.angular_velocity.copy(), None if base.turns is None else base.turns.copy(),
        )  # fmt: skip
        x, Q, speed, spin, turns = moved
        for one in self.frees:
            b, first = one.body.index, one.position
            Q[b] = _unit(one, q[first + 3 : first + 7])
            arm = quaternion.rotate(Q[b], one.centre)
            spin[b] = quaternion.rotate(Q[b], v[one.velocity + 3 : one.velocity + 6])
            x[b] = q[first : first + 3] + arm
            speed[b] = v[one.velocity : one.velocity + 3] + np.cross(spin[b], arm)
        columns = {} if turns is None else counted(base._scene.joints)
        by_joint: dict[int, list[Coordinate]] = {}
        for one in self.coordinates:
            by_joint.setdefault(one.joint.index, []).append(one)
            if turns is not None and (one.joint.index, one.index) in columns:
                turns[columns[one.joint.index, one.index]] = one.sign * (
                    q[one.position] - one.start
                )
        links: dict[int, Any] = {k: (some[0].joint, some) for k, some in by_joint.items()}
        links |= {one.joint.index: (one.joint, one) for one in self.balls}
        for _, (joint, of) in sorted(links.items()):  # parents before children, as they were added
            if isinstance(of, Ball):
                turned = _unit(of, q[of.position : of.position + 4])
                turned = quaternion.multiply(quaternion.conjugate(self._ball_start(of)), turned)
                rates = v[of.velocity : of.velocity + 3]
                put_ball(joint, turned, rates, moved)
            else:
                own = np.zeros((2, len(joint.definition.coordinates)))
                for one in of:
                    own[:, one.index] = (
                        one.sign * (q[one.position] - one.start),
                        one.sign * v[one.velocity],
                    )
                put_child(sides_of(joint), own[0], own[1], moved)
        for joint, terms in self.lines:
            length = sum(factor * (q[one.position] - one.start) for one, factor in terms)
            rate = sum(factor * v[one.velocity] for one, factor in terms)
            put_child(sides_of(joint), np.array([length]), np.array([rate]), moved)
        return moved

    def __repr__(self) -> str:
        return f"<Robot: {len(self.start)} coordinates>"


def _followed(value, find) -> Any:
    """Return a value that refers to the parts that `find` gives for the names of its own."""
    if isinstance(value, (Body, Joint, AppliedForce)):
        part = find(value.name)
        if not isinstance(part, type(value)):
            raise LookupError(value.name)
        return part
    if isinstance(value, tuple):
        new = tuple(_followed(one, find) for one in value)
        return value if all(a is b for a, b in zip(new, value)) else new
    if not is_dataclass(value) or isinstance(value, (Ground, type)):
        return value
    old = {one.name: getattr(value, one.name) for one in dataclasses.fields(value)}
    new = {name: _followed(one, find) for name, one in old.items()}
    if all(new[name] is old[name] for name in old):
        return value
    made = object.__new__(type(value))
    keep(made, **new)
    return made


class Named(dict):
    """Things by name; the message about another name lists them."""

    def __init__(self, kind: str, things: Mapping[str, Any]):
        super().__init__(things)
        self.kind = kind

    def __missing__(self, name):
        known = ", ".join(map(repr, self)) or "none"
        near = checks.nearest(str(name), self)
        raise KeyError(f"the model has no {self.kind} {name!r}; it has {known}{near}")


def _unit(one, q: np.ndarray) -> np.ndarray:
    """Return a quaternion of `qpos`, normalised as MuJoCo does."""
    length = math.sqrt(float(q @ q))
    if not length > 0.0:
        raise ValueError(f"qpos must have a quaternion of {one.name!r}, got 0")
    return q / length
