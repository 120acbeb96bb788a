"""Friction in joints by their load: arms, drawers, screws, shafts, beads on wires, and cranks."""

from __future__ import annotations

import math

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom import GROUND, constraints, forces, joints

KINDS = "arm", "drawer", "screw", "shaft", "wire", "crank"


def case(seed: int) -> Case:
    """Return load number `seed`."""
    rng = np.random.default_rng([52, seed])
    step, kind = draw.STEPS[seed % 3], str(rng.choice(KINDS))
    scene = carom.Scene(gravity=(0, 0, -9.81))
    label = {"kind": kind, "step": step, "mu": float(rng.choice([0.05, 0.2, 0.5, 1.0]))}
    _MAKERS[kind](scene, rng, label)
    label["bodies"] = len(scene.bodies)
    return Case(scene, 1.0, step, label)


def _coefficient(rng, label):
    """Return a coefficient, or a law of it."""
    mu = label["mu"]
    return mu if rng.random() < 0.7 else carom.Friction(mu, mu * rng.uniform(0.4, 1.0))


def _body(scene, rng, position, **motion):
    size = 10.0 ** rng.uniform(-1.3, -0.3)
    shape = carom.Box(size, size * rng.uniform(0.3, 1.0), size * rng.uniform(0.3, 1.0))
    return scene.add_body(shape, mass=10.0 ** rng.uniform(-1, 1), position=position, **motion)


def _arm(scene, rng, label) -> None:
    """A chain of one to four links, each on a pin with friction, over a floor that it may strike."""
    before, count, floor = GROUND, int(rng.integers(1, 5)), None
    if rng.random() < 0.5:
        floor = scene.add_half_space((0, 0, -rng.uniform(0.2, 0.8)), (0, 0, 1))
    axis = (0.0, 1.0, 0.0) if rng.random() < 0.6 else rng.normal(size=3)
    contact = draw.contact(rng)
    for k in range(count):
        link = scene.add_body(
            carom.Capsule(0.05, 0.4), mass=10.0 ** rng.uniform(-0.5, 0.5),
            position=(0.25 + 0.5 * k, 0, 0), orientation=(np.sqrt(0.5), 0, np.sqrt(0.5), 0),
        )  # fmt: skip
        joint = scene.add_joint(joints.Revolute((0.5 * k, 0, 0), axis), before, link)
        length = None if rng.random() < 0.7 else rng.uniform(0.02, 0.2)
        radius = 10.0 ** rng.uniform(-2.5, -1.0)
        scene.add_force(
            forces.JointFriction(joint, mu=_coefficient(rng, label), radius=radius, length=length)
        )
        if floor is not None:
            scene.add_contact(link, floor, **contact)
        before = link


def _drawer(scene, rng, label) -> None:
    """A drawer that is pulled beside its middle, against a spring, a stop or a wall."""
    body = _body(scene, rng, (0, 0, 1), velocity=(rng.normal(), 0, 0))
    joint = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body)
    length = None if rng.random() < 0.2 else rng.uniform(0.1, 1.0)
    radius = None if rng.random() < 0.6 else rng.uniform(0.02, 0.3)
    scene.add_force(
        forces.JointFriction(joint, mu=_coefficient(rng, label), length=length, radius=radius)
    )
    pull = 10.0 * float(body.mass) * rng.normal(size=3)
    scene.add_force(forces.Force(pull, anchor=(0.0, *(0.3 * rng.normal(size=2) + (0, 1)))), body)
    scene.add_force(forces.JointSpring(joint, stiffness=10.0 ** rng.uniform(0, 3)))
    if rng.random() < 0.5:
        scene.add_stop(joint, upper=rng.uniform(0.02, 0.3), restitution=rng.uniform(0, 1))


def _screw(scene, rng, label) -> None:
    """A nut on a thread, with its weight and a moment that grows."""
    axis = (0.0, 0.0, 1.0) if rng.random() < 0.6 else rng.normal(size=3)
    body = _body(scene, rng, (0, 0, 1))
    radius = rng.uniform(0.01, 0.1)
    lead = rng.choice([-1, 1]) * math.atan(label["mu"]) * rng.uniform(0.3, 2.0)
    pitch = 2.0 * math.pi * radius * math.tan(min(max(lead, -1.2), 1.2))
    joint = scene.add_joint(joints.Screw((0, 0, 1), axis, pitch), GROUND, body)
    scene.add_force(forces.JointFriction(joint, mu=_coefficient(rng, label), radius=radius))
    moment = 9.81 * float(body.mass) * radius * rng.normal()
    scene.add_force(forces.JointForce(joint, lambda t, q, v: moment * math.sin(7.0 * t)))


