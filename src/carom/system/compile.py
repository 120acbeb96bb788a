"""Turn a scene into flat arrays, once, before a run."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.options import Options
from carom.scene.contacts import IMPACT_LAWS
from carom.scene.forces import Spring, Torque
from carom.scene.joints import Distance, Fixed, KnifeEdge, Prismatic, Revolute, Spherical
from carom.scene.scene import Scene
from carom.system import arrays, graph, solvers
from carom.system.arrays import Bodies, Contacts, Forces, Joints, State, System

KIND = {
    Spherical: arrays.SPHERICAL,
    Revolute: arrays.REVOLUTE,
    Fixed: arrays.FIXED,
    Prismatic: arrays.PRISMATIC,
    Distance: arrays.DISTANCE,
    KnifeEdge: arrays.KNIFE_EDGE,
}


class Compiled(NamedTuple):
    """A scene as arrays, and what is needed to speak of it in the scene's own words again."""

    system: System
    start: State
    to_principal: np.ndarray  # (N, 4) principal axes -> the scene's body axes
    flipped: np.ndarray  # (J,) joints whose parent and child were exchanged


def compile_scene(scene: Scene, options: Options) -> Compiled:
    """Return the arrays of `scene`."""
    start, to_principal, moments = _start(scene)
    frames = _Frames(start)
    joints, flipped, solver = _joints(scene, frames, options)
    forces = _forces(scene, frames)
    bodies = _bodies(scene, moments, joints, forces)
    system = System(bodies, joints, forces, _contacts(scene, to_principal, options), solver)
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
    start = State(
        np.array([b.position for b in bodies], dtype=float),
        np.ascontiguousarray(Q / np.linalg.norm(Q, axis=1, keepdims=True)),
        np.array([b.velocity for b in bodies], dtype=float),
        np.array([b.angular_velocity for b in bodies], dtype=float),
    )
    return start, to_principal, moments


class _Frames:
    """World points and directions as seen from a body (or the ground) at the start."""

    def __init__(self, start: State):
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


def triad(axis: np.ndarray) -> np.ndarray:
    """Return a right-handed frame whose first column is the unit vector `axis`."""
    across = np.eye(3)[np.argmin(np.abs(axis))]
    second = across - (across @ axis) * axis
    second /= np.linalg.norm(second)
    return np.stack([axis, second, np.cross(axis, second)], axis=1)


def _anchors(joint):
    """World anchors of parent and child, and the joint's frame, of a definition."""
    d = joint.definition
    if isinstance(d, Distance):
        return d.anchor_parent, d.anchor_child, np.eye(3)
    anchor = joint.child.position if d.anchor is None else d.anchor
    if isinstance(d, KnifeEdge):
        along = np.cross(d.lateral, d.normal)
        return anchor, anchor, np.stack([along, d.lateral, d.normal], axis=1)
    frame = triad(d.axis) if isinstance(d, (Revolute, Prismatic)) else np.eye(3)
    return anchor, anchor, frame


def _joints(scene, frames, options):
    defined = scene.joints
    count, number = len(scene.bodies), len(defined)
    kind = np.array([KIND[type(j.definition)] for j in defined], dtype=np.int64)
    parent = np.array([j.parent.index for j in defined], dtype=np.int64)
    child = np.array([j.child.index for j in defined], dtype=np.int64)
    flipped = np.zeros(number, dtype=bool)
    forest = graph.is_forest(count, kind, parent, child)
    order, carrier = np.arange(count), np.full(count, -1)
    if forest:
        order, carrier, flipped = graph.forest_order(count, parent, child)
        parent, child = np.where(flipped, child, parent), np.where(flipped, parent, child)
    anchors = np.zeros((2, number, 3))
    axes = np.zeros((2, number, 3, 3))
    length = np.zeros(number)
    for j, joint in enumerate(defined):
        first, second, world = _anchors(joint)
        sides = [(joint.parent, first), (joint.child, second)]
        for side, (body, point) in enumerate(sides[::-1] if flipped[j] else sides):
            anchors[side, j] = frames.point(body, point)
            axes[side, j] = frames.axes(body, world)
        length[j] = getattr(joint.definition, "length", 0.0)
    joints = Joints(
        kind, parent, child, *(np.ascontiguousarray(a) for a in anchors),
        *(np.ascontiguousarray(a) for a in axes), length,
        np.array([arrays.ROWS[k] for k in kind], dtype=np.int64),
    )  # fmt: skip
    if number == 0:
        solver = solvers.free_solver(count)
    elif forest:
        solver = solvers.tree_solver(joints, order, carrier)
    else:
        solver = solvers.loop_solver(count, joints, options.drop_tolerance)
    return joints, flipped, solver


