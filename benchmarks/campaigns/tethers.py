"""Bodies on tethers: pendulums, pairs in space, chains and nets, some with a joint, some above a floor."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case


def case(seed: int) -> Case:
    """Return tether number `seed`: one to five bodies on one to six tethers."""
    rng = np.random.default_rng([45, seed])
    step, count = draw.STEPS[seed % 3], int(rng.integers(1, 6))
    gravity = -9.81 if rng.random() < 0.7 else 0.0
    scene = carom.Scene(gravity=(0, 0, gravity))
    for k in range(count):
        size = 10.0 ** rng.uniform(-1.5, -0.5)
        shape = draw.shape(("box", "rod", "sphere", "capsule")[rng.integers(4)], size, rng)
        scene.add_body(
            shape, mass=10.0 ** rng.uniform(-2, 2), position=(0.7 * k, 0, 0) + 0.2 * rng.normal(size=3),
            orientation=(q := rng.normal(size=4)) / np.linalg.norm(q), velocity=rng.normal(size=3),
            angular_velocity=rng.normal(size=3) * rng.choice([0.0, 1.0, 10.0]),
        )  # fmt: skip
    label = {"kind": "free" if gravity == 0.0 else "hung", "step": step, "bodies": count}
    if rng.random() < 0.3:
        first = scene.bodies[0]
        scene.replace(first.name, velocity=(0, 0, 0), angular_velocity=(0, 0, 0))
        hinge = carom.joints.Revolute(anchor=first.position, axis=_unit(rng))
        scene.add_joint(hinge, carom.GROUND, first.name)
        label["kind"] = "hinged"
    label["tethers"] = [_tether(scene, rng, k) for k in range(int(rng.integers(1, count + 2)))]
    if gravity < 0.0 and rng.random() < 0.4:
        ground = scene.add_half_space((0, 0, -rng.uniform(1.0, 2.0)), (0, 0, 1))
        contact = draw.contact(rng)
        label.update(contact)
        for body in scene.bodies:
            scene.add_contact(body, ground, **contact)
    return Case(scene, 1.0, step, label)


def _unit(rng) -> np.ndarray:
    axis = rng.normal(size=3)
    return axis / np.linalg.norm(axis)


def _tether(scene, rng, k: int) -> dict:
    """Add a tether from a body to the one before it, another one, or the ground; return its numbers."""
    bodies = scene.bodies
    child = bodies[k % len(bodies)]
    others = [carom.GROUND, *(one for one in bodies if one is not child)]
    parent = others[int(rng.integers(len(others)))]
    ends = {"anchor_child": child.position + rng.choice([0.0, 1.0]) * child.shape.size * _unit(rng)}
    if parent is carom.GROUND:
        ends["anchor_parent"] = child.position + (0, 0, 0.5) + 0.3 * rng.normal(size=3)
    else:
        ends["anchor_parent"] = parent.position + rng.choice(
            [0.0, 1.0]
        ) * parent.shape.size * _unit(rng)
    distance = float(np.linalg.norm(ends["anchor_child"] - ends["anchor_parent"]))
    length = distance * float(rng.choice([1.0, 1.1, 2.0]))
    e = float(rng.choice([0.0, 0.0, 0.5, 1.0]))
    scene.add_joint(carom.joints.Tether(length, restitution=e, **ends), parent, child)
    return {"ground": parent is carom.GROUND, "slack": length / distance, "restitution": e}
