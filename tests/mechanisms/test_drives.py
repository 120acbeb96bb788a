"""Motors with a limit: closed forms, integrations of one's own, and what is left by the ledger."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from carom import GROUND, constraints, forces, joints
from verified import agree, verifies

TOLERANCES = 1e-6, 1e-10
I, G = 0.2, 9.81


def wheel(spin=0.0):
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1.0, inertia=(I, I, I), angular_velocity=(0, 0, spin), name="wheel")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, body, name="axle")
    return scene


def closes(solution, scale, rtol):
    """Whether a run is a success and its energy has names, up to ten times its tolerance."""
    assert solution.status is carom.Status.SUCCESS
    assert not solution.warnings
    assert np.abs(solution.ledger.residual).max() <= max(10.0 * rtol, 1e-13) * scale


@verifies(
    "constraints.Driver",
    r"$I\dot\omega = M$ up to its rate; half of the work is heat",
    "closed form",
)
@pytest.mark.parametrize("rtol", TOLERANCES)
@pytest.mark.parametrize("way", [1, -1])
def test_a_start_takes_the_limit_and_its_heat_is_half_of_the_work(rtol, way):
    # I w' = M until w is the rate: t = I rate/M; work M rate t, one half of it is heat.
    rate, limit = 3.0 * way, 0.5
    scene = wheel()
    scene.add_constraint(constraints.Driver("axle", rate=rate, limit=limit), name="motor")
    run = carom.simulate(scene, 2.0, rtol=rtol)
    t = I * abs(rate) / limit
    closes(run, 1.0, rtol)
    agree(run.angular_velocity[-1, 0, 2], rate, atol=1e-14)
    agree(run["axle"].coordinate[-1], rate * (2.0 - 0.5 * t), atol=1e-12)
    agree(run.ledger.loads[-1], limit * abs(rate) * t, atol=1e-12)
    agree(run.ledger.friction[-1], -0.5 * I * rate**2, atol=1e-12)
    torque = run["motor"].torque
    agree(torque[1], limit * way, atol=1e-14)
    agree(torque[-1], 0.0, atol=1e-9)


@pytest.mark.parametrize("rtol", TOLERANCES)
def test_a_load_that_grows_is_held_up_to_the_limit(rtol):
    # a load -a t is held until it is the limit M; from there I w' = M - a t.
    rate, limit, slope, end = 3.0, 0.5, 0.8, 1.5
    scene = wheel(rate)
    scene.add_constraint(constraints.Driver("axle", rate=rate, limit=limit), name="motor")
    scene.add_force(forces.JointForce("axle", lambda t, q, v: -slope * t))
    run = carom.simulate(scene, end, rtol=rtol)
    t = limit / slope
    w = rate + (limit * (end - t) - 0.5 * slope * (end**2 - t**2)) / I
    closes(run, 1.0, rtol)
    assert run.angular_velocity[-1, 0, 2] == pytest.approx(w, abs=30.0 * rtol)
    early = run.t < t - 1e-3
    assert np.all(np.abs(run.angular_velocity[early, 0, 2] - rate) < 1e-14)
    np.testing.assert_allclose(run["motor"].torque[early], slope * run.t[early], atol=1e-9)
    assert run["motor"].torque[-1] == pytest.approx(limit)


def test_a_brake_is_friction_in_the_joint_bit_for_bit():
    scene, same = wheel(3.0), wheel(3.0)
    scene.add_constraint(constraints.Driver("axle", rate=0.0, limit=0.5))
    same.add_force(forces.JointFriction("axle", 0.5))
    run, other = (carom.simulate(one, 2.0) for one in (scene, same))
    assert np.array_equal(run.t, other.t)
    assert np.array_equal(run.angular_velocity, other.angular_velocity)
    assert run.ledger.friction[-1] == pytest.approx(-0.5 * I * 9.0, abs=1e-13)


@pytest.mark.parametrize("rtol", TOLERANCES)
def test_a_motor_between_two_bodies_keeps_momentum(rtol):
    # Reduced inertia: relative spin grows by M (1/I_a + 1/I_b), heat half of it times the rate squared.
    scene = carom.Scene(gravity=(0, 0, 0))
    for name, inertia in (("a", 0.3), ("b", 0.1)):
        scene.add_body(mass=1.0, inertia=(inertia,) * 3, name=name)
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), "a", "b", name="axle")
    rate, limit = 4.0, 0.2
    scene.add_constraint(constraints.Driver("axle", rate=rate, limit=limit))
    run = carom.simulate(scene, 3.0, rtol=rtol)
    reduced = 0.3 * 0.1 / 0.4
    closes(run, 1.0, rtol)
    assert run["axle"].rate[-1] == pytest.approx(rate, abs=1e-13)
    assert run["axle"].coordinate[-1] == pytest.approx(
        rate * (3.0 - 0.5 * reduced * rate / limit), abs=1e-11
    )
    spin = 0.3 * run.angular_velocity[:, 0, 2] + 0.1 * run.angular_velocity[:, 1, 2]
    assert np.abs(spin).max() < 1e-14
    assert run.ledger.friction[-1] == pytest.approx(-0.5 * reduced * rate**2, abs=1e-12)


def pendulum(rate, limit):
    scene = carom.Scene(gravity=(0, 0, -G))
    bob = scene.add_body(mass=1.0, inertia=(0.1, 0.1, 0.1), position=(0, 0, -0.5))
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, bob, name="hinge")
    scene.add_constraint(constraints.Driver("hinge", rate=rate, limit=limit))
    return scene


def own_integration(rate, limit, end):
    """Return the angle of the driven pendulum by SciPy: it slips up to the rate, holds it, slips again."""
    moment, inertia = 0.5 * G, 0.35

    def pulls(t, y):
        return abs(moment * np.sin(y[0])) - limit

    def reaches(t, y):
        return y[1] - rate

    pulls.terminal = reaches.terminal = True
    pulls.direction, sign = 1, np.sign(rate)
    how = {"rtol": 1e-12, "atol": 1e-13, "method": "DOP853", "max_step": 0.05}
    t, y, holds = 0.0, [0.0, 0.0], False
    while t < end:
        if holds:
            found = solve_ivp(lambda t, y: [rate, 0.0], (t, end), y, events=pulls, **how)
        else:
            reaches.direction = sign
            found = solve_ivp(
                lambda t, y, sign=sign: [y[1], (sign * limit - moment * np.sin(y[0])) / inertia],
                (t, end), y, events=reaches, **how,
            )  # fmt: skip
        t, y = found.t[-1], found.y[:, -1]
        pull = moment * np.sin(y[0])
        if holds:  # what pulls beyond the limit takes the rate down, or drives it above
            sign, holds = np.sign(pull), False
        elif abs(pull) <= limit:
            y[1], holds = rate, True
        else:
            sign = -sign
    return y


@verifies(
    "constraints.Driver",
    "a pendulum whose motor slips and holds",
    "own integration: SciPy with events",
)
@pytest.mark.parametrize("rtol", TOLERANCES)
@pytest.mark.parametrize(("rate", "limit"), [(1.0, 3.0), (1.0, 6.0), (-1.5, 4.5)])
def test_a_pendulum_with_a_weak_motor(rate, limit, rtol):
    angle, speed = own_integration(rate, limit, 3.0)
    run = carom.simulate(pendulum(rate, limit), 3.0, rtol=rtol)
    closes(run, 10.0, rtol)
    # the motion near the top multiplies errors by up to a hundred
    agree(run["hinge"].coordinate[-1], angle, atol=300.0 * rtol)
    agree(run["hinge"].rate[-1], speed, atol=300.0 * rtol)


@pytest.mark.parametrize("wall", ["stop", "contact"])
def test_a_slide_presses_with_its_limit(wall):
    limit, mass, rate, e = 3.0, 2.0, 0.5, 0.2
    scene = carom.Scene(gravity=(0, 0, 0))
    slide = scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=mass, name="slide")
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, slide, name="way")
    motor = scene.add_constraint(constraints.Driver("way", rate=rate, limit=limit), name="motor")
    if wall == "stop":
        scene.add_stop("way", upper=0.3, restitution=e)
    else:
        half_space = scene.add_half_space((0.35, 0, 0), (-1, 0, 0), name="wall")
        scene.add_contact(slide, half_space, restitution=e)
    run = carom.simulate(scene, 2.0, rtol=1e-8)
    closes(run, 1.0, 1e-8)
    assert run.position[-1, 0, 0] == pytest.approx(0.3, abs=1e-14)
    assert run.velocity[-1, 0, 0] == 0.0
    assert run[motor].force[-1] == pytest.approx(limit, abs=1e-12)
    assert len(run.impacts) > 2
    # all that the motor gives becomes heat or is lost in impacts: it slips at its whole rate in the end
    ledger = run.ledger
    lost = ledger.friction + ledger.impacts + ledger.bounces
    assert ledger.loads[-1] + lost[-1] == pytest.approx(0.0, abs=1e-12)
    if wall == "contact":
        assert run.contact_force[-1, 0, 0] == pytest.approx(limit, abs=1e-12)


@pytest.mark.parametrize("rtol", TOLERANCES)
def test_a_motion_is_followed_by_its_rate(rtol):
    # rate A cos(w t): I A w |sin(w t)| is needed, at most 1.6 of the limit 2: it never slips but at the start.
    A, w, limit = 2.0, 4.0, 2.0
    scene = wheel(A)
    scene.add_constraint(
        constraints.Driver(
            "axle", limit=limit,
            motion=lambda t: (A / w * np.sin(w * t), A * np.cos(w * t), -A * w * np.sin(w * t)),
        )
    )  # fmt: skip
    run = carom.simulate(scene, 3.0, rtol=rtol)
    closes(run, 1.0, rtol)
    assert run.angular_velocity[-1, 0, 2] == pytest.approx(A * np.cos(3.0 * w), abs=30.0 * rtol)
    assert run.ledger.friction[-1] == pytest.approx(0.0, abs=max(30.0 * rtol, 1e-12))


def test_a_motion_that_is_a_polynomial():
    from scipy.interpolate import CubicSpline

    times = np.linspace(0.0, 2.0, 41)
    spline = CubicSpline(times, 0.5 * (1.0 - np.cos(2.0 * times)))
    scene = wheel()
    scene.add_constraint(constraints.Driver("axle", motion=spline, limit=5.0))
    run = carom.simulate(scene, 2.0)
    closes(run, 1.0, 1e-6)
    assert run.angular_velocity[-1, 0, 2] == pytest.approx(float(spline(2.0, 1)), abs=1e-5)


@verifies("forces.Drive", r"$I\dot\omega = M(\omega_0 - \omega)$", "own integration: SciPy")
def test_a_torque_speed_line():
    # a limit that falls by a law of the slip: I w' = mu(rate - w), by an integration of one's own
    law, rate = carom.Friction(0.6, 0.2, speed=1.0), 3.0
    scene = wheel()
    scene.add_force(forces.Drive("axle", law, rate=rate))
    end = 0.9 * I * rate / 0.6  # before it has its rate
    run = carom.simulate(scene, end, rtol=1e-9)
    how = {"rtol": 1e-12, "atol": 1e-13}
    found = solve_ivp(lambda t, y: [law(rate - y[0]) / I], (0.0, end), [0.0], **how)
    assert 1.0 < found.y[0, -1] < 0.9 * rate
    agree(run.angular_velocity[-1, 0, 2], found.y[0, -1], atol=1e-7)
    closes(run, 1.0, 1e-9)


def test_a_sum_of_coordinates_is_driven():
    # a differential: q_1 + 2 q_2 at a rate, between two wheels of inertia I
    scene = carom.Scene(gravity=(0, 0, 0))
    for k in (1, 2):
        scene.add_body(mass=1.0, inertia=(I, I, I), position=(k, 0, 0), name=f"wheel {k}")
        joint = joints.Revolute((k, 0, 0), (0, 0, 1))
        scene.add_joint(joint, GROUND, f"wheel {k}", name=f"axle {k}")
    scene.add_force(forces.Drive({"axle 1": 1.0, "axle 2": 2.0}, 0.1, rate=1.0))
    run = carom.simulate(scene, 3.0)
    one, two = (run[f"axle {k}"].rate for k in (1, 2))
    closes(run, 1.0, 1e-6)
    np.testing.assert_allclose(two, 2.0 * one, atol=1e-13)
    assert one[-1] + 2.0 * two[-1] == pytest.approx(1.0, abs=1e-13)


def test_given_steps_end_where_tolerances_do():
    scene = pendulum(1.0, 3.0)
    best = carom.simulate(scene, 2.0, rtol=1e-10)["hinge"].coordinate[-1]
    for step in (1e-2, 2e-3):
        run = carom.simulate(scene, 2.0, step=step)
        assert run["hinge"].coordinate[-1] == pytest.approx(best, abs=2.0 * step**2)


def test_what_is_added_is_a_force():
    scene = wheel()
    made = scene.add_constraint(constraints.Driver("axle", rate=1.0, limit=0.5), name="motor")
    assert made is scene["motor"]
    assert made.kind == "Drive"
    assert not scene.constraints
    assert scene.replace("motor", rate=2.0).definition.rate == 2.0
    runs = carom.ensemble(scene, 2.0, vary={"motor.bound": [0.5, 1.0], "motor.rate": [1.0, -2.0]})
    np.testing.assert_allclose(runs["axle"].rate, [1.0, -2.0], atol=1e-13)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"rate": 1.0, "limit": 0.0}, "limit must be finite and above 0, got 0"),
        ({"rate": 1.0, "limit": -1.0}, "limit must be finite and above 0, got -1"),
        ({"limit": 1.0}, "rate or motion must be given"),
    ],
)
def test_limits_and_rates_that_it_does_not_take(given, message):
    with pytest.raises(ValueError, match=message):
        wheel().add_constraint(constraints.Driver("axle", **given))


def test_drives_need_a_rate_or_a_motion():
    for given in ({}, {"rate": 1.0, "motion": lambda t: (t, 1, 0)}):
        with pytest.raises(ValueError, match="rate or motion must be given, and not both"):
            forces.Drive("axle", 1.0, **given)
    with pytest.raises(ValueError, match="motion must be left out with a sum"):
        forces.Drive({"axle": 1.0}, 1.0, motion=lambda t: (t, 1, 0))
    scene = wheel()
    scene.add_force(forces.Drive("axle", 1.0, rate=1.0))
    with pytest.raises(ValueError, match="if joints have dry friction"):
        carom.simulate(scene, 1.0, step=1e-3, method="rattle")


def test_a_file_keeps_a_drive_and_goes_on(tmp_path):
    pytest.importorskip("h5netcdf")
    scene = pendulum(1.0, 3.0)
    whole = carom.simulate(scene, 2.0)
    carom.simulate(scene, 1.0).save(tmp_path / "run.nc")
    run = carom.Solution.load(tmp_path / "run.nc")
    drive = run.scene.forces[0].definition
    assert (drive.rate, drive.bound) == (1.0, 3.0)
    assert run.simulate(1.0)["hinge"].coordinate[-1] == pytest.approx(
        whole["hinge"].coordinate[-1], abs=1e-5
    )
