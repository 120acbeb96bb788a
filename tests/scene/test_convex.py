"""The hull of points as a solid: against box, tetrahedron and prism."""

import math

import numpy as np
import pytest

from carom.scene import Box, Convex

TETRAHEDRON = np.array([(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3.0)])


def rotation(seed=0):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


def test_box_from_its_corners_and_inner_points():
    box = Box(0.2, 0.5, 0.9)
    inner = np.random.default_rng(1).uniform(-0.09, 0.09, (50, 3))
    hull = Convex(np.concatenate([inner, box.vertices, box.vertices]))
    assert len(hull.vertices) == 8
    assert hull.volume == pytest.approx(box.volume, rel=1e-14)
    assert hull.size == pytest.approx(box.size, rel=1e-14)
    np.testing.assert_allclose(hull.inertia(2.0), box.inertia(2.0), rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(hull.centroid, 0, atol=1e-16)


def test_points_on_faces_and_edges_are_dropped():
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 5)] * 3), -1).reshape(-1, 3)
    assert len(Convex(grid).points) == 8


def test_tetrahedron():
    # Corners 0, (a,0,0), (0,b,0), (0,0,c): V = a b c / 6, centroid (a,b,c)/4, and about it the mean
    # of x^2 is 3 a^2 / 80 and of x y is -a b / 80 (from a^2/10, a b/20 about the corner).
    edges = np.array([1.0, 2.0, 3.0])
    hull = Convex(TETRAHEDRON)
    assert hull.volume == pytest.approx(1.0, rel=1e-14)
    np.testing.assert_allclose(hull.centroid, edges / 4, rtol=1e-14)
    spread = -np.outer(edges, edges) / 80 + np.diag(edges**2) * (4 / 80)
    expected = 5.0 * (np.trace(spread) * np.eye(3) - spread)
    np.testing.assert_allclose(hull.inertia(5.0), expected, rtol=1e-13)


def test_vertices_are_the_points_about_the_centroid():
    hull = Convex(TETRAHEDRON)
    np.testing.assert_array_equal(hull.vertices, hull.points - hull.centroid)
    assert {tuple(p) for p in hull.points} == {tuple(p) for p in TETRAHEDRON}
    assert hull.size == pytest.approx(math.dist((0, 0, 3), (0.25, 0.5, 0.75)), rel=1e-14)
    assert hull.radius == 0.0


def test_parallel_axes_two_halves_make_the_whole():
    # A box cut in two: J = sum of J_i + m_i (|d|^2 1 - d d^T), d from the common mass centre.
    corners = Box(1, 2, 3).vertices
    cut = np.array([(0.3 * y - 0.1 * z, y, z) for y in (-1, 1) for z in (-1.5, 1.5)])
    left = Convex(np.concatenate([corners[corners[:, 0] < 0], cut]))
    right = Convex(np.concatenate([corners[corners[:, 0] > 0], cut]))
    assert left.volume + right.volume == pytest.approx(6.0, rel=1e-14)
    total = np.zeros((3, 3))
    for half in (left, right):
        mass, d = half.volume, half.centroid
        total += half.inertia(mass) + mass * (d @ d * np.eye(3) - np.outer(d, d))
    np.testing.assert_allclose(total, Box(1, 2, 3).inertia(6.0), rtol=1e-13, atol=1e-14)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e4])
def test_moved_turned_scaled(scale):
    turn, shift = rotation(), np.array([3.0, -1.0, 2.0])
    hull, moved = Convex(TETRAHEDRON), Convex(scale * (TETRAHEDRON @ turn.T + shift))
    assert moved.volume == pytest.approx(scale**3 * hull.volume, rel=1e-13)
    np.testing.assert_allclose(moved.centroid, scale * (turn @ hull.centroid + shift), rtol=1e-13)
    expected = scale**2 * turn @ hull.inertia(1.0) @ turn.T
    np.testing.assert_allclose(moved.inertia(1.0), expected, rtol=1e-11, atol=1e-13 * scale**2)


def test_frozen():
    hull = Convex(TETRAHEDRON)
    with pytest.raises(ValueError, match="read-only"):
        hull.vertices[0, 0] = 1.0
    assert repr(hull) == "Convex(<4 vertices>)"


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (TETRAHEDRON[:3], "points must be at least 4.*got 3"),
        (np.random.default_rng(0).normal(size=(9, 3)) * (1, 1, 0), "points must not.*got 9 points"),
        (np.outer(np.arange(5.0), (1, 2, 3)), "points must not all lie in one plane"),
        (np.ones((6, 3)), "points must not all lie in one plane"),
        ([(0, 0), (1, 0), (0, 1), (1, 1)], r"points must have shape \(n, 3\).*\(4, 2\)"),
        (np.where(TETRAHEDRON == 3, math.nan, TETRAHEDRON), "points must be finite, got .*nan"),
        ("cube", r"points must be numbers of shape \(n, 3\), got 'cube'"),
    ],
)
def test_bad_points_are_refused(points, message):
    with pytest.raises(ValueError, match=f"(?s){message}"):
        Convex(points)


def many_corners():
    """Hulls of triangles alone, and of faces with more corners."""
    rng = np.random.default_rng(11)
    turn = 2.0 * np.pi * np.arange(40) / 40
    rings = [np.stack([r * np.cos(turn), r * np.sin(turn), np.full(40, z)], -1)
             for r, z in ((0.5, -1.0), (1.0, -0.3), (1.0, 0.3), (0.5, 1.0))]  # fmt: skip
    ball = rng.normal(size=(300, 3))
    return {"triangles": ball / np.linalg.norm(ball, axis=1)[:, None], "quads": np.vstack(rings)}


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("kind", "faces"), [("triangles", 596), ("quads", 122)])
def test_faces_of_many_corners(kind, faces, turned):
    """Euler: V - E + F = 2, each edge once in each sense; rings turn about their normals."""
    points = many_corners()[kind]
    hull = Convex(points @ rotation(3).T if turned else points)
    assert len(hull.faces) == faces
    edges = [(i, j) for _, ring in hull.faces for i, j in zip(ring, (*ring[1:], ring[0]))]
    assert len(set(edges)) == len(edges)
    assert {(j, i) for i, j in edges} == set(edges)
    assert len(hull.vertices) - len(edges) // 2 + faces == 2
    for normal, ring in hull.faces:
        corners = hull.vertices[list(ring)]
        across = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)  # twice the area
        np.testing.assert_allclose(across, np.linalg.norm(across) * normal, atol=1e-12)
        assert np.ptp(corners @ normal) < 1e-12
        assert (hull.vertices @ normal).max() < (corners @ normal).max() + 1e-12
