"""`Profile`: area, inertia and size in closed form, corners, what is refused, files, its surface."""

import math
import pickle

import numpy as np
import pytest

import carom
from carom.visual.surfaces import surface
from verified import agree, verifies


def disc(a):
    return 0.02 + 0.05 * math.cos(a), 0.05 * math.sin(a)


def star(teeth=8):
    turns = [2.0 * math.pi * k / teeth for k in range(teeth)]
    return [(r * math.cos(a), r * math.sin(a)) for a in turns for r in (0.04, 0.05)]


@verifies("Profile", "a circle: volume, inertia and support of a cylinder", "closed form")
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_circle_is_a_cylinder(way):
    shape, cylinder = carom.Profile(lambda a: disc(way * a), 0.01), carom.Cylinder(0.05, 0.01)
    agree(shape.centroid, (0.02, 0, 0), atol=1e-13)
    agree(shape.volume, cylinder.volume, rtol=1e-11)
    agree(shape.inertia(2.0), cylinder.inertia(2.0), atol=1e-14)
    agree(shape.size, cylinder.size, rtol=1e-12)
    agree(shape.support((0.6, -0.8, 0))[:2], (0.03, -0.04), atol=4e-12)


def test_square_is_a_box():
    square = carom.Profile([(0, 0), (0, 1), (1, 1), (1, 0)], 2.0, corners="all")
    box = carom.Box(1, 1, 2)
    assert square.volume == pytest.approx(box.volume)
    np.testing.assert_allclose(square.inertia(3.0), box.inertia(3.0), atol=1e-14)
    assert square.size == pytest.approx(box.size)
    np.testing.assert_allclose(square.support((1, 1, 0.1)), (0.5, 0.5, 1.0))


@verifies("Profile", r"$r = R (1 + a \cos 3t)$: area $\pi R^2 (1 + a^2/2)$", "closed form")
def test_area_by_polar_integral():
    # r = R (1 + a cos 3 t): the area is pi R^2 (1 + a^2/2)
    shape = carom.Profile(lambda t: 0.05 * (1 + 0.3 * math.cos(3 * t)), 0.01)
    agree(shape.volume, 0.01 * math.pi * 0.05**2 * (1 + 0.3**2 / 2), rtol=1e-11)
    # kappa at the hollows, t = pi/3: (r^2 - r r'')/r^3 with r = .7 R, r'' = 2.7 R
    np.testing.assert_allclose(
        shape.pieces[0].hollows[:, 1], (0.7 - 2.7) / 0.7**2 / 0.05, rtol=1e-3
    )


def test_some_points_are_corners():
    # a half disc: a spline around, and a straight line back
    angles = np.linspace(0.0, math.pi, 40)
    points = np.column_stack([np.cos(angles), np.sin(angles)])
    half = carom.Profile(points, 1.0, corners=[0, 39])
    assert half.volume == pytest.approx(math.pi / 2, rel=1e-6)
    assert half.centroid[1] == pytest.approx(4 / (3 * math.pi), rel=1e-6)
    assert half.length == pytest.approx(math.pi + 2, rel=1e-6)


def test_surface_is_closed_and_encloses_the_volume():
    shape = carom.Profile(star(), 0.01, corners="all")
    vertices, triangles = surface(shape)
    assert np.linalg.det(vertices[triangles]).sum() / 6 == pytest.approx(shape.volume)
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    assert {(a, b) for a, b in edges.tolist()} == {(b, a) for a, b in edges.tolist()}


@pytest.mark.parametrize(
    ("outline", "corners", "words"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "all", "cross itself"),
        ([(0, 0), (1, 0)], "all", "at least 3"),
        ([(0, 0), (1, 0), (1, 0), (1, 1)], "all", "differ from the next"),
        ([(0, 0), (1, 0), (2, 0)], "all", "enclose an area"),
        (lambda a: abs(a - 3.0) + 1.0, (), "smooth"),
        (lambda a: math.cos(a), (), "above 0"),
        (lambda a: (1.0, 2.0, 3.0), (), "or a point"),
        (lambda a: 1.0, [0], "left out"),
        (lambda a: 10**400, (), "must return the distance from the axis"),
    ],
)
def test_curves_that_are_none(outline, corners, words):
    with pytest.raises(ValueError, match=words):
        carom.Profile(outline, 1.0, corners=corners)


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (carom.Ellipsoid(0.1, 0.2, 0.3), "an Ellipsoid"),
        (carom.Convex([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]), "not parallel"),
    ],
)
def test_partners_that_it_has_not(other, words):
    scene = carom.Scene()
    scene.add_body(carom.Profile(star(), 0.01, corners="all"), mass=1.0, name="a")
    scene.add_body(other, mass=1.0, position=(9, 0, 0), name="b")
    with pytest.raises(ValueError, match=words):
        scene.add_contact("a", "b")
    scene.set_contact_default(restitution=0.5, friction=0.1)
    with pytest.raises(ValueError, match=words):
        carom.simulate(scene, 0.1)
    scene.ignore_contact("a", "b")
    assert carom.simulate(scene, 0.01).success


def test_axes_must_be_parallel():
    scene = carom.Scene()
    cam = scene.add_body(carom.Profile(disc, 0.01), mass=1.0)
    roller = scene.add_body(
        carom.Cylinder(0.1, 0.1), mass=1.0, position=(9, 0, 0), orientation=carom.euler("x", 5)
    )
    with pytest.raises(ValueError, match="not parallel"):
        scene.add_contact(roller, cam)
    floor = scene.add_half_space((0, 0, -9), (0, 0, 1))
    with pytest.raises(ValueError, match="not across the axis"):
        scene.add_contact(cam, floor)


def test_files_and_pickles(tmp_path):
    scene = carom.Scene(gravity=(0, -9.81, 0))
    wheel = carom.Profile(star(), 0.01, corners="all")
    both = carom.Compound(
        [(carom.Profile(disc, 0.01), (0, 0, 0)), (carom.Sphere(0.01), (0, 0, 0.05))]
    )
    scene.add_body(wheel, mass=1.0, name="wheel")
    scene.add_body(both, mass=1.0, position=(1, 0, 0), name="both")
    floor = scene.add_half_space((0, -0.06, 0), (0, 1, 0))
    for name in ("wheel", "both"):
        scene.add_contact(name, floor, restitution=0.3, friction=0.2)
    solution = carom.simulate(scene, 0.2)
    solution.save(tmp_path / "run.nc")
    for again in (
        carom.Solution.load(tmp_path / "run.nc"),
        pickle.loads(pickle.dumps(solution)),
    ):
        np.testing.assert_array_equal(again.scene["wheel"].shape.rows, wheel.rows)
        np.testing.assert_array_equal(carom.simulate(again.scene, 0.2).position, solution.position)
