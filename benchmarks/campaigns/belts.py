"""Bodies thrown and slid on surfaces that move in themselves: belts, turntables, rollers, by time too."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case

DURATION = 0.6  # [s]
KINDS = ("belt", "turntable", "shaken belt", "rollers", "slab")


def case(seed: int) -> Case:
    """Return number `seed`: kinds of surfaces and steps in turn, the rest at random."""
    rng = np.random.default_rng([21, seed])
    kind, step = KINDS[seed % len(KINDS)], draw.STEPS[seed // len(KINDS) % 3]
    scene, size, speed = carom.Scene(), 0.1, 10.0 ** rng.uniform(-1.5, 0.7)
    surfaces(scene, kind, speed, rng)
    shape = draw.shape(rng.choice(draw.SHAPES), size, rng)
    for k in range(1 + seed % 3):
        scene.add_body(
            shape, mass=10.0 ** rng.uniform(-1, 1),
            position=(*(0.1 * rng.normal(size=2)), 0.25 + 0.3 * k),
            orientation=draw.attitude(rng),
            velocity=0.5 * rng.normal(size=3), angular_velocity=3.0 * rng.normal(size=3),
        )  # fmt: skip
    scene.set_contact_default(
        friction=rng.uniform(0.0, 0.9), restitution=rng.choice([0.0, rng.uniform(0.0, 0.9)]),
        rolling_friction=rng.choice([0.0, 1e-3]), pivoting_friction=rng.choice([0.0, 1e-3]),
    )  # fmt: skip
    return Case(scene, DURATION, step, {"kind": kind, "step": step, "speed": speed})


def surfaces(scene: carom.Scene, kind: str, speed: float, rng) -> None:
    """Add the moving surfaces, level with z = 0."""
    way = rng.uniform(0.0, 2.0 * np.pi)
    along = speed * np.array([np.cos(way), np.sin(way), 0.0])
    if kind == "belt":
        scene.add_half_space((0, 0, 0), (0, 0, 1), surface_velocity=along)
    elif kind == "turntable":
        scene.add_half_space(
            (0, 0, 0), (0, 0, 1), surface_spin=((0, 0, 1), 3.0 * speed, (0.1, 0, 0))
        )
    elif kind == "shaken belt":
        w = rng.uniform(5.0, 30.0)
        scene.add_half_space(
            (0, 0, 0), (0, 0, 1),
            surface_velocity=lambda t: (along * np.sin(w * t), along * w * np.cos(w * t)),
        )  # fmt: skip
    elif kind == "rollers":
        scene.add_half_space((0, 0, -1), (0, 0, 1))
        for k in range(-4, 5):
            scene.add_static(
                carom.Cylinder(0.1, 3.0), position=(0.21 * k, 0, -0.1), orientation=carom.euler("x", 90),
                surface_spin=((0, 1, 0), 10.0 * speed * rng.choice([-1, 1])),
            )  # fmt: skip
    else:
        scene.add_static(carom.Box(4, 4, 0.2), position=(0, 0, -0.1), surface_velocity=along)
        scene.add_half_space((0, 0, -1), (0, 0, 1))
