"""Contact that stays: slip, stick and opening, in closed form."""

import numpy as np
import pytest
import sympy as sp
from coordinate_systems import rate, symbols

import carom
from carom import GeneralizedSystem
from verified import agree, verifies

G = 9.81


def particle(position, velocity, potential, **contact):
    """A particle of 1 kg over the floor z = 0; `potential` of (x, z)."""
    q, v = symbols("x z")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(2), potential=potential(*q), position=position, velocity=velocity
    )
    system.add_contact(q[1], tangent=v[0], **contact)
    return system


def on_floor(position, velocity, friction=0.3, restitution=0.5):
    return particle(
        position, velocity, lambda x, z: G * z, restitution=restitution, friction=friction
    )


@pytest.mark.plain
def test_block_slides_to_a_stop():
    # t = v/(mu g), s = v^2/(2 mu g); forces are constant, so nothing but round-off.
    run = carom.simulate(on_floor([0, 0], [1, 0]), 0.5, step=0.02)
    assert [str(kind) for kind in run.events.kind] == ["held", "sticks"]
    assert run.events.time[1] == pytest.approx(1 / (0.3 * G), rel=1e-14)
    assert run.q[-1, 0] == pytest.approx(1 / (0.6 * G), rel=1e-14)
    np.testing.assert_allclose(run.v[-1], 0.0, atol=1e-15)
    assert run.ledger.friction[-1] == pytest.approx(-0.5, rel=1e-13)


def test_bounces_end():
    # From 1 m with e = 1/2: bounces end at t0 (1 + 2 e/(1 - e)) = 3 t0; handed over within one step.
    run = carom.simulate(on_floor([0, 1], [0, 0], 0.0), 2.0, step=0.01)
    times = np.sqrt(2 / G) * (1 + 2 * np.cumsum(0.5 ** np.arange(1, len(run.impacts))))
    np.testing.assert_allclose(run.impacts.time[1:], times, rtol=0, atol=1e-12)
    held = run.events.time[np.flatnonzero(run.events.kind == "held")]
    assert len(held) == 1
    assert 0 < 3 * np.sqrt(2 / G) - held[0] < 0.02
    assert run.q[-1, 1] == pytest.approx(0.0, abs=1e-15)
    assert -1e-3 < run.ledger.bounces[-1] < 0
    assert np.max(np.abs(run.ledger.residual)) < 1e-12


@pytest.mark.parametrize(("friction", "slides"), [(0.4999, True), (0.5001, False)])
def test_incline_holds_up_to_the_friction_angle(friction, slides):
    slope = np.arctan(0.5)
    system = particle(
        [0, 0], [0, 0], lambda x, z: G * (z * np.cos(slope) - x * np.sin(slope)),
        restitution=0.0, friction=friction,
    )  # fmt: skip
    run = carom.simulate(system, 1.0, step=0.01)
    speed = G * (np.sin(slope) - friction * np.cos(slope)) if slides else 0.0
    np.testing.assert_allclose(run.v[-1], [speed, 0.0], rtol=0, atol=2e-13)


@verifies(
    "GeneralizedSystem", r"leaves a circle at $\cos\theta = \tfrac23 \cos\theta_0$", "closed form"
)
@pytest.mark.parametrize("polar", [False, True])
def test_particle_leaves_a_circle(polar):
    # From rest at angle 0.1 on a frictionless circle: cos th_s = 2/3 cos 0.1, at t = .9071101110440. Order 4.
    errors = []
    for step in (0.02, 0.01, 0.005):
        q, v = symbols("a b")
        if polar:
            metric, height, gap = sp.diag(1, q[0] ** 2), q[0] * sp.cos(q[1]), q[0] - 1
            start = [1, 0.1]
        else:
            metric, height, gap = sp.eye(2), q[1], sp.sqrt(q[0] ** 2 + q[1] ** 2) - 1
            start = [np.sin(0.1), np.cos(0.1)]
        system = GeneralizedSystem.from_sympy(
            q, v, metric=metric, potential=G * height, position=start, velocity=[0, 0]
        )
        system.add_contact(gap, restitution=0.0)
        run = carom.simulate(system, 1.0, step=step)
        assert [str(kind) for kind in run.events.kind] == ["held", "opens"]
        errors.append(abs(run.events.time[1] - 0.9071101110440))
    agree(errors[-1], 0.0, atol=1e-9)
    assert errors[0] / errors[1] > 10.0
    assert errors[1] / errors[2] > 10.0


