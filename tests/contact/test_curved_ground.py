"""Points of solids on surfaces that are not convex, and the rates of their rows."""

import numpy as np
import pytest

import carom
from carom.collision.api import nearest_points
from carom.collision.features import EDGE
from carom.geometry import quaternion
from contact.pair_cases import unit
from contact.row_rates import Motion, Touching

S = carom.surfaces
GROUNDS = {
    "bowl": S.InsideSphere(1.0), "pipe": S.InsideCylinder(1.0), "can": S.InsideCylinder(1.0, length=1.6),
    "funnel": S.InsideCone(0.9), "tube": S.InsideTorus(2.0, 1.0),
}  # fmt: skip
SHAPES = {
    "ball": carom.Sphere(0.3), "capsule": carom.Capsule(0.1, 0.5), "box": carom.Box(0.4, 0.3, 0.2),
    "rounded": carom.Box(0.4, 0.3, 0.2, radius=0.05), "ellipsoid": carom.Ellipsoid(0.3, 0.25, 0.2),
    "hull": carom.Convex(np.random.default_rng(4).normal(size=(20, 3)) * 0.15),
}  # fmt: skip


def height(ground, p):
    """The distance of points (..., 3) from a surface."""
    z, across = p[..., 2], np.hypot(p[..., 0], p[..., 1])
    if isinstance(ground, S.InsideSphere):
        return ground.radius - np.linalg.norm(p, axis=-1)
    if isinstance(ground, S.InsideCylinder):
        ends = np.inf if ground.length is None else ground.length / 2
        return np.minimum(ground.radius - across, ends - abs(z))
    if isinstance(ground, S.InsideCone):
        return np.sin(ground.half_angle) * z - np.cos(ground.half_angle) * across
    return ground.tube_radius - np.hypot(across - ground.radius, z)


def place(name, rng):
    """A place in free space, away from axes and centres."""
    p = 0.5 * rng.uniform(0.3, 1.0) * unit(rng.normal(size=3))
    return p + {"funnel": (0.4, 0, 2.0), "tube": (2.0, 0, 0)}.get(name, (0, 0, 0))


def points_of(shape, x, q, rng):
    """Points of the surface of a shape, among them all corners."""
    directions = rng.normal(size=(40000 if isinstance(shape, carom.Ellipsoid) else 4000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    if isinstance(shape, carom.Ellipsoid):
        return x + quaternion.rotate(q, directions * shape.pieces[0].half)
    piece = shape.pieces[0]
    corners = x + quaternion.rotate(q, piece.corners)
    return (corners[:, None] + piece.radius * directions).reshape(-1, 3)


def test_an_edge_that_dips_into_the_ground_beyond_where_it_rises():
    """The inner side of a tube is hollow at one end of an edge, and bulges at the other."""
    shape, ground = carom.Box(0.5, 0.02, 0.02), S.InsideTorus(1.0, 0.5)
    x = np.array([-0.19332065, -0.78323897, -0.43937704])
    q = unit(np.array([-0.80708963, 0.47334381, -0.24545337, 0.25358353]))
    found = nearest_points(shape, (x, q), ground, (np.zeros(3), (1.0, 0, 0, 0)))
    corners = x + quaternion.rotate(q, np.array(shape.pieces[0].corners))
    i, j = np.triu_indices(8, 1)
    shares = np.linspace(0.0, 1.0, 2001)[:, None, None]
    heights = height(ground, (1.0 - shares) * corners[i] + shares * corners[j])
    assert 1 < np.argmin(np.min(heights, axis=1)) < 2000  # between corners
    assert found.gap == pytest.approx(np.min(heights), abs=1e-6)


@pytest.mark.few(10)
@pytest.mark.parametrize("name", GROUNDS)
@pytest.mark.parametrize("kind", SHAPES)
def test_the_gap_is_that_of_the_nearest_point(kind, name):
    shape, ground, rng = SHAPES[kind], GROUNDS[name], np.random.default_rng(2)
    if kind == "ellipsoid" and name == "funnel":
        pytest.skip("its curvature is not allowed")
    for _ in range(5):
        x, q, at, turn = (
            place(name, rng),
            unit(rng.normal(size=4)),
            rng.normal(size=3),
            unit(rng.normal(size=4)),
        )
        world = at + quaternion.rotate(turn, x), quaternion.multiply(turn, q)
        found = nearest_points(shape, world, ground, (at, turn))
        gaps = height(ground, points_of(shape, x, q, rng))
        assert -1e-12 < gaps.min() - found.gap < 2e-3
        own = quaternion.rotate_back(turn, np.array([found.on_a, found.on_b]) - at)
        np.testing.assert_allclose(height(ground, own), [found.gap, 0.0], atol=1e-12)
        step = found.on_a - found.on_b
        np.testing.assert_allclose(step, found.gap * found.normal, atol=1e-12)


@pytest.mark.few(10)
@pytest.mark.parametrize("name", GROUNDS)
@pytest.mark.parametrize("kind", SHAPES)
def test_rates_of_rows_are_those_of_the_points(kind, name):
    # A Richardson extrapolation of central differences, of order 6, as in `test_row_rates`.
    shape, ground, rng, checked = SHAPES[kind], GROUNDS[name], np.random.default_rng(3), 0
    if kind == "ellipsoid" and name == "funnel":
        pytest.skip("its curvature is not allowed")
    for _ in range(6):
        x, q, turn = place(name, rng), unit(rng.normal(size=4)), unit(rng.normal(size=4))
        for _ in range(3):  # the nearest point of the body to the surface
            near = nearest_points(shape, (x, q), ground, (np.zeros(3), (1.0, 0, 0, 0)))
            x = x - near.gap * near.normal
        x, q = quaternion.rotate(turn, x), quaternion.multiply(turn, q)
        motion = Motion(x, q, rng.normal(size=3), rng.normal(size=3))
        pair = Touching(shape, ground, motion, Motion(np.zeros(3), turn), rng.choice([0.0, 0.05]))
        for rate in pair.rates():
            if rate.doubt < 1e-8 * rate.scale:
                checked += 1
                assert np.linalg.norm(rate.exact - rate.difference) < 1e-6 * rate.scale, rate
    assert checked >= 5


def test_capsule_between_its_ends_on_the_inner_side_of_a_tube():
    # Across the hole of the ring a straight line is nearest between its ends.
    capsule, ground, q = (
        carom.Capsule(0.1, 0.6),
        S.InsideTorus(2.0, 1.0),
        carom.axis_angle((1, 0, 0), 90),
    )
    x = np.array([1.0 + 0.1, 0.05, 0.0])
    found = nearest_points(capsule, (x, q), ground, (np.zeros(3), (1.0, 0, 0, 0)))
    assert found.gap == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(found.normal, [1, 0, 0], atol=1e-9)
    motion = Motion(x, q, np.array([0.3, 0.2, 0.1]), np.array([0.5, -1.0, 2.0]))
    pair = Touching(capsule, ground, motion, Motion(np.zeros(3), np.array([1.0, 0, 0, 0])))
    (rate,) = (one for one in pair.rates() if one.parts[0] >> 30 == EDGE)
    assert rate.doubt < 1e-8 * rate.scale
    assert np.linalg.norm(rate.exact - rate.difference) < 1e-6 * rate.scale
