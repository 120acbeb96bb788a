"""What lies on each other to round-off is one point: lines and faces of equal solids keep their symmetry."""

import math

import numpy as np
import pytest

from carom.geometry import quaternion
from carom.scene import Box, Capsule, Convex, Cylinder, Disc
from contact.pair_cases import Pose, touching

CASES = 60  # of each kind: tilts, turns, shifts and gaps at random


def turned(axis, angle):
    return quaternion.exp(angle * np.array(axis) / np.linalg.norm(axis))


def in_a_random_frame(rng, *poses):
    """The poses, moved together, and the way back of a point."""
    q, x = rng.normal(size=4), rng.normal(size=3) * rng.integers(2)
    q /= np.linalg.norm(q)
    moved = [Pose(x + quaternion.rotate(q, p.x), quaternion.multiply(q, p.q)) for p in poses]
    return moved, lambda p: quaternion.rotate_back(q, p - x)


def round_off_of_tilt(rng):
    return turned(rng.normal(size=3), 10.0 ** rng.uniform(-16, -13) * rng.integers(2))


def prism(corners, radius, length):
    angles = 2 * math.pi * np.arange(corners) / corners
    return Convex(
        [
            (radius * math.cos(a), radius * math.sin(a), z)
            for a in angles
            for z in (-length / 2, length / 2)
        ]
    )


#: a solid with an edge or a mantle along z, how far that is from the axis in x, and how it is turned for this
LINES = {
    "cylinder": lambda r, length: (Cylinder(r, length), r, 0.0),
    "capsule": lambda r, length: (Capsule(r, length), r, 0.0),
    "edge": lambda r, length: (Box(2 * r, 2 * r, length), math.sqrt(2) * r, math.pi / 4),
    "face": lambda r, length: (Box(2 * r, 2 * r, length), r, 0.0),
}
PAIRS = [
    (a, b)
    for i, a in enumerate(LINES)
    for b in list(LINES)[i:]
    if {a, b} not in ({"edge"}, {"face"})
]


@pytest.mark.parametrize(("a", "b"), PAIRS)
def test_equal_lines_side_by_side_touch_at_both_ends(a, b):
    # Segments of the length L, shifted by s along themselves, lie on each other from -L/2 + max(0, s) to
    # L/2 + min(0, s); one of the length K flush at one end has s = +-(L - K)/2.
    rng = np.random.default_rng([PAIRS.index((a, b))])
    for k in range(CASES):
        length, other, shift = rng.uniform(0.05, 0.5), 1.0, 0.0
        if k % 3 == 1:
            shift = rng.uniform(0.01, 0.5) * length
        if k % 3 == 2:
            other = rng.uniform(0.3, 1.0)
            shift = rng.choice([-0.5, 0.5]) * (1.0 - other) * length
        one, x, turn = LINES[a](rng.uniform(0.02, 0.2), other * length)
        two, y, about = LINES[b](rng.uniform(0.02, 0.2), length)
        gap = rng.choice([0.0, 1e-15, -1e-15, 1e-6, -1e-9])
        up = turned((1, 0, 0), math.pi * rng.integers(2))
        q = quaternion.multiply(
            round_off_of_tilt(rng), quaternion.multiply(up, turned((0, 0, 1), turn))
        )
        beside = Pose(np.array([x + y + gap, 0.0, shift]), q)
        at_origin = Pose(np.zeros(3), turned((0, 0, 1), about))
        (pose, its), back = in_a_random_frame(rng, beside, at_origin)
        found = touching(one, two, pose, its, reach=1e-3 * min(one.size, two.size)).points
        want = (
            max(-length / 2, shift - other * length / 2),
            min(length / 2, shift + other * length / 2),
        )
        np.testing.assert_allclose(sorted(back(p)[2] for p in found.on_a), want, atol=1e-9)
        np.testing.assert_allclose(found.gap, gap, atol=1e-11)


@pytest.mark.parametrize("corners", [0, 3, 4, 5, 6, 7, 8])
def test_equal_faces_on_each_other_touch_all_round(corners):
    # Prisms (cylinders: 0 corners), turned by a symmetry of theirs, touch at their corners, whose mean is on
    # the axis: corners that round-off moves over a side are no others.
    rng = np.random.default_rng([corners])
    for k in range(CASES):
        radius, height = rng.uniform(0.02, 0.2), rng.uniform(0.02, 0.2)
        solid = prism(corners, radius, height) if corners else Cylinder(radius, height)
        if corners == 4 and k % 2 == 1:
            solid = Box(radius, rng.uniform(1.0, 2.0) * radius, height)
        turn = rng.choice([0.0, 1e-15, 1e-13])
        if corners:
            turn += (
                2
                * math.pi
                * (rng.integers(corners) / corners if k % 2 == 0 else rng.integers(2) / 2)
            )
            turn = turn if corners % 2 == 0 or k % 2 == 0 else 0.0
        elif k % 2 == 0:
            turn = rng.uniform(0, 6)
        off = radius * rng.normal(size=2) * rng.choice([0.0, 1e-16, 1e-13])
        gap = radius * rng.choice([0.0, 1e-15, -1e-15, 1e-6, -1e-9])
        q = quaternion.multiply(round_off_of_tilt(rng), turned((0, 0, 1), turn))
        over, below = (
            Pose(np.array([*off, height + gap]), q),
            Pose(np.zeros(3), turned((0, 0, 1), 0.0)),
        )
        (pose, its), back = in_a_random_frame(rng, over, below)
        found = touching(solid, solid, pose, its, reach=1e-3 * solid.size).points
        assert len(found) == (corners or 8)
        mean = np.mean([back(p) for p in found.on_a], axis=0)
        np.testing.assert_allclose(mean[:2], 0.0, atol=1e-9 * radius)


def test_discs_in_one_plane_are_circles():
    # Gap d - r - s along the line of centres, inside each other too; a tilt or a height of round-off is none.
    rng = np.random.default_rng(7)
    for _ in range(CASES):
        r, s, angle = rng.uniform(0.02, 0.2), rng.uniform(0.02, 0.2), rng.uniform(0, 6)
        gap = rng.choice([0.0, 1e-3, 1e-6, -1e-9, -1e-4, -1e-2])
        n = np.array([math.cos(angle), math.sin(angle), 1e-13 * rng.integers(-1, 2)])
        upside = turned((1, 0, 0), math.pi * rng.integers(2))
        a = Pose((r + s + gap) * n, quaternion.multiply(round_off_of_tilt(rng), upside))
        (pose, its), back = in_a_random_frame(rng, a, Pose(np.zeros(3), turned((0, 0, 1), angle)))
        found = touching(Disc(r), Disc(s), pose, its, reach=1e-3 * min(r, s))
        assert len(found.points) == 1
        assert found.gap == pytest.approx(gap, abs=1e-12)
        np.testing.assert_allclose(back(found.on_b), s * n, atol=1e-12)
        np.testing.assert_allclose(back(found.on_a), (s + gap) * n, atol=1e-12)


def test_discs_in_planes_apart_do_not_touch():
    # A disc above another one, and one that stands on it: distances of thin solids.
    over = touching(Disc(0.1), Disc(0.1), Pose(np.array([0.15, 0.0, 1e-6]), turned((0, 0, 1), 0)))
    assert over.gap == pytest.approx(1e-6)
    upright = Pose(np.array([0.05, 0.0, 0.1]), turned((1, 0, 0), math.pi / 2))
    assert touching(Disc(0.1), Disc(0.1), upright).gap == pytest.approx(0.0, abs=1e-15)
