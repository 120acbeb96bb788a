"""Limits of ball joints: a cone, a twist, an angle of rotation, in impacts and in persistent contact."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from carom.geometry import quaternion
from carom.geometry.frames import triad
from verified import agree, verifies

M, L, I, AXIAL, G = 2.0, 0.5, 0.53, 0.01, 9.81  # about the pivot; I = .03 + M L^2
LIMIT = 0.4


def about(angle, axis):
    """Return the quaternion of a turn."""
    axis = np.asarray(axis, dtype=float)
    return np.append(np.cos(angle / 2), np.sin(angle / 2) * axis / np.linalg.norm(axis))


def pendulum(restitution, spin, angle=0.0, gravity=G, **stop):
    """Return a symmetric body on a ball joint, turned by `angle` about y, with an angular velocity."""
    scene, turn = carom.Scene(gravity=(0, 0, -gravity)), about(angle, (0, 1, 0))
    arm = quaternion.rotate(turn, (0.0, 0.0, -L))
    body = scene.add_body(
        mass=M, inertia=(0.03, 0.03, AXIAL), position=arm, orientation=turn, name="bob",
        angular_velocity=spin, velocity=np.cross(spin, arm),
    )  # fmt: skip
    ball = joints.Spherical((0, 0, 0), axis=(0, 0, -1), start=turn)
    joint = scene.add_joint(ball, GROUND, body, name="ball")
    stop = {"coordinate": "swing", "upper": LIMIT, **stop}
    scene.add_stop(joint, restitution=restitution, name="limit", **stop)
    return scene


def swing_of(solution):
    """The angle between the hanging direction and the body's own axis."""
    along = quaternion.rotate(solution.orientation[:, 0], np.array([0.0, 0.0, 1.0]))
    return np.arctan2(np.hypot(along[:, 0], along[:, 1]), along[:, 2])


@verifies(
    "add_stop(coordinate=)",
    r"swing: $I\dot\theta^2/2 = I\omega^2/2 - M g L (1 - \cos\theta)$",
    "closed form",
)
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_a_pendulum_strikes_its_cone(e):
    """I theta'^2 / 2 = I w^2 / 2 - M g L (1 - cos(limit)) before, e theta' after."""
    solution = carom.simulate(pendulum(e, (0.0, 2.4, 0.0)), 0.6, rtol=1e-10)
    speed = np.sqrt(2.4**2 - 2 * M * G * L / I * (1 - np.cos(LIMIT)))
    first = solution.impacts[0]
    agree(first.relative_velocity_before[0], -speed, rtol=1e-8)
    agree(first.relative_velocity_after[0], e * speed, rtol=1e-8, atol=1e-10)
    agree(first.impulse[0], (1 + e) * I * speed, rtol=1e-8)
    assert first.unit == "rad/s"
    assert np.max(swing_of(solution)) < LIMIT + 1e-10
    gap = solution.contact("limit").gap
    agree(gap, LIMIT - swing_of(solution), atol=1e-12)
    agree(solution.ledger.residual, 0.0, atol=1e-9)
    # it swings through the place where the swing has no direction, and strikes the other side
    if e == 1.0:
        assert len(solution.impacts) == 2
        agree(solution.impacts[1].relative_velocity_before[0], -speed, rtol=1e-8)


def test_a_strike_at_the_cone_keeps_the_momentum_about_its_axis():
    """The impulse is about the normal of the plane of swing: energy (1 - e^2) I theta'^2 / 2 goes."""
    e, spin = 0.6, (1.5, 2.0, 0.7)
    solution = carom.simulate(pendulum(e, spin, angle=0.2), 1.0, rtol=1e-10)
    x, v, w = solution.position[:, 0], solution.velocity[:, 0], solution.angular_velocity[:, 0]
    own = quaternion.rotate_back(solution.orientation[:, 0], w) * [0.03, 0.03, AXIAL]
    about_z = (M * np.cross(x, v) + quaternion.rotate(solution.orientation[:, 0], own))[:, 2]
    np.testing.assert_allclose(about_z, about_z[0], rtol=1e-9)
    assert len(solution.impacts) > 1
    for one in solution.impacts:
        lost = 0.5 * (1 - e * e) * I * one.relative_velocity_before[0] ** 2
        assert one.energy_change == pytest.approx(-lost, rel=1e-9)
    # the joint gives the body its change of momentum, and the stop the torque
    for row in solution["ball"].impulses:
        before, after = (solution.evaluate(row.time, side)[2][0] for side in ("left", "right"))
        np.testing.assert_allclose(row.impulse, M * (after - before), atol=1e-9)
        np.testing.assert_allclose(row.angular_impulse, 0.0, atol=1e-9)


