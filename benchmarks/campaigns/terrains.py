"""Bodies thrown onto smooth random terrain."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import DEPTH, Case, points_of
from carom.geometry import quaternion

FOOT = 40  # steps to the foot of a point: they converge where the curvature times the distance is below 1
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
    """Return how far the body gets below the ground, by its size."""
    body, ground = s.scene.bodies[0], s.scene.statics[0].shape
    worst = 0.0
    for piece in body.shape.pieces:
        for point in points_of(piece):
            p = s.position[:, 0] + quaternion.rotate(s.orientation[:, 0], point)
            above = p[:, 2] - ground.height(p[:, 0], p[:, 1])
            near = above <= piece.radius * np.hypot(1.0, ground.steepest)
            if near.any():
                worst = max(worst, float(np.max(piece.radius - distance(ground, p[near]))))
    return worst / body.shape.size


def distance(ground, p: np.ndarray) -> np.ndarray:
    """Return the distance of points (N, 3) from their feet, negative below.

    With g the gradient of the height h, u - x = (z - h(u)) g; (1 + g g^T)^-1 times what is off is a step.
    """
    u, d = p[:, :2].copy(), 1e-4 * np.min(ground.spacing)
    for _ in range(FOOT):
        x, y = u.T
        slope = np.stack([
            ground.height(x + d, y) - ground.height(x - d, y),
            ground.height(x, y + d) - ground.height(x, y - d),
        ], axis=1) / (2.0 * d)  # fmt: skip
        off = u - p[:, :2] - (p[:, 2] - ground.height(x, y))[:, None] * slope
        square = np.sum(slope * slope, axis=1)
        u += slope * (np.sum(slope * off, axis=1) / (1.0 + square))[:, None] - off
    below = p[:, 2] - ground.height(*u.T)
    return np.copysign(np.hypot(np.linalg.norm(p[:, :2] - u, axis=1), below), below)
