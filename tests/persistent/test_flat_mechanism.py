"""Mechanisms that move in a plane: across it nothing moves, and round-off there must not count."""

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from carom._compiled.decorators import entry
from carom.dynamics.friction import stick_force


@entry
def stick(W, a0, a1, a2):
    return stick_force(W, a0, a1, a2)


@pytest.mark.plain
@pytest.mark.parametrize("across", [1, 2])
@pytest.mark.parametrize("size", [0.0, 1e-33, 1e-17])
def test_round_off_across_the_plane_asks_for_no_force(across, size):
    """W is [[2, 1], [1, 3]] in the plane, and round-off across it, as is the acceleration there."""
    W, along = np.zeros((3, 3)), 3 - across
    W[0, 0], W[along, along] = 2.0, 3.0
    W[0, along] = W[along, 0] = 1.0
    W[across, across] = size
    W[0, across] = W[across, 0] = W[along, across] = W[across, along] = -0.3 * size
    a = np.array([-1.0, 0.0, 0.0])
    a[across] = 1e-16
    found = np.array(stick(W, *a))
    assert abs(found[across]) < 1e-15
    np.testing.assert_allclose((W @ found + a)[[0, along]], 0.0, atol=1e-15)


@pytest.mark.parametrize("tilt", [0.0, 0.3, 1.2])
@pytest.mark.parametrize("friction", [0.3, 0.9])
def test_a_planar_leg_falls_on_the_floor(tilt, friction):
    """A trunk on a planar joint with a thigh and a shin, in any vertical plane: its energy has names."""
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    x = np.array([np.cos(tilt), np.sin(tilt), 0.0])
    normal = np.array([-np.sin(tilt), np.cos(tilt), 0.0])
    turn = np.array([np.cos(0.5 * tilt), 0.0, 0.0, np.sin(0.5 * tilt)])
    parts = []
    for k, (size, where) in enumerate(
        (((0.6, 0.1, 0.1), 0.0), ((0.3, 0.05, 0.05), 0.4), ((0.3, 0.05, 0.05), 0.7))
    ):
        place = where * x + np.array([0.0, 0.0, 0.3])
        parts.append(
            scene.add_body(carom.Box(*size), mass=1.0 + k, position=place, orientation=turn)
        )
    scene.add_joint(joints.Planar(normal, parts[0].position), GROUND, parts[0])
    hinges = [
        scene.add_joint(
            joints.Revolute(at * x + np.array([0.0, 0.0, 0.3]), normal), *parts[i : i + 2]
        )
        for i, at in ((0, 0.275), (1, 0.55))
    ]
    for hinge in hinges:
        scene.add_force(carom.forces.JointSpring(hinge, 20.0, 0.5))
        scene.add_force(carom.forces.JointInertia(hinge, 0.02))
        scene.add_stop(hinge, lower=-0.6, restitution=0.2)
        scene.add_stop(hinge, upper=0.6, restitution=0.2)
    for part in parts:
        scene.add_contact(part, floor, friction=friction, restitution=0.2)
    solution = carom.simulate(scene, 0.8, step=1e-3)
    exchanged = np.max(solution.kinetic_energy)
    assert np.max(np.abs(solution.ledger.residual)) < 1e-5 * exchanged
    assert np.max(np.abs(np.einsum("i,tbi->tb", normal, solution.velocity))) < 1e-12
    assert np.max(solution.held_residual) < 1e-8