@verifies(
    "GeneralizedSystem.from_sympy",
    r"sticks until $t = \mu g$, then $\ddot x = t - \mu g$",
    "closed form",
)
def test_stick_gives_way():
    # A force that grows, F = t: stick until t = mu m g, then x'' = t - mu g. Located: x is exact for RK4.
    q, v = symbols("x z")
    t = sp.Symbol("t", real=True)
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(2), potential=G * q[1], forces=[t, 0], time=t, position=[0, 0],
        velocity=[0, 0],
    )  # fmt: skip
    system.add_contact(q[1], tangent=v[0], restitution=0.0, friction=0.1)
    run = carom.simulate(system, 2.0, step=0.03)
    start = 0.1 * G
    assert [str(kind) for kind in run.events.kind] == ["held", "slips"]
    agree(run.events.time[1], start, atol=1e-11)
    agree(run.q[-1, 0], (2 - start) ** 3 / 6, atol=1e-11)
    agree(run.ledger.residual, 0.0, atol=1e-11)


def test_puck_in_the_plane_stops_along_its_line():
    q, v = symbols("x y z")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(3), potential=G * q[2], position=[0, 0, 0], velocity=[0.6, 0.8, 0]
    )
    system.add_contact(q[2], tangent=v[:2], restitution=0.0, friction=0.3)
    run = carom.simulate(system, 0.5, step=0.01)
    np.testing.assert_allclose(run.q[-1], np.array([0.6, 0.8, 0]) / (0.6 * G), rtol=0, atol=1e-15)


def test_jam_is_resolved_by_an_impact():
    # Painleve: a rod of 1 m, 1 kg at 60 degrees, mu = 1.6: W = [[1.75, 1.299], [1.299, 3.25]], u = (0, 1),
    # e = 0: P = (.3247595264, -.4375), at rest at once at the point. (Mathematics page, §3.6.)
    q, v = symbols("x z a")
    x, z, a = q
    foot = x - sp.cos(a) / 2, z - sp.sin(a) / 2
    turn = np.pi / 3
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, 1, sp.Rational(1, 12)), potential=G * z,
        position=[np.cos(turn) / 2, np.sin(turn) / 2, turn], velocity=[-1, 0, 0],
    )  # fmt: skip
    tangent = sum(sp.diff(foot[0], one) * rate for one, rate in zip(q, v))
    system.add_contact(foot[1], tangent=tangent, restitution=0.0, friction=1.6)
    # a rod that stands on a point and falls about it: 1 ms is too long for it, and the run says so
    run = carom.simulate(system, 0.01, step=1e-3, throw=False)
    first = run.impacts[0]
    assert first.time == pytest.approx(0.0, abs=2e-8)  # located, to 2e-9 s
    np.testing.assert_allclose(first.inverse_mass[0, 1], -1.299038105677, rtol=0, atol=1e-12)
    np.testing.assert_allclose(first.impulse[:2], [0.3247595264, 0.4375], rtol=0, atol=1e-6)
    np.testing.assert_allclose(first.relative_velocity_after, 0.0, atol=1e-12)


