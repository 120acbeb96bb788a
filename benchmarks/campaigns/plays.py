"""Gear trains and trees of joints with play between up to three of their coordinates; some strike a floor."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw, mechanisms
from campaigns.case import Case


def case(seed: int) -> Case:
    """Return play number `seed`: half of them between wheels, the others in a tree of joints."""
    rng = np.random.default_rng([44, seed])
    step, wheels = draw.STEPS[seed % 3], rng.random() < 0.5
    scene = carom.Scene(gravity=(0, 0, -9.81))
    if wheels:
        made = _wheels(scene, rng, int(rng.integers(2, 6)))
    else:
        made = mechanisms._tree(scene, rng, int(rng.integers(2, 6)))
    one = [joint for joint in made if joint.kind in ("Revolute", "Prismatic")]
    label = {"kind": "wheels" if wheels else "tree", "step": step, "bodies": len(scene.bodies)}
    count = int(rng.choice([1, 1, 1, 2, 3])) if one else 0
    label["plays"] = [_play(scene, one, rng) for _ in range(count)]
    free = all(
        play["joints"] > 1 for play in label["plays"]
    )  # a motor does not stop at a play of its own
    label["loads"] = [
        _load(scene, joint, rng, free and joint is made[0]) for joint in one if rng.random() < 0.4
    ]
    if not wheels and rng.random() < 0.3:
        lowest = min(float(b.position[2]) - b.shape.size for b in scene.bodies)
        ground = scene.add_half_space((0, 0, lowest - rng.uniform(0.01, 0.3)), (0, 0, 1))
        contact = draw.contact(rng)
        label.update(contact)
        for body in scene.bodies:
            scene.add_contact(body, ground, **contact)
    return Case(scene, 1.0, step, label)


def _wheels(scene, rng, count: int) -> list:
    """Add wheels on axles of random directions, that turn; a few slide as racks do."""
    made = []
    for k in range(count):
        size = 10.0 ** rng.uniform(-1.5, 0)
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        slides, place = rng.random() < 0.2, np.array([2.0 * k, 0, 0])
        speed = rng.normal() * rng.choice([0.0, 1.0, 10.0]) if k > 0 else 0.0
        body = scene.add_body(
            carom.Box(size, size, size), mass=10.0 ** rng.uniform(-2, 2), position=place,
            **{"velocity" if slides else "angular_velocity": speed * axis},
        )  # fmt: skip
        kind = carom.joints.Prismatic if slides else carom.joints.Revolute
        made.append(scene.add_joint(kind(anchor=place, axis=axis), carom.GROUND, body))
    return made


def _play(scene, joints: list, rng) -> dict:
    """Add a play between one to three coordinates; return its numbers."""
    count = min(len(joints), int(rng.choice([1, 2, 2, 2, 3])))
    chosen = rng.choice(len(joints), count, replace=False)
    factors = {
        joints[k]: float(rng.choice([-1, 1]) * 10.0 ** rng.uniform(-0.7, 0.7)) for k in chosen
    }
    width, e = 10.0 ** rng.uniform(-4, -0.5), float(rng.choice([0.0, 0.3, 0.8, 1.0]))
    friction = float(rng.choice([0.0, 0.0, 10.0 ** rng.uniform(-3, 0)]))
    at = rng.uniform(0.0, 1.0)
    scene.add_play(factors, -at * width, (1.0 - at) * width, restitution=e, friction=friction)
    return {"joints": count, "width": width, "restitution": e, "friction": friction}


def _load(scene, joint, rng, at_rest: bool) -> str:
    """Add a spring, a torque, dry friction, or a motor along a joint; return which."""
    which = ("JointSpring", "JointForce", "JointFriction", "Driver")[
        rng.integers(4 if at_rest else 3)
    ]
    if which == "JointSpring":
        stiffness, damping = 10.0 ** rng.uniform(0, 3), rng.uniform(0, 1)
        scene.add_force(carom.forces.JointSpring(joint, stiffness, damping=damping))
    elif which == "JointForce":
        scene.add_force(carom.forces.JointForce(joint, float(rng.normal())))
    elif which == "JointFriction":
        scene.add_force(carom.forces.JointFriction(joint, 10.0 ** rng.uniform(-3, 0)))
    else:
        rate = rng.uniform(0.2, 3.0)
        motion = lambda t: mechanisms._wave(rate, t)  # noqa: E731
        scene.add_constraint(carom.constraints.Driver(joint, motion=motion))
    return which
