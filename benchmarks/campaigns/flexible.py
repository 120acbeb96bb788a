"""Flexible bodies: thrown on a floor, at each other, and rigid bodies on beams and plates on supports."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom import flexible
from carom.geometry import quaternion

KINDS = (
    "beam on floor",
    "plate on floor",
    "ball on beam",
    "ball on bar",
    "two bars",
    "box on beam",
)


def case(seed: int) -> Case:
    """Return case number `seed`: kinds and steps in turn, the rest at random."""
    rng = np.random.default_rng([35, seed])
    kind, step = KINDS[seed % len(KINDS)], draw.STEPS[seed // len(KINDS) % 3]
    contact = {
        "restitution": float(rng.choice([0.0, 1.0, rng.uniform(0.1, 0.9)])),
        "friction": float(rng.choice([0.0, rng.uniform(0.05, 1.0)])),
    }
    damping = float(rng.choice([0.0, 0.003, 0.03]))
    scene = carom.Scene(gravity=(0, 0, -9.81))
    label = {"kind": kind, "step": step, "damping": damping, **contact}
    if kind.endswith("on floor"):
        modes, shape = (
            beam(rng, "free", damping) if kind.startswith("beam") else plate(rng, damping)
        )
        height = shape.size * rng.uniform(1.05, 3.0)
        turn = unit(rng)
        body = scene.add_body(
            shape, modes=modes, position=(0, 0, height), orientation=turn,
            angular_velocity=rng.normal(size=3), name="body",
        )  # fmt: skip
        scene.add_contact(body, scene.add_half_space((0, 0, 0), (0, 0, 1)), **contact)
        duration = 2.0 * np.sqrt(2.0 * height / 9.81)
        return Case(scene, duration, step, {**label, "modes": len(modes)}, deep=in_floor)
    if kind in ("ball on beam", "box on beam"):
        ends = str(rng.choice(["clamped", "pinned", "clamped-free", "clamped-pinned"]))
        modes, shape = beam(rng, ends, damping)
        rest = scene.add_static(shape, modes=modes, name="beam")
        mass = modes.mass * 10.0 ** rng.uniform(-1.5, 1.0)
        size = 0.5 * shape.ly
        made = (
            carom.Sphere(size)
            if kind.startswith("ball")
            else carom.Box(*(2.0 * size * rng.uniform(0.4, 1.0, 3)))
        )
        place = rng.uniform(-0.45, 0.45) * shape.lx, 0.0, 0.5 * shape.lz + 1.5 * made.size
        top = scene.add_body(
            made, mass=mass, position=place, velocity=(0, 0, -rng.uniform(0.1, 2.0)), name="top"
        )
        scene.add_contact(top, rest, **contact)
        return Case(scene, 0.1, step, {**label, "modes": len(modes), "ends": ends}, deep=no_depth)
    modes, shape = beam(rng, "free", damping)
    bar = scene.add_body(shape, modes=modes, name="bar")
    gap = 0.01 * shape.lx
    if kind == "ball on bar":
        ball = carom.Sphere(0.5 * shape.ly)
        mass = modes.mass * 10.0 ** rng.uniform(-1.5, 1.0)
        x = -0.5 * shape.lx - gap - ball.radius
        other = scene.add_body(
            ball, mass=mass, position=(x, 0, 0), velocity=(rng.uniform(0.1, 3.0), 0, 0), name="ball"
        )
    else:
        second, its = beam(rng, "free", damping)
        x = -0.5 * shape.lx - gap - 0.5 * its.lx
        other = scene.add_body(
            its,
            modes=second,
            position=(x, 0, 0),
            velocity=(rng.uniform(0.1, 3.0), 0, 0),
            name="second",
        )
    scene.add_contact(other, bar, **contact)
    return Case(scene, 0.02, step, {**label, "modes": len(modes)}, deep=no_depth)


def unit(rng) -> np.ndarray:
    """Return a random attitude."""
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def beam(rng, ends: str, damping: float):
    """Return the modes of a random beam, and its box."""
    length = 10.0 ** rng.uniform(-1.0, 0.3)
    width, height = length * 10.0 ** rng.uniform(-2.0, -0.7, 2)
    density, young = ((7800.0, 210e9), (2700.0, 70e9), (1100.0, 2e9), (600.0, 1e10))[
        rng.integers(4)
    ]
    count = int(rng.integers(1, 31) if rng.random() < 0.8 else rng.integers(31, 61))
    modes = flexible.beam(
        length,
        flexible.Rectangle(width, height),
        density,
        young,
        ends=ends,
        modes=count,
        damping=damping,
    )
    return modes, carom.Box(length, width, height)


def plate(rng, damping: float):
    """Return the modes of a random plate, and its box."""
    length = 10.0 ** rng.uniform(-1.0, 0.0)
    width, height = length * rng.uniform(0.3, 1.0), length * 10.0 ** rng.uniform(-2.0, -1.2)
    modes = flexible.plate(
        length, width, height, 2700.0, 70e9, modes=int(rng.integers(1, 21)), damping=damping
    )
    return modes, carom.Box(length, width, height)


def in_floor(s: carom.Solution) -> float:
    """Return how far corners of the bent body get into the floor, by its size."""
    body = s.scene["body"]
    corners = body.shape.pieces[0].corners
    moved = corners + s["body"].displacement(corners)
    turned = quaternion.rotate(s["body"].orientation[:, None, :], moved)
    height = s["body"].position[:, None, 2] + turned[..., 2]
    return float(max(0.0, -height.min()) / body.shape.size)


def no_depth(s: carom.Solution) -> float:
    """Return 0: nothing tells the depth of bent bodies in each other."""
    return 0.0
