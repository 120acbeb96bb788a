"""Masses from 1e-4 to 1e3 kg and lengths from 1e-3 to 10 m in one mechanism: order and constraints stay."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom import GROUND, joints

Y = (0.0, 1.0, 0.0)


def mixed(looped):
    """A beam of 10 m and 1000 kg, a rod of 1 m on it, on that a pointer of 1 mm and 0.1 g; looped: a brace."""
    scene = carom.Scene()
    sizes = ((1e3, 10.0), (1.0, 1.0), (1e-4, 1e-3))
    x, parent, scale = 0.0, GROUND, []
    for mass, length in sizes:
        J = mass * length**2 / 12
        body = scene.add_body(mass=mass, inertia=(0.01 * J, J, J), position=(x + length / 2, 0, 0))
        scene.add_joint(joints.Revolute((x, 0, 0), Y), parent, body)
        x, parent = x + length, body
        scale.append(length)
    if looped:  # a light crank that holds the rod up from the beam: one freedom less
        beam, rod = scene.bodies[0], scene.bodies[1]
        crank = scene.add_body(
            mass=0.01, inertia=(1e-6, 1e-4, 1e-4), position=(10.0, 0.0, 0.5), name="crank"
        )
        scene.add_joint(joints.Revolute((9.5, 0, 0.5), Y), beam, crank)
        scene.add_joint(joints.Distance((10.5, 0, 0.5), (10.4, 0, 0)), crank, rod)
    return scene


@pytest.mark.parametrize(
    ("looped", "steps"),
    [(False, (2e-3, 1e-3, 5e-4, 1.25e-4)), (True, (8e-4, 4e-4, 2e-4, 2.5e-5))],
)
def test_order_four_and_exact_joints(looped, steps):
    tips, energies = [], []
    for h in steps:
        s = carom.simulate(mixed(looped), 0.1, step=h, save_every=10**6)
        tips.append(s.position[-1, 2])
        energies.append(abs(s.ledger.residual[-1]))
        assert np.max(np.abs(s.constraint_errors[0][-1])) < 1e-13  # of coordinates of 10 m
        assert np.max(np.abs(s.constraint_errors[1][-1])) < 1e-11
    errors = [np.linalg.norm(tip - tips[-1]) for tip in tips[:-1]]
    order = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(order, 4.0, atol=0.15)
    weight = 1e3 * 9.81 * 5.0  # [J], what the beam has to give
    assert energies[-2] < 1e-10 * weight
