"""Cams, convex or not, with flat, round and swinging followers; ratchets; rollers and blocks on profiles."""

from __future__ import annotations

import math

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom.geometry import quaternion

KINDS = ("flat", "roller", "swing", "ratchet", "bumps")
DURATION = 0.5  # [s]
INSIDE = 1e-6  # depth that is wrong, by the size of the cam


def case(seed: int) -> Case:
    """Return cam number `seed`: kinds and steps in turn."""
    rng = np.random.default_rng([23, seed])
    kind, step = KINDS[seed % len(KINDS)], draw.STEPS[seed // len(KINDS) % 3]
    scene = carom.Scene(gravity=(0, -9.81, 0))
    law = {
        "restitution": float(rng.choice([0.0, 1.0, rng.uniform(0.0, 1.0)])),
        "friction": float(rng.choice([0.0, rng.uniform(0.0, 1.0)])),
        "impact_law": str(rng.choice(draw.LAWS)),
    }
    made = {"ratchet": _ratchet, "bumps": _bumps}.get(kind, _follower)
    pairs = made(scene, kind, law, rng)
    label = {"kind": kind, "step": step, **law}
    return Case(scene, DURATION, step, label, lambda s: max(_off(s, *pair) for pair in pairs))


def outline(rng, size: float, hollow: float):
    """Return a periodic function of the angle: a cam with some lobes."""
    lobes = rng.integers(1, 6, 3)
    parts = hollow * rng.uniform(-1, 1, 3) / (3.0 + lobes**2)
    phase = rng.uniform(0, 6, 3)
    return lambda a: size * (1.0 + float(np.sum(parts * np.cos(lobes * a + phase))))


def _highest(shape: carom.Profile, x: float, low: float, high: float) -> float:
    """Return the height of the curve, in its axes of `outline`, between two places."""
    points = shape.points(2000) + shape.centroid[:2]
    there = points[(points[:, 0] >= low + x) & (points[:, 0] <= high + x)]
    return float(np.max(there[:, 1], initial=0.0))


def _cam(scene, shape, rng, driven=True):
    """Add a cam that turns about z through the origin: driven, by a torque, or by itself."""
    rate = float(rng.choice([-1, 1])) * 10.0 ** rng.uniform(0.0, 1.7)
    x, y = shape.centroid[:2]
    cam = scene.add_body(
        shape, mass=10.0 ** rng.uniform(-1, 1), position=shape.centroid, name="cam",
        velocity=(-rate * y, rate * x, 0), angular_velocity=(0, 0, rate),
    )  # fmt: skip
    axle = scene.add_joint(
        carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 0, 1)), carom.GROUND, cam, name="axle"
    )
    drive = rng.integers(0 if driven else 1, 3)
    if drive == 0:
        scene.add_constraint(carom.constraints.Driver(axle, rate=rate))
    elif drive == 1:
        scene.add_force(carom.forces.Torque((0, 0, float(rng.normal()))), carom.GROUND, cam)
    return cam


def _follower(scene, kind, law, rng):
    """Add a cam and a follower: a flat face, a roller, or a swinging arm with a roller or a flat face."""
    shape = carom.Profile(
        outline(rng, 0.05, rng.choice([0.5, 1.5])), thickness=rng.uniform(0.005, 0.03)
    )
    cam = _cam(scene, shape, rng)
    r, width = rng.uniform(0.004, 0.02), rng.uniform(0.05, 0.2)
    if kind == "flat" or (kind == "swing" and rng.random() < 0.5):
        piece, half, reach = carom.Box(width, 0.01, 0.02), 0.005, 0.5 * width
    else:
        piece, half, reach = carom.Cylinder(r, 0.02), r, r
    if kind == "roller" and rng.random() < 0.4:
        piece = carom.Sphere(r) if rng.random() < 0.5 else carom.Capsule(r, 0.02)
    x = float(rng.choice([0.0, rng.uniform(-0.01, 0.01)]))
    y = _highest(shape, x, -reach, reach) + half + float(rng.choice([1e-4, 0.01]))
    rod = scene.add_body(
        piece, mass=10.0 ** rng.uniform(-2, 1), position=(x, y, 0), name="follower"
    )
    if kind == "swing":
        away = float(rng.choice([-1, 1])) * 0.15
        joint = carom.joints.Revolute(anchor=(x + away, y, 0), axis=(0, 0, 1))
    else:
        joint = carom.joints.Prismatic(axis=(0, 1, 0))
    guide = scene.add_joint(joint, carom.GROUND, rod, name="guide")
    if rng.random() < 0.5:
        stiffness = 10.0 ** rng.uniform(1, 4) * (0.15**2 if kind == "swing" else 1.0)
        scene.add_force(
            carom.forces.JointSpring(guide, stiffness=stiffness, damping=0.01 * stiffness**0.5)
        )
    scene.add_contact(rod, cam, **law)
    return [(shape, "cam", piece, "follower")]


