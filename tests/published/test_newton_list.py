"""The physics verification list of Newton (1.8): closed forms, which carom meets to round-off or its tolerance.

Newton's tolerances are 1e-3 to 5 %. Gravity is 10 m/s^2 along -y there.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from scipy.special import ellipj, ellipk

import carom
from carom import GROUND, constraints, joints

DOWN, Z = (0, -10.0, 0), (0, 0, 1)


def test_free_fall_and_a_projectile():
    scene = carom.Scene(gravity=DOWN)
    scene.add_body(carom.Sphere(0.1), density=1000, position=(0, 5, 0), name="falls")
    scene.add_body(
        carom.Sphere(0.1), density=1000, position=(9, 10, 0), velocity=(5, 10, 0), name="thrown"
    )
    run = carom.simulate(scene, 0.5)
    np.testing.assert_allclose(run["falls"].position[-1], (0, 3.75, 0), atol=1e-14)
    np.testing.assert_allclose(run["falls"].velocity[-1], (0, -5, 0), atol=1e-14)
    np.testing.assert_allclose(run["thrown"].position[-1], (11.5, 13.75, 0), atol=1e-14)


@pytest.mark.parametrize(("angle", "duration"), [(0.05, 7.0), (1.0, 2.0)])
def test_a_pendulum_swings_as_the_elliptic_function(angle, duration):
    scene = carom.Scene(gravity=DOWN)
    bob = scene.add_body(
        carom.Sphere(0.01),
        density=1000,
        position=(np.sin(angle), -np.cos(angle), 0),
        orientation=carom.axis_angle(Z, np.degrees(angle)),
    )
    scene.add_joint(joints.Revolute((0, 0, 0), Z), GROUND, bob, name="hinge")
    run = carom.simulate(scene, duration, rtol=1e-10)
    w, m = np.sqrt(10 / (1 + 0.4 * 0.01**2)), np.sin(angle / 2) ** 2
    sn = ellipj(ellipk(m) - w * run.t, m)[0]
    np.testing.assert_allclose(
        angle + run["hinge"].coordinate, 2 * np.arcsin(np.sqrt(m) * sn), rtol=0, atol=1e-9
    )
    np.testing.assert_allclose(run.total_energy, run.total_energy[0], rtol=1e-10)


def test_joints_that_are_driven_by_constant_forces():
    scene = carom.Scene(gravity=(0, 0, 0))
    box = scene.add_body(carom.Box(0.4, 0.4, 0.4), density=1000)
    ball = scene.add_body(carom.Sphere(0.1), density=1000, position=(0, 5, 0))
    turn = scene.add_joint(joints.Revolute((0, 0, 0), Z), GROUND, box, name="turn")
    slide = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, ball, name="slide")
    for joint in (turn, slide):
        scene.add_force(carom.forces.JointForce(joint, 5.0))
    run = carom.simulate(scene, 0.3)
    assert run["turn"].rate[-1] == pytest.approx(1.5 / (64 * 0.4**2 / 6), rel=1e-12)
    assert run["slide"].rate[-1] == pytest.approx(1.5 / (4 / 3 * np.pi), rel=1e-12)


def test_momenta_of_free_bodies():
    scene = carom.Scene(gravity=(0, 0, 0))
    places = (0, 0, 0), (100, 0, 0), (0, 100, 0), (0, 0, 100)
    speeds = (1, 0, 0), (0, -1, 0), (0, 0, 1.5), (-0.5, 0.5, -0.5)
    rates = (0, 0, 0.5), (0.3, 0, 0), (0, -0.2, 0), (0, 0, -0.3)
    for x, v, w in zip(places, speeds, rates):
        scene.add_body(carom.Box(1, 1, 1), density=1000, position=x, velocity=v, angular_velocity=w)
    run = carom.simulate(scene, 1.0)
    linear = 1000 * run.velocity.sum(axis=1)
    angular = (1000 * np.cross(run.position, run.velocity) + 1000 / 6 * run.angular_velocity).sum(
        axis=1
    )
    np.testing.assert_allclose(linear, linear[:1].repeat(len(linear), 0), atol=1e-10)
    np.testing.assert_allclose(angular, angular[:1].repeat(len(angular), 0), atol=1e-7)


@pytest.mark.parametrize("e", [0.0, 0.5, 0.8, 1.0])
def test_a_ball_bounces_to_e_squared(e):
    scene = carom.Scene(gravity=DOWN)
    scene.add_half_space((0, 0, 0), (0, 1, 0))
    scene.set_contact_default(restitution=e)
    scene.add_body(carom.Sphere(0.05), density=1000, position=(0, 1.05, 0))
    run = carom.simulate(scene, (1 + e) * np.sqrt(0.2))
    assert run.position[-1, 0, 1] - 0.05 == pytest.approx(e * e, abs=1e-14)


@pytest.mark.parametrize("friction", [0.1, 0.25, 0.5, 0.75, 1.0])
def test_a_box_on_a_ramp_slides_or_stays(friction):
    for degrees in (5, 10, 14, 14.1, 20, 26.5, 26.6, 30, 36, 37, 44, 46):
        a = np.radians(degrees)
        scene = carom.Scene(gravity=(9.81 * np.sin(a), 0, -9.81 * np.cos(a)))
        ramp = scene.add_half_space((0, 0, 0), (0, 0, 1))
        box = scene.add_body(carom.Box(0.4, 0.4, 0.1), density=1000, position=(0, 0, 0.05))
        scene.add_contact(box, ramp, friction=friction, restitution=0)
        run = carom.simulate(scene, 1.0)
        slide = max(0.0, 9.81 * (np.sin(a) - friction * np.cos(a)))
        assert run.position[-1, 0, 0] == pytest.approx(slide / 2, abs=1e-12)


def bar(scene, start, end, name):
    start, end = np.array(start), np.array(end)
    length = np.linalg.norm(end - start)
    angle = np.degrees(np.arctan2(*(end - start)[1::-1]))
    return scene.add_body(
        carom.Box(length, 0.04, 0.04), density=1000, position=(start + end) / 2,
        orientation=carom.axis_angle(Z, angle), name=name,
    )  # fmt: skip


A, B, C, D = 0.2, 0.5, 0.4, 0.5  # crank, coupler, rocker, frame


def rocker(crank):
    """Return the angle of the rocker by Freudenstein's equation."""
    k1, k2, k3 = D / A, D / C, (A * A - B * B + C * C + D * D) / (2 * A * C)
    p, q, r = k1 - np.cos(crank), -np.sin(crank), k2 * np.cos(crank) - k3
    return np.arctan2(q, p) + np.arccos(r / np.hypot(p, q))


