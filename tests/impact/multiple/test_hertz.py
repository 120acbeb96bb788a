"""Balls that touch: each contact has the stiffness of Hertz's law, by the curvatures of both surfaces there."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import carom

X = np.array([1.0, 0.0, 0.0])


def stiffness(one, two=None):
    """R^(1/2) F^(-3/2) of relative principal curvatures (Johnson, Contact Mechanics, eqs. 4.26 to 4.32)."""
    high, low = max(one, two or one), min(one, two or one)
    if high == low:
        return high**-0.5

    def parts(k):
        K, E = ellipk(1 - k * k), ellipe(1 - k * k)
        return K, E / k**2 - K, K - E

    k = brentq(lambda k: parts(k)[1] / parts(k)[2] - high / low, 1e-3, 1 - 1e-9, xtol=1e-15)
    K, above, below = parts(k)
    cube = 4 / np.pi / (1 - k * k) * k**1.5 * np.sqrt(above * below)
    return (high * low) ** -0.25 * (2 / np.pi * np.sqrt(k) * K * cube ** (-1 / 3)) ** -1.5


def integrated(masses, kappa, walls=()):
    """Velocities (n, 3) after of bodies in a row along x; walls act on the last one: (normal, stiffness)."""
    n = len(masses)

    def rates(t, y):
        u, a = y[: 3 * n].reshape(n, 3), np.zeros((n, 3))
        for i in range(n - 1):
            force = kappa[i] * max(0.0, u[i, 0] - u[i + 1, 0]) ** 1.5 * X
            a[i] -= force / masses[i]
            a[i + 1] += force / masses[i + 1]
        for normal, k in walls:
            a[-1] += k * max(0.0, -u[-1] @ normal) ** 1.5 / masses[-1] * normal
        return np.append(y[3 * n :], a)

    start = np.zeros(6 * n)
    start[3 * n] = 1.0
    end = 60 * n * (max(masses) / min(kappa)) ** 0.4
    run = solve_ivp(rates, (0, end), start, method="DOP853", rtol=1e-12, atol=1e-16)
    return run.y[3 * n :, -1].reshape(n, 3)


def struck(shapes, masses, place=lambda scene, bodies, end: None):
    """Velocities after of bodies in a row, the first of which comes in at 1 m/s."""
    scene = carom.Scene(gravity=(0, 0, 0))
    before, after = np.array([(-s.support(-X)[0], s.support(X)[0]) for s in shapes]).T
    x = np.append(0, np.cumsum(after[:-1] + before[1:]))
    bodies = [
        scene.add_body(
            shape, mass=mass, position=(at - 1e-3 * (k == 0), 0, 0), velocity=(float(k == 0), 0, 0)
        )
        for k, (shape, mass, at) in enumerate(zip(shapes, masses, x))
    ]
    scene.set_contact_default(restitution=1, friction=0)
    place(scene, bodies, x[-1] + after[-1])
    return carom.simulate(scene, 0.0012, step=1e-4).velocity[-1]


def test_a_tapered_chain():
    """Ten balls, each with .95 of the radius before: the last leaves with 1.852094, not 1.8359 m/s."""
    R = 0.01 * 0.95 ** np.arange(10)
    after = struck([carom.Sphere(r) for r in R], R**3)
    assert after[-1, 0] == pytest.approx(1.852094, abs=1e-6)
    kappa = np.sqrt(R[:-1] * R[1:] / (R[:-1] + R[1:]))
    np.testing.assert_allclose(after, integrated(R**3, kappa), rtol=0, atol=1e-6)


R = 0.01 * np.array([1.0, 0.5, 0.8])  # a small ball between greater ones
OF_BALLS = np.sqrt(R[:-1] * R[1:] / (R[:-1] + R[1:]))
SLOPE = np.array([-0.6, 0.8, 0.0])
LAST = R[-1]


def stated(scene, bodies, end):
    for a, b, k in zip(bodies, bodies[1:], (0.4, 3.0)):
        scene.add_contact(a, b, restitution=1, friction=0, stiffness=k)


def corner(scene, bodies, end):
    scene.add_half_space((end, 0, 0), -X)
    scene.add_half_space(np.array([end - LAST, 0, 0]) - LAST * SLOPE, SLOPE)


def ground(surface, radius):
    return lambda scene, bodies, end: scene.add_surface(surface, position=(end - radius, 0, 0))


CASES = {
    "stated, on top of the law": (stated, OF_BALLS * (0.4, 3.0), []),
    "a wall": (
        lambda scene, bodies, end: scene.add_half_space((end, 0, 0), -X),
        OF_BALLS, [(-X, stiffness(1 / LAST))],
    ),
    "a corner": (corner, OF_BALLS, [(-X, stiffness(1 / LAST)), (SLOPE, stiffness(1 / LAST))]),
    "a static ball": (
        lambda scene, bodies, end: scene.add_static(carom.Sphere(0.03), position=(end + 0.03, 0, 0)),
        OF_BALLS, [(-X, stiffness(1 / LAST + 1 / 0.03))],
    ),
    "a static cylinder": (
        lambda scene, bodies, end: scene.add_static(
            carom.Cylinder(0.03, 0.1), position=(end + 0.03, 0, 0)
        ),
        OF_BALLS, [(-X, stiffness(1 / LAST, 1 / LAST + 1 / 0.03))],
    ),
    "a hollow": (
        ground(carom.surfaces.InsideSphere(0.1), 0.1), OF_BALLS, [(-X, stiffness(1 / LAST - 1 / 0.1))],
    ),
    "a pipe": (
        ground(carom.surfaces.InsideCylinder(0.1), 0.1),
        OF_BALLS, [(-X, stiffness(1 / LAST, 1 / LAST - 1 / 0.1))],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_what_the_last_ball_touches(name):
    place, kappa, walls = CASES[name]
    after = struck([carom.Sphere(r) for r in R], R**3, place)
    np.testing.assert_allclose(after, integrated(R**3, kappa, walls), rtol=0, atol=1e-6)


def test_ellipsoids_and_balls_of_compounds():
    """At its end a an ellipsoid has the radii of curvature b^2/a and c^2/a; a part of a body has its own."""
    a, b, c = 0.01, 0.013, 0.008
    masses, shapes = (1.0, 2.0, 3.0), [carom.Sphere(0.02), *2 * [carom.Ellipsoid(a, b, c)]]
    kappa = [stiffness(a / b**2 + 50, a / c**2 + 50), stiffness(2 * a / b**2, 2 * a / c**2)]
    np.testing.assert_allclose(struck(shapes, masses), integrated(masses, kappa), rtol=0, atol=1e-6)
    pear = carom.Compound(
        [(carom.Sphere(0.01), (-0.005, 0, 0)), (carom.Sphere(0.004), (0.012, 0, 0))]
    )
    ball = carom.Sphere(0.02)
    kappa = [stiffness(1 / 0.02 + 1 / 0.01), stiffness(1 / 0.004 + 1 / 0.02)]
    np.testing.assert_allclose(
        struck([ball, pear, ball], masses), integrated(masses, kappa), rtol=0, atol=1e-6
    )
