"""Coordinates of joints: closed forms, whole turns, signs, and rates that are their derivatives."""

import numpy as np
import pytest
from mechanism_scenes import G, about, matrix, pendulum
from random_forests import KINDS, MORE, build, plan

import carom
from carom import GROUND, Scene, joints

WIDTH = dict(
    Revolute=1, Spherical=3, Fixed=0, Prismatic=1, Distance=1, KnifeEdge=0, Cylindrical=2,
    Universal=2, Planar=3, PointOnLine=1, PointOnPlane=2, Screw=2,
)  # fmt: skip


def test_rates_are_derivatives():
    """All kinds between moving bodies, both ways round: central differences of order 4."""
    rng = np.random.default_rng(5)
    rows = plan(rng, len(KINDS + MORE), floating=0.0, kinds=KINDS + MORE, each=True)
    for flips in ((), set(range(len(rows)))):
        scene, h = build(rows, flips=flips), 5e-4
        s = carom.simulate(scene, 20 * h, step=h)
        for joint in scene.joints:
            q, rate = s.joint_coordinates(joint)
            assert q.shape == rate.shape == (21, WIDTH[joint.kind])
            np.testing.assert_allclose(q[0], 0.0, rtol=0, atol=1e-14)
            if joint.kind == "Spherical":  # its rates are an angular velocity
                _against_rotations(s, joint)
                continue
            slope = (q[:-4] - 8.0 * q[1:-3] + 8.0 * q[3:-1] - q[4:]) / (12.0 * h)
            # h^4/30 of the fifth derivative: spins and their rates of some 10 rad/s
            np.testing.assert_allclose(slope, rate[2:-2], rtol=0, atol=1e-7)


def _against_rotations(s, joint):
    """Rotation vector against the matrices of both bodies, in world axes of the start."""
    q, rate = s.joint_coordinates(joint)
    child, parent = (
        [matrix(p) @ matrix(b.orientation).T for p in s.orientation[:, b.index]]
        if b.index >= 0
        else [np.eye(3)] * len(s.t)
        for b in (joint.child, joint.parent)
    )
    for k in range(len(s.t)):
        angle = np.linalg.norm(q[k])
        turn = matrix(about(q[k] / angle, angle)) if angle > 0.0 else np.eye(3)
        np.testing.assert_allclose(parent[k] @ turn, child[k], rtol=0, atol=1e-13)
        up = 0.0 if joint.parent.index < 0 else s.angular_velocity[k, joint.parent.index]
        spin = s.angular_velocity[k, joint.child.index] - up
        np.testing.assert_allclose(parent[k] @ rate[k], spin, rtol=0, atol=1e-13)


def test_exchanged_bodies_change_the_sign():
    """Turns and slides of joints whose directions are those of both bodies."""
    rng = np.random.default_rng(6)
    kinds = ("Fixed", "Revolute", "Prismatic", "Cylindrical", "Screw")
    rows = plan(rng, len(kinds), floating=0.0, kinds=kinds, each=True)
    for row in rows[1:]:
        row["parent"] = max(row["parent"], 0)  # to a body: all can be exchanged
        row["velocity"], row["angular_velocity"] = np.zeros((2, 3))
    rows[0]["velocity"], rows[0]["angular_velocity"] = np.zeros((2, 3))
    one, other = (carom.simulate(build(rows, flips=f), 0.2, step=1e-3) for f in ((), {1, 2, 3, 4}))
    for joint in one.scene.joints[1:]:
        a, b = (s.joint_coordinates(joint.name) for s in (one, other))
        assert np.max(np.abs(a[0])) > 1e-3  # it has moved
        np.testing.assert_allclose(b[0], -a[0], rtol=0, atol=1e-11)
        np.testing.assert_allclose(b[1], -a[1], rtol=0, atol=1e-10)


@pytest.mark.plain
def test_whole_turns_are_counted():
    """A wheel on a hinge, 25 rad/s, looked at every 0.2 s: 5 rad between looks, 100 in all."""
    scene = Scene(gravity=(0, 0, -G))
    wheel = scene.add_body(mass=1.0, inertia=[1, 1, 2], angular_velocity=(0, 0, 25))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, wheel)
    s = carom.simulate(scene, 4.0, step=0.01, save_every=20)
    q, rate = s.joint_coordinates(hinge)
    # turns of w h = 0.25 rad a step: (w h)^4/120 of them
    np.testing.assert_allclose(q[:, 0], 25.0 * s.t, rtol=5e-5)
    np.testing.assert_allclose(rate, 25.0, rtol=1e-12)