def four_bar(gravity, axle, driven):
    scene = carom.Scene(gravity=gravity)
    angle = rocker(0.0)
    left, right, end = (A, 0, 0), (D + C * np.cos(angle), C * np.sin(angle), 0), (D, 0, 0)
    crank = bar(scene, (0, 0, 0), left, "crank")
    coupler, out = bar(scene, left, right, "coupler"), bar(scene, end, right, "rocker")
    first = scene.add_joint(axle, GROUND, crank)
    scene.add_joint(joints.Revolute(left, Z), crank, coupler)
    scene.add_joint(joints.Revolute(right, Z), coupler, out)
    scene.add_joint(joints.Revolute(end, Z), GROUND, out, name="out")
    if driven:
        scene.add_constraint(constraints.Driver(first, rate=2 * np.pi))
    return scene


def test_a_driven_four_bar_follows_freudenstein():
    scene = four_bar((0, 0, 0), joints.Revolute((0, 0, 0), Z), True)
    run = carom.simulate(
        scene, 2.0, rtol=1e-10, options=carom.Options(project_start=True), save_at=0.01
    )
    angle = np.unwrap(rocker(2 * np.pi * run.t))
    np.testing.assert_allclose(run["out"].coordinate, angle - angle[0], rtol=0, atol=1e-10)


