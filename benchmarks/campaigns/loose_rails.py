"""Rails that can be left: closed and open, fixed or moving, with bounces, friction and long flights."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom.geometry import quaternion

#: distance from the plane, and below the rail, by the size of the curve
OFF = 1e-9
SAMPLES, LOOKS = 2000, 200  # points of a curve, for the nearest one; saved times


def case(seed: int) -> Case:
    """Return rail number `seed`: a ring with the point inside or outside, or a valley with hills."""
    rng = np.random.default_rng([25, seed])
    step, turn = draw.STEPS[seed % 3], draw.attitude(rng, 0.5)
    if rng.random() < 0.5:  # upright, about the z axis
        turn = np.array([np.cos(0.5 * seed), 0.0, 0.0, np.sin(0.5 * seed)])
    closed, moving = rng.random() < 0.6, rng.random() < 0.35
    moving = closed and moving  # else it would turn a valley over
    points, kind = _ring(rng) if closed else (_valley(rng), "valley")
    if closed and rng.random() < 0.4:
        points, kind = _track(rng), "space"
    curve = carom.curves.Spline(quaternion.rotate(turn, points), closed=bool(closed))
    across = quaternion.rotate(turn, np.array((0.0, 1.0, 0.0)))
    start = rng.uniform(0.3, 0.7) * curve.length
    along = curve.tangent(start)
    side, up = np.cross(along, across), quaternion.rotate(turn, np.array((0.0, 0.0, 1.0)))
    scene = carom.Scene(gravity=(0, 0, -9.81))
    if kind == "inside" or (kind == "valley" and side @ up < 0.0):
        side = -side
    if kind in ("valley", "space"):
        scene = carom.Scene(gravity=-9.81 * up)
    if kind == "space":
        side = up
    parent = carom.GROUND
    if moving:
        middle = curve.ends[:, 0].mean(axis=0)
        parent = scene.add_body(
            mass=10.0 ** rng.uniform(-1, 1), inertia=rng.uniform(0.5, 0.8, 3), position=middle
        )
        scene.add_force(
            carom.forces.Spring(200.0, anchor_parent=middle + (0, 0, 2), anchor_child=middle),
            carom.GROUND,
            parent,
        )
    speed, above = rng.choice((0.0, 1.0, 5.0)) * rng.normal(), rng.choice((0.0, 0.05))
    point = curve.point(start) + above * side
    body = draw.shape(draw.SHAPES[rng.integers(len(draw.SHAPES))], 0.1, rng)
    child = scene.add_body(
        body, mass=10.0 ** rng.uniform(-1, 1), orientation=draw.attitude(rng), velocity=speed * along,
        position=point + rng.choice((0.0, 0.05)) * rng.normal(size=3),
    )  # fmt: skip
    law, e = str(rng.choice(draw.LAWS)), float(rng.choice((0.0, 0.5, 1.0, rng.uniform())))
    mu = float(rng.choice((0.0, rng.uniform())))
    joint = carom.joints.PointOnCurve(
        curve, anchor=point, side=side, restitution=e, friction=mu, impact_law=law
    )
    scene.add_joint(joint, parent, child, name="rail")
    label = {
        "kind": kind, "step": step, "moving": bool(moving), "restitution": e, "friction": mu,
        "impact_law": law,
    }  # fmt: skip
    if kind == "space":
        return Case(scene, 2.0, step, label, lambda s: _off_above(s, curve, side))
    return Case(scene, 2.0, step, label, lambda s: _off(s, curve, across, side))


def _ring(rng):
    """Return the points of a closed curve about the origin in the plane y = 0, and where the point flies."""
    angle = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(5, 11))))
    angle = 0.5 * angle + 0.5 * np.linspace(0, 2 * np.pi, len(angle), endpoint=False)
    r = rng.uniform(0.7, 1.3, len(angle))
    points = np.stack([r * np.sin(angle), 0.0 * r, r * np.cos(angle)], axis=1)
    return points, "outside" if rng.random() < 0.4 else "inside"


def _valley(rng):
    """Return the points of an open curve in the plane y = 0, high at both ends."""
    n = int(rng.integers(7, 14))
    x = np.linspace(-6.0, 6.0, n)
    z = 0.4 * x**2 + rng.uniform(0.0, 0.8) * rng.normal(size=n)
    return np.stack([x, 0.0 * x, z], axis=1)


def _track(rng):
    """Return the points of a closed curve in space, nowhere steeper than some 60 degrees."""
    angle = np.linspace(0, 2 * np.pi, int(rng.integers(6, 12)), endpoint=False)
    r, z = rng.uniform(0.8, 1.2, len(angle)), 0.3 * rng.normal(size=len(angle))
    return np.stack([2 * r * np.cos(angle), 2 * r * np.sin(angle), z], axis=1)


def _places(s: carom.Solution) -> np.ndarray:
    """Return the places (K, 3) of the point in the axes of its rail, at the saved times."""
    joint = s.scene["rail"]
    owner, bead = joint.parent, joint.child
    local = quaternion.rotate_back(bead.orientation, joint.definition.anchor - bead.position)
    place = s.position[:, bead.index] + quaternion.rotate(s.orientation[:, bead.index], local)
    if owner.index >= 0:
        turn = quaternion.multiply(
            s.orientation[:, owner.index], quaternion.conjugate(owner.orientation)
        )
        place = owner.position + quaternion.rotate_back(turn, place - s.position[:, owner.index])
    return place


def _off_above(s: carom.Solution, curve, up) -> float:
    """Return how far the point is beside or below a rail in space, by what is allowed."""
    place, size = _places(s), np.ptp(curve.ends[:, 0], axis=0).max()
    q = s["rail"].coordinate + s.scene["rail"].definition.foot(s.scene["rail"].definition.anchor)
    away = place - curve.point(q)
    height = away @ up
    beside = np.linalg.norm(away - height[:, None] * up, axis=1)
    return float(max(np.max(beside), np.max(-height)) / size / OFF)


def _off(s: carom.Solution, curve, across, side) -> float:
    """Return how far the point is out of the plane or beyond the rail, by what is allowed."""
    joint, place = s.scene["rail"], _places(s)
    bead, size = joint.child, np.ptp(curve.ends[:, 0], axis=0).max()
    worst = np.max(np.abs((place - curve.point(0.0)) @ across))
    samples = np.linspace(0.0, curve.length, SAMPLES)
    x = curve.point(samples)
    free = np.cross(curve.tangent(curve.nearest(joint.definition.anchor)), across) @ side
    chosen = np.unique(np.linspace(0, len(place) - 1, LOOKS).astype(int))
    for p in place[chosen]:
        near = samples[np.argmin(np.sum((x - p) ** 2, axis=1))]
        for _ in range(4):
            c, t, b = curve._at(np.array(near))
            near = near + (p - c) @ t / max(1.0 - (p - c) @ b, 0.2)
        c, t, _ = curve._at(np.array(near))
        worst = max(worst, -np.sign(free) * (np.cross(t, across) @ (p - c)))
    near = [np.sqrt(np.min(np.sum((x - p) ** 2, axis=1))) for p in place[chosen]]
    gap = np.max(np.abs(s[f"{bead.name}-rail"].gap[chosen] - near))
    return float(max(worst / size / OFF, gap / size / 1e-3))
