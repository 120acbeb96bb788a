"""Drag, wind, lift and buoyancy against closed forms, and what they refuse."""

import numpy as np
import pytest
from numba import njit
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import carom
from carom import forces
from carom.scene.fluids import drag_coefficient, mean_area
from carom.visual.surfaces import surface
from verified import agree, verifies

G = 9.81


def thrown(force, velocity=(0, 0, 0), spin=(0, 0, 0), gravity=G, shape=None, mass=0.2):
    scene = carom.Scene(gravity=(0, 0, -gravity))
    body = scene.add_body(
        carom.Sphere(0.1) if shape is None else shape, mass=mass, velocity=velocity, angular_velocity=spin,
        name="ball",
    )  # fmt: skip
    scene.add_force(force, body, name="fluid")
    return scene


@verifies("forces.Drag", r"$v = v_t \tanh(g t/v_t)$", "closed form")
def test_a_fall_with_drag():
    """V = v_t tanh(g t/v_t), z = -v_t^2/g log cosh(g t/v_t), v_t^2 = 2 m g/(rho c A)."""
    s = carom.simulate(thrown(forces.Drag(density=1.5, coefficient=0.4)), 2.0, rtol=1e-10)
    terminal = np.sqrt(2 * 0.2 * G / (1.5 * 0.4 * np.pi * 0.1**2))
    agree(s.velocity[:, 0, 2], -terminal * np.tanh(G * s.t / terminal), atol=1e-8)
    height = -(terminal**2) / G * np.log(np.cosh(G * s.t / terminal))
    agree(s.position[:, 0, 2], height, atol=1e-8)
    agree(s.ledger.residual, 0.0, atol=1e-9)
    assert np.all(np.diff(s.ledger.loads) <= 0.0)


@verifies("forces.Wind", "$u = u_0/(1 + k u_0 t/m)$", "closed form")
def test_a_body_is_carried_by_the_wind():
    """The velocity u relative to the wind falls as u_0/(1 + k u_0 t/m)."""
    wind = np.array([3.0, 0.0, 0.0])
    force = forces.Wind(wind, density=1.2, coefficient=0.47)
    s = carom.simulate(thrown(force, gravity=0.0), 5.0, rtol=1e-10)
    k = 0.5 * 1.2 * 0.47 * np.pi * 0.1**2
    expected = 3.0 - 3.0 / (1.0 + k * 3.0 * s.t / 0.2)
    agree(s.velocity[:, 0, 0], expected, atol=1e-8)
    first = s["fluid"].force[0]
    agree(first, k * 9.0 * np.array([1.0, 0, 0]), rtol=1e-12)


def vortex(t, x):
    """A flow that turns about the z axis, faster and faster."""
    out = np.empty(3)
    out[0], out[1], out[2] = -(1.0 + t) * x[1], (1.0 + t) * x[0], 0.5
    return out


@verifies("forces.Wind", "a vortex that changes in time", "own integration: SciPy")
@pytest.mark.parametrize("compiled", [False, True])
def test_a_field_of_wind(compiled):
    """Against SciPy's integrator."""
    flow = njit(vortex) if compiled else vortex
    scene = carom.Scene(gravity=(0, 0, 0))
    ball = scene.add_body(carom.Sphere(0.1), mass=0.05, position=(1, 0, 0))
    scene.add_force(forces.Wind(flow, density=2.0), ball)
    s = carom.simulate(scene, 2.0, rtol=1e-9)
    k = 0.5 * 2.0 * 0.47 * np.pi * 0.1**2 / 0.05

    def rates(t, y):
        u = y[3:] - vortex(t, y[:3])
        return np.append(y[3:], -k * np.linalg.norm(u) * u)

    known = solve_ivp(rates, (0, 2), [1, 0, 0, 0, 0, 0], method="DOP853", rtol=1e-12, atol=1e-12)
    agree(s.position[-1, 0], known.y[:3, -1], atol=1e-6)