def _shaft(scene, rng, label) -> None:
    """A wheel on a free shaft, or one of the ground, with two bearings, out of balance."""
    base = GROUND if rng.random() < 0.6 else _body(scene, rng, (0, 0, 1))
    spin = 30.0 * rng.normal()
    place = np.array([0.2, *(0.02 * rng.normal(size=2) + (0, 1))])
    velocity = np.cross((spin, 0, 0), place - (0, 0, 1))
    body = _body(scene, rng, place, angular_velocity=(spin, 0, 0), velocity=velocity)
    joint = scene.add_joint(joints.Revolute((0, 0, 1), (1, 0, 0)), base, body)
    scene.add_force(
        forces.JointFriction(
            joint, mu=_coefficient(rng, label), radius=rng.uniform(0.005, 0.05), length=rng.uniform(0.05, 0.5)
        )
    )  # fmt: skip
    if base is not GROUND:
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
        scene.add_contact(base, floor, **draw.contact(rng))


def _wire(scene, rng, label) -> None:
    """A bead on a closed wire."""
    a, b, c = rng.uniform(0.3, 1.0, size=3)
    phase = rng.uniform(0, 6)

    def place(u: float):
        return a * math.cos(u), b * math.sin(u), 0.3 * c * math.sin(2.0 * u + phase)

    curve = carom.curves.Curve(place, 0.0, 2.0 * math.pi, closed=True)
    speed = 3.0 * rng.normal()
    body = _body(scene, rng, curve.point(0.0), velocity=speed * curve.tangent(0.0))
    joint = scene.add_joint(joints.PointOnCurve(curve), GROUND, body)
    scene.add_force(forces.JointFriction(joint, mu=_coefficient(rng, label)))


def _crank(scene, rng, label) -> None:
    """A slider-crank, driven or with a torque, whose pins and slide have friction."""
    r, rod = rng.uniform(0.1, 0.3), rng.uniform(0.5, 1.0)
    angle = rng.uniform(0, 6)
    pin = r * np.array([math.cos(angle), 0.0, math.sin(angle)])
    end = np.array([pin[0] + math.sqrt(rod**2 - pin[2] ** 2), 0.0, 0.0])
    crank = scene.add_body(mass=1.0, inertia=(0.01,) * 3, position=0.5 * pin)
    link = scene.add_body(
        mass=10.0 ** rng.uniform(-1, 0.3), inertia=(0.02,) * 3, position=0.5 * (pin + end)
    )
    slider = scene.add_body(mass=10.0 ** rng.uniform(-1, 0.5), inertia=(0.01,) * 3, position=end)
    axis = (0.0, -1.0, 0.0)
    made = [
        scene.add_joint(joints.Revolute((0, 0, 0), axis), GROUND, crank),
        scene.add_joint(joints.Revolute(pin, axis), crank, link),
        scene.add_joint(joints.Revolute(end, axis), link, slider),
    ]
    slide = scene.add_joint(joints.Prismatic((1, 0, 0), end), GROUND, slider)
    for joint in made:
        if rng.random() < 0.7:
            scene.add_force(
                forces.JointFriction(
                    joint, mu=_coefficient(rng, label), radius=rng.uniform(0.003, 0.03)
                )
            )
    length = None if rng.random() < 0.5 else rng.uniform(0.05, 0.3)
    scene.add_force(forces.JointFriction(slide, mu=_coefficient(rng, label), length=length))
    if rng.random() < 0.5:
        scene.add_constraint(constraints.Driver(made[0], rate=0.0, limit=20.0 * rng.random()))
    else:
        scene.add_force(forces.JointForce(made[0], 5.0 * rng.normal()))


_MAKERS = {
    "arm": _arm, "drawer": _drawer, "screw": _screw, "shaft": _shaft, "wire": _wire, "crank": _crank,
}  # fmt: skip
