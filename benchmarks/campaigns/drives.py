"""Motors with limits on wheels, between free bodies, on arms, in trains of gears, and on slides that press."""

from __future__ import annotations

import itertools

import numpy as np

import carom
from campaigns import draw, mechanisms
from campaigns.case import Case
from carom import GROUND, constraints, forces, joints

KINDS = "wheels", "pair", "arm", "gears", "press"


def case(seed: int) -> Case:
    """Return drive number `seed`."""
    rng = np.random.default_rng([46, seed])
    step, kind = draw.STEPS[seed % 3], str(rng.choice(KINDS))
    scene = carom.Scene(gravity=(0, 0, -9.81))
    label = {"kind": kind, "step": step}
    made = _MAKERS[kind](scene, rng)
    label["motors"] = [_motor(scene, joint, rng, load) for joint, load in made]
    label["bodies"] = len(scene.bodies)
    return Case(scene, 1.0, step, label)


def _motor(scene, joint, rng, load: float) -> dict:
    """Add a motor whose limit is a part or a multiple of a load; return its numbers."""
    limit = load * 10.0 ** rng.uniform(-1, 1)
    which = str(rng.choice(["rate", "rate", "brake", "wave", "law"]))
    rate = float(rng.normal() * rng.choice([0.5, 5.0]))
    if which == "wave":
        motion = lambda t: mechanisms._wave(rate, t)  # noqa: E731
        scene.add_constraint(constraints.Driver(joint, motion=motion, limit=limit))
    elif which == "law":
        law = carom.Friction(limit, limit * rng.uniform(0.3, 1.0), speed=rng.uniform(0.1, 2.0))
        scene.add_force(forces.Drive(joint, law, rate=rate))
    else:
        goal = 0.0 if which == "brake" else rate
        scene.add_constraint(constraints.Driver(joint, rate=goal, limit=limit))
    return {"motor": which, "limit": limit, "rate": rate}


def _body(scene, rng, position, **motion):
    size = 10.0 ** rng.uniform(-1.3, -0.3)
    shape = carom.Box(size, size * rng.uniform(0.3, 1.0), size * rng.uniform(0.3, 1.0))
    return scene.add_body(shape, mass=10.0 ** rng.uniform(-1, 1), position=position, **motion)


def _wheels(scene, rng) -> list:
    """Wheels on axles with torques that grow."""
    made = []
    for k in range(int(rng.integers(1, 4))):
        body = _body(scene, rng, (3.0 * k, 0, 0), angular_velocity=(0, 0, 5.0 * rng.normal()))
        joint = scene.add_joint(joints.Revolute((3.0 * k, 0, 0), (0, 0, 1)), GROUND, body)
        load = 5.0 * float(body.inertia[2, 2])
        slope, start = load * rng.normal(), load * rng.normal()
        if rng.random() < 0.6:
            scene.add_force(forces.JointForce(joint, lambda t, q, v, a=start, b=slope: a + b * t))
        made.append((joint, load))
    return made


def _pair(scene, rng) -> list:
    """Two free bodies with a motor between them, over a floor or not."""
    a, b = _body(scene, rng, (0, 0, 0.8)), _body(scene, rng, (0.6, 0, 0.8))
    axis = rng.normal(size=3)
    joint = scene.add_joint(joints.Revolute((0.3, 0, 0.8), axis), a, b)
    if rng.random() < 0.6:
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
        contact = draw.contact(rng)
        for body in (a, b):
            scene.add_contact(body, floor, **contact)
    return [(joint, float(b.mass) * 9.81 * 0.3)]


def _arm(scene, rng) -> list:
    """An arm of one to three links that motors lift, over a floor that it may strike."""
    made, before, count = [], GROUND, int(rng.integers(1, 4))
    for k in range(count):
        link = scene.add_body(
            carom.Capsule(0.05, 0.4), mass=10.0 ** rng.uniform(-0.5, 0.5),
            position=(0.25 + 0.5 * k, 0, 0), orientation=(np.sqrt(0.5), 0, np.sqrt(0.5), 0),
        )  # fmt: skip
        joint = scene.add_joint(joints.Revolute((0.5 * k, 0, 0), (0, 1, 0)), before, link)
        made.append((joint, 5.0 * float(link.mass) * (count - k)))
        before = link
    if rng.random() < 0.5:
        floor = scene.add_half_space((0, 0, -rng.uniform(0.2, 0.8)), (0, 0, 1))
        contact = draw.contact(rng)
        for body in scene.bodies:
            scene.add_contact(body, floor, **contact)
    return [one for one in made if rng.random() < 0.8] or made[:1]


def _gears(scene, rng) -> list:
    """A train of two or three wheels that gears or plays connect, driven at one end, braked at the other."""
    made = []
    for k in range(int(rng.integers(2, 4))):
        body = _body(scene, rng, (3.0 * k, 0, 0))
        made.append(scene.add_joint(joints.Revolute((3.0 * k, 0, 0), (0, 0, 1)), GROUND, body))
    for first, second in itertools.pairwise(made):
        ratio = float(rng.choice([-1, 1]) * rng.uniform(0.5, 3.0))
        if rng.random() < 0.5:
            scene.add_constraint(constraints.Gear(first, second, ratio))
        else:
            scene.add_play({first: 1.0, second: ratio}, -0.01, 0.01, restitution=0.5)
    return [(made[0], 1.0), (made[-1], 0.5)]


def _press(scene, rng) -> list:
    """A slide that presses a box against a wall, or a block, along a floor."""
    slide = _body(scene, rng, (0, 0, 1.0))
    joint = scene.add_joint(joints.Prismatic((1, 0, 0), (0, 0, 1.0)), GROUND, slide)
    contact = draw.contact(rng)
    wall = scene.add_half_space((rng.uniform(0.5, 0.9), 0, 0), (-1, 0, 0))
    scene.add_contact(slide, wall, **contact)
    return [(joint, float(slide.mass) * 9.81)]


_MAKERS = {"wheels": _wheels, "pair": _pair, "arm": _arm, "gears": _gears, "press": _press}
