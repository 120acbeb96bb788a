"""Autoparallels and the return map on manifolds that are not flat; other charts, same motion."""

import numpy as np
import pytest
import sympy as sp
from coordinate_systems import symbols
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom import GeneralizedSystem
from verified import agree, verifies

RING, TUBE = 2.0, 0.7


def sphere(position=(1.3, 0.4), velocity=(0.9, 0.8), **more):
    q, v = symbols("th ph")
    metric = sp.diag(1, sp.sin(q[0]) ** 2)
    return GeneralizedSystem.from_sympy(
        q, v, metric=metric, position=position, velocity=velocity, **more
    )


def on_sphere(q):
    return np.array([np.sin(q[0]) * np.cos(q[1]), np.sin(q[0]) * np.sin(q[1]), np.cos(q[0])])


def torus():
    q, v = symbols("th ph")
    metric = sp.diag(TUBE**2, (RING + TUBE * sp.cos(q[0])) ** 2)
    return GeneralizedSystem.from_sympy(q, v, metric=metric, position=[0.3, 0], velocity=[0.9, 0.8])


@verifies(
    "GeneralizedSystem",
    r"torus: $\Gamma^\theta_{\varphi\varphi} = (R + r\cos\theta)\sin\theta/r$",
    "closed form",
)
def test_affinities_are_those_of_the_metric():
    # Torus: Gamma^th_phph = (R + r cos) sin / r, Gamma^ph_thph = -r sin / (R + r cos).
    c, s = np.cos(0.3), np.sin(0.3)
    gamma = torus().christoffel([0.3, 0.1])
    expected = np.zeros((2, 2, 2))
    expected[0, 1, 1] = (RING + TUBE * c) * s / TUBE
    expected[1, 0, 1] = expected[1, 1, 0] = -TUBE * s / (RING + TUBE * c)
    agree(gamma, expected, atol=1e-14)


def test_geodesic_of_the_torus_keeps_clairauts_integral():
    # Free motion: (R + r cos th)^2 dph and the energy are constant; order 4.
    errors = []
    for step in (0.02, 0.01):
        run = carom.simulate(torus(), 5.0, step=step)
        integral = (RING + TUBE * np.cos(run.q[:, 0])) ** 2 * run.v[:, 1]
        errors.append(np.ptp(integral) / integral[0])
        assert np.ptp(run.total_energy) < 1e-7
    assert errors[1] < 1e-9
    assert errors[0] / errors[1] > 12.0


@verifies("GeneralizedSystem", "autoparallels of the sphere are great circles", "closed form")
@settings(max_examples=10, deadline=None)
@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_autoparallels_of_the_sphere_are_great_circles(a, b):
    # r(1) = r cos|w| + w/|w| sin|w| with w the velocity in space.
    q = np.array([1.3, 0.4])
    end, _ = _SPHERE.autoparallel(q, [0.4 * a, 0.8 * b])
    east = np.array([-np.sin(q[1]), np.cos(q[1]), 0.0])
    south = np.cross(east, on_sphere(q))
    w = 0.4 * a * south + 0.8 * b * np.sin(q[0]) * east
    size = np.linalg.norm(w)
    expected = on_sphere(q) * np.cos(size) + w * np.sinc(size / np.pi)
    agree(on_sphere(end), expected, atol=1e-9)


_SPHERE = sphere()


@pytest.mark.parametrize("start", [(1.2, 1.2), (1.3, 0.4), (1.5, -0.3)])
def test_return_map_is_normal_to_the_surface_in_the_metric(start):
    # The gap is the height over a plane that cuts the sphere: normals of the cut are great circles through
    # the pole of the plane, n. So q_e = d n + sqrt(1 - d^2) t, t the direction of q across n.
    n, d = np.array([0.3, 0.2, 1.0]) / np.sqrt(1.13), 0.6
    q, v = symbols("th ph")
    place = [sp.sin(q[0]) * sp.cos(q[1]), sp.sin(q[0]) * sp.sin(q[1]), sp.cos(q[0])]
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, sp.sin(q[0]) ** 2), position=[0.5, 0.5], velocity=[0, 0]
    )
    system.add_contact(sum(float(a) * b for a, b in zip(n, place)) - d, restitution=1.0, name="cap")
    assert system.gaps(start)[0] < 0.0
    end = system.return_map(start, "cap")
    across = on_sphere(start) - n * (n @ on_sphere(start))
    exact = d * n + np.sqrt(1 - d * d) * across / np.linalg.norm(across)
    assert abs(system.gaps(end)[0]) < 1e-14
    np.testing.assert_allclose(on_sphere(end), exact, rtol=0, atol=1e-11)


def test_one_motion_in_two_charts():
    # A bob on a sphere with gravity and a plane that it strikes: angles about z, and angles about x.
    runs = []
    for turned in (False, True):
        q, v = symbols("th ph")
        local = [sp.sin(q[0]) * sp.cos(q[1]), sp.sin(q[0]) * sp.sin(q[1]), sp.cos(q[0])]
        place = [local[2], local[0], local[1]] if turned else local
        start = np.array([0.6, 0.5, -np.sqrt(1 - 0.61)])
        drift = np.cross([0.3, 0.4, 1.0], start)
        own = start[[1, 2, 0]] if turned else start
        angles = [np.arccos(own[2]), np.arctan2(own[1], own[0])]
        J = np.array(sp.Matrix(place).jacobian(q).subs(dict(zip(q, angles))), dtype=float)
        rates = np.linalg.lstsq(J, drift)[0]
        system = GeneralizedSystem.from_sympy(
            q, v, metric=sp.diag(1, sp.sin(q[0]) ** 2), potential=9.81 * place[2], position=angles,
            velocity=rates,
        )  # fmt: skip
        system.add_contact(place[0] + 0.2, restitution=0.7)
        run = carom.simulate(system, 0.55, step=1e-3)
        points = sp.lambdify(q, place)
        runs.append((np.array([points(*one) for one in run.q]), run.impacts))
    (first, ours), (second, theirs) = runs
    assert len(ours) == len(theirs) >= 1
    np.testing.assert_allclose(second, first, rtol=0, atol=1e-9)
    np.testing.assert_allclose(theirs.time, ours.time, rtol=0, atol=1e-10)
    np.testing.assert_allclose(theirs.impulse, ours.impulse, rtol=0, atol=1e-9)


def test_a_singular_metric_ends_the_run_with_a_status():
    # T = x v^2 / 2: x^(3/2) falls linearly from .5, to 0 at t = 1/3.
    q, v = symbols("x y")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(q[0], 1), position=[0.5, 0], velocity=[-1, 0]
    )
    run = carom.simulate(system, 1.0, step=0.01, throw=False)
    assert run.status is carom.Status.SINGULAR_METRIC
    assert 0.3 < run.t[-1] < 0.35
    with pytest.raises(carom.SimulationError, match="coordinates are singular"):
        carom.simulate(system, 1.0, step=0.01)
