"""Definitions of forces, and the forces of a scene."""

import math

import numpy as np
import pytest

from carom.scene import GROUND, Scene, Sphere, forces

NAN = (0.0, math.nan, 0.0)
ZERO, ONE = (0, 0, 0), (0, 3, 4)


def pair():
    scene = Scene()
    return scene, *(scene.add_body(Sphere(1), mass=1, name=name) for name in "ab")


def test_spring_rests_at_the_start_unless_told():
    spring = forces.Spring(10, ZERO, ONE)
    assert (spring.stiffness, spring.rest_length, spring.damping) == (10.0, 5.0, 0.0)
    spring = forces.Spring(10, ZERO, ONE, rest_length=0, damping=2)
    assert (spring.rest_length, spring.damping) == (0.0, 2.0)
    np.testing.assert_array_equal(spring.anchor_child, ONE)


def test_force_and_torque():
    np.testing.assert_array_equal(forces.Torque((1, 2, 3)).vector, [1, 2, 3])
    assert forces.Force((1, 2, 3)).anchor is None
    np.testing.assert_array_equal(forces.Force((1, 2, 3), (4, 5, 6)).anchor, [4, 5, 6])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: forces.Spring(-1, ZERO, ONE),
            "stiffness must be finite and at least 0 [N/m], got -1",
        ),
        (
            lambda: forces.Spring(math.nan, ZERO, ONE),
            "stiffness must be finite and at least 0 [N/m], got nan",
        ),
        (
            lambda: forces.Spring(1, ZERO, ONE, -2),
            "rest_length must be finite and at least 0 [m], got -2",
        ),
        (
            lambda: forces.Spring(1, ZERO, ONE, damping=-3),
            "damping must be finite and at least 0 [N s/m], got -3",
        ),
        (
            lambda: forces.Spring(1, ONE, ONE),
            "anchor_child must differ from anchor_parent, got (0, 3, 4)",
        ),
        (lambda: forces.Spring(1, NAN, ONE), "anchor_parent must be finite, got (0.0, nan, 0.0)"),
        (
            lambda: forces.Spring(1, ZERO, (1, 2)),
            "anchor_child must have shape (3,), got shape (2,)",
        ),
        (lambda: forces.Torque(NAN), "vector must be finite, got (0.0, nan, 0.0)"),
        (lambda: forces.Torque(5), "vector must have shape (3,) [N m], got shape ()"),
        (lambda: forces.Force((0, math.inf, 0)), "vector must be finite, got (0, inf, 0)"),
        (lambda: forces.Force((0, 0, 1), NAN), "anchor must be finite, got (0.0, nan, 0.0)"),
    ],
)
def test_bad_definitions_are_refused(make, message):
    with pytest.raises(ValueError, match="must") as error:
        make()
    assert message in str(error.value)


def test_one_body_alone_is_the_child():
    scene, a, b = pair()
    torque = forces.Torque((0, 0, 1))
    alone = scene.add_force(torque, a)
    keyword = scene.add_force(torque, child=a)
    stated = scene.add_force(torque, GROUND, a, name="motor")
    between = scene.add_force(torque, a, b)
    for force in (alone, keyword, stated):
        assert (force.parent, force.child, force.kind) == (GROUND, a, "Torque")
    assert (between.parent, between.child, between.definition) == (a, b, torque)
    assert [force.name for force in scene.forces] == ["force1", "force2", "motor", "force4"]
    assert [force.index for force in scene.forces] == [0, 1, 2, 3]
    assert repr(between) == "AppliedForce('force4', Torque, 'a' -> 'b')"


def test_bad_partners_are_refused():
    scene, a, b = pair()
    with pytest.raises(ValueError, match=r"parent of a Force must be carom.GROUND, got Body\('a'"):
        scene.add_force(forces.Force((0, 0, 1)), a, b)
    with pytest.raises(ValueError, match="two bodies"):
        scene.add_force(forces.Torque((0, 0, 1)), a, a)
    with pytest.raises(TypeError, match="child must be given"):
        scene.add_force(forces.Torque((0, 0, 1)), GROUND)
    with pytest.raises(
        TypeError,
        match=r"definition must be a Spring or Torque or Force or Bushing or .*, got 'push'",
    ):
        scene.add_force("push", a)
    with pytest.raises(ValueError, match="parent must belong to this scene"):
        scene.add_force(forces.Torque((0, 0, 1)), pair()[1], a)
    assert scene.forces == ()
