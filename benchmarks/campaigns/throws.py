"""A body thrown on a floor: ten kinds of shapes, all laws, e from 0 to 1, mu from 0 to 1.5, three steps."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case


def case(seed: int, kind: str | None = None, step: float | None = None) -> Case:
    """Return throw number `seed`: kinds of shapes, laws and steps in turn, the rest at random."""
    rng = np.random.default_rng([1, seed])
    kind = kind or draw.SHAPES[seed % len(draw.SHAPES)]
    step = step or draw.STEPS[seed // len(draw.SHAPES) % 3]
    law = draw.LAWS[seed // (3 * len(draw.SHAPES)) % 3]
    size = 10.0 ** rng.uniform(-2.3, -0.5)
    body = draw.shape(kind, size, rng)
    height = body.size * rng.uniform(1.05, 8.0)
    contact = draw.contact(rng, law)
    scene = carom.Scene(gravity=(0, 0, -9.81))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_contact(draw.thrown(scene, body, height, rng), ground, **contact)
    return Case(scene, 1.0, step, {"kind": kind, "step": step, **contact})
