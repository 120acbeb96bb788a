"""A cart on two wheels that motors turn at given rates: rows of rolling that depend on each other."""

import numpy as np
import pytest

import carom
from carom import constraints, joints

R, HALF, FRONT = 0.1, 0.2, 0.25


def cart(left, right, driven=True):
    """A cart on two wheels (balls) that roll, and a smooth ball in front, as it goes on evenly."""
    v, turn = 0.5 * (left + right), (right - left) / (2 * HALF)
    scene = carom.Scene(gravity=(0, 0, -9.81))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    spin = (0, 0, turn)
    body = scene.add_body(
        carom.Box(0.4, 0.2, 0.06), mass=4, position=(0.02, 0, R), velocity=(v, turn * 0.02, 0),
        angular_velocity=spin,
    )  # fmt: skip
    ball = scene.add_body(
        carom.Sphere(0.04), mass=0.2, position=(FRONT, 0, 0.04), velocity=(v, turn * FRONT, 0),
        angular_velocity=spin,
    )  # fmt: skip
    scene.add_joint(joints.Fixed(), body, ball)
    scene.add_contact(ball, floor, restitution=0, friction=0)
    for side, speed in ((1, left), (-1, right)):
        wheel = scene.add_body(
            carom.Sphere(R), mass=0.5, position=(0, side * HALF, R), velocity=(speed, 0, 0),
            angular_velocity=(0, speed / R, turn),
        )  # fmt: skip
        hinge = scene.add_joint(joints.Revolute((0, side * HALF, R), (0, 1, 0)), body, wheel)
        if driven:
            scene.add_constraint(constraints.Driver(hinge, rate=speed / R))
        scene.add_contact(wheel, floor, restitution=0, friction=1.0)
    return scene


@pytest.mark.parametrize(("left", "right"), [(1.0, 2.0), (0.2, 1.0)])
@pytest.mark.parametrize("how", [{}, {"step": 2e-3}])
def test_the_axle_goes_on_a_circle(left, right, how):
    """Its middle has the speed v = (l + r)/2 and the rate (r - l)/(2 HALF), on a circle of radius v/rate.

    Both wheels keep the axle from going along itself, so that their rows depend on each other: in a stage they
    fit only to the error of the stage, which was taken for a contact without a solution.
    """
    v, turn = 0.5 * (left + right), (right - left) / (2 * HALF)
    s = carom.simulate(cart(left, right), 1.0, **how)
    axle, a = 0.5 * (s.position[:, 2] + s.position[:, 3]), turn * s.t
    assert len(s.impacts) == 0
    assert s.stats["trial_steps"] < 1000
    allowed = 1e-6 if "step" in how else 1e-8
    np.testing.assert_allclose(axle[:, 0], v / turn * np.sin(a), rtol=0, atol=allowed)
    np.testing.assert_allclose(axle[:, 1], v / turn * (1 - np.cos(a)), rtol=0, atol=allowed)


def test_without_motors_nothing_is_lost():
    """Rolling does no work: the energy stays, and few steps are enough."""
    s = carom.simulate(cart(1.0, 2.0, driven=False), 1.0)
    assert s.stats["trial_steps"] < 1000
    np.testing.assert_allclose(s.kinetic_energy, s.kinetic_energy[0], rtol=1e-8)
