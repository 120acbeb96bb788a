"""Inertia along coordinates of joints: closed forms, a geared flywheel in its place, what it must keep."""

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints
from carom.geometry import quaternion
from verified import agree, verifies

KINDS = {  # of joints, with the coordinates that have inertia
    "Revolute": (lambda at: joints.Revolute(at, (0.3, 1.0, -0.2)), (0,)),
    "Prismatic": (lambda at: joints.Prismatic((0.3, 1.0, -0.2)), (0,)),
    "Cylindrical": (lambda at: joints.Cylindrical(at, (0.3, 1.0, -0.2)), (0, 1)),
    "Planar": (lambda at: joints.Planar((0.3, 1.0, -0.2), at), (0, 1, 2)),
    "Universal": (lambda at: joints.Universal(at, (0, 1, 0), (1, 0, 0)), (0, 1)),
    "Screw": (lambda at: joints.Screw(at, (0.3, 1.0, -0.2), 0.4), (0, 1)),
    "PointOnPlane": (lambda at: joints.PointOnPlane(at, (0.3, 1.0, -0.2)), (0, 1)),
}


def linked(kind, floats, turned):
    """Three links on hinges, of which the second hangs on a joint of the kind; the whole may float."""
    scene = carom.Scene()
    links = [
        scene.add_body(
            carom.Box(0.4, 0.05, 0.08),
            mass=1.0 + k,
            position=(0.2 + 0.4 * k, 0.0, 1.0),
            name=f"link{k}",
        )
        for k in range(3)
    ]
    if not floats:
        scene.add_joint(joints.Revolute((0, 0, 1.0), (0.1, 1, 0.3)), GROUND, links[0])
    ends = (links[1], links[0]) if turned else (links[0], links[1])
    joint = scene.add_joint(KINDS[kind][0]((0.4, 0, 1.0)), *ends)
    scene.add_joint(joints.Revolute((0.8, 0, 1.0), (0, 0.5, 1)), links[1], links[2])
    scene.add_force(forces.Torque((0.3, 2.0, 1.0), follow=True), links[0])
    return scene, joint


def add_flywheel(scene, joint, coordinate, inertia):
    """Add what `JointInertia` stands for: a wheel on the ground that turns by q."""
    wheel = scene.add_body(mass=1.0, inertia=(inertia,) * 3)
    bearing = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, wheel)
    scene.add_constraint(constraints.Coupling({(joint, coordinate): 1.0, bearing: -1.0}))


def add_loop(scene):
    """Add a driven wheel far away, which sends the whole scene to the back end of loops."""
    wheel = scene.add_body(mass=1.0, inertia=(1, 1, 1))
    bearing = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, wheel)
    scene.add_constraint(constraints.Driver(bearing, rate=0.0))


@pytest.mark.plain
def test_a_turn_under_a_torque():
    """q = M t^2/(2 (J + I)); the wrench of the hinge does not turn it."""
    scene = carom.Scene(gravity=(0, 0, 0))
    wheel = scene.add_body(mass=1.0, inertia=(2, 2, 2))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, wheel)
    scene.add_force(forces.JointInertia(hinge, 1.0))
    scene.add_force(forces.JointInertia(hinge, 2.0))
    scene.add_force(forces.Torque((0, 0, 10.0)), wheel)
    solution = carom.simulate(scene, 0.5, step=0.1)
    np.testing.assert_allclose(solution.angular_velocity[:, 0, 2], 2.0 * solution.t, atol=1e-14)
    np.testing.assert_allclose(solution.kinetic_energy, 2.5 * (2.0 * solution.t) ** 2, atol=1e-13)
    assert np.max(np.abs(solution.joint_reactions)) < 1e-13


