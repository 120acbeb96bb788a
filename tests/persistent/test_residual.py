"""Velocities and impulses of persistent contacts fit each other, measured apart from the solver."""

import numpy as np
import pytest

import carom

G = 9.81


def boxes(count, *, spin=0.0, step=2e-3):
    """Boxes on each other, each faster than the one below it."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for i in range(count):
        scene.add_body(
            carom.Box(0.1, 0.12, 0.1), mass=1.0, position=(0, 0, 0.05 + 0.1 * i),
            velocity=(0.3 * (i + 1), 0, 0), angular_velocity=(0, 0, spin),
        )  # fmt: skip
    scene.set_contact_default(restitution=0.5, friction=0.3)
    return carom.simulate(scene, 0.2, step=step)


@pytest.mark.parametrize(("count", "spin"), [(1, 0.0), (1, 4.0), (2, 0.0), (3, 0.0)])
def test_residual_is_round_off(count, spin):
    # of the speeds at hand, .3 m/s and more, in every step; and it is measured: round-off is not nothing
    s = boxes(count, spin=spin)
    assert s.held_residual.shape == s.t.shape
    assert np.max(s.held_residual) <= 1e-10 * 0.3
    assert np.count_nonzero(s.held_residual) > 10


def test_residual_of_one_point():
    # a ball that slides, then rolls: its normal velocity, then all of it at the point
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0.1, 0, 1))
    ball = scene.add_body(
        carom.Sphere(0.1), mass=1, position=0.1 * ground.normal, velocity=(0, 1, 0)
    )
    scene.add_contact(ball, ground, restitution=0.0, friction=0.2)
    s = carom.simulate(scene, 0.5, step=0.01)
    assert np.max(s.held_residual) <= 1e-10
    assert np.count_nonzero(s.held_residual) > 5


def test_a_body_in_flight_has_none():
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 3))
    scene.add_contact(ball, ground, friction=0)
    assert np.all(carom.simulate(scene, 0.5, step=0.01).held_residual == 0.0)
