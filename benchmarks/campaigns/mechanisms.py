"""Trees and loops of joints with springs, dampers, motors and stops; some strike a floor."""

from __future__ import annotations

import itertools

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case

JOINTS = ("Revolute", "Spherical", "Prismatic", "Cylindrical", "Universal", "Fixed")


def case(seed: int) -> Case:
    """Return mechanism number `seed`: one to five bodies, a third of them closed to a loop."""
    rng = np.random.default_rng([2, seed])
    step = draw.STEPS[seed % 3]
    count, loop = int(rng.integers(1, 6)), rng.random() < 0.33
    floor = rng.random() < 0.5
    scene = carom.Scene(gravity=(0, 0, -9.81))
    made = _loop(scene, rng) if loop else _tree(scene, rng, count)
    label = {
        "kind": "loop" if loop else "tree",
        "step": step,
        "bodies": len(scene.bodies),
        "loads": [],
    }
    for joint in made:
        if joint.kind in ("Revolute", "Prismatic") and rng.random() < 0.5:
            label["loads"].append(_load(scene, joint, rng, loop))
    if rng.random() < 0.3:
        scene.add_force(
            carom.forces.Spring(
                10.0 ** rng.uniform(0, 3), anchor_parent=rng.normal(size=3),
                anchor_child=scene.bodies[-1].position, rest_length=0.3, damping=rng.uniform(0, 2),
            ),
            carom.GROUND, scene.bodies[-1],
        )  # fmt: skip
        label["loads"].append("Spring")
    if floor:
        lowest = min(float(b.position[2]) - b.shape.size for b in scene.bodies)
        ground = scene.add_half_space((0, 0, lowest - rng.uniform(0.01, 0.3)), (0, 0, 1))
        contact = draw.contact(rng)
        label.update(contact)
        for body in scene.bodies:
            scene.add_contact(body, ground, **contact)
    return Case(scene, 1.0, step, label)


def _tree(scene, rng, count: int) -> list:
    """Add bodies, each on one before it or on the ground, at rest."""
    made, anchor = [], np.zeros(3)
    for k in range(count):
        parent = carom.GROUND if k == 0 else scene.bodies[int(rng.integers(k))]
        anchor = np.zeros(3) if k == 0 else parent.position + rng.normal(size=3) * 0.1
        size = rng.uniform(0.05, 0.2)
        shape = draw.shape(("box", "rod", "sphere", "capsule")[rng.integers(4)], size, rng)
        body = scene.add_body(
            shape, mass=10.0 ** rng.uniform(-1, 1), position=anchor + rng.normal(size=3) * 0.3,
            orientation=(q := rng.normal(size=4)) / np.linalg.norm(q),
        )  # fmt: skip
        made.append(scene.add_joint(_joint(rng, anchor), parent, body))
    return made


def _joint(rng, anchor):
    kind = JOINTS[rng.integers(len(JOINTS))]
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    other = np.cross(axis, (0.3, 0.5, 0.8))
    where = {
        "Spherical": {}, "Fixed": {},
        "Universal": {"axis_parent": axis, "axis_child": other / np.linalg.norm(other)},
    }.get(kind, {"axis": axis})  # fmt: skip
    return getattr(carom.joints, kind)(anchor=anchor, **where)


def _loop(scene, rng) -> list:
    """Add a four-bar in a vertical plane, with links of random lengths that close."""
    a, b, c = rng.uniform(0.3, 1.0, 3)
    start, turn = np.zeros(2), rng.uniform(-np.pi, np.pi)
    p = start + a * np.array([np.cos(turn), np.sin(turn)])
    turn += rng.uniform(-2.5, 2.5)
    q = p + b * np.array([np.cos(turn), np.sin(turn)])
    turn += rng.uniform(-2.5, 2.5)
    r = q + c * np.array([np.cos(turn), np.sin(turn)])
    points = [np.array([x, 0.0, z]) for x, z in (start, p, q, r)]
    bodies = []
    for one, two in itertools.pairwise(points):
        along = two - one
        length = np.linalg.norm(along)
        angle = 0.5 * np.arctan2(-along[2], along[0])  # about y, from the x axis
        bodies.append(
            scene.add_body(
                carom.Box(length, 0.05, 0.03), mass=length * 10.0 ** rng.uniform(-1, 1),
                position=0.5 * (one + two), orientation=(np.cos(angle), 0, np.sin(angle), 0),
            )
        )  # fmt: skip
    chain = [carom.GROUND, *bodies, carom.GROUND]
    return [
        scene.add_joint(carom.joints.Revolute(anchor=point, axis=(0, 1, 0)), *pair)
        for point, pair in zip(points, itertools.pairwise(chain))
        if pair[1] is not carom.GROUND
    ] + [
        scene.add_joint(
            carom.joints.Revolute(anchor=points[-1], axis=(0, 1, 0)), carom.GROUND, bodies[-1]
        )
    ]


def _load(scene, joint, rng, loop: bool) -> str:
    """Add a spring, a motor or a stop along a joint; return which."""
    which = ("JointSpring", "Driver", "Stop", "JointFriction")[rng.integers(4)]
    if which == "JointSpring":
        scene.add_force(
            carom.forces.JointSpring(joint, 10.0 ** rng.uniform(0, 3), damping=rng.uniform(0, 1))
        )
    elif which == "JointFriction":
        scene.add_force(carom.forces.JointFriction(joint, 10.0 ** rng.uniform(-2, 1)))
    elif which == "Stop":
        e = rng.uniform(0, 1)
        scene.add_stop(joint, lower=-rng.uniform(0.1, 1.0), restitution=e)
        scene.add_stop(joint, upper=rng.uniform(0.1, 1.0), restitution=e)
    elif not loop:  # a rate that a loop cannot follow would be refused
        rate = rng.uniform(0.2, 3.0)
        scene.add_constraint(carom.constraints.Driver(joint, motion=lambda t: _wave(rate, t)))
    return which


def _wave(rate: float, t: float) -> tuple[float, float, float]:
    """Return 0.3 sin(rate t)^2 with its rate and its acceleration."""
    turn = 2.0 * rate * t
    return (
        0.15 * (1.0 - np.cos(turn)),
        0.3 * rate * np.sin(turn),
        0.6 * rate**2 * np.cos(turn),
    )
