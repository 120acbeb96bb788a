"""Surfaces of shapes: closed, oriented outwards, on the shape, and of its volume."""

from collections import Counter

import numpy as np
import pytest

import carom
from carom.visual.surfaces import surface

TURN = (np.cos(0.4), 0.0, np.sin(0.4), 0.0)
RANDOM = np.random.default_rng(5).normal(size=(30, 3))
CUBE = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)], dtype=float)
TETRA = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
SHARP = [
    carom.Box(1.0, 2.0, 3.0),
    carom.Convex(RANDOM),
    carom.Convex(CUBE),
    carom.Mesh(TETRA, FACES),
    carom.Compound([(carom.Box(1, 1, 1), (0, 0, 0)), (carom.Box(1, 2, 1), (2, 0, 0), TURN)]),
]
ROUND = [
    carom.Sphere(0.7),
    carom.Box(1.0, 2.0, 3.0, radius=0.2),
    carom.Box(1.0, 2.0, 2.0, radius=0.5),
    carom.Box(1.0, 1.0, 1.0, radius=0.5),
    carom.Capsule(0.3, 2.0),
    carom.Cylinder(0.3, 2.0),
    carom.Ellipsoid(1.0, 0.5, 0.2),
    carom.Convex(RANDOM, radius=0.4),
    carom.Convex(CUBE, radius=3.0),
    carom.Compound([(carom.Sphere(1.0), (0, 0, 0)), (carom.Capsule(1.0, 0.5), (2, 0, 0), TURN)]),
]
FLAT = [carom.Disc(1.0), carom.Disc(1.0, 0.5), carom.Disc(1.0, 1.0)]


def volume(vertices, triangles):
    return np.linalg.det(vertices[triangles]).sum() / 6.0


@pytest.mark.few(12)
@pytest.mark.parametrize("shape", SHARP + ROUND + FLAT, ids=repr)
@pytest.mark.parametrize("fineness", [4, 9])
def test_each_edge_is_passed_once_in_each_sense(shape, fineness):
    vertices, triangles = surface(shape, fineness)
    assert vertices.dtype == np.float64
    assert triangles.dtype == np.int64
    assert set(triangles.ravel()) == set(range(len(vertices)))
    edges = Counter((int(t[k]), int(t[k - 2])) for t in triangles for k in range(3))
    assert set(edges.values()) == {1}
    assert all((b, a) in edges for a, b in edges)


@pytest.mark.parametrize("shape", SHARP, ids=repr)
def test_sharp_shapes_are_exact(shape):
    assert volume(*surface(shape)) == pytest.approx(shape.volume, rel=1e-12)


@pytest.mark.few(10)
@pytest.mark.parametrize("shape", ROUND, ids=repr)
@pytest.mark.parametrize("fineness", [4, 8, 32])
def test_round_shapes_lose_at_most_the_stated_volume(shape, fineness):
    missing = 1.0 - volume(*surface(shape, fineness)) / shape.volume
    assert 0.0 < missing <= 24.0 / fineness**2


@pytest.mark.parametrize("shape", FLAT, ids=repr)
def test_flat_shapes_have_two_sides_and_no_volume(shape):
    vertices, triangles = surface(shape, 128)
    assert abs(volume(vertices, triangles)) < 1e-15
    corners = vertices[triangles]
    areas = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    hole = min(shape.inner_radius, 0.94 * shape.radius)
    area = np.pi * (shape.radius**2 - hole**2)
    assert areas[areas > 0].sum() == pytest.approx(area, rel=1e-3)
    assert areas[areas < 0].sum() == pytest.approx(-area, rel=1e-3)


@pytest.mark.parametrize(
    "shape", [s for s in SHARP + ROUND if not isinstance(s, carom.Compound)], ids=repr
)
def test_triangles_of_convex_shapes_look_outwards_and_their_corners_lie_on_the_shape(shape):
    vertices, triangles = surface(shape, 8)
    size = np.max(np.abs(vertices))
    # the mass centre is inside: it sees the inner side of each triangle of more than no area
    assert np.min(np.linalg.det(vertices[triangles])) > -1e-12 * size**3
    for vertex in vertices:  # none reaches beyond the shape
        direction = vertex / np.linalg.norm(vertex)
        assert shape.support(direction) @ direction >= np.linalg.norm(vertex) - 1e-9 * size
    assert np.ptp(vertices, axis=0) == pytest.approx(
        [shape.support(e) @ e + shape.support(-e) @ -e for e in np.eye(3)], rel=0.1
    )


def test_parts_of_a_compound_are_where_they_are():
    dumbbell = carom.Compound([(carom.Sphere(0.1), (0, 0, 0)), (carom.Sphere(0.2), (0, 0, 1.0))])
    vertices, _ = surface(dumbbell, 16)
    assert vertices[:, 2].min() == pytest.approx(-0.1 - dumbbell.centroid[2], abs=1e-12)
    assert vertices[:, 2].max() == pytest.approx(1.2 - dumbbell.centroid[2], abs=1e-12)


@pytest.mark.parametrize("fineness", [3, 2.5, True])
def test_a_wrong_fineness_is_named(fineness):
    with pytest.raises(ValueError, match="fineness"):
        surface(carom.Sphere(1.0), fineness)


def test_what_is_no_shape_is_named():
    with pytest.raises(TypeError, match="shape"):
        surface("sphere")
