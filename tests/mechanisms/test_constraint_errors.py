"""Errors of joints and constraints: a row each, with its unit, whole turns aside."""

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, joints


def wheel(scene, x, name, rate=0.0):
    body = scene.add_body(
        mass=1.0,
        inertia=(0.1, 0.1, 0.1),
        position=(x, 0, 0),
        angular_velocity=(0, 0, rate),
        name=name,
    )
    return scene.add_joint(
        joints.Revolute((x, 0, 0), (0, 0, 1)), GROUND, body, name=f"hinge of {name}"
    )


def driven(rate=40.0):
    """A wheel that a motor turns, and one that a gear of ratio -3/2 makes turn with it."""
    scene = carom.Scene(gravity=(0, 0, 0))
    first, second = wheel(scene, 0, "a", rate), wheel(scene, 1, "b", -1.5 * rate)
    scene.add_constraint(constraints.Driver(first, rate=rate), name="motor")
    scene.add_constraint(constraints.Gear(first, second, ratio=-1.5), name="gear")
    return scene


@pytest.fixture(scope="module")
def turned():
    return carom.simulate(driven(), 2.0, step=5e-3)  # 12 turns of the motor, 19 of the gear


def test_rows_have_names_and_units(turned):
    rows = turned.constraint_rows
    hinges = [f"hinge of {wheel}[{k}]" for wheel in "ab" for k in range(5)]
    assert rows.name.tolist() == [*hinges, "motor", "gear"]
    assert rows.unit.tolist() == [*(["m"] * 3 + ["rad"] * 2) * 2, "rad", "rad"]


def test_whole_turns_are_no_error(turned):
    position, velocity = turned.constraint_errors
    assert position.shape == velocity.shape == (len(turned.t), 12)
    assert np.max(position) < 1e-12
    assert np.max(velocity) < 1e-12


def test_a_motor_may_be_saved_seldom():
    # less often than its turns: 40 rad between two saved states
    seldom = carom.simulate(driven(), 2.0, step=5e-3, save_at=1.0)
    assert np.max(seldom.constraint_errors[0]) < 1e-12


def test_asking_does_not_change_the_run(turned):
    references = turned._run.compiled.system.relations.memory.coordinates.reference.copy()
    again = carom.Solution._from_run(turned._run, turned.status)
    assert np.array_equal(again.constraint_errors, turned.constraint_errors)
    assert np.array_equal(
        turned._run.compiled.system.relations.memory.coordinates.reference, references
    )
    assert references[0] == pytest.approx(80.0)  # all turns are counted


def test_reactions_know_whole_turns():
    """A wound spring pulls at its motor: T = k q after many turns."""
    scene = carom.Scene(gravity=(0, 0, 0))
    hinge = wheel(scene, 0, "a", 10.0)
    scene.add_force(carom.forces.JointSpring(hinge, stiffness=0.3))
    scene.add_constraint(constraints.Driver(hinge, rate=10.0))
    wound = carom.simulate(scene, 3.0, step=1e-2)
    assert wound.constraint_forces[:, 0] == pytest.approx(0.3 * 10.0 * wound.t, abs=1e-10)


@pytest.mark.parametrize(
    ("definition", "units"),
    [
        (joints.Screw((0, 0, 0), (0, 0, 1), 0.1), ["m"] * 3 + ["rad"] * 2),
        (joints.Prismatic((0, 0, 1)), ["m"] * 2 + ["rad"] * 3),
        (joints.Universal((0, 0, 0), (1, 0, 0), (0, 1, 0)), ["m"] * 3 + ["rad"]),
        (joints.Planar((0, 0, 1)), ["m"] + ["rad"] * 2),
        (joints.RollingSphere(1.0), ["m"] * 3),
    ],
    ids=lambda given: type(given).__name__,
)
def test_units_of_joints(definition, units):
    from carom.results.names import row_units

    assert row_units(definition) == units


def test_units_of_constraints():
    scene = carom.Scene()
    turn = wheel(scene, 0, "a")
    body = scene.add_body(mass=1.0, inertia=(1, 1, 1), name="rack")
    slide = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body)
    scene.add_constraint(constraints.Gear(turn, slide, ratio=0.1), name="rack and pinion")
    scene.add_constraint(constraints.Coupling({turn: 1.0, slide: 2.0}), name="any")
    scene.add_constraint(constraints.Driver(slide, rate=0.0), name="piston")
    from carom.results.names import constraint_rows

    assert constraint_rows(scene).unit.tolist()[-3:] == ["m", "", "m"]
