"""Free bodies that touch and fall as one have no forces until the first of them strikes."""

import numpy as np
import pytest

import carom

HEIGHT, SIZE, SPEED = 0.5, 0.02, (0.3, -0.2, 0.1)


@pytest.mark.parametrize("spin", [0, 5])
@pytest.mark.parametrize("how", [{}, {"step": 1e-3}, {"step": 0.02}])
@pytest.mark.parametrize("shape", [carom.Box(SIZE, SIZE, SIZE), carom.Sphere(SIZE / 2)])
def test_bodies_that_touch_fall_by_the_closed_form(shape, how, spin):
    """Only balls can turn in their places: they go through the stages of a group that does not fall as one."""
    if spin and isinstance(shape, carom.Box):
        return
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(restitution=0, friction=0.0 if spin else 0.5)
    for k in range(6):
        scene.add_body(
            shape, mass=0.01 * (k + 1), position=(SIZE * (k % 3), 0, HEIGHT + SIZE * (k // 3)),
            velocity=SPEED, angular_velocity=(0, 0, spin if k == 5 else 0),
        )  # fmt: skip
    s = carom.simulate(scene, 0.2, save_at=[0.1, 0.2], **how)
    start = np.array([body.position for body in scene.bodies])
    for time, position in zip(s.t, s.position, strict=True):
        fall = np.outer(time, SPEED) - [0, 0, 0.5 * 9.81 * time**2]
        assert np.abs(position - start - fall).max() < 1e-14
    assert s.stats["impacts"] == 0 < s.stats["held_steps"]
    assert np.abs(s.contact_force).max() <= (1e-15 if spin else 0)
