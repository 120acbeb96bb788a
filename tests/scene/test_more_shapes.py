"""Ellipsoid, disc, compound, mesh: mass properties, support, bad input."""

import math

import numpy as np
import pytest

from carom.geometry import quaternion
from carom.scene import (
    Box,
    Capsule,
    Compound,
    Convex,
    Cylinder,
    Disc,
    Ellipsoid,
    Mesh,
    Scene,
    Sphere,
)

ALL = [
    Sphere(0.3),
    Box(0.2, 0.5, 0.9),
    Box(0.2, 0.5, 0.9, radius=0.05),
    Capsule(0.2, 0.7),
    Cylinder(0.2, 0.7),
    Disc(0.4),
    Ellipsoid(0.2, 0.3, 0.5),
    Convex([(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3)], radius=0.2),
    Compound([(Sphere(0.3), (0, 0, 0)), (Box(0.2, 0.2, 1), (1, 0, 0), (0.6, 0.8, 0, 0))]),
]
EIGHTH = quaternion.exp(np.array([0, 0, math.pi / 4]))


def cube(scale=1.0):
    vertices = scale * np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])


def ell():
    """An L-shaped prism: 2 x 2 less the square 1 x 1, 1 high; and its two convex parts."""
    outline = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], float)
    vertices = np.array([(x, y, z) for z in (0, 1) for x, y in outline])
    top = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    faces = [(a, c, b) for a, b, c in top] + [(a + 6, b + 6, c + 6) for a, b, c in top]
    for i in range(6):
        j = (i + 1) % 6
        faces += [(i, j, j + 6), (i, j + 6, i + 6)]
    parts = [
        [(x, y, z) for x in (0, 2) for y in (0, 1) for z in (0, 1)],
        [(x, y, z) for x in (0, 1) for y in (1, 2) for z in (0, 1)],
    ]
    return vertices, np.array(faces), parts


def test_ellipsoid():
    # V = 4/3 pi a b c, Jx = m (b^2 + c^2) / 5
    shape = Ellipsoid(0.2, 0.3, 0.5)
    assert shape.volume == pytest.approx(4 / 3 * math.pi * 0.03, rel=1e-15)
    expected = 2.5 / 5 * np.diag([0.09 + 0.25, 0.04 + 0.25, 0.04 + 0.09])
    np.testing.assert_allclose(shape.inertia(2.5), expected, rtol=1e-15)
    np.testing.assert_allclose(Ellipsoid(1, 1, 1).inertia(1), Sphere(1).inertia(1), rtol=1e-15)
    assert shape.size == 0.5


def test_disc_and_hoop():
    # Full: m R^2 / 2 about z; hoop: m R^2; across half of that.
    np.testing.assert_allclose(Disc(2).inertia(3), np.diag([3, 3, 6]), rtol=1e-15)
    np.testing.assert_allclose(Disc(2, inner_radius=2).inertia(3), np.diag([6, 6, 12]), rtol=1e-15)
    scene = Scene()
    scene.add_body(Disc(2), mass=1)
    with pytest.raises(ValueError, match="density needs a shape with a volume, got Disc"):
        scene.add_body(Disc(2), density=1)
    with pytest.raises(
        ValueError, match="inner_radius must be finite and at least 0 and at most 2"
    ):
        Disc(2, inner_radius=2.1)


