"""Crowds: what is poured, a row that is struck, a wall that is struck, bodies joined or loaded among others."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case

KINDS = ("poured", "row", "wall", "joined", "loaded", "break")
STEPS = (1e-3, 1e-4, 5e-3)
SIZE = 0.03  # about half of a body [m]


def case(seed: int) -> Case:
    """Return crowd number `seed`: kinds in turn, 2 to 60 bodies."""
    rng = np.random.default_rng([4, seed])
    kind = KINDS[seed % len(KINDS)]
    step = STEPS[seed // len(KINDS) % len(STEPS)]
    scene = carom.Scene(gravity=(0, 0, -9.81))
    count = int(2 + 58 * rng.random() ** 2)
    {
        "poured": _poured, "row": _row, "wall": _wall, "joined": _joined, "loaded": _loaded,
        "break": _break,
    }[kind](scene, count, rng)  # fmt: skip
    contact = draw.contact(rng)
    contact["friction"] = min(contact["friction"], 1.2)
    scene.set_contact_default(**contact)
    label = {"kind": kind, "step": step, "bodies": len(scene.bodies), **contact}
    return Case(scene, 0.02 if step == 1e-4 else 0.3, step, label)


def _poured(scene, count, rng, still=False) -> list:
    """Bodies of any shape above each other in a box without a lid, all in reach of each other; return them."""
    side = SIZE * max(2.5, 1.5 * count ** (1 / 3))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for normal in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)):
        scene.add_half_space(-side * np.array(normal), normal)
    across = max(1, int((side - 0.5 * SIZE) / (1.2 * SIZE)))
    places = [
        (x, y) for x in np.linspace(-1, 1, across) for y in np.linspace(-1, 1, across)
    ] if across > 1 else [(0.0, 0.0)]  # fmt: skip
    kinds = draw.SHAPES if rng.random() < 0.5 else (draw.SHAPES[rng.integers(len(draw.SHAPES))],)
    bodies = []
    for k in range(count):
        x, y = places[k % len(places)]
        shape = draw.shape(kinds[rng.integers(len(kinds))], 0.5 * SIZE, rng)
        reach = side - 1.1 * SIZE
        place = (reach * x, reach * y, 1.2 * SIZE * (1 + 2 * (k // len(places))))
        bodies.append(
            scene.add_body(
                shape, mass=10.0 ** rng.uniform(-2, 0), position=place,
                orientation=draw.attitude(rng), velocity=(0, 0, 0 if still else -rng.uniform(0, 2)),
                angular_velocity=rng.normal(size=3) * (0 if still else 3.0),
            )
        )  # fmt: skip
    return bodies


def _row(scene, count, rng) -> None:
    """Balls or boxes in a row, touching or nearly, struck by the first."""
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    gap = (0.0, 1e-6, 1e-4)[rng.integers(3)]
    ball = rng.random() < 0.7
    count = min(count, 20)
    for k in range(count):
        mass = 10.0 ** rng.uniform(-1, 1) if rng.random() < 0.2 else 1.0
        shape = carom.Sphere(SIZE) if ball else carom.Box(2 * SIZE, 2 * SIZE, 2 * SIZE)
        struck = k > 0
        scene.add_body(
            shape, mass=mass, position=(k * (2 * SIZE + gap) - (0 if struck else 1e-3), 0, SIZE),
            velocity=(0 if struck else rng.uniform(0.1, 5), 0, 0),
        )  # fmt: skip


def _wall(scene, count, rng) -> None:
    """A wall of bricks, struck by a free ball or by one on a pendulum."""
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    wide = int(rng.integers(1, 5))
    a, b, c = 0.2, 0.1, 0.1
    rows = max(1, min(count, 24) // wide)
    for i in range(rows):
        for j in range(wide):
            y = (j + 0.5 * (i % 2) - 0.5 * wide) * (a + 1e-4)
            scene.add_body(carom.Box(b, a, c), mass=3.0, position=(0, y, (i + 0.5) * c))
    height = rows * c * rng.uniform(0.4, 1.0)
    hangs, speed = rng.random() < 0.5, rng.uniform(0.5, 6)
    ball = scene.add_body(
        carom.Sphere(0.08), mass=10.0 ** rng.uniform(0, 1.5), position=(-0.25, 0, max(height, 0.09)),
        velocity=(speed, 0, 0), angular_velocity=(0, -speed / 2.0 if hangs else 0, 0),
    )  # fmt: skip
    if hangs:
        top = (-0.25, 0, max(height, 0.09) + 2.0)
        scene.add_joint(carom.joints.Spherical(anchor=top), carom.GROUND, ball)


def _joined(scene, count, rng) -> None:
    """Poured bodies, some of them joined in pairs."""
    bodies = _poured(scene, min(count, 16), rng, still=True)
    for k in range(0, len(bodies) - 1, 2):
        if rng.random() < 0.6:
            a, b = (np.asarray(bodies[i].position) for i in (k, k + 1))
            anchor = tuple(0.5 * (a + b))
            kind = rng.integers(3)
            joint = (
                carom.joints.Spherical(anchor=anchor),
                carom.joints.Revolute(anchor=anchor, axis=tuple(draw.attitude(rng)[1:] + 1e-3)),
                carom.joints.Fixed(anchor=anchor),
            )[kind]
            scene.add_joint(joint, bodies[k], bodies[k + 1])
            scene.ignore_contact(bodies[k], bodies[k + 1])


def _loaded(scene, count, rng) -> None:
    """Poured bodies, some on springs to the next."""
    bodies = _poured(scene, min(count, 16), rng)
    for k in range(len(bodies) - 1):
        if rng.random() < 0.4:
            mass = min(bodies[k].mass, bodies[k + 1].mass)
            spring = carom.forces.Spring(
                mass * 10.0 ** rng.uniform(1, 4), bodies[k].position, bodies[k + 1].position,
                rng.uniform(0.5, 3) * SIZE, mass * rng.uniform(0, 10),
            )  # fmt: skip
            scene.add_force(spring, bodies[k], bodies[k + 1])


def _break(scene, count, rng) -> None:
    """A triangle of balls, struck by one; on a table, or in space."""
    table = rng.random() < 0.5
    if table:
        scene.add_half_space((0, 0, 0), (0, 0, 1))
    rows = int(rng.integers(2, 6))
    gap = (0.0, 1e-5, 1e-3)[rng.integers(3)]
    r = 0.0286
    for i in range(rows):
        for j in range(i + 1):
            place = (i * np.sqrt(3) * (r + gap / 2), (2 * j - i) * (r + gap / 2), r)
            scene.add_body(carom.Sphere(r), mass=0.17, position=place)
    scene.add_body(
        carom.Sphere(r), mass=0.17, position=(-0.1, rng.choice((0.0, rng.uniform(-0.02, 0.02))), r),
        velocity=(rng.uniform(0.5, 8), 0, 0), angular_velocity=rng.normal(size=3) * (10.0 if table else 0.0),
    )  # fmt: skip
