"""Joints of a model: one for each, or for two or three together that have an equivalent.

In a model several joints of a body follow each other, each in the frame that those before it have moved. Two
hinges with perpendicular axes through one point are a `Universal` joint, a hinge and a slide along one line a
`Cylindrical`, two slides and a hinge across them a `Planar`. Between other joints stand links that are so light
that they do not count.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.io.models.build import Build
from carom.io.models.links import Link, name_of
from carom.io.models.report import need_mujoco
from carom.io.models.state import point_velocity
from carom.results.robot import Coordinate
from carom.scene import joints
from carom.scene.bodies import Body, Ground
from carom.scene.joints import JointDefinition

EXACT = 1e-12  # sine or cosine of axes, and distance by the extent of the model: rounding


class Group(NamedTuple):
    """Joints of the model that one joint of the scene represents."""

    definition: JointDefinition
    members: list[tuple[int, int, float]]  # joint of the model, which coordinate, sign
    frame: tuple[np.ndarray, np.ndarray] | None = (
        None  # in the world; None: the definition is there
    )


def join(build: Build, link: Link) -> None:
    """Add the joint of a link with its parent."""
    model, kinds = build.model, need_mujoco().mjtJoint
    first, count = int(model.body_jntadr[link.body]), int(model.body_jntnum[link.body])
    numbers = list(range(first, first + count))
    if model.jnt_type[numbers[0]] == kinds.mjJNT_FREE:
        return
    parent = build.carrier(int(model.body_parentid[link.body]))
    child = build.moving(link.body)
    while numbers:
        group = next_group(build, numbers)
        done, numbers = numbers[: len(group.members)], numbers[len(group.members) :]
        between = _light_link(build, link, done[-1], numbers) if numbers else child
        _add(build, group, parent, between)
        parent = between


def next_group(build: Build, numbers: list[int]) -> Group:
    """Return the joint of the scene for the first three, two or one of the joints of a body."""
    return _planar(build, numbers) or _two(build, numbers) or _one(build, numbers[0])


def _one(build: Build, j: int) -> Group:
    anchor, axis = build.data.xanchor[j], build.data.xaxis[j]
    kinds = need_mujoco().mjtJoint
    if build.model.jnt_type[j] == kinds.mjJNT_BALL:
        return Group(joints.Spherical(anchor, start=_turned(build, j)), [(j, 0, 1.0)])
    if build.model.jnt_type[j] == kinds.mjJNT_HINGE:
        return Group(joints.Revolute(anchor, axis), [(j, 0, 1.0)])
    anchor = build.moving(int(build.model.jnt_bodyid[j])).position
    return Group(joints.Prismatic(axis, anchor), [(j, 0, 1.0)])


def _turned(build: Build, j: int) -> np.ndarray:
    """Return the rotation of a ball joint at the start, from its `qpos`, in world axes.

    No joint that turns may follow it in its body.
    """
    first, axes = int(build.model.jnt_qposadr[j]), build.data.xquat[build.model.jnt_bodyid[j]]
    q = quaternion.normalize(build.data.qpos[first : first + 4])
    return quaternion.multiply(quaternion.multiply(axes, q), quaternion.conjugate(axes))


def _two(build: Build, numbers: list[int]) -> Group | None:
    """Return a universal joint or a sleeve, if the first two are one."""
    if len(numbers) < 2:
        return None
    (j, k), kinds = numbers[:2], need_mujoco().mjtJoint
    types = [build.model.jnt_type[n] for n in (j, k)]
    first, second = build.data.xaxis[j], build.data.xaxis[k]
    gap = build.data.xanchor[k] - build.data.xanchor[j]
    near = EXACT * build.model.stat.extent
    if types == [kinds.mjJNT_HINGE] * 2:
        if np.linalg.norm(gap) <= near and abs(first @ second) <= EXACT:
            anchor = build.data.xanchor[j]
            return Group(joints.Universal(anchor, first, second), [(j, 0, 1.0), (k, 1, 1.0)])
    elif sorted(types) == [kinds.mjJNT_SLIDE, kinds.mjJNT_HINGE]:
        turn, slide = (j, k) if types[0] == kinds.mjJNT_HINGE else (k, j)
        if np.linalg.norm(np.cross(first, second)) <= EXACT:
            sign = float(np.sign(first @ second))
            members = [(turn, 0, 1.0), (slide, 1, sign)]
            axis, anchor = build.data.xaxis[turn], build.data.xanchor[turn]
            return Group(joints.Cylindrical(anchor, axis), members)
    return None


def _planar(build: Build, numbers: list[int]) -> Group | None:
    """Return a plate on a table, if the first three are two slides and a hinge across both."""
    if len(numbers) < 3:
        return None
    kinds, (j, k, turn) = need_mujoco().mjtJoint, numbers[:3]
    types = [build.model.jnt_type[n] for n in (j, k, turn)]
    if types != [kinds.mjJNT_SLIDE, kinds.mjJNT_SLIDE, kinds.mjJNT_HINGE]:
        return None
    x, y, z = (build.data.xaxis[n] for n in (j, k, turn))
    if not max(abs(x @ y), abs(x @ z), abs(y @ z)) <= EXACT:
        return None
    across = np.cross(z, x)
    frame = quaternion.from_matrix(np.stack([x, across, z], axis=1))
    members = [(j, 0, 1.0), (k, 1, float(np.sign(y @ across))), (turn, 2, 1.0)]
    plane = joints.Planar((0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
    return Group(plane, members, (build.data.xanchor[turn].copy(), frame))


def _light_link(build: Build, link: Link, last: int, later: list[int]) -> Body:
    """Add a link between two joints of a body, with the position and motion after the joint `last`."""
    model, data = build.model, build.data
    joint = name_of(model, "joint", last)
    first, count = int(model.body_dofadr[link.body]), int(model.body_dofnum[link.body])
    armature = float(np.max(model.dof_armature[first : first + count]))
    body = build.moving(link.body).position
    slides = model.jnt_type[last] == need_mujoco().mjtJoint.mjJNT_SLIDE
    centre = body if slides else data.xanchor[last]
    arm2 = float(np.sum((body - centre) ** 2))
    moment = np.trace(link.inertia) / 3.0 + link.mass * arm2 + armature
    dofs = [d for d in range(model.nv) if model.dof_jntid[d] in later]
    motion = point_velocity(model, data, link.body, centre, without=dofs)
    build.report.add(
        f"joint {joint!r}",
        "is followed by another joint in the same body, and a scene has no massless bodies",
        f"a link of {build.light:g} of the body's mass and inertia is between the two",
    )
    turned = data.xquat[link.body]
    return build.light_link(joint, link.mass + armature, moment, centre, motion, turned)


def _add(build: Build, group: Group, parent: Body | Ground, child) -> None:
    """Add the joint of a group, and keep its coordinates."""
    names = [name_of(build.model, "joint", j) for j, _, _ in group.members]
    frames: Any = {}
    if group.frame is not None:
        frames = {
            "parent_frame": in_body(parent, *group.frame),
            "child_frame": in_body(child, *group.frame),
        }
    name = build.names.new("+".join(names), "joint")
    joint = build.scene.add_joint(group.definition, parent, child, **frames, name=name)
    for j, index, sign in group.members:
        if isinstance(group.definition, joints.Spherical):
            build.balls[j] = joint
        else:
            places = int(build.model.jnt_qposadr[j]), int(build.model.jnt_dofadr[j])
            start, row = float(build.data.qpos[places[0]]), len(build.coordinates)
            name = name_of(build.model, "joint", j)
            build.coordinates[j] = Coordinate(name, joint, index, sign, start, row, *places)


def in_body(body: Body | Ground, position, orientation) -> tuple[np.ndarray, np.ndarray]:
    """Return a frame of the world in the axes of a body, from its mass centre."""
    if isinstance(body, Ground):
        return position, orientation
    return (
        quaternion.rotate_back(body.orientation, position - body.position),
        quaternion.multiply(quaternion.conjugate(body.orientation), orientation),
    )