@verifies("forces.Magnus", r"a circle of radius $m v/(S\omega)$", "closed form")
def test_a_ball_that_turns_flies_in_a_circle():
    """S w x v with w across v: radius m v/(S w), at constant speed and energy."""
    s = carom.simulate(
        thrown(forces.Magnus(density=1.2), (4, 0, 0), (0, 0, 50), gravity=0.0), 3.0, rtol=1e-10
    )
    turn = 0.5 * 1.2 * np.pi * 0.1**3 * 50 / 0.2
    agree(s.position[:, 0, 0], 4 / turn * np.sin(turn * s.t), atol=1e-8)
    agree(s.position[:, 0, 1], 4 / turn * (1 - np.cos(turn * s.t)), atol=1e-8)
    agree(s.total_energy, s.total_energy[0], rtol=1e-9)
    agree(s.ledger.loads, 0.0, atol=1e-9)


@verifies("forces.Buoyancy", r"$a = (\rho V/m - 1)\,g$", "closed form")
def test_a_ball_under_water_rises():
    """At (rho V/m - 1) g, with its potential in the ledger."""
    s = carom.simulate(thrown(forces.Buoyancy(), mass=2.0), 1.0)
    volume = 4 / 3 * np.pi * 0.1**3
    up = (1000 * volume / 2.0 - 1) * G
    agree(s.position[:, 0, 2], 0.5 * up * s.t**2, atol=1e-10)
    agree(s.total_energy, 0.0, atol=1e-9)
    agree(s.ledger.loads, 0.0, atol=1e-12)


@verifies("forces.Buoyancy", "rests where it displaces its mass", "closed form")
@pytest.mark.parametrize("level", [0.0, 0.35])
def test_a_ball_floats(level):
    """It dips, comes up again and keeps its energy; where it displaces its mass it stays at rest."""
    mass, r = 2.0, 0.1
    scene = thrown(forces.Buoyancy(surface=level), (0, 0, -1.0), mass=mass)
    scene.replace("ball", position=(0, 0, level + 0.3))
    s = carom.simulate(scene, 2.0, rtol=1e-9)
    assert s.position[:, 0, 2].min() < level - r < level + r < s.position[:, 0, 2].max()
    agree(s.total_energy, s.total_energy[0], rtol=1e-7)
    h = brentq(lambda h: 1000 * np.pi * h * h * (3 * r - h) / 3 - mass, 0.0, 2 * r, xtol=1e-15)
    scene.replace("ball", position=(0, 0, level + r - h), velocity=(0, 0, 0))
    rest = carom.simulate(scene, 2.0)
    agree(rest.position[:, 0, 2], level + r - h, atol=1e-10)


@pytest.mark.parametrize(
    "shape", [carom.Box(0.3, 0.2, 0.1), carom.Box(0.3, 0.2, 0.1, radius=0.03), carom.Cylinder(0.1, 0.4),
              carom.Capsule(0.1, 0.4), carom.Sphere(0.2)]
)  # fmt: skip
def test_mean_shadow(shape):
    """The mean over directions of the area of the shadow of the surface: half of all |n . e| dA."""
    vertices, triangles = surface(shape)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    np.testing.assert_allclose(mean_area(shape), 0.25 * area.sum(), rtol=0.02)
    assert 0.4 < drag_coefficient(shape) < 1.2


@pytest.mark.parametrize(
    ("force", "message"),
    [
        (lambda: forces.Drag(-1.0), "density must be finite and at least 0"),
        (lambda: forces.Wind((1, 2)), r"velocity must have shape \(3,\)"),
        (lambda: forces.Drag(), "area must be given for 'ball'"),
        (lambda: forces.Magnus(), "radius must be given for 'ball'"),
        (lambda: forces.Buoyancy(surface=0.0), "surface must be left out except for a Sphere"),
    ],
)
def test_wrong_input(force, message):
    with pytest.raises(ValueError, match=message):
        carom.simulate(thrown(force(), shape=carom.Ellipsoid(0.1, 0.2, 0.3)), 0.1)
