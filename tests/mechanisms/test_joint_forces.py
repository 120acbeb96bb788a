"""Springs, dampers, motors and dry friction along coordinates; springs by curves; forces of the user's."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import carom
from carom import GROUND, forces, joints
from verified import agree, verifies


def block(speed=0.0, mass=1.0):
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=mass, inertia=(1, 1, 1), velocity=(speed, 0, 0), name="block")
    return scene, scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body)


def wheel(spin):
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1, inertia=(0.1, 0.1, 0.2), angular_velocity=(0, 0, spin))
    return scene, scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, body)


def test_a_clock_spring_counts_turns():
    # q = w/f sin(f t), f = sqrt(k/I) = 1: more than three turns each way, order 4
    errors = []
    for h in (
        0.0125,
        0.00625,
        0.003125,
    ):  # turns of less than .3 rad: longer ones are made in parts
        scene, joint = wheel(20.0)
        scene.add_force(forces.JointSpring(joint, stiffness=0.2))
        solution = carom.simulate(scene, 10.0, step=h)
        q, _ = solution.joint_coordinates(joint)
        assert np.max(q) > 19.9
        errors.append(np.max(np.abs(q[:, 0] - 20.0 * np.sin(solution.t))))
        assert (
            np.max(np.abs(solution.total_energy - solution.total_energy[0])) < 0.5 * errors[-1] * 8
        )
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.4)
    assert errors[-1] < 2e-3


@verifies("forces.JointSpring", r"$m\ddot q + c\dot q + k q = \sin t$", "closed form")
@verifies("forces.JointForce", r"$m\ddot q + c\dot q + k q = \sin t$", "closed form")
def test_a_damped_spring_with_a_motor_closes_the_ledger():
    # m q'' + c q' + k q = sin t: q by its particular and free parts
    m, c, k = 2.0, 0.4, 2.0
    for push in (lambda t, q, rate: np.sin(t), numba.njit(lambda t, q, rate: np.sin(t))):
        scene, joint = block(mass=m)
        scene.add_force(forces.JointSpring(joint, stiffness=k, damping=c))
        scene.add_force(forces.JointForce(joint, push))
        solution = carom.simulate(scene, 3.0, step=0.01)
        # k = m: the particular solution is -cos(t)/c, the free one cancels it at the start
        s, w = c / (2 * m), np.sqrt(k / m - (c / (2 * m)) ** 2)
        t = solution.t
        free = np.exp(-s * t) * (np.cos(w * t) + s / w * np.sin(w * t)) / c
        agree(solution.position[:, 0, 0], free - np.cos(t) / c, atol=1e-9)
        agree(solution.ledger.residual[-1], 0.0, atol=1e-10)


def test_a_constant_force_and_its_opposite_on_the_parent():
    scene = carom.Scene(gravity=(0, 0, 0))
    one = scene.add_body(mass=1, inertia=(1, 1, 1))
    two = scene.add_body(mass=3, inertia=(1, 1, 1), position=(1, 0, 0))
    joint = scene.add_joint(joints.Prismatic((1, 0, 0)), one, two)
    scene.add_force(forces.JointForce(joint, 6.0))
    solution = carom.simulate(scene, 1.0, step=0.1)
    np.testing.assert_allclose(solution.velocity[-1, :, 0], [-6.0, 2.0], rtol=1e-13)
    assert solution.ledger.loads[-1] == pytest.approx(0.5 * 36 + 1.5 * 4, rel=1e-12)


@verifies("forces.CurveSpring", r"energy $\tfrac34 (l - 1)^4 + \tfrac12 (l - 1)^2$", "closed form")
def test_a_spring_with_a_curve():
    # tension 3 (l - 1)^3 + (l - 1): a spline of degree 3 has it exactly, and its energy
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1, inertia=(1, 1, 1), position=(1.7, 0, 0))
    length = np.linspace(0.2, 3.0, 6)
    tension = CubicSpline(length, 3 * (length - 1) ** 3 + (length - 1))
    scene.add_force(forces.CurveSpring((0, 0, 0), (1.7, 0, 0), tension), GROUND, body)
    solution = carom.simulate(scene, 2.5, step=0.005)
    assert np.min(solution.position[:, 0, 0]) < 0.301

    def energy(l):
        return 0.75 * (l - 1) ** 4 + 0.5 * (l - 1) ** 2

    x = solution.position[:, 0, 0]
    gained = solution.potential_energy - solution.potential_energy[0]
    agree(gained, energy(x) - energy(1.7), atol=1e-12)
    agree(solution.total_energy, solution.total_energy[0], atol=1e-8)


def test_points_of_a_curve_are_joined_monotonously():
    spring = forces.CurveSpring((0, 0, 0), (1, 0, 0), ([0.0, 1.0, 1.1, 3.0], [0.0, 0.0, 5.0, 5.0]))
    x = np.linspace(0.0, 3.0, 301)
    assert np.all(np.diff(spring.tension(x)) >= 0.0)
    with pytest.raises(ValueError, match="each above the one before"):
        forces.CurveSpring((0, 0, 0), (1, 0, 0), ([0.0, 0.0], [1.0, 2.0]))


def attraction(t, states):
    d = states[1, :3] - states[0, :3]
    out = np.zeros((2, 6))
    r = np.sqrt(d @ d)
    out[0, :3], out[1, :3] = d / r**3, -d / r**3
    return out


def potential(t, states):
    d = states[1, :3] - states[0, :3]
    return -1.0 / np.sqrt(d @ d)


@verifies("forces.UserForce", r"attraction $1/r^2$: a circle with $\omega^2 = 2$", "closed form")
@pytest.mark.parametrize("compiled", [False, True])
def test_a_force_of_the_user_between_two_bodies(compiled):
    # a circle about the common centre: r = 1, w^2 = 2 (masses 1, attraction 1/r^2)
    force = numba.njit(attraction) if compiled else attraction
    energy = None if compiled else potential
    w = np.sqrt(2.0)
    scene = carom.Scene(gravity=(0, 0, 0))
    pair = [
        scene.add_body(
            mass=1, inertia=(1, 2, 3), position=(s * 0.5, 0, 0), velocity=(0, s * 0.5 * w, 0),
            orientation=(0.8, 0, 0.6, 0),
        )
        for s in (-1.0, 1.0)
    ]  # fmt: skip
    scene.add_force(forces.UserForce(pair, force, energy))
    solution = carom.simulate(scene, 2.0, step=0.01)
    turn = w * solution.t
    expected = 0.5 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    agree(solution.position[:, 1, :2], expected, atol=1e-8)
    agree(solution.velocity.sum(axis=1), 0.0, atol=1e-14)
    if energy is not None:
        agree(solution.potential_energy, -1.0, atol=1e-8)
        assert np.all(solution.ledger.loads == 0.0)
    agree(solution.ledger.residual[-1], 0.0, atol=1e-8)


def test_the_user_sees_the_axes_of_the_scene():
    # principal axes that are not those of the body: the function is given the latter
    seen = []

    def look(t, states):
        seen.append(states[0, 3:7].copy())
        return np.zeros((1, 6))

    turn = np.array([0.8, 0.0, 0.6, 0.0])
    inertia = [[2.0, 0.5, 0.0], [0.5, 1.5, 0.0], [0.0, 0.0, 2.0]]
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1, inertia=inertia, orientation=turn)
    scene.add_force(forces.UserForce(body, look))
    carom.simulate(scene, 0.1, step=0.1)
    assert abs(seen[0] @ turn) == pytest.approx(1.0, abs=1e-14)


def test_friction_brakes_a_block_and_holds_it():
    # x = v^2 m/(2 F), stopped at v m/F = 1.5 s for good
    scene, joint = block(speed=3.0)
    scene.add_force(forces.JointFriction(joint, 2.0))
    solution = carom.simulate(scene, 2.0, step=0.07)
    assert solution.position[-1, 0, 0] == pytest.approx(2.25, rel=1e-14)
    assert np.all(solution.velocity[-1] == 0.0)
    assert solution.ledger.friction[-1] == pytest.approx(-4.5, rel=1e-13)


def test_friction_of_no_force_is_none():
    found = []
    for bound in ((), (0.0,)):
        scene, joint = block(speed=3.0)
        scene.add_stop(joint, upper=1.0, restitution=0.5)
        for one in bound:
            scene.add_force(forces.JointFriction(joint, one), name="friction")
        solution = carom.simulate(scene, 1.0)
        found.append(solution.position)
    assert np.array_equal(*found)
    assert np.all(solution["friction"].force == 0.0)


def test_a_spring_with_dry_friction_loses_as_much_each_half_swing():
    # k = 10, F = 2, from -1.03: turning points lie 2 F/k = .4 nearer each time, until |k x| <= F
    errors = []
    for h in (0.04, 0.02):
        scene, joint = block()
        scene.add_force(forces.JointSpring(joint, stiffness=10.0, rest=-1.03))
        scene.add_force(forces.JointFriction(joint, 2.0))
        solution = carom.simulate(scene, 4.0, step=h)
        x = solution.position[-1, 0, 0] + 1.03
        errors.append(abs(x - (0.4 * 3 - 1.03)))  # 1.03, -.63, .23, .17
        assert np.all(np.abs(solution.velocity[-1]) < 1e-12)
    assert errors[1] < 1e-6
    assert np.log2(errors[0] / errors[1]) > 3.5


def arm(bounds, duration, h):
    scene = carom.Scene()
    one, two = (
        scene.add_body(mass=1, inertia=(0.01, 1 / 12, 1 / 12), position=(x, 0, 0))
        for x in (0.5, 1.5)
    )
    first = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, one)
    second = scene.add_joint(joints.Revolute((1, 0, 0), (0, 1, 0)), one, two)
    for joint, bound in zip((first, second), bounds):
        scene.add_force(forces.JointFriction(joint, bound))
    return carom.simulate(scene, duration, step=h)


def test_an_arm_sticks_in_both_joints_or_in_one():
    # the moments of a level arm: 2 m g l = 19.62 at the root, m g l/2 = 4.905 at the elbow
    stays = arm((19.7, 4.95), 0.5, 0.05)
    assert np.max(np.abs(stays.position - stays.position[0])) < 1e-14
    # with a free elbow's bound above what the fall asks of it the arm falls as one rod of 2 m: 3/2 g/l
    falls = arm((0.0, 4.95), 0.1, 0.01)
    q, _ = falls.joint_coordinates("joint2")
    assert np.max(np.abs(q)) < 1e-9
    rate = falls.angular_velocity[1, 0, 1] / 0.01
    assert rate == pytest.approx(1.5 * 9.81 / 2.0, rel=1e-4)


def test_friction_in_an_arm_comes_to_rest_and_closes_the_ledger():
    solution = arm((3.0, 1.0), 8.0, 0.005)
    assert np.max(np.abs(solution.velocity[-1])) < 1e-10
    assert abs(solution.ledger.residual[-1]) < 1e-6 * abs(solution.ledger.friction[-1])
    lost = solution.total_energy[-1] - solution.total_energy[0]
    assert solution.ledger.friction[-1] == pytest.approx(lost, rel=1e-6)


def test_slip_turns_where_a_loop_passes_its_dead_centres():
    # A crank (r = .1 m) turns a slider on a dry way by a rod of .3 m, which sees its own way end, twice a turn,
    # where the crank is in line with it. Friction can do nothing there (J P J^T = 0), and slip turns: work of
    # friction is -F times the way of the slider, here 3 whole turns and more. The last bit of a passage, of the
    # order of F times what the slider goes in the time to which its turn is located, is all that is off.
    scene, force = carom.Scene(gravity=(0, 0, 0)), 0.5
    spin, inertia = 20.0, (1e-3, 0.05, 0.05)
    crank = scene.add_body(
        mass=1.0, inertia=inertia, position=(0, 0, 0), angular_velocity=(0, 0, spin), name="crank"
    )
    along = np.sqrt(0.3**2 - 0.1**2)
    rod = scene.add_body(
        mass=0.2, inertia=(1e-4, 1e-3, 1e-3), position=(0.5 * along, 0.05, 0), velocity=(-2, 0, 0)
    )
    slider = scene.add_body(
        mass=0.5, inertia=(1e-3,) * 3, position=(along, 0, 0), velocity=(-2, 0, 0)
    )
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, crank)
    scene.add_joint(joints.Revolute((0, 0.1, 0), (0, 0, 1)), crank, rod)
    scene.add_joint(joints.Revolute((along, 0, 0), (0, 0, 1)), rod, slider)
    way = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, slider)
    scene.add_force(forces.JointFriction(way, force))
    solution = carom.simulate(scene, 1.5, step=5e-4)
    x = solution.position[:, 2, 0]
    # in the step of a dead centre it goes to .4 or .2 m, where crank and rod are in line, and back
    rate = solution.velocity[:, 2, 0]
    turned = rate[:-1] * rate[1:] < 0.0
    assert np.count_nonzero(turned) >= 6
    assert solution.stats["whole_steps"] == 0
    dead = np.where(rate[:-1] > 0.0, 0.3 + 0.1, 0.3 - 0.1)
    passed = np.abs(dead - x[:-1]) + np.abs(dead - x[1:])
    way_gone = np.sum(np.where(turned, passed, np.abs(np.diff(x))))
    assert solution.ledger.friction[-1] == pytest.approx(-force * way_gone, rel=1e-9)
    assert np.max(np.abs(solution.ledger.residual)) < 1e-8 * solution.kinetic_energy[0]


def test_forces_that_name_their_joint_take_no_bodies():
    scene, joint = block()
    with pytest.raises(ValueError, match="parent and child must be left out"):
        scene.add_force(forces.JointSpring(joint, stiffness=1.0), scene["block"])
    with pytest.raises(ValueError, match="bound"):
        forces.JointFriction(joint, -1.0)
    with pytest.raises(ValueError, match="coordinate must be below 1"):
        forces.JointForce(joint, 1.0, coordinate=2)
    _, foreign = block()
    with pytest.raises(ValueError, match="must belong to this scene"):
        scene.add_force(forces.JointFriction(foreign, 1.0))
    with pytest.raises(TypeError, match="function must be a function"):
        forces.UserForce(scene["block"], "pull")  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("contact", [False, True])
def test_a_clock_spring_that_turns_far_in_a_step(contact):
    # q'' = -w^2 q from q = 0, q' = 2000: q = 2000/w sin(w t), 40 rad there and back, 10 rad in a step; the
    # energy of the spring is k q^2/2 with all turns, at each saved time.
    w, rate, inertia = 50.0, 2000.0, 1e-4
    scene = carom.Scene(gravity=(0, 0, 0))
    wheel = scene.add_body(
        carom.Sphere(0.1), mass=1.0, inertia=(inertia,) * 3, angular_velocity=(0, 0, rate)
    )
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), carom.GROUND, wheel)
    scene.add_force(forces.JointSpring(hinge, inertia * w * w))
    if contact:
        floor = scene.add_half_space((0, 0, -1), (0, 0, 1))
        scene.add_contact(wheel, floor, friction=0)
    s = carom.simulate(scene, 0.2, step=5e-3)
    # order 4 in parts of 0.3 rad: 2e-6 of the angle at the end
    q = rate / w * np.sin(w * s.t)
    energy = 0.5 * inertia * rate**2
    assert s.potential_energy == pytest.approx(0.5 * inertia * w * w * q * q, abs=1e-5 * energy)
    assert s.angular_velocity[:, 0, 2] == pytest.approx(rate * np.cos(w * s.t), abs=1e-5 * rate)
    assert np.max(np.abs(s.ledger.residual)) < 1e-6 * energy


def axles(spins=(1.0, 0.0)):
    scene = carom.Scene(gravity=(0, 0, 0))
    for name, x, spin, inertia in zip("ab", (0.0, 1.0), spins, (0.2, 0.5)):
        body = scene.add_body(
            mass=1, inertia=(inertia,) * 3, position=(x, 0, 0), angular_velocity=(0, 0, spin)
        )
        scene.add_joint(joints.Revolute((x, 0, 0), (0, 0, 1)), GROUND, body, name=name)
    return scene


@verifies("forces.JointSpring", r"$\ddot s = -(k s + c\dot s)(1/I_a + 4/I_b)$", "closed form")
@pytest.mark.parametrize(
    "how", [{"rtol": 1e-10}, {"method": "implicit", "step": 1e-3}, {"step": 1e-3, "method": "rk4"}]
)
def test_a_spring_along_a_sum(how):
    """s = a - 2 b: s'' = -(k s + c s')(1/I_a + 4/I_b), and the angular momentum 2 I_a a' + I_b b' stays."""
    scene, k, c = axles(), 30.0, 0.4
    scene.add_force(forces.JointSpring({"a": 1.0, "b": -2.0}, k, c), name="shaft")
    s = carom.simulate(scene, 1.0, **how)
    ease = 1 / 0.2 + 4 / 0.5
    damping, f = 0.5 * c * ease, np.sqrt(k * ease - (0.5 * c * ease) ** 2)
    known = np.exp(-damping * s.t) * np.sin(f * s.t) / f
    error = 1e-9 if "rtol" in how else 1e-5
    agree(s["shaft"].coordinate, known, atol=error)
    agree(s["a"].coordinate - 2 * s["b"].coordinate, known, atol=error)
    agree(2 * 0.2 * s["a"].rate + 0.5 * s["b"].rate, 0.4, atol=1e-12)
    agree(s["shaft"].torque, -k * known - c * s["shaft"].rate, atol=1e3 * error)


def test_a_servo_along_a_sum():
    """It brings a + b to its target, with at most its limit."""
    scene = axles((0.0, 0.0))
    servo = forces.PositionServo({"a": 1.0, "b": 1.0}, kp=2.0, kd=1.0, limit=0.5, target=1.0)
    scene.add_force(servo, name="servo")
    s = carom.simulate(scene, 20.0, rtol=1e-9)
    assert s["servo"].coordinate[-1] == pytest.approx(1.0, abs=1e-6)
    assert np.abs(s["servo"].torque).max() == pytest.approx(0.5, abs=1e-12)
    early = s.t < 0.3  # at the limit
    np.testing.assert_allclose(
        s["a"].coordinate[early], 0.5 * 0.5 / 0.2 * s.t[early] ** 2, atol=1e-9
    )


@verifies("forces.Actuator", "a constant torque along a sum of coordinates", "closed form")
def test_a_control_along_a_sum():
    """A run sets it; the model-free actuator is listed with its length, the sum times its gear."""
    scene = axles((0.0, 0.0))
    scene.add_force(forces.Actuator({"a": 1.0, "b": 3.0}, gear=2.0), name="motor")
    run = carom.Run(scene, step=1e-2)
    run.ctrl["motor"] = 0.1
    run.advance(1.0)
    state = run.state
    agree(state["motor"].torque, 0.2, rtol=1e-6)
    agree(state["a"].rate, 0.2 / 0.2, atol=1e-12)
    agree(state["b"].rate, 0.6 / 0.5, atol=1e-12)
