"""Ropes that rub on posts and wheels, with whole turns and slack, or stretch; loads swing, run out or hold."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case


def case(seed: int) -> Case:
    """Return rope number `seed`: a load, a guide on which it rubs, perhaps another one, and its other end."""
    rng = np.random.default_rng([71, seed])
    scene = carom.Scene(gravity=(0, 0, -9.81))
    stretches, more = rng.random() < 0.25, rng.random() < 0.3
    over = [_load(scene, rng, -0.6), _guide(scene, rng, 0.0, 0.0 if stretches else None)]
    if more:  # beneath a second guide, over which it slips freely, or which it turns
        over.append(_guide(scene, rng, 1.0, 0.0 if rng.random() < 0.5 else np.nan))
    end = 1.6 if more else 0.6
    over.append(_load(scene, rng, end) if rng.random() < 0.7 else (carom.GROUND, (end, 0, -1.0)))
    e = 0.0 if stretches else float(rng.choice([0.0, 0.0, 0.5, 1.0]))
    k = 10.0 ** rng.uniform(2, 4) if stretches else None
    damping = float(rng.choice([0.0, 2.0])) if stretches else 0.0
    law = str(rng.choice(["poisson", "stronge"])) if e == 1.0 else None  # the default: no gain
    rope = scene.add_rope(over, stiffness=k, damping=damping, restitution=e, impact_law=law)
    if rope.stops and rng.random() < 0.4:  # laid once more, with some slack
        stop = rope.stops[0]
        scene.replace(stop.name, upper=stop.upper + rng.uniform(0.0, 0.3))
    step = draw.STEPS[seed % 3]
    label = {
        "kind": "stretches" if stretches else "rubs",
        "step": step,
        "restitution": e,
        "more": more,
        "impact_law": law,
    }
    return Case(scene, 0.4, step, label)  # before a load is pulled up to its guide


def _load(scene, rng, x: float):
    """Add a load that hangs at x, and moves."""
    return scene.add_body(
        carom.Sphere(0.05), mass=10.0 ** rng.uniform(-0.4, 0.4), position=(x, 0, -rng.uniform(0.6, 1.5)),
        velocity=(rng.normal(), 0, rng.normal()) if rng.random() < 0.5 else (0, 0, 0),
    )  # fmt: skip


def _guide(scene, rng, x: float, friction: float | None):
    """Add a post or a wheel; with friction drawn, given, or without slip (NaN)."""
    radius, below = float(10.0 ** rng.uniform(-1.5, -0.6)), x > 0.0
    axis, place = (0, -1 if below else 1, 0), (x, 0, -0.7 if below else 0.0)
    turns = int(rng.choice([0, 0, 1])) if friction is None else 0
    mu = float(rng.uniform(0.05, 0.6)) if friction is None else friction
    if rng.random() < 0.5 and not np.isnan(mu):
        return carom.Pulley(carom.GROUND, radius, axis, friction=mu, center=place, turns=turns)
    wheel = scene.add_body(
        carom.Cylinder(radius, 0.02), mass=10.0 ** rng.uniform(-1, 1), position=place,
        orientation=carom.euler("x", 90), angular_velocity=(0, 10.0 * rng.normal() * (rng.random() < 0.5), 0),
    )  # fmt: skip
    scene.add_joint(carom.joints.Revolute(place, (0, 1, 0)), carom.GROUND, wheel)
    return carom.Pulley(wheel, radius, axis, friction=None if np.isnan(mu) else mu, turns=turns)
