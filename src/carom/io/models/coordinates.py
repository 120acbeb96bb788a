"""Parts that act along joint coordinates: springs, dampers, dry friction, limits, inertia of motors."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, cast

import numpy as np

from carom.geometry import quaternion
from carom.io.models.build import Build
from carom.io.models.links import Link, called, name_of
from carom.io.models.report import need_mujoco
from carom.results.robot import Coordinate
from carom.scene import constraints, forces
from carom.scene.bodies import GROUND
from carom.scene.joints import Joint

RELAXED = 1e-9  # angle, or distance by the extent of the model, within which a mount starts relaxed
#: rate [1/s] at which a damper ends the motion of the whole model along its joint, above which the joint is
#: held: steps that resolve it are below a microsecond, and forces of the model's weight do not move it
HELD = 1e7


def add_coordinate_parts(build: Build, restitution: float, impact_law: str, armature: bool) -> None:
    """Add the parts that act along each hinge and slide."""
    for j, coordinate in build.coordinates.items():
        if _held(build, j, coordinate):
            continue
        _spring(build, j, coordinate)
        _friction(build, j, coordinate)
        _stops(build, j, coordinate, restitution, impact_law)
        _armature(build, j, coordinate, armature)


def _held(build: Build, j: int, c: Coordinate) -> bool:
    """Hold a joint at its start if its damper lets nothing move it, as models fix a base; return whether so."""
    model, damping = build.model, float(build.model.dof_damping[build.model.jnt_dofadr[j]])
    slides = model.jnt_type[j] == need_mujoco().mjtJoint.mjJNT_SLIDE
    rate = damping / (float(model.body_mass.sum()) * (1.0 if slides else model.stat.extent**2))
    if rate <= HELD or model.jnt_stiffness[j] > 0.0:  # a spring moves it, however slowly
        return False
    name = build.names.new(f"{name_of(model, 'joint', j)}:held", "constraint")
    build.scene.add_constraint(constraints.Driver(c.joint, 0.0, coordinate=c.index), name=name)
    build.report.add(
        called(model, "joint", j),
        f"a damping of {damping:g}, which ends its motion within {1.0 / rate:.1g} s",
        "it is held where it starts",
    )
    return True


def _spring(build: Build, j: int, c: Coordinate) -> None:
    model, dof = build.model, build.model.jnt_dofadr[j]
    stiffness, damping = float(model.jnt_stiffness[j]), float(model.dof_damping[dof])
    if stiffness == 0.0 and damping == 0.0:
        return
    rest = c.sign * (float(model.qpos_spring[model.jnt_qposadr[j]]) - c.start)
    spring = forces.JointSpring(
        c.joint, max(stiffness, 0.0), damping, rest if stiffness else 0.0, c.index
    )
    if stiffness < 0.0:
        build.report.add(
            called(model, "joint", j), f"stiffness {stiffness:g} is below 0", "left out"
        )
    name = name_of(model, "joint", j)
    build.scene.add_force(spring, name=build.names.new(f"{name}:spring", "force"))


def _friction(build: Build, j: int, c: Coordinate) -> None:
    bound = float(build.model.dof_frictionloss[build.model.jnt_dofadr[j]])
    if bound > 0.0:
        name = build.names.new(f"{name_of(build.model, 'joint', j)}:friction", "force")
        build.scene.add_force(forces.JointFriction(c.joint, bound, c.index), name=name)


def _stops(build: Build, j: int, c: Coordinate, restitution: float, law: str) -> None:
    """Add both limits of a joint."""
    if build.model.jnt_limited[j]:
        name, what = name_of(build.model, "joint", j), called(build.model, "joint", j)
        add_stops(build, c, name, what, build.model.jnt_range[j], restitution, law)


class Limited(NamedTuple):
    """What limits act on, ``start + sign * coordinate of the scene``: a `Coordinate`, or a sum."""

    joint: Any
    start: float
    now: float  #: value of the sum at the start
    index: int = 0
    sign: float = 1.0


def add_stops(
    build: Build, c: Coordinate | Limited, name: str, what: str, ends, restitution: float, law: str
) -> None:
    """Add both limits of a coordinate; a limit that the start exceeds is moved to the start."""
    ends, now = ends - c.start, c.now if isinstance(c, Limited) else 0.0
    for end, side, word in ((float(ends[0]), 1.0, "lower"), (float(ends[1]), -1.0, "upper")):
        if math.isinf(end):
            continue
        if side * (end - now) > 0.0:
            build.report.add(
                what,
                f"starts beyond its {word} limit, by {side * (end - now):.3g}",
                "the limit is moved to the start",
            )
            end = now
        which = "lower" if side * c.sign > 0.0 else "upper"
        limit: Any = {which: c.sign * end}
        stop = build.scene.add_stop(
            c.joint,
            **limit,
            restitution=restitution,
            impact_law=law,
            coordinate=c.index,
            name=build.names.new(f"{name}:{word}", "stop"),
        )
        build.scene._in_radians.add(stop.name)


def _armature(build: Build, j: int, c: Coordinate, represent: bool) -> None:
    """Add the inertia of a rotor, a q'^2/2."""
    inertia = float(build.model.dof_armature[build.model.jnt_dofadr[j]])
    if inertia == 0.0:
        return
    name, what = name_of(build.model, "joint", j), called(build.model, "joint", j)
    if not represent:
        build.report.add(what, f"armature {inertia:g}", "left out because of armature=False")
        return
    rotor = forces.JointInertia(c.joint, inertia, c.index)
    build.scene.add_force(rotor, name=build.names.new(f"{name}:armature", "force"))


