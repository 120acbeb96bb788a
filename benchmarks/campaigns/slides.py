"""A body that slides on a face of 3 to 8 corners: any axes of inertia, slopes, slow and fast, tall and flat."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case

DURATION = 1.5  # [s]: most have come to rest


def case(seed: int) -> Case:
    """Return slide number `seed`: corners and steps in turn, the rest at random."""
    rng = np.random.default_rng([9, seed])
    corners = 3 + seed % 6
    step = draw.STEPS[seed // 6 % 3]
    size, tilt = 10.0 ** rng.uniform(-2.3, -0.5), rng.uniform(0.0, 0.4) * (rng.random() < 0.4)
    body = prism(corners, size, rng)
    mass, mu = 10.0 ** rng.uniform(-3, 1), rng.uniform(0.0, 0.8) * (rng.random() < 0.95)
    scene = carom.Scene(gravity=9.81 * np.array([np.sin(tilt), 0.0, -np.cos(tilt)]))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    low = float(min(point[2] for point in body.points)) - body.radius
    speed = np.sqrt(9.81 * size) * 10.0 ** rng.uniform(-2.0, 0.7)
    turn = np.append(rng.normal(size=2) * speed, rng.normal() * speed / size * (rng.random() < 0.9))
    moving = scene.add_body(
        body, mass=mass, position=(0, 0, -low), velocity=(*turn[:2], 0.0), angular_velocity=(0, 0, turn[2]),
        inertia=inertia(mass, size, rng) if rng.random() < 0.6 else None,
    )  # fmt: skip
    scene.add_contact(moving, ground, restitution=rng.uniform(0.0, 0.9), friction=mu)
    return Case(
        scene,
        DURATION,
        step,
        {"kind": f"{corners} corners", "step": step, "friction": mu, "tilt": tilt},
    )


def prism(corners: int, size: float, rng) -> carom.Convex:
    """Return a prism over points near a circle or an ellipse; some are rounded."""
    angles = 2.0 * np.pi * (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) / corners
    base = np.c_[np.cos(angles), np.sin(angles) * 10.0 ** rng.uniform(-1.3, 0.0)]
    height = 10.0 ** rng.uniform(-1.5, 0.0)
    points = [(x, y, z) for x, y in base for z in (-height / 2, height / 2)]
    rounded = rng.uniform(0.05, 0.2) * size if rng.random() < 0.3 else 0.0
    return carom.Convex(size * np.array(points), radius=rounded)


def inertia(mass: float, size: float, rng) -> np.ndarray:
    """Return a tensor of inertia that some body of that mass and size has, with any axes."""
    points = rng.normal(size=(6, 3)) * rng.uniform(0.1, 0.6, 3)
    points -= points.mean(axis=0)
    spread = points.T @ points / 6.0
    axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return mass * size**2 * axes @ (np.trace(spread) * np.eye(3) - spread) @ axes.T
