"""Volume, inertia, size and vertices of each shape against their closed forms."""

import math

import numpy as np
import pytest

from carom.scene import Box, Capsule, Convex, Cylinder, Sphere

MASS = 2.5
SHAPES = [
    Sphere(0.3),
    Box(0.2, 0.5, 0.9),
    Capsule(0.2, 0.7),
    Cylinder(0.2, 0.7),
    Convex([(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3)]),
]
TOUCHING = [shape for shape in SHAPES if not isinstance(shape, Cylinder)]


def test_sphere():
    # V = 4/3 pi r^3, J = 2/5 m r^2
    assert Sphere(0.3).volume == pytest.approx(4 / 3 * math.pi * 0.3**3, rel=1e-15)
    np.testing.assert_allclose(Sphere(0.3).inertia(MASS), 0.4 * MASS * 0.09 * np.eye(3), rtol=1e-15)
    np.testing.assert_array_equal(Sphere(0.3).vertices, [[0, 0, 0]])
    assert Sphere(0.3).radius == Sphere(0.3).size == 0.3


def test_box():
    # V = a b c, Jx = m (b^2 + c^2) / 12
    box = Box(0.2, 0.5, 0.9)
    assert box.volume == pytest.approx(0.09, rel=1e-15)
    principal = MASS / 12 * np.array([0.25 + 0.81, 0.04 + 0.81, 0.04 + 0.25])
    np.testing.assert_allclose(box.inertia(MASS), np.diag(principal), rtol=1e-15)
    assert len(np.unique(box.vertices, axis=0)) == 8
    np.testing.assert_array_equal(np.abs(box.vertices), np.tile([0.1, 0.25, 0.45], (8, 1)))
    assert box.radius == 0.0


def test_cylinder():
    # V = pi r^2 l, Jz = m r^2 / 2, Jx = m (3 r^2 + l^2) / 12
    cylinder = Cylinder(0.2, 0.7)
    assert cylinder.volume == pytest.approx(math.pi * 0.04 * 0.7, rel=1e-15)
    across = MASS * (3 * 0.04 + 0.49) / 12
    principal = np.diag([across, across, MASS * 0.02])
    np.testing.assert_allclose(cylinder.inertia(MASS), principal, rtol=1e-14)
    assert cylinder.size == math.hypot(0.2, 0.35)


def test_capsule_is_the_integral_of_its_discs():
    # A disc of radius s(z): dm = rho pi s^2 dz, dJz = dm s^2 / 2, dJx = dm (s^2 / 4 + z^2).
    # Gauss-Legendre is exact for these polynomials, piece by piece.
    r, l = 0.2, 0.7
    nodes, weights = np.polynomial.legendre.leggauss(8)
    z = np.concatenate([l / 4 * (nodes + 1), l / 2 + r / 2 * (nodes + 1)])  # upper half
    w = np.concatenate([l / 4 * weights, r / 2 * weights])
    s2 = r**2 - np.maximum(z - l / 2, 0) ** 2
    volume = 2 * np.sum(w * np.pi * s2)
    density = MASS / volume
    across = 2 * np.sum(w * density * np.pi * s2 * (s2 / 4 + z**2))
    along = 2 * np.sum(w * density * np.pi * s2 * s2 / 2)
    capsule = Capsule(r, l)
    assert capsule.volume == pytest.approx(volume, rel=1e-14)
    np.testing.assert_allclose(capsule.inertia(MASS), np.diag([across, across, along]), rtol=1e-13)
    np.testing.assert_allclose(capsule.vertices, [[0, 0, -0.35], [0, 0, 0.35]], rtol=1e-15)


def test_capsule_without_straight_part_is_a_sphere():
    short, ball = Capsule(0.2, 1e-9), Sphere(0.2)
    assert short.volume == pytest.approx(ball.volume, rel=1e-8)
    np.testing.assert_allclose(short.inertia(MASS), ball.inertia(MASS), rtol=1e-8)


@pytest.mark.parametrize("shape", SHAPES, ids=repr)
def test_inertia_is_physical_and_grows_with_mass(shape):
    inertia = shape.inertia(MASS)
    moments = np.linalg.eigvalsh(inertia)
    assert inertia.shape == (3, 3)
    np.testing.assert_array_equal(inertia, inertia.T)
    assert moments[0] > 0
    assert moments[2] <= moments[0] + moments[1]
    np.testing.assert_allclose(shape.inertia(2 * MASS), 2 * inertia, rtol=1e-15)


@pytest.mark.parametrize("shape", TOUCHING, ids=repr)
def test_size_is_the_farthest_vertex_and_the_radius(shape):
    farthest = np.max(np.linalg.norm(shape.vertices, axis=1)) + shape.radius
    assert shape.size == pytest.approx(farthest, rel=1e-15)


def test_cylinder_cannot_touch_and_says_which_can():
    with pytest.raises(ValueError, match=r"Cylinder.*Sphere, Box, Capsule and Convex"):
        _ = Cylinder(0.2, 0.7).vertices


@pytest.mark.parametrize("bad", [0, -0.1, math.nan, math.inf, "wide", None])
@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (Sphere, "radius"),
        (lambda bad: Box(bad, 1, 1), "lx"),
        (lambda bad: Box(1, bad, 1), "ly"),
        (lambda bad: Box(1, 1, bad), "lz"),
        (lambda bad: Capsule(bad, 1), "radius"),
        (lambda bad: Capsule(1, bad), "length"),
        (lambda bad: Cylinder(bad, 1), "radius"),
        (lambda bad: Cylinder(1, bad), "length"),
    ],
)
def test_bad_lengths_are_refused(make, argument, bad):
    with pytest.raises(ValueError, match=rf"^{argument} must be") as error:
        make(bad)
    assert repr(bad) in str(error.value)
