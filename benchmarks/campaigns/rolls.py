"""A body thrown on a floor with rolling and pivoting friction: ten kinds of shapes, for two seconds."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case


def case(seed: int) -> Case:
    """Return roll number `seed`: kinds of shapes and steps in turn, the rest at random."""
    rng = np.random.default_rng([8, seed])
    kind = draw.SHAPES[seed % len(draw.SHAPES)]
    step = draw.STEPS[seed // len(draw.SHAPES) % 3]
    body = draw.shape(kind, 10.0 ** rng.uniform(-2.3, -0.5), rng)
    height = body.size * rng.uniform(1.05, 3.0)
    contact = draw.contact(rng) | {"restitution": rng.uniform(0.0, 0.8)}
    # one of the two is absent in some scenes; both are lengths
    turning = body.size * 10.0 ** rng.uniform(-4.0, -1.0, 2) * (rng.random(2) < 0.8)
    contact |= {"rolling_friction": turning[0], "pivoting_friction": turning[1]}
    scene = carom.Scene(gravity=(0, 0, -9.81))
    tilt = rng.uniform(0.0, 0.2) * (rng.random() < 0.3)  # a ramp
    ground = scene.add_half_space((0, 0, 0), (np.sin(tilt), 0, np.cos(tilt)))
    scene.add_contact(draw.thrown(scene, body, height, rng), ground, **contact)
    return Case(scene, 2.0, step, {"kind": kind, "step": step, **contact})
