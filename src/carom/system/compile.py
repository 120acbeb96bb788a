"""Turn a scene into flat arrays, once, before a run."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.options import Options
from carom.scene import joints as definitions
from carom.scene.forces import Bushing, Force, Spring, Torque
from carom.scene.joints import Distance, KnifeEdge, Universal
from carom.scene.scene import Scene
from carom.system import arrays, graph, solvers
from carom.system.arrays import BODY, BUSHING, JOINT, LOAD, SPRING, STATE, System, table
from carom.system.contacts import compile_contacts
from carom.system.frames import triad

KIND = {
    definitions.Spherical: arrays.SPHERICAL,
    definitions.Revolute: arrays.REVOLUTE,
    definitions.Fixed: arrays.FIXED,
    definitions.Prismatic: arrays.PRISMATIC,
    definitions.Distance: arrays.DISTANCE,
    definitions.KnifeEdge: arrays.KNIFE_EDGE,
    definitions.Cylindrical: arrays.CYLINDRICAL,
    definitions.Universal: arrays.UNIVERSAL,
    definitions.Planar: arrays.PLANAR,
    definitions.PointOnLine: arrays.POINT_ON_LINE,
    definitions.PointOnPlane: arrays.POINT_ON_PLANE,
    definitions.Screw: arrays.SCREW,
}


class Compiled(NamedTuple):
    """A scene as arrays, and what is needed to speak of it in the scene's own words again."""

    system: System
    start: np.recarray  # (N,) STATE
    to_principal: np.ndarray  # (N, 4) principal axes -> the scene's body axes
    flipped: np.ndarray  # (J,) joints whose parent and child were exchanged


def compile_scene(scene: Scene, options: Options, loops: bool = False) -> Compiled:
    """Return the arrays of `scene`; with `loops` the block-sparse back end even for a forest."""
    start, to_principal, moments = _start(scene)
    frames = _Frames(start)
    joints, flipped, solver = _joints(scene, frames, options, loops)
    springs, loads = _springs(scene, frames), _loads(scene, frames)
    bushings = _bushings(scene, frames)
    bodies = _bodies(scene, moments, joints, springs, loads, bushings)
    contacts, vertices, solids, hulls = compile_contacts(scene, to_principal, options)
    gravity = np.array(scene.gravity)
    system = System(
        bodies,
        gravity,
        joints,
        springs,
        loads,
        bushings,
        contacts,
        vertices,
        solids,
        hulls,
        0,
        0,
        0,
        solver,
    )
    return Compiled(system, start, to_principal, flipped)


