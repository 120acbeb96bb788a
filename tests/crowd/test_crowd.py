"""Crowds: bodies that lie on each other at many points take their steps whole."""

from itertools import combinations

import numpy as np
import pytest

import carom
from carom.collision.api import nearest_points
from carom.geometry import quaternion
from carom.geometry.frames import contact_axes

#: of order 1 where something strikes: friction that rises by 1e-3 of the energy in a step, and says so
pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")

G = 9.81
PLATES = 7  # on each other: 28 points, more than go from event to event


def boxed(side, floor=True, gravity=G):
    """Return a scene of a box without a lid."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    if floor:
        scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(2):
        for x, sign in ((0.0, 1.0), (side, -1.0)):
            point, normal = np.zeros(3), np.zeros(3)
            point[k], normal[k] = x, sign
            scene.add_half_space(point, normal)
    return scene


def poured(shapes, side=0.08, seed=0, **law):
    """Return a scene of bodies that fall into a box."""
    scene, rng = boxed(side), np.random.default_rng(seed)
    cell = side / 2
    for i, shape in enumerate(shapes):
        q = rng.normal(size=4)
        place = np.array([i % 2 + 0.5, i // 2 % 2 + 0.5, i // 4 + 1.0]) * cell
        scene.add_body(
            shape, mass=0.01, position=place + rng.uniform(-0.002, 0.002, 3),
            orientation=q / np.linalg.norm(q), angular_velocity=rng.normal(size=3) * 5,
        )  # fmt: skip
    scene.set_contact_default(**law)
    return scene


def deepest(scene, solution, row):
    """Return the least gap of all planes, and of pairs that are near enough to touch, at a saved time."""
    poses = list(zip(solution.position[row], solution.orientation[row]))
    shapes, gap = [body.shape for body in scene.bodies], np.inf
    for i, j in combinations(range(len(poses)), 2):
        if np.linalg.norm(poses[i][0] - poses[j][0]) < shapes[i].size + shapes[j].size:
            gap = min(gap, nearest_points(shapes[i], poses[i], shapes[j], poses[j]).gap)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    for body, (x, q) in zip(scene.bodies, poses):
        R = quaternion.matrix(q)
        for plane in scene.half_spaces:
            low = (corners * body.shape.half @ R.T + x - plane.point) @ plane.normal
            gap = min(gap, low.min())
    return gap


@pytest.fixture(scope="module")
def dice():
    scene = poured(
        [carom.Box(0.02, 0.02, 0.02)] * 16, restitution=0.4, friction=0.4
    )  # fmt: skip
    return scene, carom.simulate(scene, 1.2, step=1e-3, save_every=10)


@pytest.mark.processors
def test_poured_dice_come_to_rest(dice):
    """Exactly, and none inside another: 1e-9 m at saved times."""
    scene, s = dice
    assert s.stats["held_steps"] > 0
    assert np.all(s.velocity[-1] == 0.0)
    assert np.all(s.angular_velocity[-1] == 0.0)
    np.testing.assert_array_equal(s.position[-1], s.position[-2])
    for row in range(0, len(s.t), 10):
        assert deepest(scene, s, row) > -1e-9


def test_energy_and_forces_of_poured_dice(dice):
    """What comes back to the surfaces is 1e-3 of what falls; at rest the floor carries all."""
    scene, s = dice
    start = s.total_energy[0] - s.total_energy[-1]
    assert np.all(np.diff(s.total_energy) < 1e-4 * start)
    assert np.max(np.abs(s.ledger.residual)) < 2e-3 * start
    # contacts: each body with each plane, then pairs; sum of the vertical parts of all planes
    forces = s.contact_force[-1, : 16 * 5].reshape(16, 5, 3)
    axes = [contact_axes(plane.normal) for plane in scene.half_spaces]
    up = sum(np.sum(forces[:, k] @ E[:, 2]) for k, E in enumerate(axes))
    # rest is what moves by less than ten times `rest_tolerance` of g h in a step: forces are as good
    assert up == pytest.approx(16 * 0.01 * G, rel=1e-7)
    assert s.held_residual[-1] < 1e-12


@pytest.mark.plain
def test_momentum_and_energy_of_a_cloud():
    """Balls without friction and e = 1, none else: w_i + u_i = 0 where p_i > 0, so p . (u + w)/2 = 0."""
    scene, rng = carom.Scene(gravity=(0, 0, 0)), np.random.default_rng(4)
    for i in range(8):
        place = np.array([i % 2, i // 2 % 2, i // 4]) * 0.11
        scene.add_body(
            carom.Sphere(0.05), mass=1.0 + 0.1 * i, position=place,
            velocity=-8 * (place - 0.055) + rng.normal(size=3) * 0.1,
            angular_velocity=rng.normal(size=3),
        )  # fmt: skip
    scene.set_contact_default(restitution=1.0, friction=0.0)
    # blow by blow it would be exact: here a step has room for one
    s = carom.simulate(scene, 0.05, step=1e-3, options=carom.Options(max_impacts_per_step=1))
    assert np.sum(s.impacts.located == 0) > 4
    mass = np.array([b.mass for b in scene.bodies])
    momentum = np.einsum("n,tnk->tk", mass, s.velocity)
    np.testing.assert_allclose(momentum, np.broadcast_to(momentum[0], momentum.shape), atol=1e-13)
    inertia = np.array([b.inertia[0, 0] for b in scene.bodies])
    spin = np.einsum("n,tnk->tk", mass, np.cross(s.position, s.velocity))
    spin += np.einsum("n,tnk->tk", inertia, s.angular_velocity)
    # impulses act at the points of the middle of the step, bodies are at its end: order h
    np.testing.assert_allclose(spin, np.broadcast_to(spin[0], spin.shape), atol=2e-3)
    np.testing.assert_allclose(s.kinetic_energy, s.kinetic_energy[0], rtol=1e-9)


def blocks_on_an_incline(friction, angle=0.4):
    """Return a scene of blocks on each other on an incline."""
    scene = carom.Scene(gravity=(G * np.sin(angle), 0, -G * np.cos(angle)))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(PLATES):
        scene.add_body(carom.Box(0.2, 0.2, 0.02), mass=1.0, position=(0, 0, 0.01 + 0.02 * k))
    scene.set_contact_default(restitution=0.0, friction=friction)
    return scene


def test_blocks_stick_on_an_incline():
    """mu just above tan: exactly."""
    s = carom.simulate(blocks_on_an_incline(1.001 * np.tan(0.4)), 0.04, step=0.01)
    np.testing.assert_array_equal(s.position, np.broadcast_to(s.position[0], s.position.shape))
    assert np.all(s.velocity == 0.0)


def test_blocks_slide_down_an_incline():
    """All with a = g (sin - mu cos): constant, so as exact as the problem is solved (1e-4 of g h)."""
    mu = 0.5 * np.tan(0.4)
    s = carom.simulate(blocks_on_an_incline(mu), 0.06, step=0.01)
    assert s.stats["whole_steps"] >= 5
    a = G * (np.sin(0.4) - mu * np.cos(0.4))
    assert s.velocity[-1, 0, 0] == pytest.approx(0.06 * a, rel=1e-3)
    assert s.position[-1, 0, 0] == pytest.approx(0.0018 * a, rel=1e-3)
    np.testing.assert_allclose(s.position[-1, :, 0], s.position[-1, 0, 0], atol=1e-5)


def on_plates(weight=1e5):
    """Return a scene of plates on each other, so heavy that they do not move, and the height of the highest."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(PLATES):
        scene.add_body(carom.Box(1.0, 1.0, 0.1), mass=weight, position=(0, 0, 0.05 + 0.1 * k))
    return scene, 0.1 * PLATES


