"""The points that carry a contact: faces, edges, lines; which they are and that they keep their names."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.collision.api import nearest_points
from carom.geometry import quaternion
from carom.scene import Box, Capsule, Compound, Convex, Cylinder, Sphere
from contact.pair_cases import ORIGIN, Pose, contact_points, support, touching, unit

REACH = 1e-4
BOX, SLAB = Box(0.2, 0.3, 0.4), Box(2.0, 2.0, 0.1)


def turned(*angles):
    return quaternion.exp(np.array(angles, dtype=float))


def on(lower, upper, height, q=ORIGIN.q, shift=(0, 0), reach=REACH):
    """Touch of `upper` above `lower`, the upper one is A."""
    return touching(upper, lower, Pose(np.array([*shift, height]), q), reach=reach)


def plan(points):
    """The points of A seen from above, in order."""
    return sorted((round(float(x), 12) + 0.0, round(float(y), 12) + 0.0) for x, y, _ in points.on_a)


@pytest.mark.parametrize("gap", [0.01, 0.0, -1e-5])
@pytest.mark.parametrize("kind", [Box, Convex])
def test_box_on_slab_stands_on_its_corners(gap, kind):
    make = (lambda b: b) if kind is Box else (lambda b: Convex(b.vertices))
    found = on(make(SLAB), make(BOX), 0.05 + 0.2 + gap, shift=(0.3, -0.2))
    assert plan(found.points) == [(0.2, -0.35), (0.2, -0.05), (0.4, -0.35), (0.4, -0.05)]
    np.testing.assert_allclose(found.points.gap, gap, atol=1e-15)
    np.testing.assert_allclose(found.points.normal, np.tile([0, 0, 1], (4, 1)), atol=1e-15)


def test_equal_boxes_stacked_touch_in_four_points():
    found = on(BOX, BOX, 0.4)
    assert plan(found.points) == [(-0.1, -0.15), (-0.1, 0.15), (0.1, -0.15), (0.1, 0.15)]


def test_overhanging_box_touches_along_the_edges_of_both():
    # Half over the side x = 1 of the slab: two corners inside, two points on the slab's edge.
    found = on(SLAB, BOX, 0.25, shift=(1.0, 0.0))
    assert plan(found.points) == [(0.9, -0.15), (0.9, 0.15), (1.0, -0.15), (1.0, 0.15)]
    beside = on(SLAB, BOX, 0.25 - 0.1, shift=(1.1 + 1e-5, 0.0))
    np.testing.assert_allclose(beside.points.normal, np.tile([1, 0, 0], (4, 1)), atol=1e-12)


def test_octagon():
    # Two squares turned by 45 degrees: eight crossings of edges, |x| or |y| = a with the other at
    # sqrt(2) a - a.
    a = 0.1
    found = on(Box(0.2, 0.2, 0.2), Box(0.2, 0.2, 0.2), 0.2, turned(0, 0, math.pi / 4))
    b = math.sqrt(2) * a - a
    expected = sorted((i * p, j * q) for p, q in ((a, b), (b, a)) for i in (-1, 1) for j in (-1, 1))
    np.testing.assert_allclose(plan(found.points), expected, atol=1e-12)
    assert len({int(f) for f in found.points.feature}) == 8


def test_tilted_box_touches_with_an_edge_then_a_corner():
    tilt = turned(0.0, 0.3, 0.0)
    lowest = -min(quaternion.rotate(tilt, BOX.vertices)[:, 2])
    found = on(SLAB, BOX, 0.05 + lowest, tilt)
    assert len(found.points) == 2
    np.testing.assert_allclose(sorted(found.points.on_a[:, 1]), [-0.15, 0.15], atol=1e-15)
    tilt = turned(0.3, 0.4, 0.0)
    lowest = -min(quaternion.rotate(tilt, BOX.vertices)[:, 2])
    assert len(on(SLAB, BOX, 0.05 + lowest, tilt).points) == 1


@pytest.mark.parametrize("tilt", [1e-14, 1e-12, 1e-9, 1e-6, 1e-5])
def test_slight_tilt_keeps_four_points_and_their_names(tilt):
    flat = on(SLAB, BOX, 0.25)
    for axis in ((1, 0, 0), (0, 1, 0), (0.6, 0.8, 0)):
        found = on(SLAB, BOX, 0.25, turned(*(tilt * np.array(axis))))
        assert {int(f) for f in found.points.feature} == {int(f) for f in flat.points.feature}
        # The lowest corner is 0.15 and 0.1 from the two axes.
        assert found.gap == pytest.approx(
            -tilt * (0.15 * axis[0] + 0.1 * axis[1]), rel=1e-4, abs=1e-15
        )


def test_capsules():
    capsule = Capsule(0.1, 0.6)
    lying = turned(0, math.pi / 2, 0)
    crossed = touching(capsule, capsule, Pose(np.array([0, 0, 0.2]), lying), reach=REACH)
    assert len(crossed.points) == 1  # end on
    side = touching(capsule, capsule, Pose(np.array([0.2, 0, 0.2]), ORIGIN.q), reach=REACH)
    assert plan(side.points) == [(0.1, 0.0), (0.1, 0.0)]
    np.testing.assert_allclose(sorted(side.points.on_a[:, 2]), [-0.1, 0.3], atol=1e-15)
    slab = on(SLAB, capsule, 0.15, lying, shift=(0.2, 0.1))
    assert plan(slab.points) == [(-0.1, 0.1), (0.5, 0.1)]
    over = on(SLAB, capsule, 0.15, lying, shift=(1.0, 0.1))
    assert plan(over.points) == [(0.7, 0.1), (1.0, 0.1)]


def test_parallel_rounded_edges_touch_along_a_line():
    # Two roofs: rounded boxes on edge, edge above edge.
    box, eighth = Box(0.2, 0.2, 0.6, radius=0.02), math.pi / 4
    lying = quaternion.multiply(turned(0, math.pi / 2, 0), turned(0, 0, eighth))
    height = 2 * (0.08 * math.sqrt(2) + 0.02)
    up, low = Pose(np.array([0.1, 0, height]), lying), Pose(np.zeros(3), lying)
    found = touching(box, box, up, low, reach=REACH)
    np.testing.assert_allclose(sorted(found.points.on_a[:, 0]), [-0.18, 0.28], atol=1e-12)
    np.testing.assert_allclose(found.points.gap, 0, atol=1e-15)


def test_cylinder_stands_on_its_rim_and_lies_on_two_points():
    can = Cylinder(0.1, 0.3)
    standing = on(SLAB, can, 0.2)
    assert len(standing.points) == 8
    radii = np.hypot(standing.points.on_a[:, 0], standing.points.on_a[:, 1])
    np.testing.assert_allclose(radii, 0.1, atol=1e-15)
    lying = on(SLAB, can, 0.15, turned(0, math.pi / 2, 0))
    assert plan(lying.points) == [(-0.15, 0.0), (0.15, 0.0)]


def test_table_stands_on_its_legs():
    # Four legs of square section, turned as a whole: sixteen corners, four for each leg.
    legs = [(Box(0.1, 0.1, 0.5), (x, y, 0.25)) for x in (-0.4, 0.4) for y in (-0.4, 0.4)]
    table = Compound([*legs, (Box(1, 1, 0.1), (0, 0, 0.55))])
    q = turned(0, 0, 0.3)
    pose = np.array([0.1, 0.2, 0.05 + table.centroid[2]]), q
    points = contact_points(table, SLAB, pose, ORIGIN, REACH)
    near = points[points.gap < REACH]
    assert len(near) == 16
    np.testing.assert_allclose(near.on_b[:, 2], 0.05, atol=1e-15)
    feet = quaternion.rotate_back(q, near.on_a - pose[0])
    expected = {
        (i * 0.4 + 0.05 * k, j * 0.4 + 0.05 * l) for i, j, k, l in product((-1, 1), repeat=4)
    }
    assert {(round(x, 12), round(y, 12)) for x, y, _ in feet} == {
        (round(x, 12), round(y, 12)) for x, y in expected
    }
    assert nearest_points(table, pose, SLAB, ORIGIN).gap == pytest.approx(0, abs=1e-15)


def test_sphere_has_one_point():
    assert len(on(SLAB, Sphere(0.1), 0.15, reach=1.0).points) == 1


small = st.floats(-2e-3, 2e-3)


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from([BOX, Box(0.2, 0.3, 0.4, radius=0.03), Convex(BOX.vertices)]),
    st.tuples(small, small, st.floats(-3, 3)),
    st.tuples(st.floats(-1.1, 1.1), st.floats(-1.1, 1.1)),
    st.floats(0, 1e-3),
)
def test_points_are_on_the_surfaces_and_within_reach(shape, angles, shift, gap):
    q = turned(*angles)
    pose = Pose(np.array([*shift, 0.0]), q)
    height = 0.05 + gap - support(shape, pose, np.array([0, 0, -1.0]))[2]
    pose = Pose(np.array([*shift, height]), q)
    found = touching(shape, SLAB, pose, reach=REACH)
    for k, point in enumerate(found.points):
        assert found.gap - 1e-15 <= point.gap <= found.gap + REACH + 1e-12
        np.testing.assert_allclose(
            point.on_a - point.on_b, point.gap * point.normal, atol=1e-13, err_msg=str(k)
        )
        assert np.linalg.norm(point.normal) == pytest.approx(1, abs=1e-13)
        inside = np.abs(point.on_b) - np.array([1, 1, 0.05])
        assert np.max(inside) <= 1e-12
    features = [int(f) for f in found.points.feature]
    assert len(set(features)) == len(features)


@settings(max_examples=60, deadline=None)
@given(st.floats(-3, 3), st.floats(0.0, 0.3), st.integers(0, 2**32 - 1))
def test_corners_of_the_set_carry_the_load(angle, shift, seed):
    # Flat on flat: the points' hull, seen from above, is the overlap: any weight whose line passes
    # the overlap is carried by forces >= 0 in the points.
    found = on(Box(0.5, 0.5, 0.1), BOX, 0.25, turned(0, 0, angle), shift=(shift, 0.0))
    rng = np.random.default_rng(seed)
    corners = found.points.on_a[:, :2]
    for _ in range(20):
        x = rng.uniform(-0.25, 0.25, 2)
        local = quaternion.rotate_back(turned(0, 0, angle), np.array([*(x - (shift, 0.0)), 0]))
        if np.all(np.abs(local[:2]) <= (0.1, 0.15)):
            ring = corners[np.argsort(np.arctan2(*(corners - corners.mean(axis=0)).T))[::-1]]
            sides = np.roll(ring, -1, axis=0) - ring
            across = sides[:, 0] * (x - ring)[:, 1] - sides[:, 1] * (x - ring)[:, 0]
            assert np.all(across >= -1e-12) or np.all(across <= 1e-12)


def test_parts_far_from_the_origin():
    q = unit([1, 2, 3, 4])
    lower, upper = Pose(np.array([1e4, 0, 0]), q), None
    upper = Pose(lower.x + quaternion.rotate(q, np.array([0.0, 0, 0.25])), q)
    found = touching(BOX, SLAB, upper, lower, reach=REACH)
    assert len(found.points) == 4
    assert abs(found.gap) < 1e-11  # rounding of 1e4 m