def test_a_loop_with_a_ball_joint_stays_in_its_plane():
    run = carom.simulate(four_bar((0, -9.81, 3.0), joints.Spherical((0, 0, 0)), False), 1.0)
    assert np.abs(run.position[..., 2]).max() < 1e-12
    assert np.ptp(run["out"].coordinate) > 0.1


def test_two_bars_fixed_to_each_other_swing_as_one():
    scene = carom.Scene(gravity=(0, -9.81, 0))
    first = scene.add_body(carom.Box(0.04, 0.5, 0.04), density=1000, position=(0, -0.25, 0))
    second = scene.add_body(carom.Box(0.5, 0.04, 0.04), density=1000, position=(0.25, -0.5, 0))
    scene.add_joint(joints.Revolute((0, 0, 0), Z), GROUND, first, name="hinge")
    scene.add_joint(joints.Fixed(), first, second)
    m = 0.8
    J = m / 6 * (0.04**2 + 0.25) + m * (0.0625 + 0.0625 + 0.25)

    def rates(t, y):
        return [y[1], -2 * m * 9.81 * (0.125 * np.cos(y[0]) + 0.375 * np.sin(y[0])) / J]

    end = solve_ivp(rates, (0, 1), [0, 0], method="DOP853", rtol=1e-13, atol=1e-14).y[0, -1]
    run = carom.simulate(scene, 1.0, rtol=1e-11)
    assert run["hinge"].coordinate[-1] == pytest.approx(end, abs=1e-9)


def test_a_free_body_keeps_its_angular_momentum():
    scene = carom.Scene(gravity=(0, 0, 0))
    inertia = np.diag([0.2, 0.5, 0.4])
    scene.add_body(mass=1, inertia=inertia, angular_velocity=(0.7, -0.5, 0.9))
    run = carom.simulate(scene, 0.2)
    R = Rotation.from_quat(run.orientation[:, 0], scalar_first=True).as_matrix()
    momentum = np.einsum("tij,jk,tlk,tl->ti", R, inertia, R, run.angular_velocity[:, 0])
    np.testing.assert_allclose(momentum, momentum[:1].repeat(len(momentum), 0), atol=1e-14)


def test_a_rod_on_a_ball_joint_swings_as_euler_s_equations():
    lean = Rotation.from_rotvec((0, 0, 0.5))
    place = lean.apply((0, -0.25, 0))
    scene = carom.Scene(gravity=(0, -9.81, 0))
    rod = scene.add_body(
        carom.Box(0.04, 0.5, 0.04), density=1000, position=place,
        orientation=lean.as_quat(scalar_first=True), angular_velocity=(3, 0, 0),
        velocity=np.cross((3, 0, 0), place),
    )  # fmt: skip
    scene.add_joint(joints.Spherical((0, 0, 0)), GROUND, rod)
    m, arm = 0.8, np.array((0, -0.25, 0))
    J = m / 12 * np.array((0.04**2 + 0.25, 2 * 0.04**2, 0.04**2 + 0.25)) + m / 16 * np.array(
        (1, 0, 1)
    )

    def rates(t, y):
        q, w = y[:4], y[4:]
        weight = (
            Rotation.from_quat(q / np.linalg.norm(q), scalar_first=True)
            .inv()
            .apply((0, -9.81 * m, 0))
        )
        dq = 0.5 * np.array((-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))))
        return np.concatenate([dq, (np.cross(arm, weight) - np.cross(w, J * w)) / J])

    begin = np.concatenate([lean.as_quat(scalar_first=True), lean.inv().apply((3.0, 0, 0))])
    end = solve_ivp(rates, (0, 1), begin, method="DOP853", rtol=1e-13, atol=1e-14).y[:4, -1]
    run = carom.simulate(scene, 1.0, rtol=1e-11)
    there = Rotation.from_quat(end, scalar_first=True).apply(arm)
    np.testing.assert_allclose(run.position[-1, 0], there, rtol=0, atol=1e-9)
