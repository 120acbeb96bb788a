"""Dry friction in a joint that turns back at a dead centre, where no force along it can stop the loop."""

from __future__ import annotations

import numpy as np
import pytest

import carom


def crank_and_rocker(speed: float) -> carom.Scene:
    """Return a crank of .1 m that turns, a coupler and a rocker whose joint to the ground has dry friction."""
    scene = carom.Scene(gravity=(0, 0, 0))
    o, a, d = np.zeros(3), np.array([0.0, 0.0, 0.1]), np.array([0.4, 0.0, 0.0])
    far = np.hypot(*(d - a)[[0, 2]])  # the coupler of .35 m meets the rocker of .25 m
    along = (0.35**2 - 0.25**2 + far**2) / (2.0 * far)
    e = (d - a) / far
    b = a + along * e + np.sqrt(0.35**2 - along**2) * np.array([-e[2], 0.0, e[0]])
    w = np.array([0.0, speed, 0.0])
    v_a = np.cross(w, a)
    # rates of coupler and rocker: the velocity of b is that of both
    p, q = np.cross([0.0, 1.0, 0.0], b - a), np.cross([0.0, 1.0, 0.0], b - d)
    rates = np.linalg.solve(np.array([p, -q]).T[[0, 2]], -v_a[[0, 2]])
    bodies = []
    for start, end, rate, at, moves in (
        (o, a, speed, o, o), (a, b, rates[0], a, v_a), (d, b, rates[1], d, o),
    ):  # fmt: skip
        length = np.linalg.norm(end - start)
        angle = -np.arctan2(end[2] - start[2], end[0] - start[0])
        middle, turn = 0.5 * (start + end), np.array([0.0, rate, 0.0])
        bodies.append(
            scene.add_body(
                carom.Box(length, 0.02, 0.02), mass=1.0, position=middle,
                orientation=(np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0),
                velocity=moves + np.cross(turn, middle - at), angular_velocity=turn,
            )
        )  # fmt: skip
    axis = (0, 1, 0)
    for place, parent, child in (
        (o, carom.GROUND, bodies[0]), (a, bodies[0], bodies[1]), (b, bodies[1], bodies[2]),
    ):  # fmt: skip
        scene.add_joint(carom.joints.Revolute(anchor=place, axis=axis), parent, child)
    rocker = scene.add_joint(carom.joints.Revolute(anchor=d, axis=axis), carom.GROUND, bodies[2])
    scene.add_force(carom.forces.JointFriction(rocker, bound=0.05))
    return scene


@pytest.mark.parametrize("rtol", [1e-6, 1e-8])
def test_a_rocker_with_friction_turns_back(rtol):
    """The rocker turns back twice in each turn of the crank: its friction takes its work, and nothing else.

    The balance holds to some hundred times the tolerance: the steps' own errors of energy add up.
    """
    s = carom.simulate(crank_and_rocker(8.0), 1.5, rtol=rtol)
    rocker = s.angular_velocity[:, 2, 1]
    assert s.success
    assert np.sum(rocker[1:] * rocker[:-1] < 0.0) >= 3
    assert np.max(np.abs(s.ledger.residual)) <= 300.0 * rtol * s.kinetic_energy[0]
    assert s.kinetic_energy[-1] < s.kinetic_energy[0]
