"""Islands of a step: bodies that do not meet move as if each were alone, and what rests stays asleep."""

import numpy as np
import pytest

import carom

G = 9.81


def die(scene, plane, k, seed=0):
    q = np.random.default_rng(seed + k).normal(size=4)
    body = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0.1 * k, 0, 0.05 + 0.01 * k),
        orientation=q / np.linalg.norm(q), velocity=(0.1, 0, -0.1), angular_velocity=(0, 10, 0),
    )  # fmt: skip
    scene.add_contact(body, plane, restitution=0.5, friction=0.2, impact_law="stronge")


def dice(numbers):
    scene = carom.Scene(gravity=(0, 0, -G))
    plane = scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in numbers:
        die(scene, plane, k)
    return carom.simulate(scene, 0.7, step=1e-3)


def test_dice_thrown_together_move_as_each_alone():
    """Impacts of one do not cut the steps of another: bit for bit."""
    together = dice(range(3))
    assert np.all(np.diff(together.events.time) >= 0)
    assert np.all(np.diff(together.impacts.time) >= 0)
    for k in range(3):
        alone = dice([k])
        np.testing.assert_array_equal(together.position[:, k], alone.position[:, 0])
        np.testing.assert_array_equal(together.orientation[:, k], alone.orientation[:, 0])
        np.testing.assert_array_equal(
            together.events.time[together.events.contact == k], alone.events.time
        )
        np.testing.assert_array_equal(together.contact_force[:, k], alone.contact_force[:, 0])
        for t in (0.123, 0.345, alone.impacts.time[3]):
            for a, b in zip(together.evaluate(t), alone.evaluate(t)):
                np.testing.assert_array_equal(a[k], b[0])


@pytest.mark.plain
def test_rest_is_asleep_until_it_is_touched():
    """A ball that rests does not move at all; one that falls on it from h comes after sqrt(2 h/g)."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.1))
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0.05, 0, 1.0))
    scene.set_contact_default(restitution=0.5, friction=0.3)
    s = carom.simulate(scene, 1.0, step=0.01)
    # centres 2 r apart, .05 aside
    height = 1.0 - (0.1 + np.sqrt(0.04 - 0.05**2))
    time = s.impacts.time[0]
    assert time == pytest.approx(np.sqrt(2 * height / G), abs=1e-12)
    before = s.t < time
    assert np.all(s.position[before, 0] == [0, 0, 0.1])
    assert np.all(s.velocity[before, 0] == 0.0)
    assert s.velocity[~before, 0, 0].max() < 0.0  # pushed aside
    # steps in which nothing was near cost no trial of their own
    assert s.stats["trial_steps"] < 300


@pytest.mark.parametrize("step", [0.02, 0.01])
def test_a_light_body_that_is_thrown_out_of_its_ball(step):
    """1e6 kg strikes 1e3 kg, which strikes 1 kg, which goes on at nearly 4 v and meets a wall in the same step.

    Elastic: v_2 = 2 M/(M + m) v_1 each time. Within a step of 2 v h around each they would be apart.
    """
    masses, r, v = (1e6, 1e3, 1.0, 1e9), 0.1, 1.0
    x = np.array([0.0, 0.2001, 0.4002, 0.0])
    u2 = 2 * masses[0] / (masses[0] + masses[1]) * v
    u3 = 2 * masses[1] / (masses[1] + masses[2]) * u2
    t2 = 1e-4 / v
    t3 = t2 + 1e-4 / u2
    x[3] = x[2] + 2 * r + 0.6 * u3 * 0.01  # met 60 % of a hundredth of a second later
    t4 = t3 + (x[3] - x[2] - 2 * r) / u3
    scene = carom.Scene(gravity=(0, 0, 0))
    for mass, place in zip(masses, x):
        scene.add_body(
            carom.Sphere(r), mass=mass, position=(place, 0, 0), velocity=(v * (place == 0), 0, 0)
        )  # fmt: skip
    scene.set_contact_default(restitution=1.0, friction=0.0)
    s = carom.simulate(scene, 0.02, step=step)
    np.testing.assert_allclose(s.impacts.time[:3], (t2, t3, t4), rtol=0, atol=1e-11)
    # the fast one strikes the wall: before at u3, after at -u3 but for the ratio of the masses
    assert s.impacts.relative_velocity_before[2, 0] == pytest.approx(-u3, rel=1e-9)
    np.testing.assert_allclose(s.total_energy, s.total_energy[0], rtol=1e-12)


def test_many_near_each_other():
    """More pairs than there is room for at first: a swarm that flies in step, where all balls overlap."""
    scene = carom.Scene(gravity=(0, 0, -G))
    places = np.stack(np.meshgrid(range(4), range(5), range(2)), axis=-1).reshape(-1, 3) * 0.25
    for p in places:
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=p, velocity=(10, 0, 0))
    scene.set_contact_default(restitution=0.5, friction=0.1)
    s = carom.simulate(scene, 0.2, step=0.1)
    assert s.success
    fallen = places + 0.2 * np.array([10, 0, 0]) - 0.5 * G * 0.04 * np.array([0, 0, 1])
    np.testing.assert_allclose(s.position[-1], fallen, rtol=0, atol=1e-13)
