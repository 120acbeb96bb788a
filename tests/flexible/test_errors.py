"""Messages about scenes with flexible bodies: what is refused, with the argument and what to do."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom import flexible, forces, joints

BOX, SECTION = carom.Box(1.0, 0.02, 0.03), flexible.Rectangle(0.02, 0.03)
FREE = flexible.beam(1.0, SECTION, 7800.0, 210e9, modes=4)
HELD = flexible.beam(1.0, SECTION, 7800.0, 210e9, modes=4, ends="clamped")
CURVE = carom.Profile([(0.1, 0.0), (0.0, 0.1), (-0.1, 0.0), (0.0, -0.1)], thickness=0.02)


@pytest.fixture
def scene():
    made = carom.Scene(gravity=(0, 0, -9.81))
    made.add_body(BOX, modes=FREE, position=(0, 0, 1), name="bar")
    made.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 2, 0), name="rigid")
    made.add_static(BOX, modes=HELD, position=(0, 0, 3), name="beam")
    return made


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"mass": 1.0}, "mass must be left out with modes, which have their own, got 1.0"),
        ({"density": 1.0}, "density must be left out with modes, which have their own, got 1.0"),
        ({"inertia": (1, 1, 1)}, r"inertia must be left out with modes, .* got \(1, 1, 1\)"),
        ({"replace": True}, "replace must be left out with modes, got True; remove the body and"),
        ({"modes": HELD}, r"modes must be those of a free body, got <Modes: 4 of a supported .*add_static"),
        ({"shape": None}, "shape must be given with modes, got None"),
        ({"shape": CURVE}, "shape must be another one than a Profile with modes, got .*; give a Box"),
    ],
)  # fmt: skip
def test_add_body(given, message):
    scene = carom.Scene()
    with pytest.raises(ValueError, match=message):
        scene.add_body(**{"shape": BOX, "modes": FREE} | given)
    assert not scene.bodies


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"surface_velocity": (1, 0, 0)}, "surface_velocity must be left out with modes, got"),
        ({"surface_spin": ((0, 0, 1), 1.0)}, "surface_spin must be left out with modes, got"),
        ({"replace": True}, "replace must be left out with modes, got True"),
        ({"modes": FREE}, "modes must be those of a body on supports, got <Modes: 4 of a free .*add_body"),
        ({"shape": None}, "shape must be given with modes, got None"),
        ({"shape": CURVE}, "shape must be another one than a Profile with modes, got .*; give a Box"),
    ],
)  # fmt: skip
def test_add_static(given, message):
    scene = carom.Scene()
    with pytest.raises(ValueError, match=message):
        scene.add_static(**{"shape": BOX, "modes": HELD} | given)
    assert not scene.bodies
    assert not scene.statics


@pytest.mark.parametrize("add", ["add_body", "add_static"])
def test_modes_are_modes(add):
    with pytest.raises(TypeError, match="modes must be a Modes, got 3"):
        getattr(carom.Scene(), add)(BOX, modes=3)


def test_a_taken_name_leaves_nothing_behind(scene):
    names = [body.name for body in scene.bodies]
    with pytest.raises(ValueError, match="name must be unique in the scene, got 'bar'"):
        scene.add_body(BOX, modes=FREE, name="bar")
    with pytest.raises(ValueError, match="name must be unique in the scene, got 'beam'"):
        scene.add_static(BOX, modes=HELD, name="beam")
    assert [body.name for body in scene.bodies] == names


def test_inertia_is_given_for_modes_without():
    plain = carom.Modes([440.0], mass=0.05, shapes=lambda points: np.zeros((len(points), 3, 1)))
    scene = carom.Scene()
    np.testing.assert_array_equal(scene.add_body(BOX, modes=plain).inertia, BOX.inertia(0.05))
    given = scene.add_body(BOX, modes=plain, inertia=(1e-3, 2e-3, 2.5e-3))
    np.testing.assert_array_equal(np.diag(given.inertia), (1e-3, 2e-3, 2.5e-3))


@pytest.mark.parametrize("end", ["bar", "beam"])
def test_joints_and_forces(scene, end):
    parts, body = list(scene.forces) + list(scene.joints), scene[end]
    calls = {
        "child": [
            lambda: scene.add_joint(joints.Spherical((0, 0, 0)), "rigid", end),
            lambda: scene.add_joint(joints.Fixed(), carom.GROUND, body),
            lambda: scene.add_joint(joints.Tether(1.0), "rigid", end),
            lambda: scene.add_force(forces.Force((0, 0, 1)), body),
            lambda: scene.add_force(forces.Torque((0, 0, 1)), body),
            lambda: scene.add_force(forces.Drag(0.1), body),
        ],
        "parent": [
            lambda: scene.add_joint(joints.Spherical((0, 0, 0)), end, "rigid"),
            lambda: scene.add_force(
                forces.Spring(1.0, anchor_parent=(0, 0, 0), anchor_child=(0, 0, 1)), body, "rigid"
            ),
        ],
    }
    for argument, them in calls.items():
        for call in them:
            with pytest.raises(
                ValueError, match=rf"{argument} must be a rigid body, got Body\('{end}'.*with modes"
            ):
                call()
    assert list(scene.forces) + list(scene.joints) == parts


def test_a_contact_of_what_stands_for_modes(scene):
    with pytest.raises(
        ValueError, match="must have a shape for contact, got Body\\('bar modes 1-3'"
    ):
        scene.add_contact("bar modes 1-3", "rigid")


def test_bodies_that_stand_for_modes_stay(scene):
    with pytest.raises(
        ValueError, match="dependents must be True to remove 'bar modes 1-3' together with"
    ):
        scene.remove("bar modes 1-3")
    scene.remove("bar modes 1-3", dependents=True)
    with pytest.raises(
        ValueError, match="'bar' has lost bodies that stand for its modes; remove the whole body"
    ):
        carom.simulate(scene, duration=0.001)


@pytest.mark.parametrize(("name", "mass"), [("bar", 4.68), ("bar modes 4", 9.0)])
def test_masses_stay_equal(scene, name, mass):
    scene.replace(name, mass=2.0 * mass)
    with pytest.raises(
        ValueError, match=r"the mass of 'bar modes .*' must be that of 'bar', .* kg, got"
    ):
        carom.simulate(scene, duration=0.001)


def test_results_of_rigid_bodies(scene):
    solution = carom.simulate(scene, duration=0.001)
    for ask in (
        lambda: solution["rigid"].modal,
        lambda: solution["rigid"].modal_rates,
        lambda: solution["rigid"].displacement((0, 0, 0)),
    ):
        with pytest.raises(ValueError, match="'rigid' must have modes, got a rigid body"):
            ask()
    with pytest.raises(ValueError, match=r"points must have shape \(3,\) \[m\], got shape \(2,\)"):
        solution["bar"].displacement((0, 0))