def test_order_two_where_nothing_strikes():
    """A block that falls over about its lower edge, on plates: errors of a step h are those of h/2 times four.

    Its rows turn by half a radian on the way. The balance of energy is of order four.
    """
    rates, residuals = [], []
    for step in (4e-3, 2e-3, 1e-3):
        scene, top = on_plates(50.0)
        c, s = np.cos(0.3), np.sin(0.3)
        place = np.array([0, 0, top]) - np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ (
            0.05,
            0,
            -0.1,
        )
        scene.add_body(
            carom.Box(0.1, 0.1, 0.2), mass=1.0, position=place,
            orientation=(np.cos(0.15), 0, np.sin(0.15), 0),
        )  # fmt: skip
        scene.set_contact_default(restitution=0.0, friction=2.0)
        run = carom.simulate(scene, 0.2, step=step)
        assert run.stats["whole_steps"] >= 0.2 / step - 2
        assert np.max(run.held_residual) < 1e-9
        rates.append(run.angular_velocity[-1, -1, 1])
        residuals.append(np.max(np.abs(run.ledger.residual)))
    assert abs(rates[-1]) > 3.0
    ratio = (rates[0] - rates[1]) / (rates[1] - rates[2])
    assert np.log2(ratio) == pytest.approx(2.0, abs=0.1)
    assert np.log2(residuals[0] / residuals[1]) == pytest.approx(4.0, abs=0.3)


