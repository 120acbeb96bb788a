"""When one of several points opens or begins to slip: closed forms, located inside the step."""

import numpy as np
import pytest

import carom
from carom import joints

#: order 2 on a spring of which the other end is on a car: up to 2e-3 of the energy at 10 ms, and that is said

G = 9.81
B, H, M = 0.05, 0.1, 1.3  # half width, half height, mass of a box
STIFFNESS, CAR, SPEED = 400.0, 2.0, 0.5


def drawn(height, mu, step):
    """A box is drawn by a spring, at a height, of which the other end is on a car that drives off on a rail.

    While it stays the force is k v0/w sin(w t), w^2 = k/m of the car.
    """
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    box = scene.add_body(carom.Box(2 * B, 0.08, 2 * H), mass=M, position=(0, 0, H))
    scene.add_contact(box, ground, restitution=0.0, friction=mu)
    car = scene.add_body(
        mass=CAR, inertia=(1, 1, 1), position=(1, 0, height), velocity=(SPEED, 0, 0)
    )
    scene.add_joint(joints.Prismatic((1, 0, 0)), carom.GROUND, car)
    spring = carom.forces.Spring(STIFFNESS, (0, 0, height), (1, 0, height), rest_length=1.0)
    scene.add_force(spring, box, car)
    return carom.simulate(scene, 0.03, step=step)


def when(force):
    """The time at which the spring draws so hard."""
    w = np.sqrt(STIFFNESS / CAR)
    return np.arcsin(force * w / (STIFFNESS * SPEED)) / w


@pytest.mark.parametrize("step", [0.01, 0.0025])
def test_a_box_begins_to_tip(step):
    # Drawn at its top it tips over its front edge when F 2h = m g b: both corners behind open at once. Before,
    # the forces of four corners are not unique; that those behind could do without theirs is no event.
    s = drawn(2 * H, 50.0, step)
    assert list(s.events.kind) == 4 * ["held"] + 2 * ["opens"]
    np.testing.assert_allclose(s.events.time[4:], when(M * G * B / (2 * H)), rtol=0, atol=1e-6)
    assert np.all(s.contact_mode[1:] == 2)


@pytest.mark.parametrize("step", [0.01, 0.0025])
def test_a_box_begins_to_slip(step):
    # Drawn at its centre it slips when F = mu m g, all corners at once, though those behind, with less to
    # carry, may be at their cones before.
    s = drawn(H, 0.3, step)
    assert list(s.events.kind) == 4 * ["held"] + 4 * ["slips"]
    np.testing.assert_allclose(s.events.time[4:], when(0.3 * M * G), rtol=0, atol=1e-6)


def test_a_box_that_is_drawn_too_little_stays():
    s = drawn(H, 1.0, 0.01)
    assert list(s.events.kind) == 4 * ["held"]
    np.testing.assert_allclose(s.velocity[:, 0], 0, rtol=0, atol=1e-15)
