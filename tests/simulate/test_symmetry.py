"""The same motion in a mirror, turned, moved, tilted, in other units, in another order."""

import numpy as np
import pytest

import carom
from simulate.scenes import G, ball, matrix, on_plane, product, turn
from verified import agree, verifies

SPIN = np.array([20.0, 14.0, -9.0])
ATTITUDE = turn((1, 2, 0.5), 0.7)


def brick(attitude=ATTITUDE, velocity=(0.5, 0.2, -0.5), spin=SPIN, position=(0, 0, 0.3), **more):
    """A thrown brick; its first impacts are single corners."""
    body = {
        "shape": carom.Box(0.1, 0.06, 0.03), "mass": 0.5, "position": position,
        "orientation": attitude, "velocity": velocity, "angular_velocity": spin,
    }  # fmt: skip
    more = {"contact": {"restitution": 0.6, "friction": 0.25}, **more}
    return on_plane(body, **more)


def run(scene, **more):
    return carom.simulate(scene, 0.26, **{"step": 5e-4, **more})


@pytest.fixture(scope="module")
def base():
    a = run(brick())
    assert len(a.impacts) >= 2
    return a


def same(a, b, position, rotation, vector, axial, scale=1.0):
    """Compare b with a after a change of space, up to the second impact and just beyond."""
    stop = np.searchsorted(a.t, a.impacts.time[1]) + 3
    for k in (100, stop - 3, stop):
        np.testing.assert_allclose(
            b.position[k, 0], position(a.position[k, 0]), rtol=0, atol=1e-9 * scale
        )
        np.testing.assert_allclose(b.velocity[k, 0], vector(a.velocity[k, 0]), rtol=0, atol=1e-7)
        np.testing.assert_allclose(
            b.angular_velocity[k, 0], axial(a.angular_velocity[k, 0]), rtol=0, atol=1e-5
        )
        np.testing.assert_allclose(
            matrix(b.orientation[k, 0]), rotation(matrix(a.orientation[k, 0])), rtol=0, atol=1e-7
        )
    np.testing.assert_allclose(b.impacts.time[:2], a.impacts.time[:2], rtol=1e-9)


def test_mirror(base):
    # y -> -y: vectors by D, axial vectors by -D, rotations D R D. (A box is its own mirror image.)
    D = np.diag([1.0, -1.0, 1.0])
    q = ATTITUDE * (1, -1, 1, -1)
    a = run(brick(q, (0.5, -0.2, -0.5), -D @ SPIN))
    same(base, a, lambda x: D @ x, lambda R: D @ R @ D, lambda v: D @ v, lambda w: -D @ w)


@pytest.mark.parametrize("angle", [0.3, 1.9, np.pi])
def test_turn_about_the_vertical(base, angle):
    Z = turn((0, 0, 1), angle)
    R = matrix(Z)
    a = run(brick(product(Z, ATTITUDE), R @ (0.5, 0.2, -0.5), R @ SPIN))
    same(base, a, lambda x: R @ x, lambda M: R @ M, lambda v: R @ v, lambda w: R @ w)


@pytest.mark.parametrize("shift", [(1.0, -2.0, 0.5), (100.0, 50.0, -30.0)])
def test_translation(base, shift):
    # The plane through `shift`, the body moved with it: round-off of the larger coordinates.
    a = run(brick(position=np.add((0, 0, 0.3), shift), point=shift))
    same(base, a, lambda x: x + shift, lambda R: R, lambda v: v, lambda w: w)


@pytest.mark.parametrize("axis", [(1, 0, 0), (1, -2, 3), (0, 1, 0)])
def test_tilted_plane_with_tilted_gravity(base, axis):
    # Everything turned, plane and gravity as well.
    Z = turn(axis, 1.1)
    R = matrix(Z)
    a = run(
        brick(
            product(Z, ATTITUDE), R @ (0.5, 0.2, -0.5), R @ SPIN, R @ (0, 0, 0.3),
            gravity=R @ (0, 0, -G), normal=R @ (0, 0, 1),
        )
    )  # fmt: skip
    same(base, a, lambda x: R @ x, lambda M: R @ M, lambda v: R @ v, lambda w: R @ w)


