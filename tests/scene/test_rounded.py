"""Rounded boxes and hulls: volume, centroid and inertia against closed forms and by other ways."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.scene import Box, Capsule, Convex, Sphere

CORNERS = np.array([(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
EDGES = st.floats(0.05, 2)


def test_all_rounding_is_a_sphere():
    # A cube rounded by half its edge is a ball.
    box, ball = Box(0.6, 0.6, 0.6, radius=0.3), Sphere(0.3)
    assert box.volume == pytest.approx(ball.volume, rel=1e-14)
    np.testing.assert_allclose(box.inertia(2), ball.inertia(2), rtol=1e-14)
    assert box.size == pytest.approx(0.3, rel=1e-15)
    assert box.pieces[0].kind == "point"


def test_box_with_square_section_of_all_rounding_is_a_capsule():
    box, capsule = Box(0.4, 0.4, 1.4, radius=0.2), Capsule(0.2, 1.0)
    assert box.volume == pytest.approx(capsule.volume, rel=1e-14)
    np.testing.assert_allclose(box.inertia(2), capsule.inertia(2), rtol=1e-13)


@settings(deadline=None, max_examples=40)
@given(EDGES, EDGES, EDGES, st.floats(0, 1))
def test_box_is_the_integral_of_its_slices(lx, ly, lz, part):
    # A slice at x, |x| = a + s, is a rectangle rounded by r(s) = sqrt(r^2 - s^2) (r inside the core):
    # area 4 b c + 4 r (b + c) + pi r^2; and so for the other two axes.
    radius = part * min(lx, ly, lz) / 2
    box = Box(lx, ly, lz, radius=radius)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    moments = []
    for i in range(3):
        a, b, c = np.roll(box.half, -i)
        t = 0.5 * math.pi / 2 * (nodes + 1)  # s = r sin t: smooth
        s, r = radius * np.sin(t), radius * np.cos(t)
        area = 4 * b * c + 4 * r * (b + c) + math.pi * r**2
        w = weights * math.pi / 4 * r
        whole = 4 * b * c + 4 * radius * (b + c) + math.pi * radius**2
        volume = 2 * a * whole + 2 * np.sum(w * area)
        moments.append((2 * a**3 / 3 * whole + 2 * np.sum(w * area * (a + s) ** 2)) / volume)
        assert box.volume == pytest.approx(volume, rel=1e-12)
    x, y, z = moments
    np.testing.assert_allclose(box.inertia(3), 3 * np.diag([y + z, x + z, x + y]), rtol=1e-12)


@settings(deadline=None, max_examples=25)
@given(EDGES, EDGES, EDGES, st.floats(0.01, 0.99))
def test_hull_of_the_core_is_the_rounded_box(lx, ly, lz, part):
    radius = part * min(lx, ly, lz) / 2
    box = Box(lx, ly, lz, radius=radius)
    hull = Convex(box.half * CORNERS + (3, -2, 1), radius=radius)
    assert hull.volume == pytest.approx(box.volume, rel=1e-11)
    assert hull.size == pytest.approx(box.size, rel=1e-11)
    np.testing.assert_allclose(hull.centroid, (3, -2, 1), atol=1e-11)
    scale = box.inertia(1).max()
    np.testing.assert_allclose(hull.inertia(1), box.inertia(1), atol=1e-10 * scale)


@pytest.mark.parametrize("seed", [0, 2])
def test_rounded_hull_by_layers(seed):
    # dV/dr is the area, so V(r) = integral of the areas; the same for each moment: compare with the
    # sampled mean over random points of a ball around, to three standard errors of 2e6 points.
    rng = np.random.default_rng(seed)
    hull = Convex(rng.normal(size=(7, 3)), radius=0.5)
    points = rng.uniform(-1, 1, (400_000, 3)) * hull.size
    inside = distance_to(hull, points) <= hull.radius
    volume = (2 * hull.size) ** 3 * inside.mean()
    error = (2 * hull.size) ** 3 * math.sqrt(inside.mean() * (1 - inside.mean()) / len(points))
    assert abs(hull.volume - volume) < 4 * error
    chosen = points[inside]
    spread = np.abs(chosen).std(axis=0)
    assert np.all(np.abs(chosen.mean(axis=0)) < 4 * spread / math.sqrt(len(chosen)) + 1e-3)
    second = chosen.T @ chosen / len(chosen)
    sampled = np.trace(second) * np.eye(3) - second
    scatter = 4 * hull.size**2 / math.sqrt(len(chosen))
    np.testing.assert_allclose(hull.inertia(1), sampled, atol=scatter)


def distance_to(hull, points):
    """Distance of points from the core of a hull, by alternating projection onto its half-spaces (Dykstra)."""
    normals = np.array([normal for normal, _ in hull.faces])
    offsets = np.array([hull.vertices[ring[0]] @ normal for normal, ring in hull.faces])
    out = points @ normals.T - offsets
    near = out.max(axis=1)
    result = np.where(near <= 0, 0.0, np.inf)
    todo = np.flatnonzero((near > 0) & (near <= hull.radius))  # the others are too far or inside
    x, corrections = points[todo].copy(), np.zeros((len(normals), len(todo), 3))
    for _ in range(150):
        for k, (normal, offset) in enumerate(zip(normals, offsets)):
            y = x + corrections[k]
            over = np.maximum(y @ normal - offset, 0)
            x = y - over[:, None] * normal
            corrections[k] = y - x
    result[todo] = np.linalg.norm(points[todo] - x, axis=1)
    return result


def test_rounded_hull_moved_and_turned():
    rng = np.random.default_rng(5)
    points = rng.normal(size=(9, 3))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    hull, moved = Convex(points, 0.3), Convex(points @ turn.T + (5, 6, 7), 0.3)
    assert moved.volume == pytest.approx(hull.volume, rel=1e-12)
    np.testing.assert_allclose(moved.centroid, turn @ hull.centroid + (5, 6, 7), rtol=1e-12)
    np.testing.assert_allclose(moved.inertia(1), turn @ hull.inertia(1) @ turn.T, atol=1e-12)


def test_faces_are_rings_from_outside():
    hull = Convex(Box(1, 2, 3).vertices)
    assert sorted(len(ring) for _, ring in hull.faces) == [4] * 6
    for normal, ring in hull.faces:
        p = hull.vertices[list(ring)]
        assert np.ptp(p @ normal) < 1e-14
        turn = np.cross(p[1] - p[0], p[2] - p[1])
        assert turn @ normal > 0
        assert np.max(hull.vertices @ normal) == pytest.approx(p[0] @ normal, abs=1e-14)


def test_words():
    assert repr(Box(1, 2, 3)) == "Box(lx=1.0, ly=2.0, lz=3.0)"
    assert repr(Box(1, 2, 3, radius=0.1)) == "Box(lx=1.0, ly=2.0, lz=3.0, radius=0.1)"
    assert repr(Convex(CORNERS, radius=0.1)) == "Convex(<8 vertices>, radius=0.1)"


@pytest.mark.parametrize("bad", [-1e-9, 0.51, math.nan, "soft"])
def test_bad_radius_is_refused(bad):
    with pytest.raises(ValueError, match=r"^radius must be"):
        Box(1, 2, 3, radius=bad)
    if bad != 0.51:
        with pytest.raises(ValueError, match=r"^radius must be"):
            Convex(CORNERS, radius=bad)