@pytest.mark.processors
def test_a_tower_stands_and_its_lowest_face_carries_all():
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(30):
        scene.add_body(
            carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0.003 * (k % 4), 0, 0.05 + 0.1 * k)
        )
    scene.set_contact_default(restitution=0.3, friction=0.5)
    s = carom.simulate(scene, 2.0, step=0.01)
    assert np.all(s.position == s.position[0])
    assert s.contact_force[-1, 0, 0] == pytest.approx(30 * G, rel=1e-10)


def test_a_ball_strikes_a_plate_with_order_one():
    """A ball falls on a plate at rest, rises with e of its speed; the time of the blow is known to a step."""
    errors = []
    for step in (4e-3, 1e-3):
        scene, top = on_plates()
        scene.add_body(carom.Sphere(0.05), mass=0.1, position=(0, 0, top + 0.25))
        scene.set_contact_default(restitution=0.5, friction=0.0)
        s = carom.simulate(scene, 0.3, step=step)
        hit = np.sqrt(2 * 0.2 / G)
        rise = 0.5 * G * hit
        expected = top + 0.05 + rise * (0.3 - hit) - 0.5 * G * (0.3 - hit) ** 2
        errors.append(abs(s.position[-1, -1, 2] - expected))
        # e of the approach at the start of the step
        assert s.impacts.relative_velocity_after[0, 0] == pytest.approx(
            -0.5 * s.impacts.relative_velocity_before[0, 0], rel=1e-12
        )
    assert errors[0] < 4 * rise * 4e-3
    assert errors[1] < 4 * rise * 1e-3


def test_rolling_friction_in_a_heap():
    """A ball that rolls on a plate at rest: a = (5/7) g d/r from torques d N against it."""
    d, r, v0 = 1e-3, 0.05, 0.3
    scene, top = on_plates()
    scene.add_body(
        carom.Sphere(r), mass=0.1, position=(-0.3, 0, top + r), velocity=(v0, 0, 0),
        angular_velocity=(0, v0 / r, 0),
    )  # fmt: skip
    scene.set_contact_default(restitution=0.0, friction=0.5, rolling_friction=d)
    s = carom.simulate(scene, 0.5, step=1e-3)
    assert s.velocity[-1, -1, 0] == pytest.approx(v0 - 5 / 7 * G * d / r * 0.5, rel=1e-6)


def test_a_step_that_does_not_get_on_is_taken_whole():
    """Two halvings do not do for an impact of two turning boxes: the run goes on, and says so."""
    scene = poured([carom.Box(0.02, 0.02, 0.02)] * 8, seed=2, restitution=0.4, friction=0.4)
    rough = carom.Options(
        max_cuts=1, energy_tolerance=1e-3
    )  # its whole steps give 2e-2 of the energy
    s = carom.simulate(scene, 0.4, step=2e-3, options=rough)
    assert s.status is carom.Status.SUCCESS
    assert s.stats["whole_steps"] > 0
    assert np.all(s.impacts.located[: np.argmin(s.impacts.located)])
    assert not np.all(s.impacts.located)
    assert (
        f"In {s.stats['whole_steps']} of 200 steps touching bodies took a time-stepping"
        in s.message
    )
    # hardly ever without that
    exact = carom.simulate(scene, 0.1, step=1e-3)
    assert exact.stats["whole_steps"] <= 1
    assert exact.impacts.located.sum() >= len(exact.impacts) - 8


