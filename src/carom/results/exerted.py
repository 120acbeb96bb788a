"""What each force of a scene exerts on the bodies, from their states: for reports.

The step loop adds the forces up and keeps none of them by itself. These are the same laws, for many times at
once, with vectors as tuples of components as in `carom.results.joint_coordinates`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from carom.geometry import differential, quaternion
from carom.geometry.frames import triad
from carom.results import joint_coordinates as jc
from carom.scene.bodies import Body
from carom.scene.constraints import coordinate_kind
from carom.scene.forces import AppliedForce, Bushing, Force, Spring, Torque
from carom.scene.more_forces import (
    Actuator,
    AlongJoint,
    CurveSpring,
    JointFriction,
    JointInertia,
    JointSpring,
    UserForce,
)

#: columns of what is exerted, by a row for each force and body: force and torque on the body, world axes; value
#: along a coordinate or a line; power
COLUMNS_EACH = 8


class Row(NamedTuple):
    """A force, and a body on which it acts."""

    force: AppliedForce
    body: Body


def rows_of(scene) -> list[Row]:
    """Return the R rows of what is exerted: a force acts on its child, that of a user on each of its bodies."""
    rows = []
    for force in scene.forces:
        several = isinstance(force.definition, UserForce)
        bodies = force.definition.bodies if several else (force.child,)
        rows += [Row(force, body) for body in bodies]
    return rows


def unit_of(force: AppliedForce) -> str:
    """Return the unit of the value of a force, "" if it has none."""
    d = force.definition
    if isinstance(d, AlongJoint):
        return "N m" if coordinate_kind(d.joint, d.coordinate) == "turn" else "N"
    return "N" if isinstance(d, (Spring, CurveSpring)) else ""


def exerted(scene, states, t, given: Mapping[int, Any]) -> np.ndarray:
    """Return (T, R, 8) at times t (T,), in the order of `rows_of`.

    Parameters
    ----------
    scene : Scene
    states : position, orientation, velocity and angular velocity, (T, N, ...)
    t : (T,)
    given : values of forces that were set during the run, by index: (T, ...)
    """
    parts = [exerted_by(force, states, t, given.get(force.index)) for force in scene.forces]
    return np.concatenate([np.zeros((len(t), 0, COLUMNS_EACH)), *parts], axis=1)


def exerted_by(force: AppliedForce, states, t, value=None) -> np.ndarray:
    """Return the rows of one force, (T, n, 8) or (n, 8) at one time; `value` is the one that was set."""
    d = force.definition
    if isinstance(d, UserForce):
        return _of_user(d, states, t)
    if isinstance(d, JointInertia):  # it follows from accelerations, which nobody keeps
        row = _columns(t, (math.nan,) * 3, (math.nan,) * 3, math.nan, math.nan)
    elif isinstance(d, AlongJoint):
        row = _along(d, states, t, value)
    else:
        row = LAWS[type(d)](force, states, t, value)
    return row[..., None, :]


def _columns(t, force, torque, value, power) -> np.ndarray:
    parts = (*force, *torque, value, power)
    if np.ndim(t) == 0:
        return np.array(parts, dtype=float)
    return np.stack([np.broadcast_to(part, np.shape(t)) for part in parts], axis=-1).astype(float)


def sides(force: AppliedForce, states, parent=None, child=None) -> tuple[jc.Placed, jc.Placed]:
    """Return parent and child, with arms to points in the world at the start; None is the mass centre."""
    made = []
    for body, point in ((force.parent, parent), (force.child, child)):
        centre = body.position if isinstance(body, Body) else np.zeros(3)
        made.append(jc.placed(jc.side_of(body, None, centre if point is None else point), states))
    return made[0], made[1]


def speed(place: jc.Placed, arm):
    """Return the velocity of a point of a body at an arm from its mass centre."""
    return jc.add(place.velocity, jc.cross(place.spin, arm))


def line(force: AppliedForce, states):
    """Return the length of a spring, its rate, and the direction (a tuple) from the parent to the child."""
    d: Any = force.definition
    p, c = sides(force, states, d.anchor_parent, d.anchor_child)
    gap = jc.subtract(jc.add(c.position, c.arm), jc.add(p.position, p.arm))
    length = np.sqrt(jc.dot(gap, gap))
    with np.errstate(invalid="ignore", divide="ignore"):
        along = tuple(np.where(length > 0.0, part / length, 0.0) for part in gap)
    return length, jc.dot(along, jc.subtract(speed(c, c.arm), speed(p, p.arm))), along


def _spring(force, states, t, value):
    d = force.definition
    length, rate, along = line(force, states)
    linear = isinstance(d, Spring)
    tension = d.stiffness * (length - d.rest_length) if linear else d.tension(length)
    tension = tension + d.damping * rate
    pull = tuple(-tension * part for part in along)
    return _columns(t, pull, (0.0,) * 3, tension, -tension * rate)


def _vector(d: Force | Torque, child: jc.Placed, value):
    """Return the vector of a load in the world: constant, or turned with the child."""
    vector = tuple(np.moveaxis(d.vector if value is None else np.asarray(value), -1, 0))
    return jc.rotate(child.turn, vector) if d.follow else vector


def _force(force, states, t, value):
    _, c = sides(force, states, child=force.definition.anchor)
    push = _vector(force.definition, c, value)
    return _columns(t, push, (0.0,) * 3, math.nan, jc.dot(push, speed(c, c.arm)))


def _torque(force, states, t, value):
    p, c = sides(force, states)
    torque = _vector(force.definition, c, value)
    power = jc.dot(torque, jc.subtract(c.spin, p.spin))
    return _columns(t, (0.0,) * 3, torque, math.nan, power)


def _bushing(force, states, t, value):
    """See `carom.dynamics.bushing` for the equations: T(theta)^-1 is J(theta)^-T."""
    d = force.definition
    point = force.child.position if d.anchor is None else d.anchor
    p, c = sides(force, states, point, point)
    axes = tuple(quaternion.from_matrix(triad(d.axis)).tolist())  # of the mount, at the start
    frame = jc.multiply(p.turn, axes)
    gap = jc.subtract(jc.add(c.position, c.arm), jc.add(p.position, p.arm))
    arm = jc.subtract(
        jc.add(c.position, c.arm), p.position
    )  # both forces act at the child's anchor
    slip = jc.subtract(speed(c, c.arm), speed(p, arm))
    spin = jc.subtract(c.spin, p.spin)
    turned = jc.multiply(jc.conjugate(frame), jc.multiply(c.turn, axes))
    theta = quaternion.log(np.stack(np.broadcast_arrays(*turned), axis=-1))
    moment = differential.apply_inverse(theta, d.turn_stiffness * theta)
    own = [jc.rotate(jc.conjugate(frame), vector) for vector in (gap, slip, spin)]
    push = [-d.stiffness[k] * own[0][k] - d.damping[k] * own[1][k] for k in range(3)]
    twist = [-moment[..., k] - d.turn_damping[k] * own[2][k] for k in range(3)]
    push, twist = jc.rotate(frame, tuple(push)), jc.rotate(frame, tuple(twist))
    return _columns(t, push, twist, math.nan, jc.dot(push, slip) + jc.dot(twist, spin))


def _along(d, states, t, value):
    """Return what acts along a coordinate of a joint, on the child at its anchor."""
    joint = jc.sides_of(d.joint)
    q, rate = (a[..., d.coordinate] for a in states.joint_coordinates(d.joint))
    if isinstance(d, JointFriction):
        value = math.nan if value is None else value
    elif isinstance(d, JointSpring):
        value = -d.stiffness * (q - d.rest) - d.damping * rate
    elif isinstance(d, Actuator):
        value = d.force_at(d.control if value is None else value, q, rate)
    elif value is None and callable(d.force):
        from carom._compiled.user_functions import from_python
        from carom.model.more_forces import of_coordinate

        force = from_python(of_coordinate(d.force), (2,), (1,))
        given = zip(*(np.atleast_1d(a).tolist() for a in (t, q, rate)))
        called = [force(time, np.array(both)) for time, *both in given]
        value = np.reshape(np.array(called, dtype=float), np.shape(t))
    elif value is None:
        value = d.force
    axis, none = jc.direction(joint, states, d.coordinate), (0.0,) * 3
    wrench = tuple(value * part for part in axis)
    turns = coordinate_kind(d.joint, d.coordinate) == "turn"
    pair = (none, wrench) if turns else (wrench, none)
    return _columns(t, *pair, value, value * rate)


def _of_user(d: UserForce, states, t) -> np.ndarray:
    """Return the rows of a user's force, one for each of its bodies."""
    index = [body.index for body in d.bodies]
    names = "position", "orientation", "velocity", "angular_velocity"
    read = np.concatenate([getattr(states, name)[..., index, :] for name in names], axis=-1)
    times, many = np.atleast_1d(t).tolist(), np.reshape(read, (-1, *read.shape[-2:]))
    from carom._compiled.user_functions import from_python

    function = from_python(d.function, (len(index), 13), (len(index), 6))
    out = [function(time, one.copy()) for time, one in zip(times, many)]
    wrench = np.reshape(np.array(out, dtype=float), (*read.shape[:-1], 6))
    power = np.sum(wrench * read[..., 7:], axis=-1)
    none = np.full((*power.shape, 1), math.nan)
    return np.concatenate([wrench, none, power[..., None]], axis=-1)


LAWS = {
    Spring: _spring, CurveSpring: _spring, Force: _force, Torque: _torque, Bushing: _bushing,
}  # fmt: skip
