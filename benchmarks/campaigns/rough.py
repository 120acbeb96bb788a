"""Throws with tangential restitution: balls and boxes alone, in a corner, on each other; e_t from -1 to 1."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw, throws
from campaigns.case import Case


def case(seed: int) -> Case:
    """Return case number `seed`: a thrown body, a ball or box in a corner, and bodies on each other in turn."""
    rng = np.random.default_rng([18, seed])
    contact = {
        "restitution": float(rng.choice([0.0, 1.0, rng.uniform(), rng.uniform()])),
        "friction": rng.uniform(0.0, 3.0), "impact_law": draw.LAWS[rng.integers(3)],
        "tangential_restitution": float(rng.choice([-1.0, 1.0, *rng.uniform(-1.0, 1.0, 3)])),
        "multiple": ("simultaneous", "sequential")[rng.integers(2)],
    }  # fmt: skip
    kind, step = ("alone", "corner", "several")[seed % 3], draw.STEPS[seed // 3 % 3]
    if kind == "alone":
        made = throws.case(seed)
        scene, step = made.scene, made.step
        scene.replace(scene.contacts[0].name, **contact)
    else:
        pull = (
            (-7.0, 0, -7.0) if kind == "corner" else (0, 0, -9.81)
        )  # into the corner: both at once
        scene = carom.Scene(gravity=pull)
        for normal in ((0, 0, 1), (1, 0, 0), (-1, 0, 0))[: 3 if kind == "corner" else 1]:
            scene.add_half_space((-0.3 * normal[0], 0, 0), normal)
        for k in range(1 if kind == "corner" else int(rng.integers(2, 5))):
            _thrown(scene, k, kind == "corner", rng)
        scene.set_contact_default(**contact)
    return Case(scene, 0.6, step, {"kind": kind, "step": step, **contact})


def _thrown(scene, k, corner, rng) -> None:
    """Add a ball or a box: above the last one, or into a corner, half of them towards its edge."""
    size = rng.uniform(0.04, 0.1)
    ball, even = rng.random() < 0.6, rng.random() < 0.5
    shape = carom.Sphere(size / 2) if ball else carom.Box(*(size * rng.uniform(0.5, 1.0, 3)))
    turn = np.array([1.0, 0, 0, 0]) if even else rng.normal(size=4)
    place, velocity = np.array([*rng.uniform(-0.02, 0.02, 2), 0.1 + 0.12 * k]), rng.normal(size=3)
    if corner:
        place = np.array([-0.2, 0.0, 0.1]) + 0.5 * size if even else np.array([-0.1, 0.0, 0.2])
        velocity = np.array([-3.0, rng.normal(), -3.0 if even else rng.normal()])
    scene.add_body(
        shape, mass=10.0 ** rng.uniform(-1, 0.5), position=place, velocity=velocity,
        orientation=turn / np.linalg.norm(turn),
        angular_velocity=(0.0 if even and not ball else 8.0) * rng.normal(size=3),
    )  # fmt: skip