@pytest.mark.parametrize("shape", ALL, ids=repr)
def test_support_is_the_farthest_point(shape):
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(300, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    points = np.array([shape.support(d) for d in directions])
    heights = points @ directions.T
    assert np.all(np.diag(heights) >= heights.max(axis=0) - 1e-14)
    assert np.max(np.linalg.norm(points, axis=1)) <= shape.size * (1 + 1e-14)
    np.testing.assert_allclose(shape.support((0, 0, 2.0)), shape.support((0, 0, 1)), atol=1e-15)
    with pytest.raises(ValueError, match="direction must not be the zero vector"):
        shape.support((0, 0, 0))


def test_compound_of_two_halves_is_the_whole():
    # A box cut in two by a plane across its diagonal axes stays one box.
    half = Box(0.5, 2, 3)
    whole = Compound([(half, (0.25, 0, 0)), (half, (-0.25, 0, 0))])
    box = Box(1, 2, 3)
    assert whole.volume == pytest.approx(box.volume, rel=1e-15)
    assert whole.size == pytest.approx(math.hypot(0.25, 0) + half.size, rel=1e-15)
    np.testing.assert_allclose(whole.inertia(2), box.inertia(2), rtol=1e-14)
    np.testing.assert_allclose(whole.centroid, 0, atol=1e-16)


def test_compound_moves_its_mass_centre_to_the_origin():
    # Masses 1 and 3 at x = 0 and 4: centre at 3; J_z of balls 2/5 m r^2 + m d^2.
    dumbbell = Compound([(Sphere(0.5), (0, 0, 0)), (Sphere(0.5), (4, 0, 0))], masses=(1, 3))
    np.testing.assert_allclose(dumbbell.centroid, (3, 0, 0), rtol=1e-15)
    along, across = 0.4 * 0.25, 0.4 * 0.25 + (9 + 3) / 4
    np.testing.assert_allclose(dumbbell.inertia(1), np.diag([along, across, across]), rtol=1e-14)
    positions = [piece.position[0] for piece in dumbbell.pieces]
    np.testing.assert_allclose(positions, (-3, 1), rtol=1e-15)
    np.testing.assert_allclose(dumbbell.support((1, 0, 0)), (1.5, 0, 0), atol=1e-15)


def test_turned_parts():
    # A long box turned by 45 degrees about z: J = R J R^T.
    turned = Compound([(Box(1, 0.2, 0.3), (1, 1, 1), EIGHTH)])
    axes = quaternion.matrix(EIGHTH)
    expected = axes @ Box(1, 0.2, 0.3).inertia(2) @ axes.T
    np.testing.assert_allclose(turned.inertia(2), expected, rtol=1e-14, atol=1e-16)
    corners = quaternion.rotate(EIGHTH, Box(1, 0.2, 0.3).vertices)
    np.testing.assert_allclose(turned.vertices, corners, atol=1e-15)


def test_compound_of_compounds():
    inner = Compound([(Sphere(0.5), (0, 0, 0)), (Sphere(0.5), (2, 0, 0))])
    outer = Compound([(inner, (0, 0, 5), EIGHTH), (Sphere(0.5), (0, 0, 2))])
    flat = [(Sphere(0.5), quaternion.rotate(EIGHTH, (x, 0, 0)) + (0, 0, 5)) for x in (-1.0, 1.0)]
    flat = Compound([*flat, (Sphere(0.5), (0, 0, 2))])
    assert outer.volume == pytest.approx(flat.volume, rel=1e-15)
    np.testing.assert_allclose(outer.centroid, flat.centroid, rtol=1e-15, atol=1e-16)
    np.testing.assert_allclose(outer.inertia(1), flat.inertia(1), rtol=1e-13, atol=1e-15)
    assert len(outer.pieces) == 3


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Compound([]), "parts must be a sequence of at least one"),
        (lambda: Compound([Sphere(1)]), r"parts\[0\] must be \(shape, position\)"),
        (lambda: Compound([(Sphere(1), (0, 0))]), r"parts\[0\]\[1\] must have shape \(3,\)"),
        (
            lambda: Compound([(Sphere(1), (0, 0, 0), (1, 1, 0, 0))]),
            r"parts\[0\]\[2\] must be a unit",
        ),
        (
            lambda: Compound([(Disc(1), (0, 0, 0))]),
            "masses must be given where a part has no volume",
        ),
        (lambda: Compound([(Disc(1), (0, 0, 0))], masses=[0]), "masses must be at least 0 and not"),
        (lambda: Compound([(Disc(1), (0, 0, 0))], masses=[1, 2]), r"masses must have shape \(1,\)"),
    ],
)
def test_bad_compounds_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_part_that_is_no_shape():
    with pytest.raises(TypeError, match=r"parts\[0\]\[0\] must be a .*got 3; a shape is needed"):
        Compound([(3, (0, 0, 0))])


def test_convex_mesh_is_its_hull():
    vertices, faces = cube(2.0)
    mesh, box = Mesh(vertices, faces), Box(2, 2, 2)
    assert mesh.convex
    assert mesh.volume == pytest.approx(8, rel=1e-15)
    np.testing.assert_allclose(mesh.centroid, (1, 1, 1), rtol=1e-15)
    np.testing.assert_allclose(mesh.inertia(3), box.inertia(3), rtol=1e-14, atol=1e-15)
    assert mesh.size == pytest.approx(box.size, rel=1e-15)
    np.testing.assert_allclose(
        sorted(map(tuple, mesh.vertices)), sorted(map(tuple, box.vertices)), atol=1e-15
    )