@verifies("forces.JointInertia", "$a = g m/(m + I)$", "closed form")
@pytest.mark.plain
def test_a_slide_falls_slowly():
    """a = g m/(m + I)."""
    scene = carom.Scene(gravity=(0, 0, -10.0))
    block = scene.add_body(mass=2.0, inertia=(1, 1, 1))
    rail = scene.add_joint(joints.Prismatic((0, 0, 1)), GROUND, block)
    scene.add_force(forces.JointInertia(rail, 3.0))
    solution = carom.simulate(scene, 0.5, step=0.1)
    agree(solution.velocity[:, 0, 2], -4.0 * solution.t, atol=1e-13)


@verifies("forces.JointInertia", r"$p = (1 + e)\,u/(1/m + l^2/(J + I))$", "closed form")
@pytest.mark.parametrize("e", [0.3, 0.7, 1.0])
def test_a_ball_strikes_a_lever(e):
    """p = (1 + e) u/(1/m + l^2/(J + I)) at the arm l."""
    scene = carom.Scene(gravity=(0, 0, 0))
    lever = scene.add_body(
        carom.Box(2.0, 0.2, 0.2), mass=3.0, inertia=(1, 1, 1.5), position=(1.0, 0, 0)
    )
    ball = scene.add_body(
        carom.Sphere(0.1), mass=2.0, position=(1.6, 0.5, 0), velocity=(0, -2.0, 0)
    )
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, lever)
    scene.add_force(forces.JointInertia(hinge, 4.0))
    scene.add_contact(lever, ball, restitution=e, friction=0.0)
    solution = carom.simulate(scene, 0.2, step=0.01)
    arm, J = 1.6, 1.5 + 3.0 + 4.0
    p = (1.0 + e) * 2.0 / (1.0 / 2.0 + arm**2 / J)
    agree(solution.velocity[-1, 1, 1], -2.0 + p / 2.0, atol=1e-9)
    agree(solution.angular_velocity[-1, 0, 2], -arm * p / J, atol=1e-9)


