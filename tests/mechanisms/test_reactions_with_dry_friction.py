"""Reactions and forces where dry friction acts in joints: against the change of momenta, and at rest."""

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints

G = 9.81


def rod(bound):
    """A rod of 2 kg and 1 m on a hinge with dry friction, from the horizontal."""
    scene = carom.Scene()
    scene.add_body(carom.Box(1, 0.1, 0.1), mass=2, position=(0.5, 0, 0), name="rod")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "rod", name="hinge")
    scene.add_force(forces.JointFriction("hinge", bound), name="dry")
    return scene


def test_a_rod_that_slips():
    """m a = m g + F, and the friction has its bound against the motion."""
    h = 1e-3
    run = carom.simulate(rod(3.0), 0.3, step=h)
    a = (run["rod"].velocity[2:] - run["rod"].velocity[:-2]) / (2 * h)
    force = 2 * a + [0, 0, 2 * G]
    np.testing.assert_allclose(run["hinge"].force[2:-1], force[1:], atol=1e-3)
    np.testing.assert_allclose(run["dry"].torque[1:], -3.0, rtol=1e-12)
    np.testing.assert_allclose(run["dry"].power, run["dry"].torque * run["hinge"].rate, atol=1e-12)
    assert run["dry"].torque[0] == pytest.approx(-3.0)  # it is about to slip


def test_a_rod_that_sticks():
    """The friction carries the moment of the weight, and the hinge the weight."""
    live = carom.Run(rod(12.0), step=0.01)
    live.advance(0.1)
    for one, k in ((live.solution, -1), (live.state, ...)):
        assert one["dry"].torque[k] == pytest.approx(-2 * G * 0.5, rel=1e-9)
        np.testing.assert_allclose(one["hinge"].force[k, :] if k == -1 else one["hinge"].force,
                                   [0, 0, 2 * G], atol=1e-9)  # fmt: skip


def test_a_slide(tmp_path):
    """A block on a rail: mu stands for a constant bound, so m a = F - bound, and then it is held."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(
        carom.Box(1, 1, 1), mass=2.0, position=(0, 0, 1), velocity=(1, 0, 0), name="block"
    )
    scene.add_joint(joints.Prismatic((1, 0, 0), (0, 0, 0)), GROUND, "block", name="rail")
    scene.add_force(forces.JointFriction("rail", 4.0), name="dry")
    scene.add_force(forces.Force((1.0, 0, 0)), "block", name="wind")
    run = carom.simulate(scene, 1.0, step=0.01)
    slips = run["rail"].rate > 1e-6
    np.testing.assert_allclose(run["dry"].force[slips], -4.0)
    np.testing.assert_allclose(run["dry"].force[-5:], -1.0, rtol=1e-9)
    # the rail carries the weight; the friction acts a metre below the centre of the block
    np.testing.assert_allclose(run["rail"].force[:, 2], 2 * G, rtol=1e-9)
    run.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(loaded["dry"].force, run["dry"].force)
