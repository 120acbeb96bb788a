"""Rotation where a torque acts: of order 4 whatever the ratio of the moments, far turns in parts."""

import numpy as np
import pytest

import carom
from carom.kinematics.flight_arrays import torque_free
from references.free_rotation import angle_between

START = np.array([[1.0, 0, 0, 0]])
AS_THEY_ARE = carom.Options(energy_tolerance=1.0)  # steps are not cut for what they lose


def box(a, b, c):
    return np.array([b * b + c * c, a * a + c * c, a * a + b * b]) / 12


def off(J, h, method="rk4", spin=(0.7, 0.56, 0.42), T=12.0):
    """Angle [rad] after T by steps of h with a torque that does nothing, against the closed form."""
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1, inertia=J, angular_velocity=spin)
    scene.add_force(carom.forces.Torque((1e-20, 0, 0)), body)
    a = carom.simulate(scene, T, step=h, method=method, options=AS_THEY_ARE)
    known, _ = torque_free(J, START, np.array([spin]), a.t[-1:])
    return angle_between(a.orientation[-1, 0], known[0]), a


@pytest.mark.parametrize("J", [(1.0, 2.0, 2.5), box(1, 0.8, 0.01), box(1, 0.1, 0.09)])
def test_order(J):
    errors = [off(J, h)[0] for h in (0.1, 0.05, 0.025)]
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 4, rtol=0, atol=0.15)


def test_slender_bodies_are_no_worse():
    # ratios of moments of 110, 1100 and 1.1e6: what the factors (J_2 - J_3)/J_1 of Euler's equations make of it
    errors = [off(box(1, k, 0.9 * k), 0.2)[0] for k in (0.1, 0.03, 0.001)]
    assert max(errors) < 1.2 * min(errors)


@pytest.mark.parametrize(("method", "tolerance"), [("rk4", 1e-3), ("rk5", 1e-3), ("rk8", 1e-5)])
def test_far_turns_are_made_in_parts(method, tolerance):
    # 2 rad a step and 0.2: parts of 0.3, 0.45 and 0.9 rad; undivided, rk4 is off by 0.6 rad
    error, a = off((1.0, 2.0, 2.5), 2.0, method)
    turn = {"rk4": 0.3, "rk5": 0.45, "rk8": 0.9}[method]
    parts = a.stats["parts"] + a.stats["steps"]
    assert a.stats["steps"] == 6
    assert 12 * 0.85 / turn < parts < 12 * 1.1 / turn + 6  # |w| varies from .85 to 1.1
    assert error < tolerance
    assert off((1.0, 2.0, 2.5), 0.2, method)[1].stats["parts"] == 0


def test_an_impact_in_a_step_of_parts_is_located():
    # the end of a step in parts is a continuous function of its length: the gap at the impact is round-off
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(
        carom.Box(0.2, 0.1, 0.05), mass=1, position=(0, 0, 0.5), angular_velocity=(20, 30, 10)
    )
    scene.add_force(carom.forces.Torque((0.01, 0, 0)), body)
    scene.add_contact(body, floor, restitution=0.5)
    a = carom.simulate(scene, 0.35, step=0.05)
    assert a.success
    assert a.stats["parts"] > 20
    assert len(a.impacts) > 0
    assert np.max(np.abs(a.impacts.point[:, 2])) < 1e-13