def test_mesh_with_parts_is_the_compound_of_them():
    vertices, faces, parts = ell()
    mesh = Mesh(vertices, faces, parts=parts)
    boxes = Compound([(Box(2, 1, 1), (1, 0.5, 0.5)), (Box(1, 1, 1), (0.5, 1.5, 0.5))])
    assert not mesh.convex
    assert mesh.volume == pytest.approx(3, rel=1e-15)
    np.testing.assert_allclose(mesh.centroid, boxes.centroid, rtol=1e-14)
    np.testing.assert_allclose(mesh.inertia(2), boxes.inertia(2), rtol=1e-13, atol=1e-15)
    for d in ((1, 0, 0), (-1, 2, 0.3), (0.2, -0.1, -5)):
        difference = (mesh.support(d) - boxes.support(d)) @ np.array(d)
        assert difference == pytest.approx(0, abs=1e-14)


def test_mesh_without_parts_cannot_touch_and_says_how():
    vertices, faces, _ = ell()
    scene = Scene()
    body = scene.add_body(Mesh(vertices, faces), density=1, position=(0, 0, 5))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    with pytest.raises(ValueError, match=r"is not convex and has no parts for contact; give them"):
        scene.add_contact(body, ground)


VERTICES, FACES = cube()


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (VERTICES, FACES[:-1], "faces must form a closed surface, got edge .* on one side only"),
        (VERTICES, FACES[:, ::-1], "oriented inwards; reverse them"),
        (
            VERTICES,
            [*FACES[:-1], FACES[-1][::-1]],
            "faces must have one orientation.* twice in one direction",
        ),
        (VERTICES, [*FACES, FACES[0]], "twice in one direction"),
        (VERTICES, [*FACES, (0, 0, 1)], r"faces must not be degenerate, got face 12 \[0, 0, 1\]"),
        (VERTICES, [*FACES, (0, 1, 8)], "faces must be numbers of vertices from 0 to 7, got 8"),
        (VERTICES, [*FACES, (0, 1, -1)], "faces must be numbers of vertices from 0 to 7, got -1"),
        (VERTICES, FACES * 1.0, r"faces must be whole numbers of shape \(k, 3\)"),
        (VERTICES, FACES[:3], "faces must be at least 4"),
        (VERTICES[:, :2], FACES, r"vertices must have shape \(n, 3\)"),
        (VERTICES * math.nan, FACES, "vertices must be finite"),
    ],
)
def test_bad_meshes_are_refused(vertices, faces, message):
    with pytest.raises(ValueError, match=message):
        Mesh(vertices, faces)


def test_bad_parts_are_refused():
    vertices, faces, parts = ell()
    with pytest.raises(ValueError, match=r"parts\[1\]: points must not all lie in one plane"):
        Mesh(vertices, faces, parts=[parts[0], parts[1][::2]])
    with pytest.raises(ValueError, match="parts must be at least one set of corners"):
        Mesh(vertices, faces, parts=[])
    with pytest.raises(ValueError, match="did you mean 'coacd'"):
        Mesh(vertices, faces, parts="coacdd")


def test_parts_by_coacd():
    pytest.importorskip("coacd")
    vertices, faces, _ = ell()
    mesh = Mesh(vertices, faces, parts="coacd")
    volume = sum(Convex(piece.vertices).volume for piece in mesh.pieces)
    assert volume == pytest.approx(3, rel=0.05)


def test_missing_package_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "coacd", None)
    vertices, faces, _ = ell()
    with pytest.raises(
        ImportError, match=r'package coacd; .*\n\n    pip install "carom\[shapes\]"'
    ):
        Mesh(vertices, faces, parts="coacd")


@pytest.mark.parametrize("bad", [0, -0.1, math.nan, math.inf, "wide", None])
@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (lambda bad: Ellipsoid(bad, 1, 1), "a"),
        (lambda bad: Ellipsoid(1, bad, 1), "b"),
        (lambda bad: Ellipsoid(1, 1, bad), "c"),
        (lambda bad: Disc(bad), "radius"),
    ],
)
def test_bad_lengths_are_refused(make, argument, bad):
    with pytest.raises(ValueError, match=rf"^{argument} must be"):
        make(bad)
