"""Random scenes with springs, motors, loads and stops: no loss of energy is silent.

The short form of benchmarks/campaigns/forced.py.
"""

from math import cos, pi, sin

import pytest

import carom
from campaigns import forced, mechanisms, strikes
from campaigns.case import run

TOLERANCE = carom.Options().energy_tolerance


@pytest.mark.few(2)
@pytest.mark.parametrize("first", range(40, 80, 8))
def test_what_ends_in_success_has_its_energy_or_says_so(first):
    # Worked out from the ledger at saved times, and so never above what the loop has seen after each step. That
    # holds for any motion; scenes that are too stiff, or whose motor comes to a dead end, may fail by name.
    for seed in range(first, first + 8):
        found = run(forced.case(seed))
        if found.status == "SUCCESS":
            assert found.residual <= 100.0 * TOLERANCE, seed
        if found.status in ("SUCCESS", "INACCURATE") and found.residual > TOLERANCE:
            assert found.warned, seed


@pytest.mark.parametrize(
    ("family", "seeds"),
    [
        (
            strikes,
            (23, 79, 133, 260, 280, 339, 374, 475),
        ),  # small bodies on strings that snap round
        (forced, (19, 25, 113, 124, 199, 200, 208)),  # springs with h w up to 10
        (mechanisms, (83, 209, 371)),
    ],
    ids=["strikes", "forced", "mechanisms"],
)
def test_a_step_that_is_too_long_is_cut(family, seeds):
    # Steps as they are lose 5 to 100 % of the energy of each. Cut, each has at most 1e-7 of it without a name,
    # and few come near.
    for seed in seeds:
        found = run(family.case(seed))
        assert found.status == "SUCCESS", seed
        assert found.residual < 3e-5, seed
        assert found.warned == 0, seed


def test_a_scene_is_the_same_for_the_same_seed():
    once, again = (forced.case(7).scene for _ in range(2))
    assert str(once) == str(again)


def test_friction_of_a_joint_that_a_motor_moves():
    # A wheel on a motor that starts from rest and turns back, with dry friction M: the motor gives M |q'|
    # besides what the wheel needs. (J P J^T is 0 where the motor has the coordinate: nothing can keep it.)
    bound, a, w = 0.3, 0.5, 4.0
    scene = carom.Scene(gravity=(0, 0, 0))
    wheel = scene.add_body(mass=1.0, inertia=(0.2, 0.2, 0.2))
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 0, 1)), carom.GROUND, wheel)
    scene.add_force(carom.forces.JointFriction(hinge, bound))

    def motion(t):
        return a * (1 - cos(w * t)), a * w * sin(w * t), a * w * w * cos(w * t)

    scene.add_constraint(carom.constraints.Driver(hinge, motion=motion))
    solution = carom.simulate(scene, 3.0, step=0.01)
    q, rate = (column[:, 0] for column in solution.joint_coordinates(hinge))
    # the way, forth and back: 2 a each half turn of the motor
    half, rest = divmod(w * solution.t[-1], pi)
    way = 2.0 * a * half + a * (1 - cos(rest))
    assert solution.ledger.friction[-1] == pytest.approx(-bound * way, rel=1e-6)
    work = bound * way + 0.5 * 0.2 * rate[-1] ** 2
    assert solution.ledger.loads[-1] == pytest.approx(work, rel=1e-6)
    assert abs(q[-1] - motion(solution.t[-1])[0]) < 1e-12
