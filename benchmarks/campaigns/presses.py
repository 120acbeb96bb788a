"""Presses: plates and jaws that motors move onto bodies of any shape, alone or stacked."""

from __future__ import annotations

import math

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom import GROUND, constraints, forces, joints

KINDS = "stack", "tilted", "jaws", "limited", "spring"
EARLY, LATE = (
    0.01,
    1e-6,
)  # parts of the duration by which a run that is blocked may end too early, or too late


def case(seed: int) -> Case:
    """Return press number `seed`."""
    rng = np.random.default_rng([61, seed])
    step, kind = draw.STEPS[seed % 3], str(rng.choice(KINDS))
    shape = str(rng.choice(("box", "sphere", "cylinder") if kind == "stack" else draw.SHAPES))
    scene = carom.Scene(gravity=(0, 0, -9.81))
    label = {"kind": kind, "step": step, "shape": shape, **draw.contact(rng)}
    label["bodies"] = int(rng.integers(1, 6)) if kind == "stack" else 1
    label["blocks"] = kind in ("stack", "tilted", "jaws")
    size = 10.0 ** rng.uniform(-2, 0)
    floor, top, off = scene.add_half_space((0, 0, 0), (0, 0, 1)), 0.0, None
    law = {name: label[name] for name in ("restitution", "friction", "impact_law")}
    below = floor
    for _ in range(label["bodies"]):
        one = draw.shape(shape, size, rng)
        q = np.array([1.0, 0, 0, 0]) if kind == "stack" else draw.attitude(rng)
        up = np.array((0.0, 0.0, 1.0))
        reach = [float(one.support(w) @ w) for w in (up, -up)]
        if kind != "stack":
            reach = [one.size, one.size]  # it falls a little
        body = scene.add_body(
            one, mass=10.0 ** rng.uniform(-3, 3), position=(0, 0, top + reach[1]), orientation=q
        )
        scene.add_contact(body, below, **law)
        below, top = body, top + reach[0] + reach[1]
    way, rate = top * rng.uniform(0.1, 0.9), rng.uniform(0.3, 3.0)
    if kind == "jaws":
        for side in (-1, 1):
            _plate(scene, (side, 0, 0), one.size * rng.uniform(1.1, 1.5), (way, rate), body, law)
    else:
        room = top * rng.uniform(0.0, 0.3)
        start = top + room
        plate = _plate(scene, (0, 0, 1), start, (way, rate), below, law, kind)
        label["mass"] = float(plate.mass)
        if kind == "stack":
            off = _time_of(room, way, rate)
    return Case(scene, 1.0, step, label, off=off)


def _plate(scene, side, distance, motion, body, law, kind="") -> carom.Body:
    """Add a plate at this distance on a side that a motor brings nearer, by way (1 - cos(rate t))/2."""
    way, rate = motion
    normal, wide = np.array(side, dtype=float), 6.0 * body.shape.size
    thick = 0.1 * body.shape.size
    lengths = np.where(np.abs(normal) > 0.5, thick, wide)
    place = (distance + 0.5 * thick) * normal
    if side[2] == 0:
        place = place + (0, 0, 0.5 * wide + 0.01 * body.shape.size)
    plate = scene.add_body(
        carom.Box(*lengths), mass=float(body.mass) * 10.0 ** np.sign(normal.sum()), position=place
    )
    slide = scene.add_joint(joints.Prismatic(anchor=place, axis=-normal), GROUND, plate)
    scene.add_contact(plate, body, **law)
    if kind == "spring":
        stiffness = float(plate.mass) * 1e4
        scene.add_force(forces.JointSpring(slide, stiffness, rest=way))
        return plate

    def move(t):
        return (
            0.5 * way * (1.0 - math.cos(rate * t)), 0.5 * way * rate * math.sin(rate * t),
            0.5 * way * rate**2 * math.cos(rate * t),
        )  # fmt: skip

    limit = 3.0 * 9.81 * (float(plate.mass) + float(body.mass)) if kind == "limited" else None
    scene.add_constraint(constraints.Driver(slide, motion=move, limit=limit))
    return plate


def _time_of(room, way, rate):
    """Return a judge of the end of a run: a press with this room to the stack is blocked when it is closed."""
    closed = math.acos(1.0 - 2.0 * room / way) / rate if room < way else math.inf

    def off(s) -> float:
        end = float(s.t[-1])
        if closed > 1.0:
            return 0.0 if end == 1.0 else 2.0
        return 0.0 if closed - EARLY <= end <= closed + LATE else 2.0

    return off