@pytest.mark.few(7)
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("floats", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_it_is_a_flywheel_on_a_gear(kind, floats, turned):
    """In a tree, with a loop elsewhere, and as a wheel that is geared to it: .5 ms have errors below 1e-10."""
    ends = []
    for way in ("wheel", "tree", "loops"):
        scene, joint = linked(kind, floats, turned)
        for coordinate in KINDS[kind][1]:
            inertia = 0.05 * (1 + coordinate)
            if way == "wheel":
                add_flywheel(scene, joint, coordinate, inertia)
            else:
                scene.add_force(forces.JointInertia(joint, inertia, coordinate))
        if way == "loops":
            add_loop(scene)
        solution = carom.simulate(scene, 0.04, step=5e-4, save_every=80)
        ends.append(np.concatenate([solution.velocity[-1, :3], solution.angular_velocity[-1, :3]]))
    np.testing.assert_allclose(ends[1], ends[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(ends[2], ends[0], rtol=0, atol=1e-9)


def arm_on_the_floor(loops=False):
    """A floating pair of boxes, of which one slides on the floor by four corners as the other swings."""
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    foot = scene.add_body(
        carom.Box(0.6, 0.4, 0.1), mass=2.0, position=(0, 0, 0.05), velocity=(0.8, 0.1, 0)
    )
    arm = scene.add_body(
        carom.Box(0.05, 0.05, 0.3), mass=0.5, position=(0, 0, 0.25), velocity=(0.8 + 0.15 * 3.0, 0.1, 0.0),
        angular_velocity=(0, 3.0, 0),
    )  # fmt: skip
    hinge = scene.add_joint(joints.Revolute((0, 0, 0.1), (0, 1, 0)), foot, arm)
    scene.add_force(forces.JointInertia(hinge, 0.05))
    scene.add_contact(foot, floor, friction=0.2, restitution=0.0)
    if loops:
        add_loop(scene)
    return scene


@pytest.mark.parametrize("loops", [False, True])
def test_contact_at_several_points_is_of_order_2(loops):
    """The corners hold, and the foot slides: errors fall by four as the step is halved; energy has its name."""
    ends = []
    for h in (4e-3, 2e-3, 1e-3, 2.5e-4):
        solution = carom.simulate(arm_on_the_floor(loops), 0.1, step=h)
        assert solution.stats["whole_steps"] == 0
        ends.append(
            np.concatenate([solution.position[-1, :2].ravel(), solution.velocity[-1, :2].ravel()])
        )
    errors = [np.max(np.abs(end - ends[-1])) for end in ends[:-1]]
    assert errors[0] < 1e-4
    assert errors[0] / errors[2] > 11.0  # 16 of order 2, 4 of order 1


def test_momentum_of_what_floats_is_kept():
    """Forces along the angles of a universal joint turn both bodies, and all together nothing."""
    scene = carom.Scene(gravity=(0, 0, 0))
    bodies = [
        scene.add_body(carom.Box(0.4, 0.05, 0.08), mass=1.0 + k, position=(0.2 + 0.4 * k, 0, 1))
        for k in range(2)
    ]
    bent = scene.add_joint(joints.Universal((0.4, 0, 1.0), (0, 1, 0), (1, 0, 0)), *bodies)
    for coordinate in (0, 1):
        scene.add_force(forces.JointInertia(bent, 0.3, coordinate))
        scene.add_force(forces.JointForce(bent, 0.1 + coordinate, coordinate))
    solution = carom.simulate(scene, 1.0, step=5e-3)
    m, J = np.array([1.0, 2.0]), np.array([b.inertia for b in bodies])
    R = quaternion.matrix(solution.orientation)
    spin = np.einsum("tbij,bjk,tblk,tbl->ti", R, J, R, solution.angular_velocity)
    orbital = np.einsum("b,tbi->ti", m, np.cross(solution.position, solution.velocity))
    assert np.max(np.abs(solution.angular_velocity)) > 1.0
    np.testing.assert_allclose(np.einsum("b,tbi->ti", m, solution.velocity), 0.0, atol=1e-12)
    np.testing.assert_allclose(orbital + spin, 0.0, atol=1e-9)
    assert np.max(np.abs(solution.ledger.residual)) < 1e-8


@pytest.mark.plain
def test_it_is_no_constraint():
    scene, joint = linked("Revolute", floats=False, turned=False)
    before = scene.check()
    scene.add_force(forces.JointInertia(joint, 1.0))
    assert scene.check().degrees_of_freedom == before.degrees_of_freedom == 3


@pytest.mark.parametrize("method", ["rattle", "paper"])
def test_methods_of_momenta_refuse_it(method):
    scene, joint = linked("Revolute", floats=False, turned=False)
    scene.add_force(forces.JointInertia(joint, 1.0))
    with pytest.raises(ValueError, match=r"method must be .* if joints have inertia, got"):
        carom.simulate(scene, 0.1, step=1e-3, method=method)


def test_the_implicit_method_takes_it():
    """A stiff spring on a turn with J + I: q = q_0 cos(sqrt(k/(J + I)) t), to order 2."""
    scene = carom.Scene(gravity=(0, 0, 0))
    wheel = scene.add_body(mass=1.0, inertia=(2, 2, 2), angular_velocity=(0, 0, 1.0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, wheel)
    scene.add_force(forces.JointInertia(hinge, 3.0))
    scene.add_force(forces.JointSpring(hinge, 500.0))
    solution = carom.simulate(scene, 0.5, step=1e-3, method="implicit")
    expected = np.cos(10.0 * solution.t)
    np.testing.assert_allclose(solution.angular_velocity[:, 0, 2], expected, atol=2e-3)


def test_bad_inertia_is_refused():
    _, joint = linked("Revolute", floats=False, turned=False)
    with pytest.raises(ValueError, match=r"inertia must be .*at least 0, got -1"):
        forces.JointInertia(joint, -1.0)
    with pytest.raises(ValueError, match="coordinate must be below 1, the number"):
        forces.JointInertia(joint, 1.0, 1)
