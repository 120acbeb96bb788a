"""Gears whose teeth are convex pieces: teeth that touch at flanks and tips never skip."""

import numpy as np
import pytest

import carom
from campaigns import teeth
from campaigns.case import run, wrong
from carom import GROUND, constraints, forces, joints

MODULE, FIRST, SECOND = 0.004, 12, 18
PLAY = 0.27  # of a tooth, to either side: polygon against polygon


def gear(count, turned):
    """Return a hub with straight teeth."""
    pitch = 0.5 * count * MODULE
    outline = [
        (pitch + up * MODULE, side * half * MODULE)
        for up, half in ((-1.3, 0.609), (0.0, 0.369), (0.9, 0.173))
        for side in (-1, 1)
    ]
    pieces = [(carom.Cylinder(pitch - 1.1 * MODULE, 0.01), (0, 0, 0))]
    pieces += [
        teeth.prism(teeth.turned(outline, 2.0 * np.pi * k / count + turned)) for k in range(count)
    ]
    return carom.Compound(pieces, masses=[1] + [1e-9] * count)


def pair(speed):
    """Return a gear that is driven, and one that friction in its hinge loads."""
    scene, far = carom.Scene(gravity=(0, 0, 0)), 0.5 * (FIRST + SECOND) * MODULE
    one = scene.add_body(
        gear(FIRST, 0), mass=0.1, inertia=(2e-5, 2e-5, 3e-5), angular_velocity=(0, 0, speed)
    )
    two = scene.add_body(
        gear(SECOND, np.pi + np.pi / SECOND), mass=0.2, inertia=(6e-5, 6e-5, 1e-4), position=(far, 0, 0)
    )  # fmt: skip
    drive = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, one)
    driven = scene.add_joint(joints.Revolute((far, 0, 0), (0, 0, 1)), GROUND, two, name="driven")
    scene.add_constraint(constraints.Driver(drive, rate=speed))
    scene.add_force(forces.JointFriction(driven, 0.01))
    scene.add_contact(one, two, restitution=0.2, friction=0.1)
    return scene


@pytest.mark.filterwarnings(
    "ignore:A contact problem:carom.AccuracyWarning"
)  # one of 1e-3 m/s at 1 rad/s
@pytest.mark.parametrize("speed", [8.0, 4.0, 1.0])
def test_no_tooth_is_skipped(speed):
    # four teeth: each touches at its flank, at the flank beyond its edge, and at its tip
    s = carom.simulate(pair(speed), 2.0 / speed)
    turned = s.joint_coordinates("driven")[0][:, 0]
    off = np.abs(turned + FIRST / SECOND * speed * s.t) / (2.0 * np.pi / SECOND)
    assert np.max(off) < PLAY
    assert s.stats["trial_steps"] < 5000  # 500 to 1700; 10 times that with planes at rest


@pytest.mark.parametrize(
    ("seed", "tolerances"),
    [(5, True), (8, True), (13, True), (38, True), (15, True), (45, False), (50, False)],
)
def test_cases_of_the_campaign(seed, tolerances):
    """A ratchet, a cam, gears that touch at flanks of several faces, with their edges between; three faults.

    15: friction of a Geneva drive that a stage leaves 3e-9 within its cone slips all the same. 45: a pin as
    thick as its slot leaves it sideways. 50: a time-stepping step does not turn a gear to free a point whose
    normal meets the axis: it went on by five teeth. (A given step of .8 ms leaves energy unnamed there.)
    """
    case = teeth.case(seed)
    outcome = vars(run(case, tolerances))
    assert set(wrong(outcome)) <= (set() if tolerances else {"unnamed energy, said"})
