"""A ball held by friction between two plates that forces press together, in a hand that is shaken sideways."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from carom import GROUND, constraints, forces, joints

FORCE, MU, MASS, G, RATE = 10.0, 0.5, 0.2, 9.81, 20.0


def grasp(reach):
    scene = carom.Scene(gravity=(0, 0, -G))
    hand = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=1, position=(0, 0, 2), name="hand")
    slide = scene.add_joint(joints.Prismatic((0, 1, 0)), GROUND, hand)

    def motion(t):
        a, w = reach, RATE
        return a * (1 - np.cos(w * t)), a * w * np.sin(w * t), a * w * w * np.cos(w * t)

    scene.add_constraint(constraints.Driver(slide, motion=motion))
    ball = scene.add_body(carom.Sphere(0.025), mass=MASS, position=(0, 0, 0.12), name="ball")
    for side in (-1, 1):
        plate = scene.add_body(
            carom.Box(0.02, 0.4, 0.4), mass=0.05, position=(0.035 * side, 0, 0.12)
        )
        way = scene.add_joint(joints.Prismatic((-side, 0, 0)), hand, plate)
        scene.add_force(forces.JointForce(way, FORCE))
        scene.add_contact(plate, ball, restitution=0, friction=MU)
    return scene


def way_of_slip(reach, duration):
    """Return the way of the ball along y and z against the hand.

    By symmetry it does not turn, so that its slip obeys m u' = m (g - a_hand) - 2 mu N u/|u|. It starts at rest
    along the acceleration without friction, with |u| = (|a| - 2 mu N/m) t at first.
    """
    most = 2 * MU * FORCE / MASS

    def rates(t, y):
        free = np.array([-reach * RATE**2 * np.cos(RATE * t), -G])
        way = y[2:] / np.hypot(*y[2:]) if t > 0.0 else free / np.hypot(*free)
        return [*y[2:], *(free - most * way)]

    return solve_ivp(rates, (0, duration), [0] * 4, rtol=1e-11, atol=1e-14).y[:2, -1]


@pytest.mark.parametrize("rtol", [1e-8, 1e-10])
def test_what_sticks_does_not_creep(rtol):
    """Friction could hold more than twice what is needed."""
    s = carom.simulate(grasp(0.01), 0.3, rtol=rtol)
    way = s["ball"].position - s["hand"].position
    np.testing.assert_allclose(way, np.broadcast_to(way[0], way.shape), atol=1e-12)


@pytest.mark.parametrize("how", [{}, {"rtol": 1e-6}, {"step": 2.5e-4}])
def test_what_slips_obeys_coulomb(how):
    s = carom.simulate(grasp(0.15), 0.05, **how)
    way = s["ball"].position - s["hand"].position
    allowed = 1e-6 if "rtol" in how else 1e-8
    np.testing.assert_allclose((way[-1] - way[0])[1:], way_of_slip(0.15, 0.05), atol=allowed)
