"""Shapes and poses of pairs, and an independent judge of nearest points."""

from itertools import product
from typing import NamedTuple

import numpy as np
from hypothesis import strategies as st

from carom.collision.layout import Placed, new_pair_work, new_points, solid_table
from carom.collision.touch import touch
from carom.geometry import quaternion
from carom.scene import Box, Capsule, Convex, Cylinder, Disc, Ellipsoid, Sphere

_rng = np.random.default_rng(3)
SHAPES = {
    "sphere": Sphere(0.3),
    "capsule": Capsule(0.2, 0.7),
    "box": Box(0.4, 0.5, 0.9),
    "rounded box": Box(0.4, 0.5, 0.9, radius=0.1),
    "convex": Convex(_rng.normal(size=(12, 3)) * 0.3),
    "rounded convex": Convex(_rng.normal(size=(8, 3)) * 0.2, radius=0.1),
    "cylinder": Cylinder(0.3, 0.6),
    "disc": Disc(0.4),
    "ellipsoid": Ellipsoid(0.2, 0.3, 0.5),
}
NAMES = tuple(SHAPES)
DIRECTIONS = _rng.normal(size=(300, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]


class Pose(NamedTuple):
    x: np.ndarray
    q: np.ndarray


ORIGIN = Pose(np.zeros(3), np.array([1.0, 0, 0, 0]))


class Touch(NamedTuple):
    """Points of a contact, and the one with the least gap."""

    points: np.recarray
    gap: float
    normal: np.ndarray
    on_a: np.ndarray
    on_b: np.ndarray


def touching(a, b, pose_a, pose_b=ORIGIN, reach=0.0):
    solids, hulls = solid_table([a, b])
    out = new_points()
    first, second = (Pose(np.array(p.x, float), np.array(p.q, float)) for p in (pose_a, pose_b))
    placed = Placed(solids[0], *first), Placed(solids[1], *second)
    count = touch(*placed, hulls, reach, new_pair_work(), out)
    points = out[:count]
    k = int(np.argmin(points.gap))
    return Touch(points, points.gap[k], points.normal[k], points.on_a[k], points.on_b[k])


def contact_points(a, b, pose_a, pose_b, reach):
    """The points of two shapes, of all their pieces: gaps up to the least of two pieces plus `reach`."""
    solids, hulls = solid_table([a, b])
    work, out, found = new_pair_work(), new_points(), []

    def placed(solid, pose):
        x = pose[0] + quaternion.rotate(pose[1], solid.x)
        return Placed(solid, x, quaternion.multiply(pose[1], solid.Q))

    for one, two in product(solids[solids.body == 0], solids[solids.body == 1]):
        count = touch(placed(one, pose_a), placed(two, pose_b), hulls, reach, work, out)
        found.append(out[:count].copy())
    return np.concatenate(found).view(np.recarray)


def support(shape, pose, direction):
    local = quaternion.rotate_back(pose.q, direction)
    return pose.x + quaternion.rotate(pose.q, shape.support(local))


def separation(a, b, pose_a, pose_b, n):
    """How far A and B are apart along n: by duality the greatest over n is the distance."""
    return float((support(a, pose_a, -n) - support(b, pose_b, n)) @ n)


def beyond(shape, pose, point):
    """How far a point is outside of a shape, by its support in many directions."""
    return max(float((point - support(shape, pose, d)) @ d) for d in DIRECTIONS)


def unit(values):
    v = np.array(values, dtype=float)
    return v / np.linalg.norm(v)


numbers = st.floats(-1, 1).filter(lambda x: x == 0 or abs(x) > 1e-6)
directions = (
    st.tuples(numbers, numbers, numbers).filter(lambda v: np.linalg.norm(v) > 0.1).map(unit)
)
rotations = (
    st.tuples(numbers, numbers, numbers, numbers)
    .filter(lambda v: np.linalg.norm(v) > 0.1)
    .map(unit)
)
