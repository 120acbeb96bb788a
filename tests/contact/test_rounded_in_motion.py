"""Rounded boxes and hulls strike the ground as what they are."""

import numpy as np
import pytest

import carom
from carom.scene import Box, Convex, Scene, Sphere


def dropped(shape, orientation=(1, 0, 0, 0)):
    scene = Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    motion = {"velocity": (1.0, 0.5, 0), "angular_velocity": (3.0, -1, 2)}
    body = scene.add_body(shape, mass=2, position=(0, 0, 1), orientation=orientation, **motion)
    scene.add_contact(body, ground, restitution=0.7, friction=0.3)
    return carom.simulate(scene, 0.6, step=0.01)


def test_cube_that_is_all_rounding_bounces_as_a_ball():
    cube, ball = dropped(Box(0.4, 0.4, 0.4, radius=0.2)), dropped(Sphere(0.2))
    assert len(cube.impacts) == len(ball.impacts) >= 1
    np.testing.assert_allclose(cube.position, ball.position, atol=1e-12)
    np.testing.assert_allclose(cube.angular_velocity, ball.angular_velocity, atol=1e-11)


def test_hull_of_the_core_moves_as_the_rounded_box():
    box = Box(0.2, 0.3, 0.4, radius=0.05)
    turn = np.array([4.0, 1, 2, 3]) / np.sqrt(30)
    one, two = dropped(box, turn), dropped(Convex(box.vertices, radius=0.05), turn)
    assert len(one.impacts) >= 1
    np.testing.assert_allclose(one.position, two.position, atol=1e-9)
    first = one.impacts[0]
    assert first.time == pytest.approx(two.impacts[0].time, abs=1e-12)