@pytest.mark.few(3)
@pytest.mark.parametrize("gap", [0.0, 1e-5, 1e-4])
@pytest.mark.parametrize(("e", "mu"), [(1.0, 0.0), (0.95, 0.1), (0.5, 0.1)])
def test_a_break_goes_from_blow_to_blow(e, mu, gap):
    """Fifteen balls in a triangle, struck at 8 m/s: no ball is in another, energy never rises, e = 1 keeps it.

    Taken whole, a ball that was struck went .15 of its size into the next one.
    """
    r = 0.0286
    scene = carom.Scene(gravity=(0, 0, 0))
    for i in range(5):
        for j in range(i + 1):
            place = (i * np.sqrt(3) * (r + gap / 2), (2 * j - i) * (r + gap / 2), 0)
            scene.add_body(carom.Sphere(r), mass=0.17, position=place)
    scene.add_body(carom.Sphere(r), mass=0.17, position=(-0.1, 0, 0), velocity=(8, 0, 0))
    scene.set_contact_default(restitution=e, friction=mu)
    s = carom.simulate(scene, 0.02, step=1e-3)
    assert s.status is carom.Status.SUCCESS
    assert s.stats["whole_steps"] <= (1 if e == 0.5 and gap == 0.0 else 0)
    assert not s.warnings
    energy = s.kinetic_energy
    assert np.all(np.diff(energy) <= 1e-12 * energy[0])
    if e == 1.0:
        np.testing.assert_allclose(energy, energy[0], rtol=1e-12)
    momentum = 0.17 * s.velocity.sum(axis=1)
    np.testing.assert_allclose(momentum, np.tile([1.36, 0, 0], (len(s.t), 1)), atol=1e-12)


def test_what_is_pushed_within_a_step_pushes_on():
    """Nine balls in a row, .1 mm apart, each step with room for one blow: none goes into the next."""
    r, gap = 0.03, 1e-4
    scene = carom.Scene(gravity=(0, 0, 0))
    for k in range(9):
        v = 5.0 if k == 0 else 0.0
        scene.add_body(
            carom.Sphere(r), mass=1.0, position=(k * (2 * r + gap), 0, 0), velocity=(v, 0, 0)
        )
    scene.set_contact_default(restitution=0.5, friction=0.0)
    s = carom.simulate(scene, 0.02, step=1e-3, options=carom.Options(max_impacts_per_step=1))
    assert s.stats["whole_steps"] > 0
    assert not np.all(s.impacts.located)
    assert np.min(np.diff(s.position[:, :, 0], axis=1)) >= 2 * r - 1e-12
    np.testing.assert_allclose(s.velocity[:, :, 0].sum(axis=1), 5.0, rtol=1e-12)
    assert np.all(np.diff(s.kinetic_energy) <= 1e-12)


@pytest.mark.parametrize("seed", [12, 30, 31])
def test_nothing_sinks_in_at_long_steps(seed):
    """At the end of each step, of 5 ms, bodies are in each other by no more than 1e-9 of their size.

    Corners come over edges of faces within such steps, and what falls on a body at rest pushes it aside.
    """
    scene, rng = carom.Scene(gravity=(0, 0, -G)), np.random.default_rng(seed)
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(12):
        q = rng.normal(size=4)
        place = (*rng.uniform(-0.01, 0.01, 2), 0.03 + 0.06 * k)
        scene.add_body(
            carom.Box(0.02, 0.03, 0.04),
            mass=0.02,
            position=place,
            orientation=q / np.linalg.norm(q),
        )
    scene.set_contact_default(restitution=0.0, friction=0.4)
    few = carom.Options(max_impacts_per_step=2)  # so that steps are taken whole
    s = carom.simulate(scene, 0.4, step=5e-3, options=few, throw=False)
    assert s.stats["whole_steps"] > 5
    assert min(deepest(scene, s, row) for row in range(len(s.t))) > -1e-9 * 0.02