@verifies("simulate", "the same motion in other units", "invariant")
@pytest.mark.parametrize(("length", "mass", "time"), [(1e-3, 1, 1), (1, 1e6, 1), (8, 1e-3, 0.25)])
def test_units(length, mass, time):
    # x -> L x, m -> M m, t -> T t; g -> L/T^2 g: the same motion in other units.
    def scaled(L, M, T):
        box = carom.Box(0.1 * L, 0.06 * L, 0.03 * L)
        body = {
            "shape": box, "mass": 0.5 * M, "position": (0, 0, 0.3 * L), "orientation": ATTITUDE,
            "velocity": np.array((0.5, 0.2, -0.5)) * L / T, "angular_velocity": SPIN / T,
        }  # fmt: skip
        scene = on_plane(
            body, gravity=(0, 0, -G * L / T**2), contact={"restitution": 0.6, "friction": 0.25}
        )
        return carom.simulate(scene, 0.2 * T, step=5e-4 * T)

    a, b = scaled(1, 1, 1), scaled(length, mass, time)
    agree(b.impacts.time[:2], a.impacts.time[:2] * time, rtol=1e-10)
    P = a.impacts.impulse[:2] * mass * length / time
    agree(b.impacts.impulse[:2], P, rtol=1e-7, atol=1e-9 * np.abs(P).max())
    energy = a.impacts.energy_change[:2] * mass * (length / time) ** 2
    agree(b.impacts.energy_change[:2], energy, rtol=1e-7)


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e3, 1e6])
def test_a_ball_of_any_size_comes_to_rest(scale):
    # Lengths by `scale`, times by its root: bounces, hold and rest are the same.
    t = np.sqrt(scale)
    small = ball(0.5, height=0.4 * scale, radius=0.1 * scale, mass=scale**3)
    a = carom.simulate(ball(0.5), 1.0, step=0.01)
    b = carom.simulate(small, 1.0 * t, step=0.01 * t)
    assert len(a.impacts) == len(b.impacts)
    np.testing.assert_allclose(b.impacts.time, a.impacts.time * t, rtol=1e-9)
    assert np.all(b.velocity[-1] == 0.0)


def test_many_balls_in_one_scene_are_single_balls():
    # Bodies that do not touch each other: bitwise the same impacts as alone.
    rng = np.random.default_rng(3)
    heights, speeds, e = rng.uniform(0.1, 1, 12), rng.uniform(-1, 1, 12), rng.uniform(0.2, 0.9, 12)
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(12):
        body = scene.add_body(
            carom.Sphere(0.1), mass=1, position=(k, 0, 0.1 + heights[k]), velocity=(speeds[k], 0, 0)
        )
        scene.add_contact(body, ground, restitution=e[k], friction=0.1)
    together = carom.simulate(scene, 2.0, step=0.01)
    for k in range(12):
        alone = carom.simulate(
            ball(e[k], 0.1, heights[k], velocity=(speeds[k], 0, 0)), 2.0, step=0.01
        )
        mine = together.impacts.contact == k
        n = min(mine.sum(), len(alone.impacts))
        assert n >= 2
        np.testing.assert_allclose(
            together.impacts.time[mine][:n], alone.impacts.time[:n], rtol=0, atol=1e-12
        )
        np.testing.assert_allclose(together.velocity[:, k], alone.velocity[:, 0], rtol=0, atol=1e-9)
        shift = np.array([k, 0, 0])
        np.testing.assert_allclose(
            together.position[:, k], alone.position[:, 0] + shift, rtol=0, atol=1e-9
        )


def test_order_of_the_contacts_does_not_matter():
    # Two balls, their contacts (and bodies) added in either order.
    def pair(reverse):
        scene = carom.Scene()
        ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
        starts = [(0, 0, 0.5), (3, 0, 0.71)]
        for x in reversed(starts) if reverse else starts:
            body = scene.add_body(carom.Sphere(0.1), mass=1, position=x, velocity=(1, 0, 0))
            scene.add_contact(body, ground, restitution=0.8, friction=0.2)
        return carom.simulate(scene, 2.0, step=0.01)

    a, b = pair(False), pair(True)
    np.testing.assert_array_equal(a.impacts.time, b.impacts.time)
    np.testing.assert_array_equal(a.position, b.position[:, ::-1])
    np.testing.assert_array_equal(a.angular_velocity, b.angular_velocity[:, ::-1])
    np.testing.assert_array_equal(a.contact_force, b.contact_force[:, ::-1])


def test_a_run_repeats_to_the_bit():
    a, b = run(brick()), run(brick())
    np.testing.assert_array_equal(a.position, b.position)
    np.testing.assert_array_equal(a.impacts.impulse, b.impacts.impulse)


def test_what_is_saved_does_not_change_the_run(base):
    a = run(brick(), save_every=7)
    np.testing.assert_array_equal(a.impacts.time, base.impacts.time)
    np.testing.assert_array_equal(a.position[:-1], base.position[:-1:7][: len(a.t) - 1])
    np.testing.assert_array_equal(a.position[-1], base.position[-1])
