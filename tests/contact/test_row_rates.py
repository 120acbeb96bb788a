"""Rates of the rows of two solids: closed form against the points found before and after, and by hand."""

import numpy as np
import pytest

import carom
from carom.collision.features import EDGE
from carom.geometry import quaternion
from contact.pair_cases import ORIGIN, Pose, touching, unit
from contact.row_cases import MODES, case
from contact.row_rates import Motion, Touching


def rates_of(a, b, x, v, w=((0, 0, 0), (0, 0, 0)), q=ORIGIN.q):
    """Return the rates of the points of A at x on B at the origin, with velocities v and w of both."""
    v, w = np.array(v, dtype=float), np.array(w, dtype=float)
    first, second = (
        Motion(np.array(x, dtype=float), q, v[0], w[0]),
        Motion(ORIGIN.x, ORIGIN.q, v[1], w[1]),
    )
    return Touching(a, b, first, second).points()[2]


@pytest.mark.parametrize("pairs", [8, pytest.param(25, marks=pytest.mark.slow)])
@pytest.mark.parametrize("mode", MODES)
def test_closed_form_is_the_rate_of_the_points(mode, pairs):
    # A Richardson extrapolation of central differences, of order 6; points whose part changes within the
    # difference, or that are arbitrary ones of a line, have none.
    rng, checked, left_out = np.random.default_rng(7), 0, 0
    for _ in range(pairs):
        a, b, pair = case(mode, rng)
        for rate in pair.rates():
            lines = any(part >> 30 == EDGE for part in rate.parts)
            if not rate.doubt < 1e-8 * rate.scale or (rate.feature == 0 and lines):
                left_out += 1
                continue
            checked += 1
            off = np.linalg.norm(rate.exact - rate.difference)
            assert off < 1e-6 * rate.scale, (a, b, rate)
    assert left_out < 0.2 * checked


def test_balls_pass_each_other():
    # The distance r of the centres has r'' = |u_t|^2/r; the velocity of one ball stays the same.
    (rate,) = rates_of(carom.Sphere(0.3), carom.Sphere(0.2), (0, 0, 0.5), [(2, 1, 0), (0, 0, 0)])
    np.testing.assert_allclose(rate, [5 / 0.5, 0, 0], atol=1e-14)


def test_ball_that_spins_on_a_ball():
    # n' = v/(r_A + r_B) = (2, 0, 0) for v = (1, 0, 0), and p_A' - v = -r_A n' = (-.6, 0, 0). The spin (0, w, 0)
    # of the upper ball turns it into w x (p_A' - v) = (0, 0, .6 w). The velocity at the point is
    # u = v + w x (-r_A n) = (1 - .3 w, 0, 0), so that n'.u = 2 - .6 w.
    w = 7.0
    spins = [(0, w, 0), (0, 0, 0)]
    (rate,) = rates_of(
        carom.Sphere(0.3), carom.Sphere(0.2), (0, 0, 0.5), [(1, 0, 0), (0, 0, 0)], spins
    )
    np.testing.assert_allclose(rate, [2.0, 0, 0], atol=1e-13)


def test_corners_on_a_turning_table():
    # The table turns with w, n' = w x n; the box above rests, p_A' = 0. The gap opens at d' = n.u with
    # u = -w x p, so the point of the table moves with p_B' = -d' n: u has the rate d' w x n.
    box, table, w = carom.Box(0.2, 0.2, 0.2), carom.Box(2, 2, 1), np.array([3.0, 0, 0])
    rests, turns = np.zeros((2, 3)), (np.zeros(3), w)
    above = Motion(np.array([0.1, 0.2, 0.6]), ORIGIN.q, *rests)
    touches, points, rates = Touching(
        box, table, above, Motion(ORIGIN.x, ORIGIN.q, *turns), 1e-6
    ).points()
    assert len(points) == 4
    turn = np.cross(w, [0, 0, 1])
    for touch, point, rate in zip(touches, points, rates):
        u = -np.cross(w, touch.on_b)
        expected = point.axes @ (u[2] * turn)
        expected[0] += turn @ u
        np.testing.assert_allclose(rate, expected, atol=1e-13)


def test_sharp_vertices_that_meet_have_finite_rates():
    box = carom.Box(0.2, 0.2, 0.2)
    x = np.full(3, 0.2)
    for place in (x, x * [1, 1, 0], x * [1, 1, 0] + [0, 0, 0.1]):
        pair = Touching(
            box, box, Motion(place, ORIGIN.q, *np.ones((2, 3))), Motion(ORIGIN.x, ORIGIN.q)
        )
        assert np.isfinite(pair.points()[2]).all()


CURVED = {
    "ellipsoid": carom.Ellipsoid(0.1, 0.07, 0.02),
    "cylinder": carom.Cylinder(0.1, 0.1),
    "coin": carom.Cylinder(0.1, 0.01),
    "capsule": carom.Capsule(0.03, 0.1),
    "box": carom.Box(0.1, 0.07, 0.02),
    "sphere": carom.Sphere(0.1),
}


@pytest.mark.few(6)
@pytest.mark.parametrize("table", ["box", "hull", "cylinder"])
@pytest.mark.parametrize("name", CURVED)
def test_the_lowest_point_over_a_face_is_exact(name, table):
    # The plane of the face: its point nearest to the body is below the body's lowest point, in closed form.
    shape, rng = CURVED[name], np.random.default_rng(3)
    flat = {"box": carom.Box(20, 20, 1), "hull": carom.Convex(carom.Box(20, 20, 1).vertices)}
    below = flat.get(table) or carom.Cylinder(10, 1)
    for _ in range(40):
        q = unit(rng.normal(size=4))
        turn = Pose(np.zeros(3), q)
        low = lowest(shape, turn)
        gap = 10 ** rng.uniform(-14, -3) * rng.choice([1, 1, -1])
        x = np.array([*rng.uniform(-0.1, 0.1, 2), 0.5 + gap - low[2]])
        found = touching(shape, below, Pose(x, q))
        assert found.gap == pytest.approx(gap, abs=5e-14)
        np.testing.assert_allclose(found.on_a, x + low, atol=1e-13)
        np.testing.assert_allclose(found.normal, [0, 0, 1], atol=1e-14)


def lowest(shape, pose):
    down = quaternion.rotate_back(pose.q, np.array([0, 0, -1.0]))
    return quaternion.rotate(pose.q, shape.support(down))


@pytest.mark.parametrize("gap", [1e-3, 1e-7, 0.0, -1e-6])
def test_parallel_cylinders_touch_along_a_line_at_any_gap(gap):
    a, b = carom.Cylinder(0.1, 0.4), carom.Cylinder(0.2, 1.0)
    found = touching(a, b, Pose(np.array([0.3 + gap, 0, 0.1]), ORIGIN.q), reach=1e-6)
    ends = sorted(float(z) for z in found.points.on_a[:, 2])
    np.testing.assert_allclose(ends, [-0.1, 0.3], atol=1e-14)
    np.testing.assert_allclose(found.points.gap, gap, atol=1e-15)
    np.testing.assert_allclose(found.points.normal, np.tile([1, 0, 0], (2, 1)), atol=1e-14)