def principal(inertia: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return principal moments (3,) and the quaternion principal -> body axes; identity if diagonal."""
    diagonal = np.diag(inertia).copy()
    scale = diagonal.max()
    if np.ptp(diagonal) <= 1e-13 * scale:
        diagonal[:] = diagonal.mean()
    if np.max(np.abs(inertia - np.diag(np.diag(inertia)))) <= 1e-15 * scale:
        return diagonal, np.array([1.0, 0.0, 0.0, 0.0])
    moments, axes = np.linalg.eigh(inertia)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    if np.ptp(moments) <= 1e-13 * scale:
        return np.full(3, moments.mean()), np.array([1.0, 0.0, 0.0, 0.0])
    return moments, quaternion.from_matrix(axes)


def _start(scene):
    bodies = scene.bodies
    pairs = [principal(b.inertia) for b in bodies]
    moments = np.array([m for m, _ in pairs])
    to_principal = np.array([q for _, q in pairs])
    Q = quaternion.multiply(np.array([b.orientation for b in bodies]), to_principal)
    start = table(STATE, len(bodies))
    start.Q = Q / np.linalg.norm(Q, axis=1, keepdims=True)
    start.x = [b.position for b in bodies]
    start.v = [b.velocity for b in bodies]
    start.w = [b.angular_velocity for b in bodies]
    return start, to_principal, moments


class _Frames:
    """World points and directions as seen from a body (or the ground) at the start."""

    def __init__(self, start: np.recarray):
        self.start = start

    def point(self, body, point) -> np.ndarray:
        if body.index < 0:
            return np.array(point, dtype=float)
        q, x = self.start.Q[body.index], self.start.x[body.index]
        return quaternion.rotate_back(q, np.asarray(point) - x)

    def axes(self, body, world: np.ndarray) -> np.ndarray:
        """Columns of `world` (3, 3) in the body's axes."""
        if body.index < 0:
            return np.array(world, dtype=float)
        return quaternion.rotate_back(self.start.Q[body.index], world.T).T


def _anchors(joint, flipped):
    """World anchors of the scene's parent and child, and the joint's frame, of a definition."""
    d = joint.definition
    if isinstance(d, Distance):
        return d.anchor_parent, d.anchor_child, np.eye(3)
    anchor = joint.child.position if d.anchor is None else d.anchor
    if isinstance(d, KnifeEdge):
        along = np.cross(d.lateral, d.normal)
        return anchor, anchor, np.stack([along, d.lateral, d.normal], axis=1)
    if isinstance(d, Universal):  # first the axis of the (walked) parent, then that of the child
        first, second = d.axis_parent, d.axis_child
        if flipped:
            first, second = second, first
        return anchor, anchor, np.stack([first, second, np.cross(first, second)], axis=1)
    for name in ("axis", "normal", "direction"):
        if hasattr(d, name):
            return anchor, anchor, triad(getattr(d, name))
    return anchor, anchor, np.eye(3)


def _joints(scene, frames, options, loops):
    defined = scene.joints
    count, number = len(scene.bodies), len(defined)
    kind = np.array([KIND[type(j.definition)] for j in defined], dtype=np.int64)
    parent = np.array([j.parent.index for j in defined], dtype=np.int64)
    child = np.array([j.child.index for j in defined], dtype=np.int64)
    flipped = np.zeros(number, dtype=bool)
    forest = not loops and graph.is_forest(count, kind, parent, child)
    order, carrier = np.arange(count), np.full(count, -1)
    if forest:
        order, carrier, turned = graph.forest_order(count, parent, child)
        forest = not np.any(turned & graph.cannot_flip(kind))
    if forest:
        flipped = turned
        parent, child = np.where(flipped, child, parent), np.where(flipped, parent, child)
    joints = table(JOINT, number)
    joints.kind, joints.parent, joints.child = kind, parent, child
    joints.rows = [arrays.ROWS[k] for k in kind]
    for j, joint in enumerate(defined):
        first, second, world = _anchors(joint, flipped[j])
        sides = [(joint.parent, first), (joint.child, second)]
        (a, p), (b, q) = sides[::-1] if flipped[j] else sides
        joints.parent_anchor[j], joints.child_anchor[j] = frames.point(a, p), frames.point(b, q)
        joints.parent_frame[j], joints.child_frame[j] = frames.axes(a, world), frames.axes(b, world)
        joints.length[j] = _length(joint.definition)
    if number == 0:
        solver = arrays.FreeSolver(0)
    elif forest:
        solver = solvers.tree_solver(joints, order, carrier)
    else:
        solver = solvers.loop_solver(joints, options.drop_tolerance)
    return joints, flipped, solver


def _length(definition):
    if isinstance(definition, definitions.Screw):
        return definition.pitch / (2.0 * np.pi)
    return getattr(definition, "length", 0.0)


def _springs(scene, frames):
    chosen = [f for f in scene.forces if isinstance(f.definition, Spring)]
    springs = table(SPRING, len(chosen))
    for s, f in zip(springs, chosen):
        d = f.definition
        s.parent, s.child = f.parent.index, f.child.index
        s.parent_anchor[:] = frames.point(f.parent, d.anchor_parent)
        s.child_anchor[:] = frames.point(f.child, d.anchor_child)
        s.stiffness, s.damping, s.rest_length = d.stiffness, d.damping, d.rest_length
    return springs


def _loads(scene, frames):
    rows, none = [], np.zeros(3)
    for f in scene.forces:
        d = f.definition
        if not isinstance(d, (Torque, Force)):
            continue
        frame = f.child.index if d.follow else -1
        vector = frames.axes(f.child, d.vector[:, None])[:, 0] if d.follow else d.vector
        if isinstance(d, Torque):
            rows.append((f.child.index, frame, none, none, vector))
            if f.parent.index >= 0:
                rows.append((f.parent.index, frame, none, none, -vector))
        else:
            anchor = f.child.position if d.anchor is None else d.anchor
            rows.append((f.child.index, frame, frames.point(f.child, anchor), vector, none))
    loads = table(LOAD, len(rows))
    for k, (body, frame, anchor, force, torque) in enumerate(rows):
        loads.body[k], loads.frame[k] = body, frame
        loads.anchor[k], loads.force[k], loads.torque[k] = anchor, force, torque
    return loads


def _bushings(scene, frames):
    chosen = [f for f in scene.forces if isinstance(f.definition, Bushing)]
    bushings = table(BUSHING, len(chosen))
    for b, f in zip(bushings, chosen):
        d = f.definition
        b.parent, b.child = f.parent.index, f.child.index
        anchor, world = f.child.position if d.anchor is None else d.anchor, triad(d.axis)
        b.parent_anchor[:] = frames.point(f.parent, anchor)
        b.child_anchor[:] = frames.point(f.child, anchor)
        b.parent_frame[:] = quaternion.from_matrix(frames.axes(f.parent, world))
        b.child_frame[:] = quaternion.from_matrix(frames.axes(f.child, world))
        for name in ("stiffness", "damping", "turn_stiffness", "turn_damping"):
            b[name][:] = getattr(d, name)
    return bushings


def _bodies(scene, moments, joints, springs, loads, bushings):
    bodies = table(BODY, len(scene.bodies))
    size = np.array([0.0 if b.shape is None else b.shape.size for b in scene.bodies])
    isolated = np.ones(len(scene.bodies), dtype=np.int64)
    for sides, anchors in (
        (joints.parent, joints.parent_anchor),
        (joints.child, joints.child_anchor),
    ):
        inside = sides >= 0
        isolated[sides[inside]] = 0
        np.maximum.at(size, sides[inside], np.linalg.norm(anchors[inside], axis=1))
    size[size == 0.0] = 1.0
    ballistic = isolated.copy()
    for loaded in (
        springs.parent, springs.child, loads.body, bushings.parent, bushings.child
    ):  # fmt: skip
        ballistic[loaded[loaded >= 0]] = 0
    bodies.mass = [b.mass for b in scene.bodies]
    bodies.inertia, bodies.extent = moments, size
    bodies.isotropic = np.ptp(moments, axis=1) == 0.0
    bodies.isolated, bodies.ballistic = isolated, ballistic
    bodies.number = np.arange(len(bodies))
    bodies.ball = [0.0 if b.shape is None else b.shape.size for b in scene.bodies]
    bodies.component = np.where(isolated == 1, np.arange(len(bodies)), len(bodies))
    return bodies
