"""Joints placed by frames in their bodies: the same joint as one placed in the world."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints
from carom.geometry import quaternion

AXIS, ACROSS = np.array([0.0, 0.6, 0.8]), np.array([1.0, 0.0, 0.0])
ANCHOR = np.array([0.4, -0.1, 0.2])
KINDS = {
    "Revolute": lambda a, e, f: joints.Revolute(a, e),
    "Prismatic": lambda a, e, f: joints.Prismatic(e, a),
    "Cylindrical": lambda a, e, f: joints.Cylindrical(a, e),
    "Universal": lambda a, e, f: joints.Universal(a, e, f),
}


def pair(kind, framed, spring=False):
    """Two bodies that are turned and away from each other, joined in the world or by frames."""
    turns = [quaternion.exp(np.array(a)) for a in ([0.3, -0.2, 0.5], [-0.4, 0.1, 0.2])]
    places = np.array([[0.0, 0.0, 0.0], [0.9, -0.3, 0.5]])
    scene = carom.Scene()
    one, two = (
        scene.add_body(mass=m, inertia=J, position=x, orientation=q)
        for m, J, x, q in zip((2.0, 1.0), ((0.3, 0.4, 0.5), (0.1, 0.15, 0.2)), places, turns)
    )
    scene.add_joint(joints.Spherical((0, 0, 0.3)), GROUND, one)
    if framed:
        # a frame at the anchor, turned in the world by F: the definition is in its axes
        F = quaternion.exp(np.array([0.2, 0.7, -0.3]))
        definition = KINDS[kind](
            np.zeros(3), quaternion.rotate_back(F, AXIS), quaternion.rotate_back(F, ACROSS)
        )
        frames = [
            (quaternion.rotate_back(q, ANCHOR - x), quaternion.multiply(quaternion.conjugate(q), F))
            for x, q in zip(places, turns)
        ]
        joint = scene.add_joint(
            definition, one, two, parent_frame=frames[0], child_frame=frames[1], name="joint"
        )
    else:
        joint = scene.add_joint(KINDS[kind](ANCHOR, AXIS, ACROSS), one, two, name="joint")
    if spring:
        scene.add_force(forces.JointSpring(joint, stiffness=3.0, damping=0.2, rest=0.1))
        scene.add_stop(joint, upper=0.15, restitution=0.5)
    return scene


@pytest.mark.parametrize("kind", KINDS)
def test_frames_and_the_world_say_the_same(kind):
    world, framed = (carom.simulate(pair(kind, f), 0.3, step=0.01) for f in (False, True))
    np.testing.assert_allclose(framed.position, world.position, atol=1e-10)
    np.testing.assert_allclose(framed.orientation, world.orientation, atol=1e-10)
    for one, two in zip(framed.joint_coordinates("joint"), world.joint_coordinates("joint")):
        assert np.all(np.abs(one[0]) < 1e-12)
        np.testing.assert_allclose(one, two, atol=1e-9)
    assert np.max(np.abs(world.joint_coordinates("joint")[0])) > 0.05


def test_springs_and_stops_know_frames():
    world, framed = (
        carom.simulate(pair("Revolute", f, spring=True), 0.5, step=0.01) for f in (False, True)
    )
    assert len(world.impacts) > 0
    np.testing.assert_allclose(framed.impacts.time, world.impacts.time, atol=1e-10)
    np.testing.assert_allclose(framed.position, world.position, atol=1e-9)
    np.testing.assert_allclose(framed.potential_energy, world.potential_energy, atol=1e-9)


def arm():
    """A link on a pedestal, its frames agreeing nowhere at the start."""
    scene = carom.Scene()
    link = scene.add_body(
        mass=1.0, inertia=(0.01, 0.05, 0.05), position=(0.3, 0.1, 0.2), name="link"
    )
    turned = quaternion.exp(np.array([0.0, 0.0, 0.5]))
    scene.add_joint(
        joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, link, name="hinge",
        parent_frame=((0, 0, 0.5), turned), child_frame=((-0.25, 0, 0), (1, 0, 0, 0)),
    )  # fmt: skip
    return scene


def test_a_start_that_does_not_fit_is_refused_or_brought_there():
    with pytest.raises(
        ValueError, match=r"position violates 'hinge' \(Revolute\): its error must be 0"
    ):
        carom.simulate(arm(), 0.1, step=0.01)
    solution = carom.simulate(arm(), 0.1, step=0.01, options=carom.Options(project_start=True))
    x, Q = solution.position[0, 0], solution.orientation[0, 0]
    # the end of the link is at the anchor, and its y axis is that of the frame in the ground
    np.testing.assert_allclose(
        x + quaternion.rotate(Q, np.array([-0.25, 0, 0])), [0, 0, 0.5], atol=1e-13
    )
    turned = quaternion.exp(np.array([0.0, 0.0, 0.5]))
    y = np.array([0.0, 1.0, 0.0])
    np.testing.assert_allclose(quaternion.rotate(Q, y), quaternion.rotate(turned, y), atol=1e-13)
    assert max(e.max() for e in solution.constraint_errors) < 1e-12


def test_bad_frames_are_refused():
    scene = carom.Scene()
    body = scene.add_body(mass=1.0, inertia=(1, 1, 1))
    hinge = joints.Revolute((0, 0, 0), (0, 1, 0))
    good = ((0, 0, 0), (1, 0, 0, 0))
    with pytest.raises(ValueError, match="must be given together"):
        scene.add_joint(hinge, GROUND, body, parent_frame=good)
    with pytest.raises(ValueError, match="child_frame must be a pair"):
        scene.add_joint(hinge, GROUND, body, parent_frame=good, child_frame=(1, 2, 3))
    with pytest.raises(ValueError, match="child_frame orientation"):
        scene.add_joint(
            hinge, GROUND, body, parent_frame=good, child_frame=((0, 0, 0), (1, 1, 0, 0))
        )
    with pytest.raises(ValueError, match="placed in the world"):
        scene.add_joint(
            joints.RollingSphere(0.1), GROUND, body, parent_frame=good, child_frame=good
        )
