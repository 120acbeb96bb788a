"""Ropes over one to three pulleys, on wheels that turn or not, with loads that swing; some begin slack."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case


def case(seed: int) -> Case:
    """Return rope number `seed`: a load, pulleys above in a row, and a load or a point of the ground."""
    rng = np.random.default_rng([46, seed])
    step, count = draw.STEPS[seed % 3], int(rng.integers(1, 4))
    scene = carom.Scene(gravity=(0, 0, -9.81))
    over, label = (
        [_load(scene, rng, -0.6)],
        {"kind": f"{count} pulleys", "step": step, "wheels": []},
    )
    for k in range(count):
        over.append(_pulley(scene, rng, k, label))
    end = 1.0 * count - 0.4
    over.append(_load(scene, rng, end) if rng.random() < 0.7 else (carom.GROUND, (end, 0, -1.0)))
    rope = scene.add_rope(over, restitution=(e := float(rng.choice([0.0, 0.0, 0.5, 1.0]))))
    if rng.random() < 0.4:  # laid once more, with some slack
        stop = rope.stops[0]
        scene.replace(stop.name, upper=stop.upper + rng.uniform(0.0, 0.5))
    label.update(restitution=e, bodies=len(scene.bodies))
    return Case(scene, 0.5, step, label)  # before a load is pulled up to its pulley


def _load(scene, rng, x: float):
    """Add a load that hangs at x, and moves."""
    return scene.add_body(
        carom.Sphere(0.05), mass=10.0 ** rng.uniform(-0.4, 0.4), position=(x, 0, -rng.uniform(0.5, 1.5)),
        velocity=(rng.normal(), 0, rng.normal()) if rng.random() < 0.5 else (0, 0, 0),
    )  # fmt: skip


def _pulley(scene, rng, k: int, label: dict):
    """Add a wheel, or a pulley of the ground; every second one is below, and the rope goes under it."""
    radius, below = float(10.0 ** rng.uniform(-1.5, -0.6)), k % 2 == 1
    axis, place = (0, -1 if below else 1, 0), (1.0 * k, 0, -0.7 if below else 0.0)
    kind = ("ground", "slips", "turns")[rng.integers(3)]
    label["wheels"].append(kind)
    if kind == "ground":
        return carom.Pulley(carom.GROUND, radius, axis, center=place)
    wheel = scene.add_body(
        carom.Cylinder(radius, 0.02), mass=10.0 ** rng.uniform(-1, 1), position=place,
        orientation=carom.euler("x", 90),
    )  # fmt: skip
    scene.add_joint(carom.joints.Revolute(place, (0, 1, 0)), carom.GROUND, wheel)
    return carom.Pulley(wheel, radius, axis, friction=0.0 if kind == "slips" else None)