def double_pendulum():
    """The lower of two links whirls: both turn round in 1.8 s."""
    scene = Scene(gravity=(0, 0, -G))
    for k, whirl in enumerate((0.0, 15.0)):
        scene.add_body(
            mass=1.0, inertia=(0.02, 0.02, 1e-3), position=(0.2 + 0.4 * k, 0, 0),
            velocity=(0, 0, -0.2 * whirl), angular_velocity=(0, whirl, 0), name=f"link{k}",
        )  # fmt: skip
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "link0", name="upper")
    scene.add_joint(joints.Revolute((0.4, 0, 0), (0, 1, 0)), "link0", "link1", name="lower")
    return scene


def test_turns_are_those_of_the_run_whatever_is_saved(tmp_path):
    """Of what swings freely, of a part of the scene, in files, and of a run that goes on from its file."""
    every = carom.simulate(double_pendulum(), 1.5, rtol=1e-10)
    path, how = tmp_path / "ends.nc", dict(save_at=[1.5], rtol=1e-10)
    ends = carom.simulate(double_pendulum(), 1.5, save=path, **how)
    scene = double_pendulum()
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(9, 0, 0))  # moves in an island of its own
    beside = carom.simulate(scene, 1.5, **how)
    loaded = carom.Solution.load(path)
    on = carom.resume(path, until=1.8)
    long = carom.simulate(double_pendulum(), 1.8, rtol=1e-10)
    for name in ("upper", "lower"):
        q = every.joint_coordinates(name)[0]
        assert np.max(np.abs(np.diff(q[:, 0]))) < np.pi  # steps are short enough to tell
        for one in (ends, loaded, beside):
            np.testing.assert_allclose(one.joint_coordinates(name)[0][-1], q[-1], atol=1e-6)
        q, found = (one.joint_coordinates(name)[0][-1] for one in (on, long))
        np.testing.assert_allclose(q, found, atol=1e-6)
        assert found[0] > 2.0 * np.pi


@pytest.mark.parametrize("rtol", [None, 1e-8])
def test_a_free_wheel_turns_far_between_two_saved_times(rtol):
    """3000 rad in a second, saved once: (w h)^4/120 of 0.3 rad a given step."""
    scene = Scene(gravity=(0, 0, 0))
    scene.add_body(mass=1.0, inertia=(1, 1, 2), angular_velocity=(0, 0, 3000), name="wheel")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, "wheel", name="hinge")
    how = {"step": 1e-4} if rtol is None else {"rtol": rtol}
    q, _ = carom.simulate(scene, 1.0, save_at=[1.0], **how).joint_coordinates("hinge")
    assert q[-1, 0] == pytest.approx(3000.0, rel=1e-4 if rtol is None else 1e-7)


def test_files_of_earlier_versions_count_turns_by_the_rates():
    s = carom.simulate(double_pendulum(), 1.5)
    known, rates = s.joint_coordinates("lower")
    s._run.records = s._run.records._replace(turn=s._run.records.turn[:, :0])
    np.testing.assert_array_equal(s.joint_coordinates("lower")[1], rates)
    np.testing.assert_allclose(s.joint_coordinates("lower")[0], known, atol=1e-12)


def test_hinge_and_rod_of_a_pendulum():
    """From (-1, 0): the angle grows by the axis z, as that of the body's centre does."""
    s = carom.simulate(pendulum("Revolute"), 1.0, step=0.01)
    q, rate = s.joint_coordinates("pivot")
    x = s.position[:, 0]
    found = -np.stack([np.cos(q[:, 0]), np.sin(q[:, 0])], axis=1)
    np.testing.assert_allclose(0.5 * found, x[:, :2], rtol=0, atol=1e-12)
    np.testing.assert_allclose(rate[:, 0], s.angular_velocity[:, 0, 2], rtol=0, atol=1e-13)
    assert rate[5, 0] > 0.0
    length, speed = carom.simulate(pendulum(), 1.0, step=0.01).joint_coordinates("pivot")
    np.testing.assert_allclose(length, 1.0, rtol=0, atol=1e-13)
    np.testing.assert_allclose(speed, 0.0, rtol=0, atol=1e-12)


def test_refuses_what_is_no_joint_of_the_scene():
    s = carom.simulate(pendulum(), 0.01, step=0.01)
    with pytest.raises(KeyError, match="pivot"):
        s.joint_coordinates("pivo")
    with pytest.raises(TypeError, match="joint must be a Joint or str, got Body"):
        s.joint_coordinates("bob")
    with pytest.raises(TypeError, match="joint must be a Joint or str, got 0"):
        s.joint_coordinates(0)
    with pytest.raises(ValueError, match="joint must belong to the scene of this solution"):
        s.joint_coordinates(pendulum().joints[0])
