"""Servos: closed forms within and at their limits, lines of torque over speed, targets that are set."""

import math

import pytest
from scipy.integrate import solve_ivp

import carom
from carom import GROUND, forces, joints
from verified import agree, verifies

TOLERANCES = 1e-6, 1e-10
I = 0.2


def wheel(spin=0.0, gravity=(0, 0, 0)):
    scene = carom.Scene(gravity=gravity)
    body = scene.add_body(mass=1.0, inertia=(I, I, I), angular_velocity=(0, 0, spin), name="wheel")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, body, name="axle")
    return scene


@verifies(
    "forces.PositionServo",
    r"$q = q_0 (1 - e^{-dt}(\cos\omega t + \tfrac d\omega \sin\omega t))$",
    "closed form",
)
@pytest.mark.parametrize("rtol", TOLERANCES)
def test_a_servo_swings_as_a_damped_spring(rtol):
    # q = target (1 - exp(-d t)(cos w t + d/w sin w t)), d = kd/2I, w^2 = kp/I - d^2
    kp, kd, target, t = 8.0, 0.4, 0.7, 2.0
    scene = wheel()
    scene.add_force(forces.PositionServo("axle", kp=kp, kd=kd, target=target), name="servo")
    run = carom.simulate(scene, t, rtol=rtol)
    d = kd / (2 * I)
    w = math.sqrt(kp / I - d * d)
    q = target * (1 - math.exp(-d * t) * (math.cos(w * t) + d / w * math.sin(w * t)))
    agree(run["axle"].coordinate[-1], q, atol=30 * rtol)
    agree(run.ledger.residual, 0.0, atol=30 * rtol)


def own(law, t, start=(0.0, 0.0), events=()):
    """Angle and rate of the wheel under a law of both, by SciPy."""
    run = solve_ivp(
        lambda _, y: [y[1], law(*y) / I],
        (0, t),
        start,
        "DOP853",
        rtol=1e-12,
        atol=1e-13,
        max_step=1e-3,
    )
    return run.y[:, -1]


@verifies("forces.PositionServo", "limit and line of torque over speed", "own integration: SciPy")
@pytest.mark.parametrize("rtol", TOLERANCES)
def test_a_limit_and_a_line_of_torque_over_speed(rtol):
    kp, kd, target, limit, idle, t = 40.0, 2.0, 2.0, 1.5, 6.0, 1.5
    scene = wheel(-1.0)
    scene.add_force(
        forces.PositionServo("axle", kp=kp, kd=kd, target=target, limit=limit, no_load=idle),
        name="servo",
    )
    run = carom.simulate(scene, t, rtol=rtol)

    def law(q, v):
        low, high = -limit * (1 + v / idle), limit * (1 - v / idle)
        return min(max(kp * (target - q) - kd * v, low), high)

    q, v = own(law, t, (0.0, -1.0))
    # two kinks, at which the method is of order 1 to 2 within the tolerance; measured 2e-8, 5e-12
    agree(run["axle"].coordinate[-1], q, atol=10 * rtol + 1e-9)
    agree(run["axle"].rate[-1], v, atol=30 * rtol + 1e-9)
    torque, rate = run["servo"].torque, run["axle"].rate
    agree(torque[1], limit * (1 - rate[1] / idle), rtol=1e-12)
    agree(run.ledger.residual, 0.0, atol=100 * rtol)


@verifies(
    "forces.VelocityServo", r"$I\dot v$ = limit, then $v_0 - v \propto e^{-k t/I}$", "closed form"
)
@pytest.mark.parametrize("rtol", TOLERANCES)
def test_a_velocity_servo_at_its_limit(rtol):
    # I v' = limit up to v = target - limit/kv, then target - v falls by exp(-kv t/I)
    kv, target, limit, t = 2.0, 5.0, 1.0, 1.5
    scene = wheel()
    scene.add_force(forces.VelocityServo("axle", kv=kv, target=target, limit=limit))
    run = carom.simulate(scene, t, rtol=rtol)
    until = I * (target - limit / kv) / limit
    v = target - limit / kv * math.exp(-kv * (t - until) / I)
    agree(run["axle"].rate[-1], v, atol=30 * rtol)


def test_a_servo_is_an_actuator_of_its_numbers():
    scene, other = wheel(1.0), wheel(1.0)
    scene.add_force(forces.PositionServo("axle", kp=3.0, kd=0.2, target=0.4, limit=0.5))
    other.add_force(
        forces.Actuator(
            "axle", gain=3.0, bias=(0, -3.0, -0.2), control=0.4, force_range=(-0.5, 0.5)
        )
    )
    ends = [carom.simulate(one, 2.0)["axle"].coordinate[-1] for one in (scene, other)]
    assert ends[0] == ends[1]


def test_targets_are_set_and_kept():
    scene = wheel()
    scene.add_force(forces.PositionServo("axle", kp=20.0, kd=4.0, limit=3.0), name="servo")
    run = carom.Run(scene)
    run.advance(0.5)
    assert run.state["axle"].coordinate == 0.0
    run.ctrl["servo"] = 1.0
    run.advance(0.05)
    assert run.state["servo"].torque == pytest.approx(3.0)
    run.advance(4.0)
    solution = run.solution
    assert solution["axle"].coordinate[-1] == pytest.approx(1.0, abs=1e-4)
    assert solution["servo"].torque[2] == pytest.approx(3.0)
    run.reset()
    run.advance(0.5)
    assert run.state["axle"].coordinate == 0.0


def test_stiff_servos_are_rows_of_implicit_steps():
    scene = wheel()
    scene.add_force(forces.PositionServo("axle", kp=1e8, kd=1e5), name="servo")
    scene.add_force(forces.JointForce("axle", 10.0))
    # the potential that its steps damp out, 5e-6 J, has no name
    run = carom.simulate(scene, 1.0, step=0.01, method="implicit", throw=False)
    assert run["axle"].coordinate[-1] == pytest.approx(1e-7, rel=1e-6)


def test_a_line_needs_a_limit():
    with pytest.raises(ValueError, match="limit must be given with no_load"):
        forces.PositionServo("axle", kp=1.0, no_load=2.0)
