"""Belts and chains between wheels in hinges: rigid, slack and elastic, on the ground and on moving bodies."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom import GROUND, forces, joints
from carom.geometry import quaternion

BEYOND = 1e-8  # of the size of a wheel: how far a strand may be longer than it is


def case(seed: int) -> Case:
    """Return belt drive number `seed`: a row of two to four wheels."""
    rng = np.random.default_rng([54, seed])
    step, carrier = draw.STEPS[seed % 3], rng.random() < 0.4
    scene = carom.Scene(gravity=(0, 0, -9.81) if rng.random() < 0.5 else (0, 0, 0))
    turn = quaternion.exp(rng.normal(size=3))  # of the plane of the wheels
    on, motion = GROUND, (np.zeros(3), np.zeros(3))
    if carrier:
        motion = rng.normal(size=3), rng.normal(size=3)
        on = scene.add_body(
            carom.Box(1.0, 0.1, 0.02), mass=10.0 ** rng.uniform(0, 1), orientation=turn,
            velocity=motion[0], angular_velocity=motion[1],
        )  # fmt: skip
        if rng.random() < 0.3:
            scene.add_joint(joints.Spherical((0.3, 0.2, 0.1)), GROUND, on)
            w = motion[1]
            scene.replace(on, velocity=np.cross(w, -np.array([0.3, 0.2, 0.1])))
            motion = scene[on.name].velocity, w
    z = quaternion.rotate(turn, np.array([0, 0, 1.0]))
    wheels, belts, x, spin = [], [], 0.0, 0.0
    for k in range(int(rng.integers(2, 5))):
        radius = 10.0 ** rng.uniform(-2, -1)
        x += 2.0 * radius if k == 0 else wheels[-1][1] + radius * rng.uniform(1.1, 3.0)
        place = quaternion.rotate(turn, np.array([x, 0.05 * rng.normal(), 0.0]))
        belt = _belt(rng) if k > 0 else {}
        if belt.get("belt") == "rigid":  # as fast as the one before
            spin *= wheels[-1][1] / radius * (-1.0 if belt["crossed"] else 1.0)
        else:
            spin = rng.normal() * 20.0 if k == 0 or rng.random() < 0.2 else 0.0
        wheel = scene.add_body(
            carom.Cylinder(radius, 0.02), mass=10.0 ** rng.uniform(-1, 1), position=place, orientation=turn,
            velocity=motion[0] + np.cross(motion[1], place), angular_velocity=motion[1] + spin * z,
        )  # fmt: skip
        hinge = scene.add_joint(joints.Revolute(place, rng.choice([-1.0, 1.0]) * z), on, wheel)
        if k > 0:
            own = {name: value for name, value in belt.items() if name != "belt"}
            scene.add_joint(joints.Belt(wheels[-1][1], radius, **own), wheels[-1][0], wheel)
            belts.append(belt)
        if rng.random() < 0.5:
            scene.add_force(forces.JointForce(hinge, float(rng.normal() * radius)))
        if rng.random() < 0.3:
            scene.add_force(forces.JointSpring(hinge, damping=10.0 ** rng.uniform(-4, -2)))
        if rng.random() < 0.2:
            scene.add_force(forces.JointFriction(hinge, mu=0.2, radius=0.2 * radius))
        wheels.append((wheel, radius))
        x += radius
    names = [stop.name for stop in scene.stops]

    def off(s: carom.Solution) -> float:
        """Return how much longer than it is a strand is, by what is allowed."""
        beyond = max((-float(np.min(s[name].gap)) for name in names), default=0.0)
        return beyond / (BEYOND * wheels[0][1])

    label = {"kind": "carrier" if carrier else "ground", "step": step, "belts": belts}
    return Case(scene, 0.5, step, label, off)


def _belt(rng) -> dict:
    """Return the options of a belt, and its kind."""
    kind = str(rng.choice(["rigid", "rigid", "one-sided", "slack", "elastic"]))
    belt = {"belt": kind, "crossed": bool(rng.random() < 0.3)}
    if kind == "rigid":
        belt["tension"] = float(rng.choice([0.0, 50.0]))
    elif kind in ("one-sided", "slack"):
        belt["one_sided"] = True
        if kind == "slack":
            belt["restitution"] = float(rng.choice([0.0, 0.3, 1.0]))
            belt["slack"] = 10.0 ** rng.uniform(-4, -2)
    else:
        belt["stiffness"] = 10.0 ** rng.uniform(2, 4)
        belt["damping"] = float(rng.choice([0.0, 1.0]))
        belt["tension"] = float(rng.choice([0.0, 50.0]))
    return belt
