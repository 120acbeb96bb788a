"""Friction in joints by their load: closed forms, an integration by SciPy, self-locking, results."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import carom
from carom import forces, joints
from verified import agree, verifies

G = 9.81
RTOLS = [1e-6, 1e-10]


def scene(gravity: float = 0.0, down=(0.0, 0.0, -1.0)) -> carom.Scene:
    """Return an empty scene."""
    return carom.Scene(gravity=gravity * np.array(down))


def simulated(made: carom.Scene, duration: float, **given):
    """Return a run whose ledger closes, without a remark."""
    solution = carom.simulate(made, duration, **given)
    assert solution.success
    assert solution.warnings == ()
    ledger = solution.ledger
    exchanged = np.ptp(solution.kinetic_energy) + np.ptp(solution.potential_energy)
    assert_allclose(ledger.residual, 0.0, atol=10.0 * given.get("rtol", 1e-8) * exchanged + 1e-13)
    assert np.all(np.diff(ledger.friction) <= 1e-9 * exchanged + 1e-15)
    return solution


MASS, LENGTH, MOMENT, RADIUS, MU, START = 2.0, 0.7, 0.05, 0.08, 0.3, 1.2


def pendulum(turned: bool = False, looped: bool = False) -> carom.Scene:
    """Return a rod on a pin with friction; parent and child exchanged, or with the solver for loops."""
    made = scene(G)
    made.add_body(
        mass=MASS,
        inertia=(MOMENT,) * 3,
        position=(LENGTH * math.sin(START), 0.0, -LENGTH * math.cos(START)),
        name="rod",
    )
    between = ("hub", "rod") if turned else (carom.GROUND, "rod")
    if turned:  # the tree goes from the child of this joint to its parent
        made.add_body(mass=1.0, inertia=(1.0,) * 3, name="hub")
        made.add_joint(joints.Fixed((0.0, 0.0, 0.0)), carom.GROUND, "hub")
        between = ("rod", "hub")
    made.add_joint(joints.Revolute((0.0, 0.0, 0.0), (0.0, -1.0, 0.0)), *between, name="pin")
    made.add_force(forces.JointFriction("pin", mu=MU, radius=RADIUS), name="friction")
    if looped:
        made.add_body(
            mass=1.0, inertia=(1.0,) * 3, position=(5.0, 0.0, 0.0),
            angular_velocity=(0.0, 1.0, 0.0), name="wheel",
        )  # fmt: skip
        wheel = made.add_joint(
            joints.Revolute((5.0, 0.0, 0.0), (0.0, 1.0, 0.0)), carom.GROUND, "wheel"
        )
        made.add_constraint(carom.constraints.Driver(wheel, rate=1.0))
    return made


def torque(th: float, om: float, sign: float) -> tuple[float, float]:
    """Return acceleration and friction of the rod at an angle from below, which swings towards `sign`."""
    inertia = MOMENT + MASS * LENGTH**2

    def excess(t: float) -> float:
        a = (-MASS * G * LENGTH * math.sin(th) - sign * t) / inertia
        along = MASS * (LENGTH * om**2 + G * math.cos(th))
        return t - MU * RADIUS * math.hypot(along, MASS * (LENGTH * a + G * math.sin(th)))

    t = brentq(excess, 0.0, 1e3, xtol=1e-15, rtol=1e-15)
    return (-MASS * G * LENGTH * math.sin(th) - sign * t) / inertia, t


def swung(duration: float) -> np.ndarray:
    """Return angle and rate of the rod by SciPy."""
    t, y, sign = 0.0, [START, 0.0], -1.0

    def stops(_, y):
        return y[1]

    stops.terminal = True  # pyright: ignore
    while t < duration:
        stops.direction = -sign  # pyright: ignore
        run = solve_ivp(
            lambda _, y, s=sign: [y[1], torque(y[0], y[1], s)[0]], (t, duration), y, "DOP853",
            events=stops, rtol=1e-12, atol=1e-13,
        )  # fmt: skip
        t, y, sign = run.t[-1], [run.y[0, -1], 0.0 if run.status == 1 else run.y[1, -1]], -sign
    return np.array(y)


@verifies(
    "forces.JointFriction",
    r"$M = \mu r \lvert R \rvert$ with the reaction $R$ of the pin",
    "own integration: SciPy",
)
@pytest.mark.parametrize("rtol", RTOLS)
@pytest.mark.parametrize(("turned", "looped"), [(False, False), (True, False), (False, True)])
def test_pendulum_on_a_pin(turned, looped, rtol):
    solution = simulated(pendulum(turned, looped), 3.0, rtol=rtol)
    angle, rate = swung(3.0)
    # measured: 1e-8, 2e-13 at 1e-6, 1e-10
    sign = -1.0 if turned else 1.0
    agree(START + sign * solution["pin"].coordinate[-1], angle, atol=rtol)
    agree(-solution["rod"].angular_velocity[-1, 1], rate, atol=10.0 * rtol)


def test_friction_of_a_pin_is_mu_r_times_its_reaction():
    solution = simulated(pendulum(), 3.0, rtol=1e-10)
    reaction = np.linalg.norm(solution["pin"].force, axis=1)
    about = -solution["friction"].torque
    slides = np.abs(solution["pin"].rate) > 1e-3
    assert_allclose(np.abs(about)[slides], MU * RADIUS * reaction[slides], rtol=1e-9)
    rate = solution["rod"].angular_velocity[:, 1]
    assert np.all(about[slides] * rate[slides] < 0.0)


@pytest.mark.parametrize(("share", "sticks"), [(0.99, True), (1.01, False)])
def test_rod_sticks_within_the_circle_of_friction(share, sticks):
    # the weight passes the pin within mu r: m g l sin(angle) < mu r m g
    angle = math.asin(share * MU * RADIUS / LENGTH)
    made = scene(G)
    at = (LENGTH * math.sin(angle), 0.0, -LENGTH * math.cos(angle))
    made.add_body(mass=MASS, inertia=(MOMENT,) * 3, position=at, name="rod")
    pin = made.add_joint(joints.Revolute((0.0, 0.0, 0.0), (0.0, 1.0, 0.0)), carom.GROUND, "rod")
    made.add_force(forces.JointFriction(pin, mu=MU, radius=RADIUS), name="friction")
    solution = simulated(made, 0.5)
    moved = np.abs(solution[pin].coordinate[-1])
    assert (moved == 0.0) if sticks else (moved > 1e-5)
    if sticks:
        held = np.abs(solution["friction"].torque)
        assert_allclose(held, MASS * G * LENGTH * math.sin(angle), rtol=1e-9)


@verifies("forces.JointFriction", r"$\omega = \omega_0/(1 + k\omega_0 t)$", "closed form")
@pytest.mark.parametrize("rtol", RTOLS)
def test_eccentric_rotor_slows_by_its_own_load(rtol):
    # J w' = -mu r m e sqrt(w^4 + w'^2), so w' = -k w^2 with J k = mu r m e sqrt(1 + k^2), w = w0/(1 + k w0 t)
    e, spin = 0.02, 100.0
    made = scene()
    made.add_body(
        mass=MASS, inertia=(MOMENT,) * 3, position=(e, 0.0, 0.0), velocity=(0.0, spin * e, 0.0),
        angular_velocity=(0.0, 0.0, spin), name="rotor",
    )  # fmt: skip
    pin = made.add_joint(joints.Revolute((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), carom.GROUND, "rotor")
    made.add_force(forces.JointFriction(pin, mu=MU, radius=RADIUS))
    solution = simulated(made, 2.0, rtol=rtol)
    J, f = MOMENT + MASS * e**2, MU * RADIUS * MASS * e
    k = f / math.sqrt(J**2 - f**2)
    rate = spin / (1.0 + k * spin * solution.t)
    agree(solution["rotor"].angular_velocity[:, 2], rate, rtol=100.0 * rtol)


@pytest.mark.parametrize("rtol", RTOLS)
def test_bead_on_a_wire_slows_by_its_turn(rtol):
    # no gravity: N = m v^2/R, v' = -mu v^2/R, so v = v0 exp(-mu angle): by half a turn, e^(-pi mu)
    R, v = 0.4, 3.0
    made = scene()
    made.add_body(
        mass=1.5, inertia=(0.01,) * 3, position=(R, 0.0, 0.0), velocity=(0.0, v, 0.0), name="bead"
    )
    circle = carom.curves.Curve(
        lambda u: (R * math.cos(u), R * math.sin(u), 0.0), 0.0, 2.0 * math.pi, closed=True
    )
    rail = joints.PointOnCurve(circle)
    wire = made.add_joint(rail, carom.GROUND, "bead")
    made.add_force(forces.JointFriction(wire, mu=MU))
    solution = simulated(made, 1.0, rtol=rtol)
    angle = solution[wire].coordinate / R
    speed = np.linalg.norm(solution["bead"].velocity, axis=1)
    assert_allclose(speed, v * np.exp(-MU * angle), rtol=100.0 * rtol)
    # and v = v0/(1 + mu v0 t/R)
    assert_allclose(speed, v / (1.0 + MU * v * solution.t / R), rtol=100.0 * rtol)


WIDTH = 0.4  # of a drawer


def drawer(
    beside: float,
    pull: float,
    length: float | None = WIDTH,
    radius: float | None = None,
    speed: float = 0.0,
) -> carom.Scene:
    """Return a drawer that is pulled along its guide, beside the middle."""
    made = scene()
    made.add_body(mass=MASS, inertia=(MOMENT,) * 3, velocity=(speed, 0.0, 0.0), name="drawer")
    guide = made.add_joint(joints.Prismatic((1.0, 0.0, 0.0)), carom.GROUND, "drawer", name="guide")
    made.add_force(
        forces.JointFriction(guide, mu=MU, length=length, radius=radius), name="friction"
    )
    made.add_force(forces.Force((pull, 0.0, 0.0), anchor=(0.0, beside, 0.0)), "drawer")
    return made


@verifies("forces.JointFriction", r"$m a = P (1 - 2\mu y/L)$", "closed form")
@pytest.mark.parametrize("share", [0.2, 0.9])
def test_drawer_slides_below_its_limit(share):
    # N at both ends is P y/L: friction 2 mu y P/L
    beside = share * WIDTH / (2.0 * MU)
    solution = simulated(drawer(beside, 10.0), 1.0, rtol=1e-10)
    a = 10.0 * (1.0 - share) / MASS
    agree(solution["guide"].coordinate, a * solution.t**2 / 2.0, atol=1e-10)
    agree(np.abs(solution["friction"].force[1:]), 10.0 * share, rtol=1e-9)


@pytest.mark.parametrize("pull", [0.1, 1e4])
def test_drawer_jams_beyond_its_limit(pull):
    solution = simulated(drawer(1.01 * WIDTH / (2.0 * MU), pull), 1.0)
    assert np.all(solution["guide"].coordinate == 0.0)
    assert_allclose(solution["friction"].force, -pull, rtol=1e-9)


def test_drawer_that_is_pulled_beyond_its_limit_stops():
    # 1.5 times the pull brakes it: v^2/(2 a)
    solution = simulated(drawer(1.5 * WIDTH / (2.0 * MU), 5.0, speed=0.1), 0.5, rtol=1e-10)
    assert_allclose(solution["guide"].coordinate[-1], 0.1**2 / (2.0 * 0.5 * 5.0 / MASS), atol=1e-12)
    assert solution["drawer"].velocity[-1, 0] == 0.0


def test_slide_across_gravity():
    made = scene(G)
    made.add_body(mass=MASS, inertia=(MOMENT,) * 3, velocity=(2.0, 0.0, 0.0), name="block")
    guide = made.add_joint(joints.Prismatic((1.0, 0.0, 0.0)), carom.GROUND, "block")
    made.add_force(forces.JointFriction(guide, mu=carom.Friction(0.5, MU)))
    solution = simulated(made, 2.0, rtol=1e-10)
    # stops after v/(mu g) = .68 s
    assert_allclose(solution[guide].coordinate[-1], 4.0 / (2.0 * MU * G), atol=1e-10)


def test_torque_on_a_keyed_slide():
    # a moment M about the axis, kept from turning at r: force M/r
    made = drawer(0.0, 10.0, length=None, radius=0.05)
    made.add_force(forces.Torque((0.3, 0.0, 0.0)), "drawer")
    solution = simulated(made, 1.0, rtol=1e-10)
    a = (10.0 - MU * 0.3 / 0.05) / MASS
    assert_allclose(solution["guide"].coordinate, a * solution.t**2 / 2.0, atol=1e-10)


def test_shaft_in_two_bearings():
    # a wheel at the distance b beyond the middle of two bearings L apart: N = m g (b/L +- 1/2)
    b, L, spin = 0.5, 0.3, 50.0
    made = scene(G)
    made.add_body(
        mass=MASS,
        inertia=(MOMENT,) * 3,
        position=(b, 0.0, 0.0),
        angular_velocity=(spin, 0.0, 0.0),
        name="wheel",
    )
    axle = made.add_joint(joints.Revolute((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), carom.GROUND, "wheel")
    made.add_force(forces.JointFriction(axle, mu=MU, radius=RADIUS, length=L))
    made.add_force(forces.Force((7.0, 0.0, 0.0)), "wheel")  # on the shoulder
    solution = simulated(made, 1.0, rtol=1e-10)
    load = MASS * G * 2.0 * b / L + 7.0
    slowed = MU * RADIUS * load / MOMENT
    assert_allclose(
        solution["wheel"].angular_velocity[:, 0],
        np.maximum(spin - slowed * solution.t, 0.0),
        atol=1e-8,
    )


def screw(lead: float, moment: float) -> carom.Scene:
    """Return a nut on a vertical thread at rest, with its weight and a moment about it."""
    made = scene(G)
    made.add_body(mass=MASS, inertia=(MOMENT,) * 3, name="nut")
    pitch = 2.0 * np.pi * RADIUS * math.tan(lead)
    thread = made.add_joint(
        joints.Screw((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), pitch), carom.GROUND, "nut", name="thread"
    )
    made.add_force(forces.JointFriction(thread, mu=MU, radius=RADIUS), name="friction")
    made.add_force(forces.Torque((0.0, 0.0, moment)), "nut")
    return made


@pytest.mark.parametrize("share", [0.98, -0.98])
def test_screw_locks_itself(share):
    solution = simulated(screw(math.copysign(math.atan(abs(share) * MU), share), 0.0), 0.5)
    assert np.all(solution["thread"].coordinate[-1] == 0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("raises", [True, False])
def test_moment_of_a_screw(raises, sign):
    # W r tan(lead + angle of friction) raises the nut, and W r tan(lead - angle) lowers it, at an even rate
    lead, phi = 0.2, math.atan(MU)
    even = MASS * G * RADIUS * math.tan(lead + phi if raises else lead - phi)
    for share, moves in ((0.99, False), (1.01, True)):
        moment = even * share if raises else even + (1.0 - share) * 0.5 * abs(even)
        solution = simulated(screw(sign * lead, sign * moment), 0.3)
        angle = sign * solution["thread"].coordinate[-1]
        angle = angle[0] if np.ndim(angle) else angle
        assert (angle != 0.0) == moves
        assert not moves or (angle > 0.0) == raises


@verifies("forces.JointFriction", r"$I a = M - F r \tan(\lambda + \varphi)$", "closed form")
def test_efficiency_of_a_screw():
    # tan(lead)/tan(lead + phi) of the work of the moment lifts the nut and moves it; by energies
    lead = 0.2
    moment = 1.5 * MASS * G * RADIUS * math.tan(lead + math.atan(MU))
    solution = simulated(screw(lead, moment), 0.5, rtol=1e-10)
    angle, h = solution["nut"].position[-1, 2] / (RADIUS * math.tan(lead)), RADIUS * math.tan(lead)
    # F on the thread is W + m h a; I a = M - F r tan(lead + phi)
    arm = RADIUS * math.tan(lead + math.atan(MU))
    a = (moment - MASS * G * arm) / (MOMENT + MASS * h * arm)
    agree(angle, a * 0.5**2 / 2.0, rtol=1e-9)
    heat = moment * angle - MASS * G * h * angle - 0.5 * (MOMENT + MASS * h * h) * (a * 0.5) ** 2
    agree(-solution.ledger.friction[-1], heat, rtol=1e-8)


def test_a_joint_locks_where_friction_adds_to_its_own_load():
    # J a = -p r with p = mu m e a: for mu m e r > J no slip is possible, and the wheel stops at once
    e, spin = 0.05, 20.0
    made = scene()
    made.add_body(
        mass=MASS, inertia=(1e-5,) * 3, position=(e, 0.0, 0.0), velocity=(0.0, spin * e, 0.0),
        angular_velocity=(0.0, 0.0, spin), name="wheel",
    )  # fmt: skip
    pin = made.add_joint(joints.Revolute((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), carom.GROUND, "wheel")
    made.add_force(forces.JointFriction(pin, mu=1.2, radius=0.045))
    solution = carom.simulate(made, 0.1)
    assert solution.success
    assert solution.warnings == ()
    energy = 0.5 * (1e-5 + MASS * e**2) * spin**2
    assert solution["wheel"].angular_velocity[1, 2] == pytest.approx(0.0, abs=1e-12)
    # measured: 1e-16 rad, 1e-7 of the energy
    assert abs(solution[pin].coordinate[-1]) < 1e-6
    assert_allclose(solution.ledger.friction[-1], -energy, rtol=1e-5)


def test_laws_of_a_pin_are_by_the_speed_of_its_surfaces():
    # a wheel of weight m g, mu = mu_s + (mu_k - mu_s)(1 - exp(-v/v_s)) by v = r w
    law = carom.Friction(0.4, 0.1, speed=0.5)
    made = scene(G)
    made.add_body(mass=MASS, inertia=(MOMENT,) * 3, angular_velocity=(0.0, 0.0, 40.0), name="wheel")
    pin = made.add_joint(joints.Revolute((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), carom.GROUND, "wheel")
    made.add_force(forces.JointFriction(pin, mu=law, radius=RADIUS), name="friction")
    solution = simulated(made, 0.6, rtol=1e-10)

    def slows(_, w):
        return -law(RADIUS * w) * MASS * G * RADIUS / MOMENT

    own = solve_ivp(slows, (0.0, 0.6), [40.0], "DOP853", rtol=1e-12, atol=1e-12, dense_output=True)
    assert_allclose(solution["wheel"].angular_velocity[:, 2], own.sol(solution.t)[0], atol=1e-7)


def test_friction_by_load_is_saved_varied_and_goes_on(tmp_path):
    made = pendulum()
    half = carom.simulate(made, 1.0)
    half.save(tmp_path / "half.nc")
    loaded = carom.Solution.load(tmp_path / "half.nc")
    whole, again = carom.simulate(made, 2.0), loaded.simulate(1.0)
    assert_allclose(again["rod"].position[-1], whole["rod"].position[-1], atol=1e-6)
    assert_allclose(loaded["friction"].torque, half["friction"].torque, rtol=1e-12)
    runs = carom.ensemble(
        made, vary={"friction.mu": [0.1, MU], "friction.radius": [0.01, RADIUS]}, duration=1.0
    )
    assert_allclose(runs["rod"].position[1], half["rod"].position[-1], atol=1e-12)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "bound .* or mu .* must be given"),
        ({"bound": 1.0, "mu": 0.1}, "bound .* or mu .* must be given"),
        ({"bound": 1.0, "radius": 0.1}, "radius must be left out with bound"),
        ({"mu": 0.1}, "radius must be given with mu for an angle"),
    ],
)
def test_what_is_refused(given, message):
    with pytest.raises(ValueError, match=message):
        pendulum().add_force(forces.JointFriction("pin", **given))


def test_lengths_that_joints_do_not_have_are_refused():
    made = screw(0.2, 0.0)
    with pytest.raises(ValueError, match="length must be left out"):
        made.add_force(forces.JointFriction("thread", mu=0.1, radius=0.1, length=0.1))
    with pytest.raises(ValueError, match="coordinate of a screw must be 0"):
        made.add_force(forces.JointFriction("thread", mu=0.1, radius=0.1, coordinate=1))
