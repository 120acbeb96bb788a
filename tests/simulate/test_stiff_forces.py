"""Steps that the stability of the explicit method limits: a sentence names the force."""

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints
from carom.dynamics.methods import METHODS, make_method
from carom.results.stiff_forces import radius


def rod(force, duration):
    """A rod on a hinge under gravity, with a force along the hinge."""
    scene = carom.Scene()
    body = scene.add_body(carom.Box(0.2, 0.02, 0.02), mass=0.1, position=(0.1, 0, 0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, body, name="hinge")
    scene.add_force(force(hinge), name="brake")
    return scene, duration


@pytest.mark.parametrize(
    ("force", "said"),
    [
        (lambda hinge: forces.JointSpring(hinge, 0.0, 100.0), "Use method"),
        (
            lambda hinge: forces.JointForce(hinge, lambda t, q, rate: -100.0 * rate),
            "JointSpring(joint",
        ),
    ],
)
def test_a_stiff_damper_is_named(force, said):
    # c/I = 100/(0.1 0.2^2/3 + ...) = 7e4 1/s: 0.1 s are 7e3 relaxation times, a step at most 6 of them
    with pytest.warns(carom.MistakeWarning, match="'brake'"):
        solution = carom.simulate(*rod(force, 0.1))
    assert solution.stats["trial_steps"] > 1000
    (sentence,) = solution.warnings
    assert "'brake'" in sentence
    assert 'method="implicit"' in sentence
    assert said in sentence


def test_a_soft_damper_and_a_motion_that_is_resolved_are_not():
    # the damper stops a pendulum in some forty swings; a spring without damper swings for ever
    for force, duration in (
        (lambda hinge: forces.JointSpring(hinge, 0.0, 6e-4), 30.0),
        (lambda hinge: forces.JointSpring(hinge, 10.0, 0.0), 8.0),
    ):
        solution = carom.simulate(*rod(force, duration), rtol=1e-12, atol=1e-12)
        assert solution.stats["trial_steps"] > 1000  # below nothing is said
        assert solution.warnings == ()


def test_the_boundary_of_stability_is_that_of_the_method():
    # order 4: 2.785 on the real axis and 2 sqrt 2 on the imaginary one (Hairer and Wanner 1996, IV.2); grid 0.1
    method = make_method("rk4", carom.Options())
    assert "rk4" in METHODS
    assert np.allclose(radius(method, np.array([-1.0, 1.0j])), [2.785, 8**0.5], atol=0.1)
