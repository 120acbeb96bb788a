"""Lines and circles that strike: equal rollers keep their symmetry, discs in one plane are circles."""

import numpy as np
import pytest

import carom
from carom.geometry import quaternion

Q = quaternion.exp(np.array([0.3, -0.8, 0.5]))  # of the whole scene


def strike(a, b, e):
    """Throw `a` along x against `b`, both with the axis z, in a turned frame; return both velocities."""
    scene = carom.Scene(gravity=(0, 0, 0))
    along = quaternion.rotate(Q, np.array([1.0, 0, 0]))
    scene.add_body(a, mass=1, orientation=Q, velocity=along, name="a")
    scene.add_body(b, mass=1, position=0.4 * along, orientation=Q, name="b")
    scene.add_contact("a", "b", restitution=e, friction=0)
    solution = carom.simulate(scene, 0.5)
    assert solution.stats["whole_steps"] == 0
    spins = [solution[name].angular_velocity[-1] for name in "ab"]
    return [solution[name].velocity[-1] @ along for name in "ab"], np.abs(spins).max(), solution


@pytest.mark.parametrize("shape", [carom.Cylinder(0.1, 0.2), carom.Capsule(0.05, 0.3)])
def test_equal_rollers_exchange_their_velocities(shape):
    # (1 - e)/2 and (1 + e)/2, and no spin, by symmetry.
    speeds, spin, _ = strike(shape, shape, 0.5)
    np.testing.assert_allclose(speeds, [0.25, 0.75], atol=1e-10)
    assert spin < 1e-9


def test_discs_in_one_plane_strike_as_circles():
    # They touch at the distance .1 + .03: after .27 s.
    speeds, _, solution = strike(carom.Disc(0.1), carom.Disc(0.03), 1.0)
    np.testing.assert_allclose(speeds, [0.0, 1.0], atol=1e-12)
    assert solution.impacts.time[0] == pytest.approx(0.27, abs=1e-12)


def test_equal_rollers_drive_each_other():
    # Friction mu N slows one and drives the other evenly, until they roll at t1 = w0 I/(2 F R).
    R, mu, w0, I, lie = 0.1, 0.3, 30.0, 0.004, carom.euler("x", 90)
    scene = carom.Scene()
    add = dict(mass=1, inertia=(I, I, I), orientation=lie)
    scene.add_body(carom.Cylinder(R, 0.05), **add, angular_velocity=(0, w0, 0), name="A")
    scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, "A", name="hinge")
    scene.add_body(mass=1, inertia=(1, 1, 1), position=(0, 0, 2 * R), name="car")
    scene.add_joint(carom.joints.Prismatic((0, 0, 1)), carom.GROUND, "car")
    scene.add_body(carom.Cylinder(R, 0.05), **add, position=(0, 0, 2 * R), name="B")
    scene.add_joint(carom.joints.Revolute((0, 0, 2 * R), (0, 1, 0)), "car", "B")
    scene.add_contact("A", "B", friction=mu, restitution=0)
    force = mu * 2 * 9.81
    t1 = w0 * I / (2 * force * R)
    solution = carom.simulate(scene, t1 + 0.5)
    assert solution.stats["whole_steps"] == 0
    turned = w0 * t1 - force * R / I * t1**2 / 2 + w0 / 4
    assert solution["hinge"].coordinate[-1] == pytest.approx(turned, abs=1e-8)
