"""A box that lands on an arm which friction in its joint holds: it counts when the box comes to rest."""

from __future__ import annotations

import pytest

import carom


def landing(box_first: bool) -> carom.Solution:
    """Return a run of a box that falls by 2 cm on the end of an arm, which only friction holds."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.set_contact_default(restitution=0.3, friction=0.5)
    parts = {
        "box": (carom.Box(0.1, 0.1, 0.1), (0.9, 0, 0.095)),
        "arm": (carom.Box(1, 0.2, 0.05), (0.5, 0, 0)),
    }
    bodies = {}
    for name in sorted(parts, reverse=box_first):
        shape, place = parts[name]
        bodies[name] = scene.add_body(shape, mass=1, position=place)
    turn = carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
    hinge = scene.add_joint(turn, carom.GROUND, bodies["arm"])
    scene.add_force(carom.forces.JointFriction(hinge, 50.0))
    return carom.simulate(scene, 0.3)


@pytest.mark.parametrize("box_first", [True, False])
def test_a_box_comes_to_rest_on_an_arm_held_by_friction(box_first):
    # without its friction the end of the arm would fall faster than the box, which could not come to rest on it
    solution = landing(box_first)
    assert solution.stats["whole_steps"] == 0
    assert abs(solution.velocity[-1]).max() == pytest.approx(0.0, abs=1e-12)
