"""Reactions of joints: closed forms, balance with the weight, redundancy, no work."""

import numpy as np
import pytest
from dense_reference import solve
from mechanism_scenes import G, chain, four_bar, pendulum, run
from test_pendulum import KINDS

import carom
from carom import GROUND, Scene, joints


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_pendulum_rod_pulls_with_three_weights(method):
    """From the horizontal: m v^2/l = 2 m g cos(theta), so the rod pulls with 3 m g cos(theta)."""
    s = carom.simulate(pendulum(), 2.0, step=0.0025, method=method)
    x = s.position[:, 0]
    expected = -3.0 * G * -x[:, [1]] * x  # towards the pivot, cos(theta) = -y
    error = np.max(np.abs(s.joint_reactions[:, 0, :3] - expected))
    assert error < {"rk4": 1e-7, "paper": 1e-3}[method]  # speeds are right to h^4, to h^2
    np.testing.assert_allclose(s.joint_reactions[:, 0, 3:], 0.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("kind", ["Revolute", "Spherical"])
def test_hinge_of_a_body(kind):
    """m a = m g + F with a = theta'' d t - theta'^2 d n, here d = 1/2, theta'' = -g sin, l = 1."""
    s = carom.simulate(pendulum(kind), 1.0, step=0.0025)
    sin, cos = -2.0 * s.position[:, 0, 0], -2.0 * s.position[:, 0, 1]
    swing = 2.0 * G * cos  # theta'^2
    along, ahead = np.stack([-sin, -cos], 1), np.stack([-cos, sin], 1)
    a = 0.5 * (-G * sin[:, None] * ahead - swing[:, None] * along)
    expected = a - np.array([0.0, -G])
    np.testing.assert_allclose(s.joint_reactions[:, 0, :2], expected, rtol=0, atol=1e-7)
    np.testing.assert_allclose(s.joint_reactions[:, 0, 2:], 0.0, rtol=0, atol=1e-10)


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_hanging_chain_carries_what_is_below(method):
    count = 5
    s = carom.simulate(
        chain(count, angles=np.full(count, np.pi / 2)), 0.01, step=0.01, method=method
    )
    below = G * np.arange(count, 0, -1.0)
    expected = np.zeros((count, 6))
    expected[:, 2] = below
    np.testing.assert_allclose(s.joint_reactions[0], expected, rtol=0, atol=1e-11)
    np.testing.assert_allclose(s.joint_reactions[-1], expected, rtol=0, atol=1e-9)


def test_child_first_gives_the_opposite_on_the_other_body():
    angles = [0.3, 0.9, -0.4]
    a, b = (carom.simulate(chain(3, angles=angles, flips=f), 0.1, step=1e-3) for f in ((), (1, 2)))
    np.testing.assert_allclose(b.joint_reactions[:, 0], a.joint_reactions[:, 0], rtol=0, atol=1e-8)
    np.testing.assert_allclose(
        b.joint_reactions[:, 1:], -a.joint_reactions[:, 1:], rtol=0, atol=1e-8
    )


def door(hinges):
    """A door of 3 kg on hinges along z; its centre 0.4 m from them, at rest."""
    scene = Scene()
    scene.add_body(mass=3.0, inertia=[0.2, 0.3, 0.4], position=(0.4, 0, 0), name="door")
    for k, z in enumerate(hinges):
        joint = joints.Revolute((0, 0, z), (0, 0, 1))
        scene.add_joint(joint, GROUND, scene["door"], name=f"hinge{k}")
    return scene


def on_centres(s, k=0):
    """Reactions (J, 6) on children, moved to their mass centre, as at the start."""
    out = s.joint_reactions[k].copy()
    for j, joint in enumerate(s.scene.joints):
        arm = joint.definition.anchor - joint.child.position
        out[j, 3:] += np.cross(arm, out[j, :3])
    return out


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_coincident_hinges_share_alike(method):
    s = run(door([0.0, 0.0]), 0.01, 0.01, method=method)
    one, both = run(door([0.0]), 0.01, 0.01, method=method), s.joint_reactions[0]
    np.testing.assert_allclose(both[0], both[1], rtol=0, atol=1e-8)
    np.testing.assert_allclose(both.sum(axis=0), one.joint_reactions[0, 0], rtol=0, atol=1e-8)
    np.testing.assert_allclose(
        both[0], [0, 0, 1.5 * G, 0, -0.5 * 3.0 * G * 0.4, 0], rtol=0, atol=1e-8
    )


@pytest.mark.parametrize("hinges", [[0.5, -0.5], [1.0, 0.3, -0.6]])
def test_redundant_hinges_balance_the_weight_with_least_norm(hinges):
    scene = door(hinges)
    s = run(scene, 0.01, 0.01)
    total = on_centres(s).sum(axis=0)
    np.testing.assert_allclose(total, [0, 0, 3.0 * G, 0, 0, 0], rtol=0, atol=1e-8)
    # the dense pseudo-inverse weighs the rows by the same diagonal, but chooses its own directions
    # across the axis; they are principal ones here
    _, wrenches, _, _ = solve(scene)
    np.testing.assert_allclose(on_centres(s), wrenches[:, 0], rtol=0, atol=1e-5)


@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_four_bar_reactions_are_finite_and_balance(method):
    s = carom.simulate(four_bar(3, angle=0.4), 0.2, step=1e-3, method=method)
    f = s.joint_reactions
    assert np.all(np.isfinite(f))
    feet = [j.index for j in s.scene.joints if j.name.startswith("foot")]
    # Newton's law of the whole: feet and weight, d(momentum)/dt by differences
    momentum = s.velocity.sum(axis=1)
    rate = (momentum[2:] - momentum[:-2]) / (s.t[2:] - s.t[:-2])[:, None]
    weight = np.array([0.0, -G, 0.0]) * len(s.scene.bodies)
    found = f[1:-1, feet, :3].sum(axis=1) + weight
    np.testing.assert_allclose(found, rate, rtol=0, atol=2e-3)  # differences of order 2: h^2 v'''
    assert np.max(np.abs(f[..., 2])) < 1e-8  # nothing out of the plane


@pytest.mark.parametrize("kind", KINDS)
def test_reactions_do_no_work_on_the_motion(kind):
    s = carom.simulate(pendulum(kind), 1.0, step=0.01)
    anchor = np.zeros(3) if kind != "Distance" else s.position[:, 0]
    arm = anchor - s.position[:, 0]
    v = s.velocity[:, 0] + np.cross(s.angular_velocity[:, 0], arm)
    f = s.joint_reactions[:, 0]
    power = np.sum(f[:, :3] * v, 1) + np.sum(f[:, 3:] * s.angular_velocity[:, 0], 1)
    assert np.max(np.abs(power)) < 1e-10


def test_reactions_do_no_work_in_a_loop():
    s = carom.simulate(four_bar(2, angle=0.3), 0.5, step=0.005)
    for k in (10, 60):
        power = 0.0
        for j, joint in enumerate(s.scene.joints):
            f, b = s.joint_reactions[k, j], joint.child
            arm = joint.definition.anchor - b.position
            turned = _turn(s.orientation[k, b.index], b.orientation) @ arm
            at = s.position[k, b.index] + turned
            for body, sign in ((joint.child, 1.0), (joint.parent, -1.0)):
                i = body.index
                if i >= 0:
                    w = s.angular_velocity[k, i]
                    v = s.velocity[k, i] + np.cross(w, at - s.position[k, i])
                    power += sign * (f[:3] @ v + f[3:] @ w)
        assert abs(power) < 1e-9


def _turn(now, start):
    from mechanism_scenes import matrix

    return matrix(now) @ matrix(start).T


def arm_with_a_motor(count, redundant=False):
    """Heavy balls on long massless rods, on hinges that are not parallel, of which a motor holds the last."""
    scene, last = Scene(gravity=(0, 0, -G)), GROUND
    for k in range(count):
        ball = scene.add_body(
            carom.Sphere(0.1), mass=1.0 + k, position=(1.0 + k, 0, 0.1 * k), name=f"ball{k}"
        )
        hinge = joints.Revolute((k + 0.1, 0, 0.1 * k), (0, 1, 0.2 * k))
        scene.add_joint(hinge, last, ball, name=f"pin{k}")
        if redundant and k == 1:  # a second hinge on the same axis
            again = joints.Revolute((k + 0.1, 0.5, 0.1 * k + 0.1), (0, 1, 0.2 * k))
            scene.add_joint(again, last, ball, name="again")
        last = ball
    scene.add_constraint(carom.constraints.Driver(f"pin{count - 1}", rate=0.0))
    return scene


@pytest.mark.parametrize("redundant", [False, True])
@pytest.mark.parametrize("count", [2, 3, 4, 8])
def test_a_motor_on_a_chain_leaves_newtons_law(count, redundant):
    """Through each hinge goes the sum of m (a - g) of the balls beyond; a by central differences.

    A sum of passes with a regularised matrix had errors of 10 to 60 % here: the balls' moments are a hundredth
    of what their masses have about the hinges, and the small eigenvalues need hundreds of passes.
    """
    s = carom.simulate(arm_with_a_motor(count, redundant), 0.021, step=1e-4)
    a = (s.velocity[201] - s.velocity[199]) / (s.t[201] - s.t[199])
    through = (1.0 + np.arange(count))[:, None] * (a + [0, 0, G])
    for k in range(count):
        found = s[f"pin{k}"].force[200] + (s["again"].force[200] if redundant and k == 1 else 0.0)
        expected = through[k:].sum(axis=0)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6 * np.linalg.norm(through))


@pytest.mark.parametrize("eps", [1e-2, 1e-3, 1e-5])
def test_reactions_of_least_norm_do_not_depend_on_the_regularisation(eps):
    options = carom.Options(augmentation=eps)
    s = carom.simulate(arm_with_a_motor(4, True), 0.02, step=1e-3, options=options)
    usual = carom.simulate(arm_with_a_motor(4, True), 0.02, step=1e-3)
    np.testing.assert_allclose(s.joint_reactions, usual.joint_reactions, rtol=0, atol=1e-8)
