"""A box sticks to a plate that moves, with several times the friction that is needed: it does not creep."""

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints


def sine(a, w):
    return lambda t: (a * (1 - np.cos(w * t)), a * w * np.sin(w * t), a * w * w * np.cos(w * t))


def ramp(t):
    return t * t, 2 * t, 2.0


PLATES = {
    "slider": (joints.Prismatic((1, 0, 0)), sine(0.06, 5.8)),
    "lift": (joints.Prismatic((0, 0, 1)), sine(0.06, 5.8)),
    "turntable": (joints.Revolute((0, 0, 0), (0, 0, 1)), ramp),
    "seesaw": (joints.Revolute((0, 0, 0), (0, 1, 0)), sine(0.1, 5.0)),
    "slider on a spring": (joints.Prismatic((1, 0, 0)), None),
}


@pytest.mark.few(4)
@pytest.mark.parametrize("plate", PLATES)
@pytest.mark.parametrize("rtol", [1e-6, 1e-10])
def test_it_does_not_move_on_the_plate(plate, rtol):
    joint, motion = PLATES[plate]
    scene = carom.Scene(gravity=(0, 0, -9.81))
    body = scene.add_body(carom.Box(2, 1, 0.1), mass=5)
    scene.add_body(carom.Box(0.3, 0.3, 0.2), mass=1, position=(-0.4, 0, 0.15))
    j = scene.add_joint(joint, GROUND, body)
    if motion is None:
        scene.add_force(forces.JointSpring(j, 60.0, rest=0.1))
    else:
        scene.add_constraint(constraints.Driver(j, motion=motion))
    scene.set_contact_default(restitution=0.0, friction=0.7)
    s = carom.simulate(scene, 0.6, rtol=rtol)
    w, *q = s.orientation[:, 0].T
    apart, q = s.position[:, 1] - s.position[:, 0], -np.transpose(q)  # into the axes of the plate
    place = apart + 2 * np.cross(q, np.cross(q, apart) + w[:, None] * apart)
    np.testing.assert_allclose(place, np.broadcast_to(place[0], place.shape), atol=1e-12)
