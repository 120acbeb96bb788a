"""Motion on height fields and on surfaces of functions: against an integration, spheres, and each other."""

import math
import re

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import carom
from verified import agree, verifies

S = carom.surfaces
G, R, RADIUS, START = 9.81, 0.5, 0.05, 0.2  # z = x^2 / (2 R)
TIGHT = dict(rtol=1e-10, atol=1e-12)
BOX = [(-1.0, -1.0, -0.2), (1.0, 1.0, 1.2)]
BEYOND = "ignore:Contact .* is outside the bounds"  # where these functions have no value


def rolls(ground, duration=1.5):
    """Return the motion of a ball that rolls from rest on z = (x^2 + y^2)/(2 R)."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_surface(ground, name="ground")
    normal = np.array([-START / R, 0, 1]) / math.hypot(START / R, 1)
    place = np.array([START, 0, START**2 / (2 * R)]) + RADIUS * normal
    scene.add_body(carom.Sphere(RADIUS), mass=0.3, position=place, name="ball")
    scene.add_contact("ball", "ground", friction=2.0, restitution=0.0)
    return carom.simulate(scene, duration, **TIGHT)


def paraboloid():
    x = np.linspace(-1, 1, 21)
    return S.HeightField((x[:, None] ** 2 + x**2) / (2 * R), spacing=0.1)


def by_quadrature(times):
    """x of the centre from 7/10 s(u)^2 u'^2 + g z(u) = const, u the foot, s the way of the centre per u."""

    def centre(u):
        a = math.atan(u / R)
        return np.array([u - RADIUS * math.sin(a), u * u / (2 * R) + RADIUS * math.cos(a)])

    def rate(t, y):
        u, v = y
        a, da = math.atan(u / R), R / (R * R + u * u)
        dda = -2 * u * R / (R * R + u * u) ** 2
        x1, z1 = 1 - RADIUS * math.cos(a) * da, u / R - RADIUS * math.sin(a) * da
        x2 = RADIUS * (math.sin(a) * da**2 - math.cos(a) * dda)
        z2 = 1 / R - RADIUS * (math.cos(a) * da**2 + math.sin(a) * dda)
        square = x1 * x1 + z1 * z1
        return v, -((x1 * x2 + z1 * z2) * v * v + G * z1 / 1.4) / square

    found = solve_ivp(rate, (0, times[-1]), (START, 0.0), t_eval=times, rtol=1e-12, atol=1e-14)
    return np.array([centre(u) for u in found.y[0]])


@verifies(
    "surfaces.HeightField",
    r"$\tfrac75 s'^2 \dot u^2/2 + g z(u)$ is constant",
    "own integration: SciPy",
)
def test_a_ball_rolls_on_a_paraboloid():
    solution = rolls(paraboloid())
    exact = by_quadrature(solution.t)
    assert np.ptp(exact[:, 0]) > 0.3
    agree(solution.position[:, 0, [0, 2]], exact, atol=1e-8)
    agree(np.ptp(solution.total_energy), 0.0, atol=1e-9)
    same = rolls(S.Surface(lambda x, y, z: z - (x * x + y * y) / (2 * R), BOX))
    agree(same.position, solution.position, atol=1e-8)