def _ratchet(scene, kind, law, rng):
    """Add a ratchet wheel and a pawl that falls into it."""
    n, r = int(rng.integers(6, 16)), 0.05
    height = r * rng.uniform(0.1, 0.25)
    points = []
    for k in range(n):
        a = 0.5 * math.pi + 2.0 * math.pi * k / n
        points += [(q * math.cos(a), q * math.sin(a)) for q in (r, r + height)]
    wheel = carom.Profile(points, 0.01, corners="all")
    cam = _cam(scene, wheel, rng, driven=False)  # a drive against the pawl has no solution
    length, thick, turn = 0.08, 0.4 * height, 0.3
    pawl = (
        carom.Box(length, thick, 0.01)
        if rng.random() < 0.7
        else carom.Box(length, thick, 0.01, radius=0.3 * thick)
    )
    tip = np.array([0.6 * height, r + 0.3 * height])
    c, s = math.cos(turn), math.sin(turn)
    middle = tip + 0.5 * np.array([c * length - s * thick, s * length + c * thick])
    arm = scene.add_body(
        pawl, mass=10.0 ** rng.uniform(-2, 0), position=(*middle, 0),
        orientation=carom.euler("z", math.degrees(turn)),
        name="follower",
    )  # fmt: skip
    pivot = (*(tip + length * np.array([c, s]) + (0, 0.01)), 0)
    scene.add_joint(
        carom.joints.Revolute(anchor=pivot, axis=(0, 0, 1)), carom.GROUND, arm, name="guide"
    )
    scene.add_contact(arm, cam, **law)
    return [(wheel, "cam", pawl, "follower")]


def _bumps(scene, kind, law, rng):
    """Add a profile at rest, with bodies in its plane above it."""
    ground = carom.Profile(outline(rng, 0.3, rng.choice([0.5, 1.5])), thickness=0.1)
    scene.add_static(ground, position=ground.centroid, name="cam")
    pairs, top = [], _highest(ground, 0.0, -0.4, 0.4)
    for k in range(int(rng.integers(1, 3))):
        size = rng.uniform(0.01, 0.06)
        which = rng.integers(3)
        piece = (carom.Cylinder(size, 0.05), carom.Box(2 * size, size, 0.05), carom.Sphere(size))[
            which
        ]
        name = f"body {k}"
        body = scene.add_body(
            piece, mass=10.0 ** rng.uniform(-1, 1), name=name,
            orientation=carom.euler("z", rng.uniform(0, 360)),
            position=(rng.uniform(-0.1, 0.1), top + 0.08 + 0.15 * k, 0), velocity=(rng.normal(), 0, 0),
            angular_velocity=(0, 0, 3.0 * rng.normal()),
        )  # fmt: skip
        scene.add_joint(
            carom.joints.Planar(normal=(0, 0, 1)), carom.GROUND, body, name=f"plane {k}"
        )
        scene.add_contact(body, "cam", **law)
        pairs.append((ground, "cam", piece, name))
    return pairs


def _off(s: carom.Solution, shape, cam: str, piece, name: str) -> float:
    """Return how deep points of the curve are in a body at saved times, by what is wrong."""
    points = np.column_stack([shape.points(3000), np.zeros(0 + len(shape.points(3000)))])
    worst, body = 0.0, s[name]
    for k in range(0, len(s.t), max(1, len(s.t) // 40)):
        if s.scene[cam] in s.scene.statics:
            x, q = s.scene[cam].position, s.scene[cam].orientation
        else:
            x, q = s[cam].position[k], s[cam].orientation[k]
        own = quaternion.rotate_back(
            body.orientation[k], x + quaternion.rotate(q, points) - body.position[k]
        )
        if isinstance(piece, carom.Box):
            core = np.array([piece.lx, piece.ly]) / 2 - piece.radius
            out = np.abs(own[:, :2]) - core
            depth = piece.radius - (
                np.linalg.norm(np.maximum(out, 0.0), axis=1) + np.minimum(np.max(out, axis=1), 0.0)
            )
        else:
            depth = piece.radius - np.linalg.norm(own[:, :2], axis=1)
        worst = max(worst, float(np.max(depth)))
    return worst / (INSIDE * shape.size)