def test_two_blocks_collide_and_stop_together():
    # A row of two on a line with a wall: both contacts are resolved at one instant when they close together.
    q, v = symbols("x y")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(2), position=[1, 2], velocity=[-1, -1]
    )
    system.add_contact(q[0], restitution=0.0, name="wall")
    system.add_contact(q[1] - q[0] - 1, restitution=0.0, name="pair")
    run = carom.simulate(system, 2.0, step=0.1)
    np.testing.assert_allclose(run.q[-1], [0, 1], rtol=0, atol=1e-14)
    np.testing.assert_allclose(run.v[-1], 0.0, atol=1e-14)
    assert run.ledger.impacts[-1] == pytest.approx(-1.0, rel=1e-13)


def test_slip_that_turns():
    # A side wind F on a puck, du/dt = F - mu g u/|u|. With s the angle of slip from the wind, w = tan(s/2) and
    # k = mu g/F: d|u|/ds = |u| (k - cos s)/sin s and ds/dt = -F sin s/|u|.
    # Here k = 1/2 and s = 90 degrees at the start: |u| = (v0/2) w^(-1/2) (1 + w^2).
    from scipy.integrate import quad

    q, v = symbols("x y z")
    force, start = 2.0 * 0.3 * G, 1.0
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(3), potential=G * q[2], forces=[0, force, 0], position=[0, 0, 0],
        velocity=[start, 0, 0],
    )  # fmt: skip
    system.add_contact(q[2], tangent=v[:2], restitution=0.0, friction=0.3)
    angle = 0.2

    def speed(s):
        w = np.tan(s / 2)
        return 0.5 * start * w**-0.5 * (1 + w * w)

    time, _ = quad(lambda s: speed(s) / (force * np.sin(s)), angle, np.pi / 2, epsabs=1e-13)
    for step, most in ((0.3, 1e-3), (0.02, 1e-4), (2e-3, 1e-8)):
        run = carom.simulate(system, time, step=step)
        exact = speed(angle) * np.array([np.sin(angle), np.cos(angle)])
        np.testing.assert_allclose(run.v[-1, :2], exact, rtol=0, atol=most)


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")  # the steps are coarse
@pytest.mark.parametrize("wind", [1.2, 2.0])
@pytest.mark.parametrize("across", [0.02, 0.1])
def test_slip_that_turns_back(wind, across):
    # A head wind stops a puck, but for its slow motion across, and blows it back: in a small part of a step.
    q, v = symbols("x y z")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(3), potential=G * q[2], forces=[-wind * 0.3 * G, 0, 0],
        position=[0, 0, 0], velocity=[1, across, 0],
    )  # fmt: skip
    system.add_contact(q[2], tangent=v[:2], restitution=0.0, friction=0.3)
    exact = carom.simulate(system, 0.6, rtol=1e-10)
    for step in (0.2, 0.1, 0.05):
        run = carom.simulate(system, 0.6, step=step)
        np.testing.assert_allclose(run.q[-1], exact.q[-1], rtol=0, atol=1e-3)


@pytest.mark.parametrize("friction", [0.0, 0.15])
def test_two_held_contacts_keep_the_order(friction):
    # A rod slides on both ends over the hill z = cos(x)/10, to a stop if there is friction. Against rk8.
    from scipy.optimize import root

    q, v = symbols("x z a")
    x, z, a = q
    ends = [(x + k * sp.cos(a) / 2, z + k * sp.sin(a) / 2) for k in (-1, 1)]
    gaps = [Z - sp.cos(X) / 10 for X, Z in ends]
    given = {x: 0.3}
    at = root(sp.lambdify([(z, a)], [one.subs(given) for one in gaps]), [0.1, 0.0], tol=1e-14).x
    given |= {z: at[0], a: at[1]}
    J = np.array(sp.Matrix(gaps).jacobian(q).subs(given), dtype=float)
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, 1, sp.Rational(1, 12)), potential=G * z, position=[0.3, *at],
        velocity=[0.8, *np.linalg.solve(J[:, 1:], -0.8 * J[:, 0])],
    )  # fmt: skip
    for (X, Z), gap in zip(ends, gaps):
        slope = -sp.sin(X) / 10
        n = sp.sqrt(1 + slope**2)
        tangent = (rate(X, q, v) + slope * rate(Z, q, v)) / n
        system.add_contact(gap / n, tangent=tangent, restitution=0.0, friction=friction)
    exact = carom.simulate(system, 1.2, step=2e-3, method="rk8")
    runs = [carom.simulate(system, 1.2, step=h) for h in (0.04, 0.02, 0.01)]
    errors = np.array([np.max(np.abs(run.q[-1] - exact.q[-1])) for run in runs])
    assert np.all(np.log2(errors[:-1] / errors[1:]) > 3.7)
    assert errors[-1] < 1e-10
    if friction > 0.0:
        assert [str(kind) for kind in exact.events.kind] == ["held", "held", "sticks", "sticks"]
        assert runs[-1].events.time[2] == pytest.approx(exact.events.time[2], abs=1e-10)
        np.testing.assert_allclose(runs[-1].v[-1], 0.0, atol=1e-14)


