"""Names, lookup, copies and words of a scene; a light import."""

import math
import pickle
import subprocess
import sys

import numpy as np
import pytest

from carom.scene import GROUND, Box, Scene, Sphere, forces, joints


def example():
    scene = Scene(gravity=(0, 0, -9.81))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    die = scene.add_body(Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3), name="die")
    scene.add_contact(die, ground, restitution=0.5, friction=0.2)
    scene.add_joint(joints.Spherical((0, 0, 0.5)), GROUND, die)
    scene.add_force(forces.Torque((0, 0, 1)), die)
    return scene


def test_parts_are_tuples_in_order():
    scene = example()
    for kind in ("bodies", "half_spaces", "contacts", "joints", "forces"):
        parts = getattr(scene, kind)
        assert isinstance(parts, tuple)
        assert [part.index for part in parts] == [0]
    np.testing.assert_array_equal(scene.gravity, [0, 0, -9.81])
    with pytest.raises(ValueError, match="read-only"):
        scene.gravity[2] = 0


def test_lookup_by_name():
    scene = example()
    names = ("die", "ground", "die-ground", "joint1", "force1")
    assert [scene[name].name for name in names] == list(names)
    with pytest.raises(KeyError, match="no part called 'dei'; did you mean 'die'"):
        scene["dei"]
    with pytest.raises(KeyError, match="no part called 3; it has 5 named parts"):
        scene[3]


def test_default_names_count_and_step_aside():
    scene = Scene()
    named = [scene.add_body(Sphere(1), mass=1, name=name).name for name in (None, "body3", None)]
    assert named == ["body1", "body3", "body4"]
    plane = scene.add_half_space((0, 0, -5), (0, 0, 1))
    assert plane.name == "half_space1"
    assert scene.add_contact(scene["body1"], plane).name == "body1-half_space1"


def test_names_are_unique_among_all_parts():
    scene = example()
    with pytest.raises(ValueError, match="name must be unique in the scene, got 'die'"):
        scene.add_half_space((0, 0, -1), (0, 0, 1), name="die")
    with pytest.raises(ValueError, match="got 'ground'"):
        scene.add_body(Sphere(1), mass=1, name="ground")


@pytest.mark.parametrize(
    ("gravity", "message"),
    [
        ((0, 0, math.nan), "gravity must be finite, got (0, 0, nan)"),
        (-9.81, "gravity must have shape (3,) [m/s^2], got shape ()"),
        ("down", "gravity must be numbers of shape (3,), got 'down'"),
    ],
)
def test_bad_gravity_is_refused(gravity, message):
    with pytest.raises(ValueError, match="gravity") as error:
        Scene(gravity)
    assert message in str(error.value)


def test_words():
    scene = example()
    assert repr(scene) == "<Scene: 1 body, 1 half-space, 1 contact, 1 joint, 1 force>"
    assert repr(Scene()) == "<Scene: 0 bodies, 0 half-spaces, 0 contacts, 0 joints, 0 forces>"
    lines = str(scene).splitlines()
    assert lines[0] == "Scene with gravity [ 0.    0.   -9.81] m/s^2"
    assert "  Body('die', Box(lx=0.02, ly=0.02, lz=0.02), mass=0.016)" in lines
    assert "  Contact('die-ground', restitution=0.5, friction=0.2, impact_law='newton')" in lines


def test_pickled_scene_is_a_scene():
    scene = pickle.loads(pickle.dumps(example()))
    assert scene.contacts[0].body is scene["die"]
    assert scene.joints[0].parent is GROUND
    scene.validate()
    with pytest.raises(ValueError, match="given once"):
        scene.add_contact(scene["die"], scene["ground"], name="again")


def test_import_is_light():
    code = (
        "import sys, carom.scene as s; s.Scene().add_body(s.Box(1, 1, 1), mass=1); "
        "print([m for m in ('numba', 'scipy', 'matplotlib') if m in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
