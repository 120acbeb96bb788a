"""Stacks, towers, overhanging blocks, cards and arches: some stand, some topple."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case


def case(seed: int) -> Case:
    """Return pile number `seed`: kinds in turn, up to seven bodies."""
    rng = np.random.default_rng([3, seed])
    kind = ("stack", "overhang", "cards", "thrown")[seed % 4]
    step = draw.STEPS[seed // 4 % 3]
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    {"stack": _stack, "overhang": _overhang, "cards": _cards, "thrown": _thrown}[kind](scene, rng)
    e = 0.0 if rng.random() < 0.5 else rng.uniform(0.0, 0.8)
    contact = {
        "restitution": e,
        "friction": rng.uniform(0.1, 1.0),
        "impact_law": draw.LAWS[rng.integers(3)],
    }
    scene.set_contact_default(**contact)
    return Case(
        scene, 0.5, step, {"kind": kind, "step": step, "bodies": len(scene.bodies), **contact}
    )


def _stack(scene, rng) -> None:
    """Boxes on each other, each a little beside the one below."""
    x, z = np.zeros(2), 0.0
    for _ in range(int(rng.integers(2, 8))):
        a, b, c = rng.uniform(0.05, 0.15, 3)
        scene.add_body(
            carom.Box(a, b, c), mass=10.0 ** rng.uniform(-1, 1), position=(*x, z + c / 2)
        )
        x, z = x + rng.uniform(-0.3, 0.3, 2) * min(a, b), z + c


def _overhang(scene, rng) -> None:
    """Blocks over the edge of a block, about as far as they may."""
    length, thick, count, part = 0.2, 0.03, int(rng.integers(1, 5)), rng.uniform(0.95, 1.08)
    scene.add_body(carom.Box(0.4, 0.2, 0.1), mass=50.0, position=(-0.2, 0, 0.05))
    x = -length / 2
    for k in range(count):
        x += part * length / (2 * (count - k))
        scene.add_body(
            carom.Box(length, 0.1, thick), mass=1.0, position=(x, 0, 0.1 + (k + 0.5) * thick)
        )


def _cards(scene, rng) -> None:
    """Two cards that lean against each other."""
    length, thick, lean = 0.09, 0.002, rng.uniform(0.2, 0.6)
    for side in (-1, 1):
        angle = 0.5 * side * lean
        x = side * (0.5 * length * np.sin(lean) + 0.5 * thick * np.cos(lean))
        z = 0.5 * length * np.cos(lean) + 0.5 * thick * np.sin(lean)
        scene.add_body(
            carom.Box(thick, 0.06, length), mass=0.002, position=(x, 0, z),
            orientation=(np.cos(angle), 0, -np.sin(angle), 0),
        )  # fmt: skip


def _thrown(scene, rng) -> None:
    """Two to four bodies of any shape thrown on each other."""
    for k in range(int(rng.integers(2, 5))):
        shape = draw.shape(draw.SHAPES[rng.integers(len(draw.SHAPES))], 0.05, rng)
        q = rng.normal(size=4)
        scene.add_body(
            shape, mass=10.0 ** rng.uniform(-1, 0), position=(*rng.uniform(-0.03, 0.03, 2), 0.12 + 0.25 * k),
            orientation=q / np.linalg.norm(q), velocity=(0, 0, -rng.uniform(0, 3)),
            angular_velocity=rng.normal(size=3) * 5.0,
        )  # fmt: skip
