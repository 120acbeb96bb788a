"""Adhesive contacts: bodies that hang, are pulled off, strike, slide and roll on magnets and on each other."""

from __future__ import annotations

import math

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom import GROUND, forces, joints

KINDS = "ceiling", "wall", "floor", "pair", "arm"


def case(seed: int) -> Case:
    """Return magnet number `seed`."""
    rng = np.random.default_rng([53, seed])
    step, kind = draw.STEPS[seed % 3], str(rng.choice(KINDS))
    scene = carom.Scene(gravity=(0, 0, -9.81))
    label = {"kind": kind, "step": step, "shape": str(rng.choice(draw.SHAPES))}
    _MAKERS[kind](scene, rng, label)
    label["bodies"] = len(scene.bodies)
    return Case(scene, 1.0, step, label)


def _law(rng, weight: float) -> dict:
    """Return the numbers of a contact that holds a part or a multiple of a weight."""
    return {**draw.contact(rng), "adhesion": weight * 10.0 ** rng.uniform(-0.7, 1.0)}


def _thrown(scene, rng, label, normal) -> carom.Body:
    """Add a body near the plane through the origin with this normal, which flies towards it or touches it."""
    size = 10.0 ** rng.uniform(-1.5, -0.5)
    shape = draw.shape(label["shape"], size, rng)
    n = np.array(normal, dtype=float)
    touches = rng.random() < 0.5
    q = np.array([1.0, 0, 0, 0]) if touches else rng.normal(size=4)
    body = scene.add_body(shape, mass=10.0 ** rng.uniform(-1, 1), orientation=q / np.linalg.norm(q))
    plane = scene.add_half_space((0, 0, 0), normal, name="plane")
    from carom.scene.contacts import gap_between

    gap = gap_between(body, plane)[0]
    away = 0.0 if touches else rng.uniform(0.01, 0.3)
    motion = {"position": n * (away - gap)}
    if not touches:
        motion["velocity"] = -2.0 * rng.random() * n + 0.3 * rng.normal(size=3)
        motion["angular_velocity"] = rng.normal(size=3)
    scene.replace(body, **motion)
    scene.add_contact(body, plane, **_law(rng, 9.81 * float(body.mass)))
    if rng.random() < 0.6:
        load = 9.81 * float(body.mass) * 10.0 ** rng.uniform(-0.5, 1.0) * n
        rate = rng.uniform(0.3, 10.0)

        def pull(t, states):
            return [[*(load * math.sin(rate * t)), 0.0, 0.0, 0.0]]

        scene.add_force(forces.UserForce([body], pull))
    return body


def _pair(scene, rng, label) -> None:
    """Two bodies that hold each other, on a floor or in the air."""
    shapes = [draw.shape("sphere", 10.0 ** rng.uniform(-1.5, -0.5), rng) for _ in range(2)]
    a = scene.add_body(shapes[0], mass=10.0 ** rng.uniform(-1, 1), position=(0, 0, 1))
    below = 1.0 - shapes[0].size - shapes[1].size
    b = scene.add_body(shapes[1], mass=10.0 ** rng.uniform(-1, 1), position=(0, 0, below))
    scene.add_contact(a, b, **_law(rng, 9.81 * float(b.mass)))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    contact = draw.contact(rng)
    for body in (a, b):
        scene.add_contact(body, floor, **contact)
    lift = 9.81 * float(a.mass + b.mass) * rng.uniform(0.0, 2.0)
    scene.add_force(forces.Force((0, 0, lift)), a)


def _arm(scene, rng, label) -> None:
    """An arm on a pin that a magnet holds, and a motor pulls away."""
    arm = scene.add_body(
        carom.Box(0.6, 0.06, 0.06), mass=10.0 ** rng.uniform(-0.5, 0.5), position=(0.3, 0, 0.03)
    )
    joint = scene.add_joint(joints.Revolute((0, 0, 0.03), (0, -1, 0)), GROUND, arm)
    plate = scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_contact(arm, plate, **_law(rng, 9.81 * float(arm.mass)))
    moment, rate = 9.81 * float(arm.mass) * rng.normal(), rng.uniform(1.0, 10.0)
    scene.add_force(forces.JointForce(joint, lambda t, q, v: moment * math.sin(rate * t)))


_MAKERS = {
    "ceiling": lambda *given: _thrown(*given, (0.0, 0.0, -1.0)),
    "wall": lambda *given: _thrown(*given, (1.0, 0.0, 0.0)),
    "floor": lambda *given: _thrown(*given, (0.0, 0.0, 1.0)),
    "pair": _pair,
    "arm": _arm,
}