def test_a_body_goes_round_at_its_cone():
    """At the constant angle the stop carries I W^2 sin cos - M g L sin, without spin about the own axis."""
    rate = 8.0  # of the azimuth [rad/s], turned forward by the body's spin -rate cos(limit)
    up, own = np.array([0.0, 0.0, 1.0]), np.array([-np.sin(LIMIT), 0.0, -np.cos(LIMIT)])
    spin = rate * (up - (up @ own) * own)
    solution = carom.simulate(pendulum(0.0, spin, angle=LIMIT), 1.0, rtol=1e-10)
    torque = (I * rate**2 * np.cos(LIMIT) - M * G * L) * np.sin(LIMIT)
    np.testing.assert_allclose(solution.contact_force[1:, 0, 0], torque, rtol=1e-8)
    np.testing.assert_allclose(swing_of(solution), LIMIT, atol=1e-10)
    place = solution.position[-1, 0]
    azimuth = np.arctan2(place[1], place[0]) - np.pi
    assert np.sin(azimuth - rate) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_a_spinning_body_strikes_the_limit_of_its_twist(e):
    """After .7 rad below 0, at 2 rad/s, and with e = 1 again at 2.1 rad above."""
    scene = pendulum(0.0, (0.0, 0.0, 2.0), gravity=0.0)
    ends: Any = ({"lower": -0.7}, {"upper": 1.4})
    for one in ends:
        scene.add_stop("ball", coordinate="twist", restitution=e, name=min(one), **one)
    solution = carom.simulate(scene, 1.5, rtol=1e-10)
    # the axis points down, so the twist falls
    times = [0.35, 1.4] if e == 1.0 else [0.35]
    # round-off may leave a plastic strike some speed, which a second one ends
    struck = np.abs(solution.impacts.relative_velocity_before[:, 0]) > 1e-9
    np.testing.assert_allclose(solution.impacts.time[struck], times, rtol=1e-10)
    assert list(solution.impacts.name[struck]) == ["lower", "upper"][: len(times)]
    assert solution.impacts.impulse[0, 0] == pytest.approx((1 + e) * AXIAL * 2.0, rel=1e-10)
    known = [-2.0 * t if t < 0.35 else -0.7 + 2.0 * e * (t - 0.35) for t in solution.t]
    if e < 1.0:
        np.testing.assert_allclose(solution.contact("lower").gap, np.add(known, 0.7), atol=1e-10)
        np.testing.assert_allclose(solution.contact("limit").gap, LIMIT, atol=1e-10)
    end = 2.0 if e == 1.0 else -2.0 * e
    np.testing.assert_allclose(solution.angular_velocity[-1, 0], [0, 0, end], atol=1e-10)


def test_a_twist_counts_whole_turns():
    """Its stop at 9 rad is struck after more than a turn."""
    scene = pendulum(0.0, (0.0, 0.0, -10.0), gravity=0.0)
    scene.add_stop("ball", coordinate="twist", upper=9.25, restitution=0.5)
    solution = carom.simulate(scene, 1.0)
    np.testing.assert_allclose(solution.impacts.time, [0.925], rtol=1e-9)