def add_mounts(build: Build, links: list[Link], restitution: float, impact_law: str) -> None:
    """Add springs, dampers and limits of ball and free joints, and report what else such joints have."""
    kinds = need_mujoco().mjtJoint
    for link in links:
        j = int(build.model.body_jntadr[link.body])
        if build.model.jnt_type[j] == kinds.mjJNT_FREE:
            _mount(build, j, link, GROUND, build.bodies[link.body], moves=True)
    for j, joint in build.balls.items():
        link = next(one for one in links if one.body == build.model.jnt_bodyid[j])
        _mount(build, j, link, joint.parent, joint.child, moves=False)
        if build.model.jnt_limited[j]:
            _limit(build, j, joint, restitution, impact_law)


def _mount(build: Build, j: int, link: Link, parent, child, moves: bool) -> None:
    model, data = build.model, build.data
    name, what = name_of(build.model, "joint", j), called(build.model, "joint", j)
    dof, first = int(model.jnt_dofadr[j]), int(model.jnt_qposadr[j])
    stiffness, damping = float(model.jnt_stiffness[j]), float(model.dof_damping[dof])
    turn = first + 3 if moves else first
    apart = np.linalg.norm(
        quaternion.between(model.qpos_spring[turn : turn + 4], data.qpos[turn : turn + 4])
    )
    if moves:
        shift = model.qpos_spring[first : first + 3] - data.qpos[first : first + 3]
        apart = max(apart, np.linalg.norm(shift) / model.stat.extent)
    if stiffness > 0.0 and apart > RELAXED:
        build.report.add(what, "its spring is not relaxed at the start", "without this spring")
        stiffness = 0.0
    if stiffness > 0.0 or damping > 0.0:
        k, d = (stiffness, stiffness), (damping, damping)
        none = (0.0, 0.0)
        anchor = data.xpos[link.body] if moves else data.xanchor[j]
        mount = forces.Bushing(k if moves else none, k, d if moves else none, d, anchor=anchor)
        build.scene.add_force(mount, parent, child, name=build.names.new(f"{name}:spring", "force"))
    dofs = slice(dof, dof + (6 if moves else 3))
    if np.any(model.dof_armature[dofs]):
        build.report.add(what, "armature of a joint with several freedoms", "left out")
    if np.any(model.dof_frictionloss[dofs]):
        build.report.add(what, "dry friction of a joint with several freedoms", "left out")


def _limit(build: Build, j: int, joint: Joint, restitution: float, impact_law: str) -> None:
    """Add the limit of a ball joint, the greatest angle of its rotation; one of pi or more limits nothing."""
    name, what = name_of(build.model, "joint", j), called(build.model, "joint", j)
    end, definition = float(np.max(build.model.jnt_range[j])), cast(Any, joint.definition)
    angle = float(np.linalg.norm(quaternion.log(definition.start)))
    if angle > end > 0.0:
        past = f"starts beyond its upper limit, by {angle - end:.3g}"
        build.report.add(what, past, "the limit is moved to the start")
        end = angle
    if not end > 0.0:
        build.report.add(what, f"limit {end:g} rad of a ball joint", "left out")
    elif end < math.pi:
        name = build.names.new(f"{name}:upper", "stop")
        build.scene.add_stop(
            joint,
            upper=end,
            coordinate="rotation",
            restitution=restitution,
            impact_law=impact_law,
            name=name,
        )