@pytest.mark.parametrize("how", [dict(step=5e-3), dict(rtol=1e-8)])
def test_table_stands_in_the_origin(how):
    # All coordinates, gaps and energies are zero: nothing but the loads gives them a scale.
    q, v = symbols("z a b")
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, sp.Rational(1, 3), sp.Rational(1, 3)), potential=G * q[0],
        position=[0, 0, 0], velocity=[0, 0, 0],
    )  # fmt: skip
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        system.add_contact(q[0] + x * q[1] + y * q[2], restitution=0.3)
    run = carom.simulate(system, 1.0, **how)
    np.testing.assert_allclose(run.q, 0.0, atol=1e-15)
    assert len(run.impacts) == 0


@pytest.mark.parametrize(("seed", "how"), [(5, dict(step=0.01)), (13, dict(rtol=1e-8))])
def test_table_slides_to_rest(seed, how):
    # Three legs carry it; the fourth has a force of round-off, and neither slips nor turns back by itself.
    draw = np.random.default_rng(1000 + seed).uniform
    q, v = symbols("z a b x y")
    start = [draw(0.05, 0.3), draw(-0.03, 0.03), draw(-0.03, 0.03), 0, 0]
    velocity = [0, draw(-0.3, 0.3), draw(-0.3, 0.3), draw(-1, 1), draw(-1, 1)]
    third, friction = sp.Rational(1, 3), draw(0, 0.6)
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, third, third, 1, 1), potential=G * q[0], position=start,
        velocity=velocity,
    )  # fmt: skip
    slip = [v[3] + v[2] / 5, v[4] - v[1] / 5]
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        system.add_contact(
            q[0] + x * q[1] + y * q[2], tangent=slip, restitution=draw(0, 0.8), friction=friction,
            impact_law=("newton", "poisson", "stronge")[seed % 3],
        )  # fmt: skip
    run = carom.simulate(system, 1.2, **how)
    np.testing.assert_allclose(run.v[-1], 0.0, atol=1e-12)
    assert np.max(np.abs(run.ledger.residual)) < 3e-7  # 3e-8 by tolerances


@pytest.mark.parametrize(("friction", "speed"), [(2.0, 0.0), (0.2, 5.0)])
def test_steps_in_contact_are_as_many_as_the_order_says(friction, speed):
    """A block that sticks or slips carries a mass on a spring at 30 degrees: order 8 needs 10^(1/8) times the
    steps for a digit more. The acceleration of what is held is round-off, and was an error of first order."""
    x, z, s, dx, dz, ds = sp.symbols("x z s dx dz ds")
    slant = sp.sqrt(3) / 2
    T = (dx**2 + dz**2) / 2 + ((dx + ds / 2) ** 2 + (dz + slant * ds) ** 2) / 10
    V = G * z + G / 5 * (z + slant * s) + 50 * s**2
    ends, counts = [], []
    for rtol in (1e-10, 1e-12):
        system = GeneralizedSystem.from_sympy(
            [x, z, s], [dx, dz, ds], kinetic_energy=T, potential=V, position=[0, 0, 0.02],
            velocity=[speed, 0, 0],
        )  # fmt: skip
        system.add_contact(z, tangent=dx, restitution=0.0, friction=friction)
        run = carom.simulate(system, 10.0, rtol=rtol, save_at=10.0)
        ends.append(run.q[-1])
        counts.append(run.stats["trial_steps"])
    assert np.abs(ends[1] - ends[0]).max() < 1e-8
    assert 1.2 < counts[1] / counts[0] < 2.2  # 10^(2/8) = 1.8