def _forces(scene, frames):
    springs = [f for f in scene.forces if isinstance(f.definition, Spring)]
    ends, loads = [], []
    for f in springs:
        d = f.definition
        ends.append((
            f.parent.index, f.child.index, frames.point(f.parent, d.anchor_parent),
            frames.point(f.child, d.anchor_child), (d.stiffness, d.damping, d.rest_length),
        ))  # fmt: skip
    for f in scene.forces:
        d = f.definition
        if isinstance(d, Torque):
            wrench = np.concatenate([np.zeros(3), d.vector])
            loads.append((f.child.index, np.zeros(3), wrench))
            if f.parent.index >= 0:
                loads.append((f.parent.index, np.zeros(3), -wrench))
        elif not isinstance(d, Spring):
            anchor = f.child.position if d.anchor is None else d.anchor
            wrench = np.concatenate([d.vector, np.zeros(3)])
            loads.append((f.child.index, frames.point(f.child, anchor), wrench))
    return Forces(
        np.array([e[0] for e in ends], dtype=np.int64),
        np.array([e[1] for e in ends], dtype=np.int64),
        np.array([e[2] for e in ends]).reshape(-1, 3),
        np.array([e[3] for e in ends]).reshape(-1, 3),
        np.array([e[4] for e in ends]).reshape(-1, 3),
        np.array([e[0] for e in loads], dtype=np.int64),
        np.array([e[1] for e in loads]).reshape(-1, 3),
        np.array([e[2] for e in loads]).reshape(-1, 6),
    )


def _bodies(scene, moments, joints, forces):
    count = len(scene.bodies)
    size = np.array([0.0 if b.shape is None else b.shape.size for b in scene.bodies])
    isolated = np.ones(count, dtype=np.int64)
    for bodies, anchors in (
        (joints.parent, joints.parent_anchor),
        (joints.child, joints.child_anchor),
    ):
        inside = bodies >= 0
        isolated[bodies[inside]] = 0
        np.maximum.at(size, bodies[inside], np.linalg.norm(anchors[inside], axis=1))
    size[size == 0.0] = 1.0
    ballistic = isolated.copy()
    for bodies in (forces.spring_parent, forces.spring_child, forces.wrench_body):
        ballistic[bodies[bodies >= 0]] = 0
    return Bodies(
        mass=np.array([b.mass for b in scene.bodies]),
        inertia=np.ascontiguousarray(moments),
        size=size,
        isotropic=(np.ptp(moments, axis=1) == 0.0).astype(np.int64),
        isolated=isolated,
        ballistic=ballistic,
        gravity=np.array(scene.gravity),
    )


def contact_axes(normal: np.ndarray) -> np.ndarray:
    """Return rows n, t1, t2: t1 the world axis least along n (x first), made tangent; t2 = n x t1."""
    return np.ascontiguousarray(triad(normal).T)


def _contacts(scene, to_principal, options):
    contacts = scene.contacts
    start, vertices = [0], [np.zeros((0, 3))]
    for c in contacts:
        points = c.body.shape.vertices
        vertices.append(quaternion.rotate_back(to_principal[c.body.index], points))
        start.append(start[-1] + len(points))
    size = np.array([c.body.shape.size for c in contacts], dtype=float)
    width = 1e-5 * size if options.layer_width is None else np.full(size.shape, options.layer_width)
    return Contacts(
        body=np.array([c.body.index for c in contacts], dtype=np.int64),
        axes=np.array([contact_axes(c.half_space.normal) for c in contacts]).reshape(-1, 3, 3),
        offset=np.array([c.half_space.point @ c.half_space.normal for c in contacts], dtype=float),
        radius=np.array([c.body.shape.radius for c in contacts], dtype=float),
        start=np.array(start, dtype=np.int64),
        vertices=np.concatenate(vertices),
        friction=np.array([c.friction for c in contacts], dtype=float),
        restitution=np.array([c.restitution for c in contacts], dtype=float),
        law=np.array([IMPACT_LAWS.index(c.impact_law) for c in contacts], dtype=np.int64),
        size=size,
        width=width,
        penetration=np.full(len(contacts), options.penetration),
    )
