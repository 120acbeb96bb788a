"""Stops in joints: they strike with restitution, alone and in closed loops, are held, and let go."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints
from carom.geometry import quaternion
from verified import agree, verifies

EXACT = 1e-12


def sliding_block(restitution, **more):
    scene = carom.Scene()
    block = scene.add_body(mass=1, inertia=(1, 1, 1), position=(0, 0, 1), name="block")
    slide = scene.add_joint(joints.Prismatic((0, 0, 1)), GROUND, block)
    scene.add_stop(slide, lower=-1.0, restitution=restitution, **more)
    return scene


@verifies("add_stop", r"$t_n = t_1 (1 + 2\sum e^k)$, impulse $m (1 + e)\,e^n v_1$", "closed form")
@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_a_block_bounces_on_its_stop_as_a_ball_does(law):
    # t_n = t_1 (1 + 2 sum of e^k), impulse m (1 + e) e^n v_1: without friction all laws agree
    e, first = 0.8, np.sqrt(2 / 9.81)
    solution = carom.simulate(sliding_block(e, impact_law=law), 1.5, step=0.05)
    times = [first * (1 + 2 * sum(e**k for k in range(1, n + 1))) for n in range(2)]
    agree(solution.impacts.time, times, rtol=1e-13)
    assert solution.impacts[0].unit == "m/s"
    assert "rad/s" not in repr(solution.impacts)
    speed = 9.81 * first
    agree(solution.impacts.impulse[:, 0], [(1 + e) * speed, (1 + e) * e * speed], rtol=1e-12)
    agree(solution.impacts.energy_change[0], -0.5 * (1 - e * e) * speed**2, rtol=1e-7)
    assert np.min(solution.position[:, 0, 2]) > -1e-12


def test_bounces_end_and_the_stop_carries_the_weight():
    # e = 1/2: bounces end at t_1 (1 + e)/(1 - e) = 3 t_1
    solution = carom.simulate(sliding_block(0.5), 2.0, step=0.02)
    assert list(solution.events.kind)[-1] == "held"
    assert solution.events.time[-1] < 3 * np.sqrt(2 / 9.81)
    assert abs(solution.position[-1, 0, 2]) < 1e-14
    assert np.all(solution.velocity[-1] == 0.0)
    np.testing.assert_allclose(solution.contact_force[-1, 0], [9.81, 0, 0], rtol=1e-12)
    np.testing.assert_allclose(solution.joint_reactions[-1, 0], 0.0, atol=1e-12)


# the force jumps in a step of 20 ms: 7e-4 of the energy
def test_a_held_stop_lets_go_when_it_is_pulled():
    # a plastic stop holds the block from sqrt(2/g) on; a force 10 t lifts it off at t = .981
    scene = sliding_block(0.0)
    scene.add_force(
        forces.JointForce(scene.joints[0], lambda t, q, rate: 10.0 * t if t > 0.6 else 0.0)
    )
    solution = carom.simulate(scene, 1.5, step=0.02)
    kinds = list(solution.events.kind)
    assert kinds[-1] == "opens"
    assert solution.events.time[kinds.index("opens")] == pytest.approx(0.981, abs=1e-6)
    # from there z'' = 10 t - g: z = 10/6 (t^3 - s^3) - g/2 ... of s = t - .981: 10 s^3 / 6
    assert solution.position[-1, 0, 2] == pytest.approx(10 * (1.5 - 0.981) ** 3 / 6, abs=1e-6)


def rod_pendulum(restitution, h):
    """A rod released level, which strikes when it hangs down: w^2 = 3 g/l there."""
    scene = carom.Scene()
    rod = scene.add_body(mass=1, inertia=(1e-3, 1 / 12, 1 / 12), position=(0.5, 0, 0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, rod)
    scene.add_stop(hinge, upper=np.pi / 2, restitution=restitution)
    as_they_are = carom.Options(energy_tolerance=1.0)  # steps are not cut for what they lose
    return carom.simulate(scene, 1.0, step=h, options=as_they_are)


def test_a_turn_stops_with_order_4():
    errors = []
    for h in (0.04, 0.02, 0.01):
        impacts = rod_pendulum(0.8, h).impacts
        assert impacts.impulse[0, 0] == pytest.approx(
            -1.8 * impacts.relative_velocity_before[0, 0] / 3.0, rel=EXACT
        )
        errors.append(abs(impacts.relative_velocity_before[0, 0] + np.sqrt(3 * 9.81)))
        assert np.all(impacts.impulse[:, 1:] == 0.0)
        assert impacts[0].unit == "rad/s"
        assert " rad/s  dE" in repr(impacts)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.5)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4.0, abs=0.5)
    assert errors[-1] < 1e-6


def four_bar(restitution=0.6):
    """A parallelogram of rods of 1 m and 1 kg, hinges spatial (redundant), with a stop in the third."""
    scene = carom.Scene(gravity=(0, -9.81, 0))
    about = np.array([0.0, 0.0, 1.0])
    middles = np.array([[0.0, 0.5, 0.0], [0.5, 1.0, 0.0], [1.0, 0.5, 0.0]])
    speeds = np.array([[0.5, 0, 0], [1.0, 0, 0], [0.5, 0, 0]])
    spins = np.array([-1.0, 0.0, -1.0])
    upright = (1 / 12, 1e-3, 1 / 12)
    level = (1e-3, 1 / 12, 1 / 12)
    bars = [
        scene.add_body(
            mass=1, inertia=upright if k != 1 else level, position=middles[k], velocity=speeds[k],
            angular_velocity=spins[k] * about,
        )
        for k in range(3)
    ]  # fmt: skip
    scene.add_joint(joints.Revolute((0, 0, 0), about), GROUND, bars[0])
    scene.add_joint(joints.Revolute((0, 1, 0), about), bars[0], bars[1])
    third = scene.add_joint(joints.Revolute((1, 1, 0), about), bars[1], bars[2])
    scene.add_joint(joints.Revolute((1, 0, 0), about), GROUND, bars[2])
    scene.add_stop(third, lower=-1.2, restitution=restitution)
    return scene


@verifies(
    "add_stop",
    r"in a closed loop: $\dot a^2 = \tfrac65 (\tfrac56 + 2 g (1 - \cos a))$, $W = \tfrac35$",
    "closed form",
)
def test_a_closed_loop_strikes_a_stop_in_one_of_its_joints():
    # one freedom, the angle a of the bars: 5/3 a'^2/2 = energy; the stop sees a' itself, W = 1/(5/3)
    solution = carom.simulate(four_bar(), 3.0, step=0.005)
    impacts, ledger = solution.impacts, solution.ledger
    assert len(impacts) > 3
    W = impacts.inverse_mass[:, 0, 0]
    agree(W, 0.6, rtol=1e-9)
    u = impacts.relative_velocity_before[:, 0]
    agree(impacts.relative_velocity_after[:, 0], -0.6 * u, rtol=EXACT)
    agree(impacts.energy_change, -0.5 * (1 - 0.36) * u**2 / W, rtol=1e-9)
    # the angle at the stop is located, and energy tells the speed: 2 g (1 - cos 1.2) + 5/6
    speed = np.sqrt((5 / 6 + 2 * 9.81 * (1 - np.cos(1.2))) * 6 / 5)
    agree(-u[0], speed, rtol=1e-8)
    position, velocity = solution.constraint_errors
    assert max(position.max(), velocity.max()) < 1e-12
    agree(ledger.residual, 0.0, atol=1e-7)  # of the steps, order 4
    # the blow turns all bars: those on the ground by the same, the coupler not at all
    after = solution.evaluate(impacts.time[0])[3]
    before = solution.evaluate(impacts.time[0], side="left")[3]
    change = (after - before)[:, 2]
    agree(change, [1.6 * speed, 0, 1.6 * speed], rtol=1e-7, atol=1e-9)


def test_the_ledger_closes_through_the_impacts_of_a_loop():
    residuals = []
    for h in (0.008, 0.004):
        ledger = carom.simulate(four_bar(), 1.2, step=h, method="rk8").ledger
        residuals.append(np.max(np.abs(ledger.residual)))
    assert min(residuals) < 1e-9


def test_a_motor_works_in_an_impact():
    # a motor turns an arm at 3 rad/s for good; the arm meets the flap (I = .3) that it carries: e = .5
    scene = carom.Scene(gravity=(0, 0, 0))
    arm = scene.add_body(mass=1, inertia=(1, 1, 0.5), angular_velocity=(0, 0, 3.0))
    flap = scene.add_body(mass=1, inertia=(1, 1, 0.3), angular_velocity=(0, 0, 1.0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, arm)
    inner = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), arm, flap)
    scene.add_constraint(constraints.Driver(hinge, rate=3.0))
    scene.add_stop(inner, lower=-1.0, restitution=0.5)
    solution = carom.simulate(scene, 1.0, step=0.05)
    # relative speed -2, after +1: the flap goes from 1 to 4, the motor keeps the arm at 3
    np.testing.assert_allclose(solution.angular_velocity[-1, :, 2], [3.0, 4.0], rtol=1e-12)
    assert solution.impacts.time[0] == pytest.approx(0.5, rel=1e-8)  # turns are of order 4
    # impulse .3 * 3; the stop takes 1/2 (1 - e^2) 4 .3, the motor gives .9 * 3
    assert solution.impacts.impulse[0, 0] == pytest.approx(0.9, rel=1e-12)
    assert solution.ledger.impacts[-1] == pytest.approx(-0.45, rel=1e-12)
    assert solution.ledger.loads[-1] == pytest.approx(2.7, rel=1e-12)
    assert abs(solution.ledger.residual[-1]) < 1e-12


@verifies("add_stop(coordinate=)", r"strikes at $t = q/\omega$", "closed form")
def test_the_second_angle_of_a_universal_joint_stops():
    # measured from the child, with the ground as parent
    scene = carom.Scene(gravity=(0, 0, 0))
    cross = scene.add_body(mass=1, inertia=(1, 1, 1), angular_velocity=(0, 2.0, 0))
    joint = scene.add_joint(joints.Universal((0, 0, 0), (1, 0, 0), (0, 1, 0)), GROUND, cross)
    scene.add_stop(joint, upper=0.5, restitution=1.0, coordinate=1)
    scene.add_stop(joint, lower=-0.5, restitution=1.0, coordinate=1)
    solution = carom.simulate(scene, 1.0, step=0.02)
    agree(solution.impacts.time, [0.25, 0.75], rtol=1e-9)
    assert [int(c) for c in solution.impacts.contact] == [0, 1]
    q, _ = solution.joint_coordinates(joint)
    agree(q[-1, 1], 0.0, atol=1e-9)


def rod_over_a_floor(stop, friction=0.0):
    """A hinged rod whose lower corners meet the floor when it has turned by `level`; a stop near there."""
    # sin a + 1e-3 cos a = sqrt(1/2), the corners 1 m along and 1 mm below the hinge
    level = np.arcsin(np.sqrt(0.5) / np.hypot(1.0, 1e-3)) - np.arctan(1e-3)
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, -np.sqrt(0.5)), (0, 0, 1))
    corners = [[x, y, z] for x in (-0.5, 0.5) for y in (-0.1, 0.1) for z in (-1e-3, 1e-3)]
    rod = scene.add_body(carom.Convex(corners), mass=1, position=(0.5, 0, 0))
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, rod)
    scene.add_contact(rod, floor, restitution=0.5, friction=friction)
    if stop is not None:
        scene.add_stop(hinge, upper=level + stop, restitution=0.5)
    return carom.simulate(scene, 0.6, step=0.01)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_stop_and_a_floor_strike_together(friction):
    # two corners and the stop close at once: with the same e the rod goes back with half its speed
    solution = rod_over_a_floor(0.0, friction)
    impacts = solution.impacts
    assert sorted(impacts.contact[:3]) == [0, 0, 1]
    assert np.all(impacts.together[:3] == 3)
    t = impacts.time[0]
    before, after = solution.evaluate(t, side="left")[3][0, 1], solution.evaluate(t)[3][0, 1]
    assert after == pytest.approx(-0.5 * before, rel=1e-9)
    assert np.max(np.abs(solution.ledger.residual)) < 1e-6  # of the steps, order 4


def test_a_stop_that_is_not_reached_changes_nothing():
    with_stop, without = rod_over_a_floor(0.5), rod_over_a_floor(None)
    np.testing.assert_allclose(with_stop.impacts.time, without.impacts.time, rtol=1e-12)
    np.testing.assert_allclose(with_stop.position, without.position, atol=1e-12)


def test_stops_look_the_same_from_another_frame():
    axis = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
    turn = quaternion.exp(1.1 * axis)

    def scene_of(Q):
        def world(a):
            return quaternion.rotate(Q, np.array(a, dtype=float))

        scene = carom.Scene(gravity=world([0, 0, -9.81]))
        one = scene.add_body(
            mass=1, inertia=(0.1, 0.2, 0.25), position=world([0.5, 0, 0]), orientation=Q
        )
        two = scene.add_body(
            mass=0.5, inertia=(0.1, 0.12, 0.05), position=world([1.4, 0, 0]), orientation=Q
        )
        scene.add_joint(joints.Revolute(world([0, 0, 0]), world([0, 1, 0])), GROUND, one)
        inner = scene.add_joint(joints.Revolute(world([1, 0, 0]), world([0, 1, 0])), one, two)
        scene.add_stop(inner, upper=0.4, restitution=0.7)
        scene.add_stop(inner, lower=-0.4, restitution=0.7)
        return scene

    here = carom.simulate(scene_of(np.array([1.0, 0, 0, 0])), 1.6, step=0.01)
    there = carom.simulate(scene_of(turn), 1.6, step=0.01)
    assert len(here.impacts) > 1
    np.testing.assert_allclose(here.impacts.time, there.impacts.time, rtol=1e-9)
    np.testing.assert_allclose(
        quaternion.rotate(turn, here.position[-1]), there.position[-1], atol=1e-9
    )
    np.testing.assert_allclose(here.impacts.impulse, there.impacts.impulse, atol=1e-9)


def test_bad_stops_are_refused():
    scene = sliding_block(0.5)
    joint = scene.joints[0]
    with pytest.raises(ValueError, match="lower or upper must be given"):
        scene.add_stop(joint)
    with pytest.raises(ValueError, match="restitution"):
        scene.add_stop(joint, lower=0.0, restitution=1.5)
    with pytest.raises(ValueError, match="coordinate must be below 1"):
        scene.add_stop(joint, lower=0.0, coordinate=1)
    with pytest.raises(ValueError, match='must be "locate" if joints have stops'):
        carom.simulate(scene, 1.0, step=0.1, impact_location="project")
    scene.add_stop(joint, lower=0.5, name="passed")
    with pytest.raises(ValueError, match=r"stop 'passed' .* must not be exceeded at the start"):
        carom.simulate(scene, 1.0, step=0.1)
