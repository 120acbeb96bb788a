"""The implicit step: springs and dampers of any stiffness, order 2, L-stable."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints

#: what a step far beyond the period of a spring takes out of it has no name
DAMPED = carom.Options(energy_tolerance=1.0)


def oscillator(k, c, h, duration=1.0, **more):
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1, inertia=(1, 1, 1), velocity=(1.0, 0, 0))
    joint = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body)
    scene.add_force(forces.JointSpring(joint, stiffness=k, damping=c))
    scene.add_force(forces.JointForce(joint, 2.0))
    return carom.simulate(scene, duration, step=h, method="implicit", **more)


def moved(k, c, t):
    # x'' + c x' + k x = 2, x(0) = 0, x'(0) = 1, below critical damping
    a, rest = c / 2, 2.0 / k
    w = np.sqrt(k - a * a)
    return rest + np.exp(-a * t) * (-rest * np.cos(w * t) + (1 - a * rest) / w * np.sin(w * t))


# order 2: 1e-3 of the energy at the longest step
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
def test_an_oscillator_has_order_two():
    errors = []
    for h in (0.05, 0.025, 0.0125):
        solution = oscillator(10.0, 0.5, h)
        errors.append(abs(solution.position[-1, 0, 0] - moved(10.0, 0.5, 1.0)))
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2.0, atol=0.05)
    assert abs(solution.ledger.residual[-1]) < 1e-3


@pytest.mark.parametrize(("k", "c"), [(1e8, 1e4), (1e8, 0.0), (1e6, 1e6)])
def test_steps_far_beyond_the_periods_of_a_spring_settle(k, c):
    # h = .1 s is 1600 periods; a damped spring creeps with k/c where that is slow
    x = oscillator(k, c, 0.1, duration=2.0, options=DAMPED).position[-1, 0, 0]
    creep = np.exp(-2.0 * k / c) if c > 0.0 else 0.0
    assert abs(x - 2.0 / k * (1 - creep)) < 1e-6


def pendulum(h, method):
    scene = carom.Scene()
    bob = scene.add_body(mass=1, inertia=(0.1, 0.2, 0.3), position=(1.0, 0, 0))
    scene.add_force(forces.Spring(400.0, (0, 0, 0), (1.0, 0, 0), damping=1.0), GROUND, bob)
    return carom.simulate(scene, 1.0, step=h, method=method)


def test_an_elastic_pendulum_has_order_two():
    exact = pendulum(1e-3, "rk8").position[-1, 0]
    errors = [
        np.linalg.norm(pendulum(h, "implicit").position[-1, 0] - exact) for h in (2e-3, 1e-3, 5e-4)
    ]
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2.0, atol=0.15)


def braced_four_bar(k, c):
    """A square of bars with a stiff brace across it: the loop is closed, the brace nearly rigid."""
    scene = carom.Scene()
    corners = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]], dtype=float)
    bars = [
        scene.add_body(carom.Box(*(0.04 + 0.96 * np.abs(b - a))), mass=1.0, position=(a + b) / 2)
        for a, b in itertools.pairwise(corners)
    ]
    pairs = [(GROUND, bars[0]), (bars[0], bars[1]), (bars[1], bars[2]), (GROUND, bars[2])]
    for corner, (parent, child) in zip(corners, pairs):
        scene.add_joint(joints.Revolute(corner, (0, 1, 0)), parent, child)
    scene.add_force(forces.Spring(k, corners[0], corners[2], damping=c), GROUND, bars[1])
    scene.add_force(forces.Force((10.0, 0, 0)), bars[1])
    return scene


def test_a_stiff_brace_in_a_loop_carries_its_load():
    # the brace at 45 degrees: tension 10 sqrt 2 N; in one step of 0.05 s its period is 1e-3 s
    k = 1e8
    solution = carom.simulate(
        braced_four_bar(k, 1e3), 2.0, step=0.05, method="implicit", options=DAMPED
    )
    position, velocity = solution.constraint_errors
    assert max(position.max(), velocity.max()) < 1e-12
    ends = solution.position[-1, 1] + [0.5, 0, 0]  # the bar on top stays level
    stretch = np.linalg.norm(ends) - np.sqrt(2.0)
    assert k * stretch == pytest.approx(10.0 * np.sqrt(2.0), rel=1e-3)
    # the reactions of the hinges, and the brace, balance force and weights
    on_ground = solution.joint_reactions[-1, [0, 3], :3].sum(axis=0)
    brace = -10.0 * np.array([1.0, 0.0, 1.0])
    np.testing.assert_allclose(on_ground + brace, [-10.0, 0, 3 * 9.81], atol=0.02)


def test_a_body_on_a_spring_strikes_a_stop():
    # k = 100, from the middle with 1 m/s: x = sin(10 t)/10 meets .05 at asin(.5)/10 with cos(30 deg)
    errors = []
    for h in (4e-3, 2e-3):
        scene = carom.Scene(gravity=(0, 0, 0))
        body = scene.add_body(mass=1, inertia=(1, 1, 1), velocity=(1.0, 0, 0))
        joint = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body)
        scene.add_force(forces.JointSpring(joint, stiffness=100.0))
        scene.add_stop(joint, upper=0.05, restitution=0.5)
        hit = carom.simulate(scene, 0.1, step=h, method="implicit").impacts[0]
        assert hit.impulse[0] == pytest.approx(-1.5 * hit.relative_velocity_before[0], rel=1e-12)
        errors.append(abs(hit.time - np.arcsin(0.5) / 10))
    assert errors[1] < 2e-6
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=1.0)


def test_what_it_does_not_do_is_refused():
    scene = carom.Scene()
    body = scene.add_body(mass=1, inertia=(1, 1, 1))
    joint = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body)
    scene.add_force(forces.JointFriction(joint, 1.0))
    with pytest.raises(ValueError, match="dry friction"):
        carom.simulate(scene, 0.1, step=0.01, method="implicit")
    with pytest.raises(ValueError, match="step must be a number for method='implicit'"):
        carom.simulate(scene, 0.1, method="implicit")
