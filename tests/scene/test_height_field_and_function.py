"""What height fields and surfaces of functions are: splines against SciPy's, bounds, and what is refused."""

import math

import numpy as np
import pytest
import sympy as sp
from scipy.interpolate import RectBivariateSpline

import carom
from carom.scene.surfaces import HeightField, Surface

BOX = [(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)]


def sphere(x, y, z):
    return 0.25 - x**2 - y**2 - z**2


def outwards(x, y, z):
    return -2 * x, -2 * y, -2 * z


def constant(x, y, z):
    return -2.0 * np.eye(3)


@pytest.mark.parametrize("shape", [(2, 2), (3, 5), (4, 4), (30, 20)])
def test_a_height_field_goes_through_its_heights(shape):
    heights = np.random.default_rng(0).normal(size=shape)
    field = HeightField(heights, (0.3, 0.7), corner=(1.0, 2.0))
    x, y = (c + s * np.arange(n) for c, s, n in zip((1.0, 2.0), (0.3, 0.7), shape))
    assert field.height(x[:, None], y) == pytest.approx(heights, abs=1e-12)
    if min(shape) > 3:  # the same spline of another library
        other = RectBivariateSpline(x, y, heights, s=0)
        u, v = np.random.default_rng(1).random((2, 50))
        u, v = x[0] + u * (x[-1] - x[0]), y[0] + v * (y[-1] - y[0])
        assert field.height(u, v) == pytest.approx(other.ev(u, v), abs=1e-12)
        # its curvature and slope are within the bounds
        fine = np.linspace(x[0], x[-1], 200), np.linspace(y[0], y[-1], 200)
        xx, yy, xy = (other(*fine, *k) for k in ((2, 0), (0, 2), (1, 1)))
        valley = 0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), xy)
        assert valley.max() <= field.bend
        assert np.hypot(other(*fine, 1, 0), other(*fine, 0, 1)).max() <= field.steepest


def test_a_paraboloid_is_exact():
    x = np.linspace(-1, 1, 21)
    field = HeightField(0.5 * (x[:, None] ** 2 + x**2), spacing=0.1)
    u, v = np.random.default_rng(0).uniform(-1, 1, (2, 100))
    assert field.height(u, v) == pytest.approx(0.5 * (u**2 + v**2), abs=1e-14)
    assert field.bend == pytest.approx(1.0, rel=1e-9)


def test_a_height_field_levels_out_beyond_its_border():
    heights = np.random.default_rng(2).normal(size=(6, 7))
    field = HeightField(heights, 0.5)
    end = -field.corner[0]
    x = end + np.linspace(-0.5, 6.0, 2601)
    bend = np.diff(field.height(x, 0.3), 2) / (x[1] - x[0]) ** 2
    assert np.max(np.abs(np.diff(bend))) < 0.02 * np.max(np.abs(bend))  # it has no jump
    far = field.height(end + np.array([5.6, 6.0, 60.0]), 0.3)
    assert far == pytest.approx(np.full(3, far[0]), rel=1e-12)


@pytest.mark.parametrize(
    ("given", "what"),
    [
        (dict(heights=[[1.0, 2.0]], spacing=1.0), "heights must be at least 2 along x and y"),
        (dict(heights=[[1.0, math.nan], [0, 0]], spacing=1.0), "heights must be finite"),
        (dict(heights=np.zeros((3, 3)), spacing=0.0), "spacing must be finite and above 0"),
        (dict(heights=np.zeros((3, 3)), spacing=(1.0, -1.0)), "spacing must be"),
    ],
)
def test_height_fields_that_are_none(given, what):
    with pytest.raises(ValueError, match=what):
        HeightField(**given)


def test_bounds_of_a_function():
    for given in ({}, {"gradient": outwards, "hessian": constant}):
        surface = Surface(sphere, BOX, **given)
        assert 2.0 <= surface.bend < 3.0
        assert 1.0 <= surface.steepest < 2.5
    hill = Surface(lambda x, y, z: x**2 + y**2 + z**2 - 0.25, BOX)
    assert hill.bend < 1e-12  # nothing is concave


@pytest.mark.parametrize(
    ("given", "what"),
    [
        (dict(function=lambda x, y, z: math.sin(x)), "must take symbols of SymPy .* raised TypeError"),
        (dict(function=lambda x, y, z: sp.log(x)), "must be finite where bodies are, .* domain error at"),
        (dict(function=lambda x, y, z: x * x), "above 0 on one side and below 0 on the other"),
        (dict(function=lambda x, y, z: z + 3), "got none such, and values from 2.5"),
        (dict(function=lambda x, y, z: math.nan), "must be a SymPy expression, got nan"),
        (dict(function=lambda x, y, z: z - sp.Symbol("a")), "must be of x, y and z only, got one of a"),
        (dict(gradient=outwards), "gradient and hessian must be given both"),
        (dict(gradient=outwards, hessian=lambda *x: np.eye(3)), "hessian must be the derivative of gradient"),
        (dict(gradient=lambda *x: x, hessian=constant), "gradient must be the derivative of function"),
        (dict(gradient=outwards, hessian=lambda *x: [1, 2]), r"hessian\(x, y, z\) must have shape \(3, 3\)"),
        (dict(bounds=[(0, 0, 0), (1, 1, 0)]), "sides above 0"),
    ],
)  # fmt: skip
def test_functions_that_are_no_surface(given, what):
    with pytest.raises(ValueError, match=what):
        Surface(**{"function": sphere, "bounds": BOX} | given)


def test_a_function_is_needed():
    with pytest.raises(TypeError, match="function must be a function, got 3"):
        carom.surfaces.Surface(3, BOX)
