"""Definitions of joints, and the joints of a scene."""

import math

import numpy as np
import pytest

from carom.scene import GROUND, Scene, Sphere, joints

NAN = (0.0, math.nan, 0.0)
ZERO, UP = (0, 0, 0), (0, 0, 1)


def pair():
    scene = Scene()
    return scene, *(scene.add_body(Sphere(1), mass=1, name=name) for name in "ab")


def test_definitions_normalise_and_freeze():
    hinge = joints.Revolute(anchor=(1, 2, 3), axis=(0, 3, 4))
    np.testing.assert_array_equal(hinge.anchor, [1, 2, 3])
    np.testing.assert_allclose(hinge.axis, [0, 0.6, 0.8], rtol=1e-15)
    with pytest.raises(ValueError, match="read-only"):
        hinge.axis[0] = 1
    np.testing.assert_array_equal(joints.Prismatic((2, 0, 0)).axis, [1, 0, 0])
    assert joints.Prismatic((2, 0, 0)).anchor is None
    assert joints.Fixed().anchor is None
    np.testing.assert_array_equal(joints.Fixed((1, 2, 3)).anchor, [1, 2, 3])
    np.testing.assert_array_equal(joints.Spherical((1, 2, 3)).anchor, [1, 2, 3])


def test_axes_of_a_universal_joint_are_made_perpendicular():
    cross = joints.Universal((0, 0, 0), (2, 0, 0), (4e-10, 3, 0))
    assert cross.axis_parent @ cross.axis_child == 0.0
    np.testing.assert_allclose(cross.axis_child, [0, 1, 0], rtol=0, atol=1e-9)


def test_distance_has_the_length_at_the_start():
    assert joints.Distance((1, 0, 0), (1, 3, 4)).length == 5.0


def test_knife_edge_has_a_lateral_direction():
    edge = joints.KnifeEdge(anchor=(0, 0, 0), direction=(2, 0, 1))
    np.testing.assert_array_equal(edge.normal, [0, 0, 1])
    np.testing.assert_allclose(edge.lateral, [0, 1, 0], atol=1e-16)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: joints.Revolute(NAN, UP), "anchor must be finite, got (0.0, nan, 0.0)"),
        (lambda: joints.Revolute((0, 0), UP), "anchor must have shape (3,), got shape (2,)"),
        (lambda: joints.Revolute(ZERO, ZERO), "axis must not be the zero vector, got (0, 0, 0)"),
        (lambda: joints.Revolute(ZERO, NAN), "axis must be finite, got (0.0, nan, 0.0)"),
        (lambda: joints.Spherical("here"), "anchor must be numbers of shape (3,), got 'here'"),
        (lambda: joints.Fixed((1, 2)), "anchor must have shape (3,), got shape (2,)"),
        (lambda: joints.Prismatic(ZERO), "axis must not be the zero vector, got (0, 0, 0)"),
        (lambda: joints.Prismatic(UP, NAN), "anchor must be finite"),
        (
            lambda: joints.Distance((1, 2, 3), (1, 2, 3)),
            "must differ from anchor_parent, got (1, 2, 3)",
        ),
        (lambda: joints.Distance((1, 2, 3), NAN), "anchor_child must be finite"),
        (lambda: joints.Distance(NAN, (1, 2, 3)), "anchor_parent must be finite"),
        (lambda: joints.KnifeEdge(ZERO, ZERO), "direction must not be the zero vector"),
        (lambda: joints.KnifeEdge(ZERO, (0, 0, 5)), "not be parallel to normal, got (0, 0, 1)"),
        (lambda: joints.KnifeEdge(ZERO, (1, 0, 0), ZERO), "normal must not be the zero vector"),
        (lambda: joints.KnifeEdge(NAN, (1, 0, 0)), "anchor must be finite"),
        (lambda: joints.Cylindrical(ZERO, ZERO), "axis must not be the zero vector, got (0, 0, 0)"),
        (lambda: joints.Cylindrical(NAN, UP), "anchor must be finite"),
        (lambda: joints.Screw(ZERO, ZERO, 1.0), "axis must not be the zero vector"),
        (lambda: joints.Screw(ZERO, UP, 0), "pitch must not be 0, got 0.0; for no slide use Revol"),
        (lambda: joints.Screw(ZERO, UP, math.inf), "pitch must be finite [m], got inf"),
        (
            lambda: joints.Universal(ZERO, UP, (0, 0, 5)),
            "axis_child must be perpendicular to axis_parent, got (0, 0, 1) and (0, 0, 1), with an "
            "angle of 0 degrees",
        ),
        (lambda: joints.Universal(ZERO, UP, (1, 0, 1)), "with an angle of 45 degrees"),
        (lambda: joints.Universal(ZERO, ZERO, UP), "axis_parent must not be the zero vector"),
        (lambda: joints.Universal(ZERO, UP, ZERO), "axis_child must not be the zero vector"),
        (lambda: joints.Planar(ZERO), "normal must not be the zero vector, got (0, 0, 0)"),
        (lambda: joints.Planar(UP, NAN), "anchor must be finite"),
        (lambda: joints.PointOnLine(ZERO, ZERO), "direction must not be the zero vector"),
        (lambda: joints.PointOnLine(NAN, UP), "anchor must be finite"),
        (lambda: joints.PointOnPlane(ZERO, ZERO), "normal must not be the zero vector"),
        (lambda: joints.PointOnPlane(NAN, UP), "anchor must be finite"),
    ],
)
def test_bad_definitions_are_refused(make, message):
    with pytest.raises(ValueError, match="must") as error:
        make()
    assert message in str(error.value)


def test_joint_of_two_bodies_and_of_the_ground():
    scene, a, b = pair()
    hinge = joints.Revolute((0, 0, 0), (0, 0, 1))
    first = scene.add_joint(hinge, GROUND, a)
    second = scene.add_joint(joints.Spherical((1, 0, 0)), a, b, name="elbow")
    assert (first.index, first.name, first.kind) == (0, "joint1", "Revolute")
    assert (first.definition, first.parent, first.child) == (hinge, GROUND, a)
    assert (second.index, second.name, second.kind) == (1, "elbow", "Spherical")
    assert repr(second) == "Joint('elbow', Spherical, 'a' -> 'b')"
    assert scene.joints == (first, second)


def test_bad_partners_are_refused():
    scene, a, b = pair()
    plane = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    ball = joints.Spherical((0, 0, 0))
    with pytest.raises(
        TypeError, match=r"parent must be a Body or Ground, .*'floor'.*carom.GROUND"
    ):
        scene.add_joint(ball, plane, a)
    with pytest.raises(TypeError, match=r"child must be a Body, got carom.GROUND"):
        scene.add_joint(ball, a, GROUND)
    with pytest.raises(ValueError, match=r"parent and child must be two bodies, got Body\('a'"):
        scene.add_joint(ball, a, a)
    with pytest.raises(ValueError, match="child must belong to this scene"):
        scene.add_joint(ball, a, pair()[1])
    with pytest.raises(ValueError, match=r"KnifeEdge must be carom.GROUND, got Body\('a'"):
        scene.add_joint(joints.KnifeEdge((0, 0, 0), (1, 0, 0)), a, b)
    with pytest.raises(
        TypeError, match=r"definition must be a Spherical or Revolute or .*, got <class"
    ):
        scene.add_joint(joints.Revolute, GROUND, a)
    assert scene.joints == ()
