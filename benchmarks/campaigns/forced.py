"""Springs, dampers, motors, loads and stops, softer and stiffer than any step: is every loss of energy said?

A chain of one to four bodies on joints of any kind, or free, with masses over four orders and shapes from
needles to plates; springs from soft to stiffer than any step, dampers, mounts, constant loads that may turn
with their body, dry friction, motors and stops; with and without a floor.
"""

from __future__ import annotations

import numpy as np

import carom
from campaigns.case import Case
from carom import GROUND, constraints, forces, joints

STEPS = (1e-3, 5e-3, 20e-3)
JOINTS = ("Revolute", "Prismatic", "Spherical", "Cylindrical", "Universal", "Fixed", "free")
SLIDES = ("Prismatic", "Cylindrical")
#: coordinates that forces and motors can act along
ALONG = {"Revolute": 1, "Prismatic": 1, "Cylindrical": 2, "Universal": 2}


def _unit(rng) -> np.ndarray:
    e = rng.normal(size=3)
    return e / np.linalg.norm(e)


def _body(rng, scene, place) -> carom.scene.bodies.Body:
    """Add a body of a random shape and mass."""
    size = 0.05 * np.exp(rng.uniform(-0.7, 0.7, size=3) * (2.0 if rng.random() < 0.3 else 1.0))
    kind = rng.integers(3)
    shape = carom.Box(*(2.0 * size)) if kind else carom.Sphere(float(size[0]))
    if kind == 2:
        shape = carom.Capsule(float(size[0]), float(4.0 * size[1]))
    return scene.add_body(
        shape, mass=float(10.0 ** rng.uniform(-3, 1)), position=place, orientation=_unit4(rng)
    )


def _unit4(rng) -> np.ndarray:
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def _joint(rng, kind, place):
    axis = _unit(rng)
    if kind == "Universal":
        across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        return joints.Universal(place, axis, across / np.linalg.norm(across))
    if kind in ("Spherical", "Fixed"):
        return getattr(joints, kind)(place)
    if kind == "Prismatic":
        return joints.Prismatic(axis=axis, anchor=place)
    return getattr(joints, kind)(place, axis=axis)


def _motor(rng, joint):
    """Return a motor that starts from rest, smoothly."""
    a, w = float(rng.uniform(0.1, 1.0)), float(rng.uniform(1.0, 20.0))
    if joint.definition.__class__.__name__ in SLIDES:
        a *= 0.1

    def motion(t):
        return a * (1 - np.cos(w * t)), a * w * np.sin(w * t), a * w * w * np.cos(w * t)

    return constraints.Driver(joint, motion=motion)


def case(seed: int) -> Case:
    """Return scene number `seed`, at one of three steps."""
    rng = np.random.default_rng(seed)
    made = carom.Scene(gravity=(0, 0, -9.81) if rng.random() < 0.8 else (0, 0, 0))
    step = float(rng.choice(STEPS))
    made_bodies, made_joints, last = [], [], GROUND
    for k in range(int(rng.integers(1, 5))):
        place = np.array([0.4 * k, 0.0, 0.0]) + rng.uniform(-0.05, 0.05, size=3)
        body = _body(rng, made, place)
        kind = str(rng.choice(JOINTS))
        if kind != "free":
            at = place - np.array([0.2, 0.0, 0.0])
            made_joints.append((kind, made.add_joint(_joint(rng, kind, at), last, body)))
        made_bodies.append((body, place))
        last = body
    for body, place in made_bodies:
        mass, speed = body.mass, 1.0
        other, there = GROUND, place + 0.3 * _unit(rng)
        if len(made_bodies) > 1 and rng.random() < 0.5:
            other, there = made_bodies[int(rng.integers(len(made_bodies)))]
        if other is not body and rng.random() < 0.5:
            # h omega from 0.01 to 10, h lambda from 0.01 to 10
            w = 10.0 ** rng.uniform(-2, 1) / step
            c = 10.0 ** rng.uniform(-2, 1) / step if rng.random() < 0.5 else 0.0
            made.add_force(
                forces.Spring(
                    stiffness=mass * w * w, anchor_parent=there, anchor_child=place + 0.02 * _unit(rng),
                    damping=mass * c,
                    rest_length=float(np.linalg.norm(there - place)) * rng.uniform(0.95, 1.05),
                ), other, body,
            )  # fmt: skip
        if rng.random() < 0.15:
            w = 10.0 ** rng.uniform(-2, 0.5) / step
            made.add_force(
                forces.Bushing(mass * w * w, mass * 1e-3 * w * w, damping=0.1 * mass * w), body
            )
        if rng.random() < 0.3:
            vector = mass * 10.0 * speed * rng.normal(size=3)
            made.add_force(forces.Force(vector, follow=bool(rng.random() < 0.5)), body)
        if rng.random() < 0.3:
            inertia = np.diag(body.inertia).min()
            vector = inertia * 10.0 ** rng.uniform(0, 3) * _unit(rng)
            made.add_force(forces.Torque(vector, follow=bool(rng.random() < 0.5)), body)
    driven = set()
    for kind, joint in made_joints:
        if kind not in ALONG:
            continue
        mass = joint.child.mass
        if rng.random() < 0.25:
            made.add_force(
                forces.JointFriction(joint, bound=mass * 10.0 ** rng.uniform(-2, 1) * 0.1)
            )
        if rng.random() < 0.25:
            w = 10.0 ** rng.uniform(-2, 1) / step
            scale = mass if kind in SLIDES else mass * 0.01
            made.add_force(
                forces.JointSpring(joint, stiffness=scale * w * w, damping=scale * w * rng.random())
            )
        if rng.random() < 0.2:
            made.add_stop(joint, upper=0.1, restitution=float(rng.uniform(0, 0.9)))
        elif rng.random() < 0.25:
            made.add_constraint(_motor(rng, joint))
            driven.add(joint)
    if rng.random() < 0.5:
        floor = made.add_half_space(point=(0, 0, -0.7), normal=(0, 0, 1))
        for body, _ in made_bodies:
            made.add_contact(
                body, floor, restitution=float(rng.uniform(0, 0.9)), friction=float(rng.uniform(0, 1)),
                impact_law=str(rng.choice(["newton", "poisson", "stronge"])),
            )  # fmt: skip
    kinds = sorted({type(force.definition).__name__ for force in made.forces})
    return Case(
        made,
        0.5,
        step,
        {"kind": "floor" if made.contacts else "free", "step": step, "loads": kinds},
    )
