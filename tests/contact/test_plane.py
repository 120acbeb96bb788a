"""Every shape against a half-space: the lowest points, the set that carries the load, continuity."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.collision.layout import Placed, Plane, new_pair_work, new_points, solid_table
from carom.collision.plane import touch_plane
from carom.geometry import quaternion
from carom.scene import Box, Capsule, Convex, Cylinder, Disc, Ellipsoid, Sphere
from contact.pair_cases import DIRECTIONS, NAMES, SHAPES, Pose, directions, rotations, support

UP = np.array([0.0, 0.0, 1.0])


def touching(shape, x, q, normal=UP, offset=0.0, reach=0.0):
    solids, hulls = solid_table([shape])
    out, x, q = new_points(), np.array(x, float), np.array(q, float)
    solid, plane = Placed(solids[0], x, q), Plane(normal, offset)
    count = touch_plane(solid, plane, hulls, reach, new_pair_work(), out)
    return out[:count]


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(NAMES), directions, rotations, directions, st.floats(-2, 2))
def test_least_gap_is_that_of_the_support(name, x, q, normal, offset):
    # gap = min over the solid of n.a - offset
    shape = SHAPES[name]
    points = touching(shape, x, q, normal, offset)
    lowest = support(shape, Pose(x, q), -normal)
    assert points.gap.min() == pytest.approx(lowest @ normal - offset, abs=1e-14)
    k = int(np.argmin(points.gap))
    np.testing.assert_allclose(points.on_b[k] @ normal, offset, atol=1e-14)
    np.testing.assert_allclose(points.on_a[k] - points.on_b[k], points.gap[k] * normal, atol=1e-14)
    for d in DIRECTIONS[:25]:
        assert (points.on_a[k] - support(shape, Pose(x, q), d)) @ d <= 1e-14


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(NAMES), rotations, st.floats(1e-6, 0.05))
def test_all_points_are_of_the_solid_and_within_reach(name, q, reach):
    shape = SHAPES[name]
    points = touching(shape, (0, 0, 1), q, reach=reach)
    assert 1 <= len(points) <= 8
    assert len(set(points.feature.tolist())) == len(points)
    for p in points:
        assert p.gap <= points.gap.min() + reach + 1e-15
        assert p.on_a[2] == pytest.approx(p.gap, abs=1e-15)
        for d in DIRECTIONS[:50]:
            assert (p.on_a - support(shape, Pose(np.array([0, 0, 1.0]), q), d)) @ d <= 1e-14


def test_ellipsoid():
    # Height of the mass centre over the plane that touches: sqrt(a^2 nx^2 + b^2 ny^2 + c^2 nz^2).
    q = quaternion.exp(np.array([0.3, -0.5, 1.1]))
    n = quaternion.rotate_back(q, UP)
    height = math.sqrt((0.2 * n[0]) ** 2 + (0.3 * n[1]) ** 2 + (0.5 * n[2]) ** 2)
    assert touching(Ellipsoid(0.2, 0.3, 0.5), (0, 0, 1), q).gap[0] == pytest.approx(
        1 - height, abs=1e-15
    )


@pytest.mark.parametrize("angle", [0.1, 0.7, 1.3])
def test_tilted_cylinder_and_disc(angle):
    # Axis tilted by t from the vertical: lowest point r sin t + h cos t below the mass centre.
    q = quaternion.exp(np.array([0, angle, 0]))
    for shape, h in ((Cylinder(0.3, 0.8), 0.4), (Disc(0.3), 0.0)):
        points = touching(shape, (0, 0, 1), q, reach=1e-3)
        assert len(points) == 1
        depth = 0.3 * math.sin(angle) + h * math.cos(angle)
        assert points.gap[0] == pytest.approx(1 - depth, abs=1e-15)


def test_flat_rims_stand_on_four_points_and_a_lying_cylinder_on_two():
    for shape, height in ((Cylinder(0.3, 0.8), 0.4), (Disc(0.3), 0.0)):
        points = touching(shape, (0, 0, height), (1, 0, 0, 0), reach=1e-6)
        angles = np.sort(np.arctan2(points.on_a[:, 1], points.on_a[:, 0]))
        np.testing.assert_allclose(np.diff(angles), np.pi / 2, atol=1e-14)
        np.testing.assert_allclose(points.gap, 0, atol=1e-16)
    lying = quaternion.exp(np.array([0, math.pi / 2, 0]))
    points = touching(Cylinder(0.3, 0.8), (0, 0, 0.3), lying, reach=1e-6)
    np.testing.assert_allclose(sorted(points.on_a[:, 0]), [-0.4, 0.4], atol=1e-15)


@pytest.mark.parametrize("tilt", [1e-13, 1e-11, 1e-9, 1e-7, 1e-6])
def test_nearly_flat_rim_keeps_its_points(tilt):
    # The lowest point and three fixed ones; the least gap is exact at any tilt above rounding.
    for direction in np.linspace(0, 6, 7):
        axis = np.array([math.cos(direction), math.sin(direction), 0])
        points = touching(Disc(0.3), (0, 0, 0), quaternion.exp(tilt * axis), reach=1e-6)
        assert len(points) == 4
        assert points.gap.min() == pytest.approx(-0.3 * math.sin(tilt), abs=1e-13 * 0.3)
        fixed = {int(f) >> 45 & 0x7FFF for f in points.feature} & set(range(8))
        assert len(fixed) == (4 if tilt < 1e-12 else 3)


@pytest.mark.parametrize(
    ("shape", "height", "count"),
    [
        (Sphere(0.2), 0.2, 1),
        (Box(0.2, 0.3, 0.4), 0.2, 4),
        (Box(0.2, 0.3, 0.4, radius=0.05), 0.2, 4),
        (Convex(Box(0.2, 0.3, 0.4).vertices), 0.2, 4),
        (Capsule(0.1, 0.3), 0.25, 1),
    ],
)
def test_set_that_carries_the_load(shape, height, count):
    points = touching(shape, (1, 2, height), (1, 0, 0, 0), reach=1e-3)
    assert len(points) == count
    np.testing.assert_allclose(points.gap, 0, atol=1e-15)
    np.testing.assert_allclose(points.on_a[:, 2], 0, atol=1e-15)


def test_many_corners_are_thinned_to_eight_that_span_them():
    angles = np.arange(60) * 2 * np.pi / 60
    prism = [(np.cos(t), np.sin(t), z) for t in angles for z in (-0.1, 0.1)]
    points = touching(Convex(prism), (0, 0, 0.1), (1, 0, 0, 0), reach=1e-9)
    assert len(points) == 8
    around = np.sort(np.arctan2(points.on_a[:, 1], points.on_a[:, 0]))
    assert np.max(np.diff(np.append(around, around[0] + 2 * np.pi))) < 2 * np.pi / 6


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(NAMES), rotations, directions, st.floats(1e-4, 1e-2))
def test_rate_of_the_gap_is_the_normal_velocity_of_the_point(name, q, w, h):
    # The envelope theorem: d gap/dt = n.(v + w x r) of the lowest point. Where another point becomes
    # lowest inside the step, the mean rate lies between the rates of the two.
    shape = SHAPES[name]
    x, v = np.array([0, 0, 1.0]), np.array([0.3, -0.2, -1.0])
    gaps, rates = [], []
    for s in (0, 1):
        turned = quaternion.multiply(quaternion.exp(s * h * w), q)
        points = touching(shape, x + s * h * v, turned)
        k = int(np.argmin(points.gap))
        gaps.append(points.gap[k])
        rates.append((v + np.cross(w, points.on_a[k] - (x + s * h * v)))[2])
    rate = (gaps[1] - gaps[0]) / h
    assert min(rates) - h * shape.size <= rate <= max(rates) + h * shape.size