def test_a_rotation_is_limited_about_any_axis():
    """A ball turns from .5 rad at 2 rad/s to 1.5 rad, and at half the speed back through 0."""
    scene, axis = carom.Scene(gravity=(0, 0, 0)), np.array([0.6, 0.0, 0.8])
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, angular_velocity=2.0 * axis)
    joint = scene.add_joint(joints.Spherical((0, 0, 0), start=about(0.5, axis)), GROUND, ball)
    scene.add_stop(joint, upper=1.5, coordinate="rotation", restitution=0.5)
    solution = carom.simulate(scene, 4.0, rtol=1e-10)
    np.testing.assert_allclose(solution.impacts.time, [0.5, 3.5], rtol=1e-10)
    np.testing.assert_allclose(solution.angular_velocity[-1, 0], 0.5 * axis, atol=1e-10)
    np.testing.assert_allclose(solution.contact("stop1").gap[[0, -1]], [1.0, 0.25], atol=1e-9)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (dict(upper=1.0), 'coordinate must be "rotation" or "swing" or "twist", got 0'),
        (dict(upper=1.0, coordinate="bend"), 'coordinate must be "rotation" or "swing" or "twist"'),
        (dict(upper=3.2, coordinate="swing"), "upper must be .* below"),
        (dict(lower=0.1, coordinate="rotation"), "upper must be a number"),
    ],
)
def test_limits_that_a_ball_joint_does_not_have(values, said):
    scene = pendulum(0.0, (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match=said):
        scene.add_stop("ball", **values)


def test_a_hinge_has_no_such_angle():
    scene = carom.Scene()
    hinge = scene.add_joint(
        joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, scene.add_body(carom.Sphere(1), mass=1)
    )
    with pytest.raises(ValueError, match="coordinate must be the index of one of the joint"):
        scene.add_stop(hinge, upper=1.0, coordinate="swing")


def test_a_twist_comes_with_a_swing_and_a_start_within_limits():
    alone = pendulum(0.0, (0.0, 0.0, 0.0), coordinate="twist", upper=1.0)
    with pytest.raises(ValueError, match='must come with a stop of its "swing"'):
        carom.simulate(alone, 0.1)
    with pytest.raises(ValueError, match=r"where the coordinate is 0\.5, got upper=0\.4 rad"):
        carom.simulate(pendulum(0.0, (0.0, 0.0, 0.0), angle=0.5), 0.1)


def test_files_and_ensembles_know_them(tmp_path):
    scene: Any = pendulum(0.5, (0.0, 2.4, 0.0), angle=0.1)
    solution = carom.simulate(scene, 0.3, step=0.01)
    solution.save(tmp_path / "ball.nc")
    again: Any = carom.Solution.load(tmp_path / "ball.nc").scene
    stop = again["limit"]
    assert (stop.coordinate, stop.upper) == ("swing", LIMIT)
    np.testing.assert_array_equal(again["ball"].definition.start, scene["ball"].definition.start)
    runs = carom.ensemble(scene, 0.3, step=0.01, vary={"limit.upper": [LIMIT, 1.0]})
    np.testing.assert_array_equal(runs.impacts, [len(solution.impacts), 0])


def random_rotation(rng):
    return about(rng.uniform(0, 3), rng.normal(size=3))


def random_scene(seed, frame=(1.0, 0.0, 0.0, 0.0)):
    """Return two bodies, or one and the ground, with limits of their ball joint, within which they start.

    All is turned by `frame`.
    """

    def placed(vector):
        return quaternion.rotate(frame, vector)

    def turned(q):
        return quaternion.multiply(frame, q)

    rng = np.random.default_rng(seed)
    size, pair = 10 ** rng.uniform(-2, 1), rng.random() < 0.5
    scene = carom.Scene(gravity=placed(size * rng.normal(size=3) * rng.choice([0.0, 5.0])))
    dims = size * rng.uniform(0.2, 1.0, size=(2, 3))
    axis, anchor = rng.normal(size=3), 0.5 * size * rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    parent, speed = GROUND, np.zeros(3)
    if pair:
        w = 2.0 * rng.normal(size=3)
        mass, turn = 10 ** rng.uniform(-1, 1), random_rotation(rng)
        parent = scene.add_body(
            carom.Box(*dims[0]), mass=mass, orientation=turned(turn), angular_velocity=placed(w)
        )
        speed = np.cross(w, anchor)
    limits = {"rotation": rng.uniform(0.3, 2.8)}
    if rng.random() < 0.7:
        limits = {"swing": rng.uniform(0.3, 2.8), "twist": rng.uniform(0.3, 2.0)}
        swing = about(limits["swing"] * rng.uniform(0, 0.9), np.cross(axis, rng.normal(size=3)))
        start = quaternion.multiply(swing, about(limits["twist"] * rng.uniform(-0.9, 0.9), axis))
    else:
        start = about(limits["rotation"] * rng.uniform(0, 0.9), rng.normal(size=3))
    arm, w = size * rng.normal(size=3) * rng.choice([0.0, 0.5]), 3.0 * rng.normal(size=3)
    child = scene.add_body(
        carom.Box(*dims[1]), mass=10 ** rng.uniform(-1, 1), position=placed(anchor + arm),
        orientation=turned(random_rotation(rng)), angular_velocity=placed(w),
        velocity=placed(speed + np.cross(w, arm)),
    )  # fmt: skip
    start = quaternion.multiply(turned(start), quaternion.conjugate(frame))
    joint = scene.add_joint(joints.Spherical(placed(anchor), placed(axis), start), parent, child)
    e = rng.choice([0.0, rng.random(), 1.0])
    for name, limit in limits.items():
        scene.add_stop(joint, upper=limit, coordinate=name, restitution=e)
        if name == "twist":
            scene.add_stop(joint, lower=-limit, coordinate=name, restitution=e)
    return scene, joint, limits


def angles_of(solution, joint):
    """The angles from the relative rotation R = P^T C: of R, between its first axes, and about them."""
    P = triad(joint.definition.axis)
    C = quaternion.rotate(joint.definition.start, P.T).T
    sides = []
    for body, axes in ((joint.parent, P), (joint.child, C)):
        turn = np.tile([1.0, 0.0, 0.0, 0.0], (len(solution.t), 1))
        if body is not GROUND:
            turn = solution.orientation[:, body.index]
            turn = quaternion.multiply(turn, quaternion.conjugate(turn[0]))
        sides.append(np.stack([quaternion.rotate(turn, axes[:, k]) for k in range(3)], axis=2))
    R = np.einsum("tij,tik->tjk", *sides)
    q = np.array([quaternion.from_matrix(one) for one in R])
    half = np.linalg.norm(q[:, 1:], axis=1)
    return {
        "rotation": 2.0 * np.arctan2(half, np.abs(q[:, 0])),
        "swing": np.arctan2(np.hypot(R[:, 1, 0], R[:, 2, 0]), R[:, 0, 0]),
        "twist": np.abs(np.unwrap(2.0 * np.arctan2(q[:, 1], q[:, 0]), period=2.0 * np.pi)),
    }


@cache
def run(seed):
    scene, joint, limits = random_scene(seed)
    return carom.simulate(scene, 2.0, rtol=1e-10), joint, limits


@pytest.mark.few(20)
@pytest.mark.parametrize("seed", range(300))
def test_random_bodies_stay_within_their_limits(seed):
    """Within 1e-8 rad, a hundred tolerances; the ledger is closed (measured with 1e-8: 1.6e-8, 1.2e-6)."""
    solution, joint, limits = run(seed)
    angles = angles_of(solution, joint)
    for name, limit in limits.items():
        assert np.max(angles[name]) < limit + 1e-8
    scale = max(solution.kinetic_energy)
    assert np.abs(solution.ledger.residual).max() < 1e-7 * scale
    assert np.max(np.diff(solution.total_energy)) < 1e-7 * scale


@pytest.mark.few(4)
@pytest.mark.parametrize("seed", range(40))
def test_a_turned_scene_strikes_at_the_same_times(seed):
    """Until round-off has grown: the first five strikes."""
    frame = about(2.0, (1.0, -2.0, 0.5))
    scene, _, _ = random_scene(seed, frame)
    found, known = carom.simulate(scene, 2.0, rtol=1e-10).impacts, run(seed)[0].impacts
    many = min(5, len(known))
    np.testing.assert_allclose(found.time[:many], known.time[:many], rtol=1e-8)
    assert list(found.name[:many]) == list(known.name[:many])
