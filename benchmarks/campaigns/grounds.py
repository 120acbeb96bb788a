"""Bodies thrown into bowls, pipes, cans, funnels and bent tubes: all shapes that may touch them."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import DEPTH, Case, points_of
from carom.collision.api import nearest_points
from carom.geometry import quaternion

KINDS = ("bowl", "pipe", "can", "funnel", "tube")
SHAPES = ("sphere", "box", "capsule", "ellipsoid", "rod", "convex", "sphere", "plate", "compound")
LOOKS = 60  # saved times at which ellipsoids are looked at
S = carom.surfaces


def case(seed: int) -> Case:
    """Return number `seed`: kinds of ground, shapes and steps in turn, the rest at random."""
    rng = np.random.default_rng([22, seed])
    kind = KINDS[seed % len(KINDS)]
    name = SHAPES[seed // len(KINDS) % len(SHAPES)]
    step = draw.STEPS[seed // (len(KINDS) * len(SHAPES)) % 3]
    size = 10.0 ** rng.uniform(-2.0, -0.5)
    room = size * 10.0 ** rng.uniform(0.45, 1.5)  # radius of the ground
    shape = draw.shape(name, size, rng)
    if name == "ellipsoid":
        while max(shape.pieces[0].half) ** 2 / min(shape.pieces[0].half) > 0.8 * room:
            shape = carom.Ellipsoid(*(size * rng.uniform(0.5, 1.0, 3)))
    ground, place = surface(kind, room, shape.size, rng)
    if kind == "funnel" and name == "ellipsoid":
        shape = carom.Sphere(size)
        ground, place = surface(kind, room, shape.size, rng)
    scene = carom.Scene(gravity=(0, 0, -9.81))
    at, turn = rng.normal(size=3), draw.attitude(rng) if kind != "funnel" else (1.0, 0, 0, 0)
    wall = scene.add_surface(ground, position=at, orientation=turn)
    speed = np.sqrt(2.0 * 9.81 * room) * 10.0 ** rng.uniform(-1.5, 0.5)
    body = scene.add_body(
        shape, mass=10.0 ** rng.uniform(-2, 1),
        position=at + quaternion.rotate(np.array(turn), place), orientation=draw.attitude(rng),
        velocity=speed * rng.normal(size=3),
        angular_velocity=rng.normal(size=3) * rng.uniform(0.0, 3.0) * speed / size,
    )  # fmt: skip
    contact = draw.contact(rng, draw.LAWS[seed % 3])
    turning = rng.choice([0.0, 1e-2], 2) * size
    scene.add_contact(
        body, wall, **contact, rolling_friction=turning[0], pivoting_friction=turning[1]
    )
    label = {"kind": kind, "shape": name, "step": step, **contact}
    return Case(scene, 1.0, step, label, lambda s: sunk(s, wall) / DEPTH)


def surface(kind: str, room: float, size: float, rng):
    """Return a surface, and a place in its axes at which a body of this size fits."""
    left = room - 1.01 * size
    inside = rng.normal(size=3)
    inside *= left * rng.random() / np.linalg.norm(inside)
    if kind == "bowl":
        return S.InsideSphere(room), inside
    if kind == "pipe":
        return S.InsideCylinder(room), inside
    if kind == "can":
        return S.InsideCylinder(room, length=2.0 * room), inside * (0.7, 0.7, 0.7)
    if kind == "funnel":
        angle = rng.uniform(0.3, 1.3)
        height = rng.uniform(1.05, 4.0) * size / np.sin(angle)
        return S.InsideCone(angle), np.array([0, 0, height])
    radius, way = room * rng.uniform(1.5, 6.0), rng.uniform(0, 2 * np.pi)
    ring = np.array([np.cos(way), np.sin(way), 0.0])
    across = inside[0] * ring + np.array([0, 0, inside[1]])
    return S.InsideTorus(radius, room), radius * ring + 0.7 * across


def height(ground, p: np.ndarray) -> np.ndarray:
    """Return the distance of points (..., 3) from a surface, in its axes."""
    z, across = p[..., 2], np.hypot(p[..., 0], p[..., 1])
    if isinstance(ground, S.InsideSphere):
        return ground.radius - np.linalg.norm(p, axis=-1)
    if isinstance(ground, S.InsideCylinder):
        ends = np.inf if ground.length is None else 0.5 * ground.length
        return np.minimum(ground.radius - across, ends - np.abs(z))
    if isinstance(ground, S.InsideCone):
        return np.sin(ground.half_angle) * z - np.cos(ground.half_angle) * across
    return ground.tube_radius - np.hypot(across - ground.radius, z)


def sunk(s: carom.Solution, wall) -> float:
    """Return how far the body gets into the ground, by its size."""
    body, worst = s.scene.bodies[0], 0.0
    for piece in body.shape.pieces:
        if piece.kind == "ellipsoid":
            for k in np.unique(np.linspace(0, len(s.t) - 1, LOOKS).astype(int)):
                pose = s.position[k, 0], s.orientation[k, 0]
                near = nearest_points(
                    body.shape, pose, wall.shape, (wall.position, wall.orientation)
                )
                worst = max(worst, -near.gap)
            continue
        for corner in points_of(piece):
            world = s.position[:, 0] + quaternion.rotate(s.orientation[:, 0], corner)
            own = quaternion.rotate_back(wall.orientation, world - wall.position)
            worst = max(worst, float(np.max(piece.radius - height(wall.shape, own))))
    return worst / body.shape.size