@pytest.mark.plain
def test_forces_modes_and_intervals_are_in_the_results():
    run = carom.simulate(on_floor([0, 0], [1, 0]), 0.5, step=0.02)
    stops = run.t > 1 / (0.3 * G)
    assert run.contact_force.shape == (26, 1, 3)
    np.testing.assert_allclose(run.contact_force[:, 0, 0], G, rtol=1e-13)
    np.testing.assert_allclose(run.contact_force[~stops, 0, 1], -0.3 * G, rtol=1e-13)
    assert run.contact_mode[:, 0].tolist() == [2 if stop else 1 for stop in stops]
    assert [str(mode) for mode in run.contacts.mode] == ["slipping", "sticking"]
    assert np.max(run.held_residual) < 1e-14


def test_an_impact_has_its_history():
    run = carom.simulate(on_floor([0, 1], [2, 0]), 0.5)
    layer = run.impact_history(0)
    np.testing.assert_allclose(
        layer.velocity[-1], run.impacts[0].relative_velocity_after, rtol=0, atol=1e-12
    )


@pytest.mark.parametrize("size", [1e-4, 1e4])
def test_differences_have_the_sizes_of_the_coordinates(size):
    # As above, of plain functions: their derivatives are differences, over parts of the sizes.
    ends = []
    for unit in (1.0, size):
        system = GeneralizedSystem(
            lambda q, unit=unit: unit**2 * np.diag([1.0, 1.0, 2.0 + np.cos(unit * q[1])]),
            np.array([0.0, 0.7, 0.4]) / unit, np.array([0.3, 0.0, 1.0]) / unit, scale=1.0 / unit,
            potential=lambda q, unit=unit: G * np.sin(unit * q[1]),
        )  # fmt: skip
        system.add_contact(lambda q, unit=unit: np.sin(unit * q[1]), restitution=0.5)
        ends.append(unit * carom.simulate(system, 1.0).q[-1])
    np.testing.assert_allclose(ends[1], ends[0], rtol=0, atol=1e-7)


@pytest.mark.parametrize("size", [1e-3, 1e4])
def test_coordinates_in_other_units_move_alike(size):
    """A rod in coordinates of 1/size metres and radians, with tolerances in their sizes."""
    q, v = symbols("x z a")
    runs = []
    for unit in (1.0, size):
        x, z, a = (sp.Float(unit) * one for one in q)
        ends = [(x + k * sp.cos(a) / 2, z + k * sp.sin(a) / 2) for k in (-1, 1)]
        system = GeneralizedSystem.from_sympy(
            q, v, metric=unit**2 * sp.diag(1, 1, sp.Rational(1, 12)), potential=G * z,
            position=np.array([0, 0.7, 0.4]) / unit, velocity=np.array([0.3, 0, 1.0]) / unit,
            scale=1.0 / unit,
        )  # fmt: skip
        for end in ends:
            system.add_contact(end[1], tangent=rate(end[0], q, v), restitution=0.5, friction=0.3)
        runs.append((unit, carom.simulate(system, 1.5, rtol=1e-8)))
    (_, first), (unit, other) = runs
    # rest after 39 impacts; no rule has a unit, so the trial steps are as many but for round-off
    assert abs(other.stats["trial_steps"] - first.stats["trial_steps"]) <= 10
    assert len(other.impacts) == len(first.impacts)
    np.testing.assert_allclose(unit * other.q[-1], first.q[-1], rtol=0, atol=1e-7)
