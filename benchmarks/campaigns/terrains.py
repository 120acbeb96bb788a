"""Bodies thrown onto smooth random terrain."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import DEPTH, Case
from carom.geometry import quaternion

SHAPES = ("sphere", "box", "capsule", "convex", "rod", "compound")


def case(seed: int) -> Case:
    """Return number `seed`: shapes, steps and laws in turn, the rest at random."""
    rng = np.random.default_rng([23, seed])
    name, step = SHAPES[seed % len(SHAPES)], draw.STEPS[seed // len(SHAPES) % 3]
    ground = terrain(rng)
    size = 10.0 ** rng.uniform(-2.0, -0.5)
    if name in ("sphere", "capsule"):
        size = min(size, 0.9 / ground.bend)
    shape = draw.shape(name, size, rng)
    x, y = rng.uniform(-0.3, 0.3, 2) * ground.spacing * ground.heights.shape
    around = shape.size * np.linspace(-1.0, 1.0, 15)
    z = np.max(ground.height(x + around[:, None], y + around))
    z += shape.size * rng.uniform(1.2, 4.0)
    speed = 10.0 ** rng.uniform(-1.0, 0.8)
    scene = carom.Scene(gravity=(0, 0, -9.81))
    hills = scene.add_surface(ground, name="hills")
    body = scene.add_body(
        shape, mass=10.0 ** rng.uniform(-2, 1), position=(x, y, z), orientation=draw.attitude(rng),
        velocity=speed * rng.normal(size=3),
        angular_velocity=rng.normal(size=3) * rng.uniform(0.0, 3.0) * speed / shape.size,
    )  # fmt: skip
    contact = draw.contact(rng, draw.LAWS[seed % 3])
    scene.add_contact(body, hills, **contact)
    return Case(
        scene, 1.0, step, {"shape": name, "step": step, **contact}, lambda s: sunk(s) / DEPTH
    )


def terrain(rng) -> carom.surfaces.HeightField:
    """Return smooth random heights: noise without its short waves."""
    n, spacing = int(rng.integers(8, 25)), rng.uniform(0.1, 0.3)
    waves = np.fft.fftfreq(n)[:, None] ** 2 + np.fft.fftfreq(n) ** 2
    noise = np.fft.fft2(rng.normal(size=(n, n))) * np.exp(-waves * rng.uniform(60, 400))
    heights = np.real(np.fft.ifft2(noise))
    return carom.surfaces.HeightField(
        heights * rng.uniform(0.4, 2.4) * spacing / heights.std(), spacing
    )


def sunk(s: carom.Solution) -> float:
    """Return how far the corners of the body get below the ground, by its size."""
    body, ground = s.scene.bodies[0], s.scene.statics[0].shape
    worst = 0.0
    for piece in body.shape.pieces:
        corners = s.position[:, :1] + quaternion.rotate(s.orientation[:, :1], piece.corners)
        x, y, z = np.moveaxis(corners, -1, 0)  # the height is no less than the distance
        worst = max(worst, float(np.max(piece.radius - (z - ground.height(x, y)))))
    return worst / body.shape.size