def wild(ground, at):
    """Return a ball that is thrown into a bowl of radius 0.5, bounces, slides and rolls."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_surface(ground, position=at, name="ground")
    scene.add_body(
        carom.Sphere(0.06), mass=0.3, position=np.add(at, (0.1, 0.05, 0.1)), velocity=(1.0, -0.5, 0.3),
        angular_velocity=(3.0, 20.0, -7.0), name="ball",
    )  # fmt: skip
    scene.add_contact("ball", "ground", friction=0.3, restitution=0.6)
    return carom.simulate(scene, 1.2, **TIGHT)


@verifies(
    "surfaces.Surface",
    "the function of a sphere moves a ball as the sphere does",
    "invariant: two descriptions of one surface",
)
@pytest.mark.parametrize("with_functions", [False, True])
def test_the_function_of_a_sphere_is_a_sphere(with_functions):
    given = (lambda x, y, z: (-2 * x, -2 * y, -2 * z), lambda *x: -2.0 * np.eye(3)) * with_functions
    box = [(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)]
    one = wild(
        S.Surface(lambda x, y, z: 0.25 - x * x - y * y - z * z, box, *given), (1.0, 2.0, 3.0)
    )
    two = wild(S.InsideSphere(0.5), (1.0, 2.0, 3.0))
    assert len(one.impacts) == len(two.impacts) > 5
    agree(one.impacts.time, two.impacts.time, atol=1e-8)
    agree(one.position, two.position, atol=1e-7)


def no_map(x):
    raise RuntimeError("beyond the map")


@pytest.mark.parametrize("e", [0.0, 0.6])
@pytest.mark.filterwarnings(BEYOND)
@pytest.mark.parametrize(
    ("beyond", "said"),
    [(no_map, "raised .*: beyond the map"), (lambda x: math.nan, "returned nan")],
)
def test_a_function_without_a_value_ends_the_run(e, beyond, said):
    ground = S.Surface(
        lambda x, y, z: beyond(x) if x > 0.6 else z, [(-1, -1, -1), (0.5, 1, 1)],
        lambda *x: (0, 0, 1), lambda *x: np.zeros((3, 3)),
    )  # fmt: skip
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_surface(ground, name="map")
    scene.add_body(
        carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.1 + e), velocity=(1, 0, 0), name="ball"
    )
    scene.add_contact("ball", "map", friction=0.0, restitution=e)
    solution = carom.simulate(scene, 2.0, step=0.01, throw=False)
    assert solution.status is carom.Status.FUNCTION_FAILED
    assert re.search(f"he function of the surface 'map' {said}", solution.message)
    assert 0.59 <= solution.t[-1] <= 0.65  # it does not fall through until the end
    assert np.min(solution.position[:, 0, 2]) > 0.09


@pytest.mark.filterwarnings(BEYOND)
def test_a_compiled_function_without_a_value_ends_the_run():
    # derived and compiled: the logarithm has no value beyond x = 0.6
    ground = S.Surface(lambda x, y, z: z + 1e-9 * sp.log(0.6 - x), [(-1, -1, -1), (0.5, 1, 1)])
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_surface(ground, name="map")
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.2), velocity=(1, 0, 0), name="b")
    scene.add_contact("b", "map", friction=0.0, restitution=0.0)
    solution = carom.simulate(scene, 2.0, throw=False)
    assert solution.status is carom.Status.FUNCTION_FAILED
    assert "math domain error" in solution.message
    assert 0.59 <= solution.t[-1] <= 0.65


def terrain(seed):
    """Return a scene of three bodies over smooth random terrain, and the terrain."""
    rng = np.random.default_rng(seed)
    waves = np.fft.fftfreq(20)[:, None] ** 2 + np.fft.fftfreq(20) ** 2
    noise = np.fft.fft2(rng.normal(size=(20, 20))) * np.exp(-200 * waves)
    heights = np.real(np.fft.ifft2(noise))
    ground = S.HeightField(0.12 * heights / heights.std(), spacing=0.2)
    round_by = 0.5 / ground.bend
    shapes = carom.Sphere(round_by), carom.Box(0.2, 0.15, 0.1), carom.Capsule(round_by, 0.2)
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_surface(ground, name="ground")
    for k, shape in enumerate(shapes):
        x, y = rng.uniform(-1, 1, 2)
        around = np.linspace(-0.2, 0.2, 9)
        z = np.max(ground.height(x + around[:, None], y + around)) + shape.size + 0.05
        turn = rng.normal(size=4)
        scene.add_body(
            shape, density=1000, position=(x, y, z), orientation=turn / np.linalg.norm(turn),
            velocity=rng.normal(size=3), angular_velocity=4 * rng.normal(size=3), name=f"body{k}",
        )  # fmt: skip
    scene.set_contact_default(friction=0.6, restitution=0.3, rolling_friction=0.003)
    scene.ignore_contact([f"body{k}" for k in range(3)])
    return scene, ground


@pytest.mark.parametrize("seed", [0, 2, 4])
def test_bodies_on_random_terrain(seed):
    scene, ground = terrain(seed)
    solution = carom.simulate(scene, 1.5)
    assert solution.success
    scale = np.max(solution.kinetic_energy) + np.ptp(solution.potential_energy)
    assert np.max(np.abs(solution.ledger.residual)) < 1e-6 * scale
    assert np.max(np.diff(solution.total_energy)) < 1e-9 * scale
    for body in scene.bodies:
        corners, radius = body.shape.pieces[0].corners, body.shape.pieces[0].radius
        turned = carom.geometry.quaternion.rotate(
            solution.orientation[:, body.index, None], corners
        )
        x, y, z = np.moveaxis(solution.position[:, body.index, None] + turned, -1, 0)
        assert np.min(z - ground.height(x, y)) > radius - 1e-6  # no deeper than over a plane


def test_a_wave_of_two_functions():
    wave = S.Surface(lambda x, y, z: z - 0.1 * sp.cos(4 * x) * sp.cos(3 * y), BOX)
    assert 1.6 <= wave.bend < 2.1
    with pytest.raises(ValueError, match=r"Sphere\(radius=0.7\).*radius of its rounding, 0.7 m"):
        rolls_on(wave, carom.Sphere(0.7))
    with pytest.raises(ValueError, match="rims have no fixed points"):
        rolls_on(wave, carom.Cylinder(0.1, 0.1))


def rolls_on(ground, shape):
    scene = carom.Scene()
    scene.add_surface(ground, name="ground")
    scene.add_body(shape, mass=1.0, position=(0, 0, 3), name="body")
    scene.add_contact("body", "ground")


def test_a_bump_in_a_face_is_said():
    x = np.linspace(-1, 1, 41)
    heights = 0.1 * np.exp(-(x[:, None] ** 2 + x**2) / 0.1**2)
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_surface(S.HeightField(heights, spacing=0.05), name="hill")
    scene.add_body(carom.Box(0.8, 0.8, 0.1), mass=1.0, position=(0, 0, 0.2), name="plate")
    scene.add_contact("plate", "hill", friction=0.5, restitution=0.0)
    solution = carom.simulate(scene, 0.3, throw=False)
    assert solution.status is carom.Status.INACCURATE
    assert "'plate' penetrates 'hill'" in solution.message
    assert "a bump reaches into a face" in solution.message


def test_a_contact_beyond_the_bounds_of_a_function_is_said():
    """A ball rolls down a slope: from x = .5 at t = sqrt(2 (.5 - .4)/a) on it is outside, a = (5/7) g sin."""
    slope = 0.1 / np.hypot(1.0, 0.1)
    for high, out in ((0.5, True), (9.0, False)):
        scene = carom.Scene()
        box = [(-1, -1, -1), (high, 1, 1)]
        ground = scene.add_surface(carom.surfaces.Surface(lambda x, y, z: z + 0.1 * x, bounds=box))
        n = np.array([slope, 0.0, np.sqrt(1 - slope**2)])
        ball = scene.add_body(
            carom.Sphere(0.05), mass=1, position=np.array([0.4, 0, -0.04]) + 0.05 * n
        )
        scene.add_contact(ball, ground, restitution=0, friction=0.5)
        options = carom.Options(project_start=True)
        if out:
            with pytest.warns(carom.MistakeWarning, match="outside the bounds of the surface"):
                run = carom.simulate(scene, 1.0, save_at=0.01, options=options)
            time = float(run.warnings[-1].split("at t = ")[1].split(" s")[0])
            rolled = 0.1 / np.sqrt(1 - slope**2)  # along the slope
            assert time == pytest.approx(np.sqrt(2 * rolled / (5 / 7 * 9.81 * slope)), abs=0.01)
        else:
            assert not carom.simulate(scene, 1.0, save_at=0.01, options=options).warnings
