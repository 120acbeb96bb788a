"""Curves: arc length, position, direction and curvature against those of functions; what is refused."""

import copy
import math
import pickle

import numpy as np
import pytest

import carom
from carom.scene.curves import Curve, Spline

CIRCLE = {"start": 0.0, "end": 2 * math.pi, "closed": True}


def circle(u):
    return 2.0 * math.cos(u), 2.0 * math.sin(u), 5.0


def test_circle_by_arc_length():
    curve = Curve(lambda u: circle(u + 0.3 * math.sin(u)), **CIRCLE)  # not at a steady speed
    assert curve.length == pytest.approx(4 * math.pi, abs=1e-12)
    s = np.linspace(-5.0, 20.0, 400)  # it has no ends
    point = np.stack([2 * np.cos(s / 2), 2 * np.sin(s / 2), 5.0 + 0 * s], axis=1)
    np.testing.assert_allclose(curve.point(s), point, atol=4e-12)
    across = np.stack([-np.sin(s / 2), np.cos(s / 2), 0 * s], axis=1)
    np.testing.assert_allclose(curve.tangent(s), across, atol=1e-10)
    # by differences of second order: round-off of values over the square of a spacing; 1e-11 was measured for
    # functions that differ in the last place
    assert curve.sharpest == pytest.approx(0.5, abs=1e-10)
    assert curve.nearest((0.0, 3.0, 4.0)) == pytest.approx(math.pi, abs=1e-9)


def test_pieces_are_continuous_to_the_second_derivative():
    curve = Spline(np.random.default_rng(1).normal(size=(9, 3)), closed=True)
    c, h = curve.coefficients, np.diff(curve.knots)[:, None]
    for k in range(3):  # derivatives at the ends of pieces are those at the starts of the next ones
        terms = [c[n] * h ** (n - k) * math.perm(n, k) for n in range(k, 6)]
        scale = np.max(np.abs(c[k])) * math.factorial(k)
        np.testing.assert_allclose(
            sum(terms), np.roll(c[k], -1, 0) * math.factorial(k), atol=1e-10 * scale
        )
    across, tangent = curve.normals, curve.ends[:-1, 1]
    np.testing.assert_allclose(np.linalg.norm(across, axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.sum(across * tangent, axis=1), 0.0, atol=1e-12)
    turns = np.linalg.norm(across - np.roll(across, 1, 0), axis=1)
    assert np.max(turns) < 0.2  # also where it closes


def test_spline_goes_through_its_points_and_is_cubic():
    from scipy.interpolate import CubicSpline

    points = np.random.default_rng(2).normal(size=(7, 3))
    curve = Spline(points)
    feet = [curve.nearest(point) for point in points]
    np.testing.assert_allclose(curve.point(feet), points, atol=1e-11)
    assert np.all(np.diff(feet) > 0.0)
    chords = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    between = CubicSpline(chords, points)(np.linspace(0, chords[-1], 50))
    away = [np.linalg.norm(curve.point(curve.nearest(point)) - point) for point in between]
    assert max(away) < 1e-11
    straight = Spline([(0, 0, 1), (3, 0, 5)])
    assert straight.length == pytest.approx(5.0, abs=1e-14)
    assert straight.sharpest < 1e-12


def test_copies_and_pickles():
    curve = Curve(circle, **CIRCLE)
    for again in (copy.deepcopy(curve), pickle.loads(pickle.dumps(curve))):
        assert np.array_equal(again.ends, curve.ends)
        assert again.length == curve.length
    with pytest.raises(AttributeError):
        curve.closed = False
    assert repr(curve) == f"Curve(length=12.5664 m, {len(curve.knots) - 1} pieces, closed)"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Spline([(0, 0, 0)]), "points must be at least 2 of an open spline, got 1"),
        (lambda: Spline([(0, 0, 0), (1, 0, 0)], closed=True), "at least 3 of a closed spline, got 2"),
        (lambda: Spline([(0, 0, 0), (0, 0, 0), (1, 0, 0)]), "must differ from the next ones"),
        (lambda: Spline([(0, 0, 0), (1, 1, 0), (0, 0, 0)], closed=True), "is not repeated"),
        (lambda: Spline([(0, 0, 0), (1, 0, math.nan)]), "points must be finite"),
        (lambda: Curve(lambda u: (u, abs(u), 0), -1), "a jump of its direction"),
        (lambda: Curve(lambda u: (u, u * abs(u), 0), -1), "a jump of its curvature"),
        (lambda: Curve(lambda u: (u, abs(u - 0.3), 0)), "near the parameter 0.3"),
        (lambda: Curve(lambda u: (u**2, u**3, 0), -1), "without a cusp"),
        (lambda: Curve(lambda u: (u**2, 0, 0)), "without a cusp"),
        (lambda: Curve(lambda u: (1e-9 * u**2, u**3 + 1e-9 * u, 0), -1), "radii of curvature above"),
        (lambda: Curve(lambda u: (u, u**2, 0), closed=True), "closed must be False .* a jump of its position"),
        (lambda: Curve(lambda u: (1, 2, 3)), "a length above 0"),
        (lambda: Curve(lambda u: (u, 0)), "must return a finite point"),
        (lambda: Curve(lambda u: (u, math.inf, 0)), "must return a finite point"),
        (lambda: Curve(circle, 1.0, 1.0), "end must be finite and above 1"),
    ],
)  # fmt: skip
def test_what_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_a_joint_needs_a_curve():
    with pytest.raises(TypeError, match=r"curve must be a Curve, got .*Spline"):
        carom.joints.PointOnCurve([(0, 0, 0), (1, 0, 0)])
