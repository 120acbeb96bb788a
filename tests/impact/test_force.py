"""Force and duration of an impact: closed forms, a spring integrated in time, and what a run reports."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import beta

import carom
from carom import Hertz, Stiffness
from carom.results import waves
from verified import agree, verifies

FRICTION = np.array([[2.5, -1.5, 0], [-1.5, 2.5, 0], [0, 0, 1.0]]), (-1.0, 2.0, 0.0), 0.2


@verifies(
    "Stiffness", "$m v^2/2 = k d^{n+1}/(n+1)$, duration by Euler's beta function", "closed form"
)
@verifies("add_contact(stiffness=)", "peak force $k d^n$", "closed form")
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("n", [1.0, 1.5, 3.0])
def test_central_impact(n, e):
    m, v, k = 0.03, 1.7, 1e7
    impact = carom.resolve_impact(
        np.diag([1 / m, 1, 1]), (-v, 0, 0), 0.0, e, stiffness=Stiffness(k, n)
    )
    # m v^2/2 = k d^(n+1)/(n+1); time to there d/v times B(1/(n+1), 1/2)/(n+1); unloading takes e times as long
    d = ((n + 1) * m * v**2 / (2 * k)) ** (1 / (n + 1))
    time = d / v * beta(1 / (n + 1), 0.5) / (n + 1)
    force = impact.force()
    agree(impact.peak_force, k * d**n, rtol=1e-13)
    agree(impact.duration, time * (1 + e), rtol=1e-11)
    agree(force.compression_time, time, rtol=1e-11)
    agree(force.depth.max(), d, rtol=1e-12)
    agree(force.velocity[-1, 0], e * v, atol=1e-14)


@pytest.mark.parametrize(
    ("n", "e", "compression", "duration", "peak"),
    [
        (1.0, 1.0, 9.387303545e-4, 1.8774607e-3, 597.6143047),
        (1.0, 0.5, 9.387303545e-4, 1.4080955e-3, 597.6143047),
        (1.5, 0.5, 4.2432797597e-3, 6.3649195e-3, 154.8286008),
    ],
)
def test_numbers_of_a_spring_integrated_in_time(n, e, compression, duration, peak):
    impact = carom.resolve_impact(*FRICTION, e, stiffness=Stiffness(1e6, n))
    assert impact.force().compression_time == pytest.approx(compression, rel=3e-10)
    assert impact.duration == pytest.approx(duration, rel=3e-8)
    assert impact.peak_force == pytest.approx(peak, rel=1e-9)


def random_impact(rng):
    """Return the arguments of a random impact, and its exponent and stiffness."""
    A = rng.normal(size=(3, 3))
    W = A @ A.T + 10.0 ** rng.uniform(-3, 0) * np.eye(3)
    u = np.array([-rng.uniform(0.05, 3), *(3.0 * rng.normal(size=2) * (rng.random() < 0.9))])
    mu = rng.uniform(0, 2) * (rng.random() < 0.9)
    e, law = (
        rng.choice([0.0, 1.0, rng.uniform(0.05, 1)]),
        str(rng.choice(["newton", "poisson", "stronge"])),
    )
    n, k = float(rng.choice([1.0, 1.5, 2.5])), 10.0 ** rng.uniform(2, 9)
    return (W, u, mu, e, law), Stiffness(k, n)


@verifies("Stiffness", "a spring with friction in three dimensions", "own integration: SciPy")
def test_random_impacts_that_slip_are_those_of_a_spring():
    rng, tried = np.random.default_rng(7), 0
    while tried < 30:
        given, stiffness = random_impact(rng)
        W, u, mu, *_ = given
        try:
            impact = carom.resolve_impact(*given, stiffness=stiffness)
        except ValueError:
            continue
        if impact.phases != ("slip",) or mu == 0.0:
            continue
        tried += 1

        def rates(t, y, W=W, mu=mu, stiffness=stiffness):
            N = stiffness.k * max(y[0], 0.0) ** stiffness.exponent
            slip = y[2:4] / np.hypot(y[2], y[3])
            return np.concatenate([[-y[1]], W @ np.append(N, -mu * N * slip)])

        def turns(t, y):
            return y[1]

        turns.terminal = True
        start, force = np.append(0.0, u), impact.force()
        spring = solve_ivp(
            rates, (0, 1e4), start, events=turns, rtol=1e-12, atol=1e-16, method="DOP853"
        )
        agree(force.compression_time, spring.t[-1], rtol=1e-8)
        agree(force.depth.max(), spring.y[0, -1], rtol=1e-8)


def test_random_impacts_keep_the_cone_and_end_as_they_do():
    rng, opened = np.random.default_rng(8), 0
    for _ in range(300):
        given, stiffness = random_impact(rng)
        try:
            impact = carom.resolve_impact(*given, stiffness=stiffness)
        except ValueError:
            continue
        try:
            force = impact.force()
        except ValueError:  # it opens within the impact
            opened += 1
            continue
        size = 1.0 + np.abs(impact.impulse).max()
        np.testing.assert_allclose(force.impulse[-1], impact.impulse, atol=1e-9 * size)
        np.testing.assert_allclose(force.velocity[-1], impact.velocity_after, atol=1e-8 * size)
        friction = np.linalg.norm(force.friction_force, axis=1)
        assert np.all(friction <= given[2] * force.normal_force + 1e-9 * force.peak_force)
        assert force.normal_force.max() <= force.peak_force * (1 + 1e-9)
        assert np.all(np.diff(force.t) >= 0.0)
        total = np.trapezoid(force.normal_force, force.t)
        assert total == pytest.approx(impact.impulse[0], rel=5e-2)
    assert opened <= 3


def ball(**stiffness):
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    scene.add_body(
        carom.Sphere(0.02), mass=0.03, position=(0, 0, 0.52), velocity=(0.3, 0, 0), name="ball"
    )
    scene.add_contact("ball", "floor", restitution=0.7, friction=0.2, **stiffness)
    return scene


@verifies("Hertz", r"$k = \tfrac43 E^* \sqrt R$, $F = k d^{3/2}$", "closed form")
def test_a_run_reports_what_it_was_told(tmp_path):
    hertz = Hertz(2e9, 0.3)
    solution, plain = carom.simulate(ball(stiffness=hertz), 1.0), carom.simulate(ball(), 1.0)
    assert np.array_equal(solution.position, plain.position)
    assert np.all(np.isnan(plain.impacts.peak_force))
    assert np.all(np.isnan(plain.impacts.duration))
    v, (k, n) = -solution.impacts.relative_velocity_before[:, 0], hertz._of(1 / 0.02)
    agree(k, 4 / 3 * 2e9 / (2 * 0.91) * np.sqrt(0.02), rtol=1e-6)
    assert n == 1.5
    d = (1.25 * 0.03 * v**2 / k) ** 0.4
    agree(solution.impacts.peak_force, k * d**1.5, rtol=1e-12)
    time = 0.4 * beta(0.4, 0.5) * d / v * 1.7
    agree(solution.impacts.duration, time, rtol=1e-9)
    alone = plain.impacts[0].force(Hertz(2e9, 0.3, radius=0.02))
    agree(alone.duration, time[0], rtol=1e-9)
    solution.save(tmp_path / "drop.nc")
    loaded = carom.Solution.load(tmp_path / "drop.nc")
    assert np.array_equal(loaded.impacts.peak_force, solution.impacts.peak_force)
    assert np.array_equal(loaded.impacts.duration, solution.impacts.duration)
    assert loaded.scene["ball-floor"].stiffness == hertz


@verifies("Material", r"peak force $k^{2/5} (\tfrac54 m v^2)^{3/5}$", "closed form")
def test_materials_with_a_modulus_have_hertz_s_law():
    scene = carom.Scene()
    steel = carom.Material(0.6, 0.1, young=210e9)
    scene.add_half_space((0, 0, 0), (0, 0, 1), material=steel, name="floor")
    for k in range(2):
        scene.add_body(
            carom.Sphere(0.02),
            mass=0.26,
            position=(0.5 * k, 0, 0.1),
            material=steel,
            name=f"ball{k}",
        )
    scene.add_body(
        carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(1, 0, 0.2), material=steel, name="box"
    )
    scene.set_contact_default()
    impacts = carom.simulate(scene, 0.25).impacts
    (ball0,) = impacts[impacts.body == "ball0"].peak_force[:1]
    v, (k, _) = np.sqrt(2 * 9.81 * 0.08), Hertz(210e9, 0.3, radius=0.02)._of(None)
    agree(ball0, k**0.4 * (1.25 * 0.26 * v * v) ** 0.6, rtol=1e-9)
    assert np.all(np.isnan(impacts[impacts.body == "box"].peak_force))


def test_many_impacts_have_many_forces():
    speeds = np.array([[-1.0, 0.5], [-2.0, 0.1]])
    many = carom.resolve_impact(np.diag([1.0, 3.5]), speeds, 0.1, 0.5, stiffness=Stiffness(1e6))
    np.testing.assert_allclose(many.peak_force, [1e3, 2e3], rtol=1e-12)
    assert np.isnan(carom.resolve_impact(*FRICTION, 0.5).peak_force)


def test_what_has_no_force_is_refused():
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    scene.add_body(carom.Box(1, 1, 1), mass=1.0, position=(0, 0, 1), name="box")
    with pytest.raises(ValueError, match="must have a radius"):
        scene.add_contact("box", "floor", stiffness=Hertz(1e9))
    scene.add_contact(
        "box", "floor", restitution=0.5, friction=0.1, stiffness=Hertz(1e9, radius=0.1)
    )
    flat = carom.simulate(scene, 0.5).impacts
    assert flat.together[0] == 1 or np.isnan(flat.duration[0])
    with pytest.raises(ValueError, match="radius"):
        carom.resolve_impact(*FRICTION, 0.5, stiffness=Hertz(1e9))
    with pytest.raises(TypeError, match="stiffness"):
        carom.resolve_impact(*FRICTION, 0.5).force()


def struck(shape, partner=None, orientation=(1, 0, 0, 0), height=0.1, **hertz):
    """Return the first impact of a body on a plane or on a fixed shape, at 1 m/s."""
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(
        shape,
        mass=0.03,
        position=(0, 0, height),
        velocity=(0, 0, -1),
        orientation=orientation,
        name="body",
    )
    if partner is None:
        scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    else:
        scene.add_static(partner, position=(0, 0, -0.02), name="floor")
    stated = Hertz((2e9, 70e9), (0.35, 0.33), **hertz)
    scene.add_contact("body", "floor", restitution=0.7, friction=0.2, stiffness=stated)
    return carom.simulate(scene, 0.2)


def elliptic(high, low):
    """Return R^(1/2) F2^(-3/2) of Hertz's law by SciPy (Johnson 1985, 4.26 to 4.32)."""
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipk

    def parts(k):
        K, E = ellipk(1 - k * k), ellipe(1 - k * k)
        return K, E / k**2 - K, K - E

    def wrong(k):
        _, a, b = parts(k)
        return a / b - high / low

    k = brentq(wrong, 1e-3, 1 - 1e-9)
    K, a, b = parts(k)
    F1 = (4 / (np.pi * (1 - k * k)) * k**1.5 * np.sqrt(a * b)) ** (1 / 3)
    F2 = 2 / np.pi * np.sqrt(k) * K / F1
    return (high * low) ** -0.25 * F2**-1.5


def test_an_ellipsoid_has_the_curvatures_of_its_point():
    a, b, c = 0.03, 0.02, 0.01
    peak = struck(carom.Ellipsoid(a, b, c)).impacts.peak_force[0]
    k = 4 / 3 * Hertz((2e9, 70e9), (0.35, 0.33)).modulus * elliptic(c / b**2, c / a**2)
    assert peak == pytest.approx(k**0.4 * (1.25 * 0.03) ** 0.6, rel=1e-9)
    lying = struck(carom.Ellipsoid(b, c, a), orientation=carom.euler("xyz", (0, 90, 0)))
    k = 4 / 3 * Hertz((2e9, 70e9), (0.35, 0.33)).modulus * elliptic(b / c**2, b / a**2)
    assert lying.impacts.peak_force[0] == pytest.approx(k**0.4 * (1.25 * 0.03) ** 0.6, rel=1e-9)
    force = carom.plots.impact_force(lying, 0, panel="force")
    assert force.lines[0].get_ydata().max() > 0.0


def test_a_ball_is_an_ellipsoid_of_equal_axes():
    ball, same = carom.Sphere(0.02), carom.Ellipsoid(0.02, 0.02, 0.02)
    for partner in (None, ball, same):
        one, two = struck(ball, partner).impacts, struck(same, partner).impacts
        assert two.peak_force[0] == pytest.approx(one.peak_force[0], rel=1e-12)
        assert two.duration[0] == pytest.approx(one.duration[0], rel=1e-9)


def test_two_ellipsoids_across_each_other():
    """Two that lie crosswise have the sums of their curvatures; turned by 90 degrees they have others."""
    flat, long = carom.Ellipsoid(0.02, 0.02, 0.01), carom.Ellipsoid(0.04, 0.02, 0.02)
    modulus = Hertz((2e9, 70e9), (0.35, 0.33)).modulus
    for turn in (0, 90):
        peak = struck(long, flat, carom.euler("xyz", (0, 0, turn))).impacts.peak_force[0]
        low, high = sorted([0.02 / 0.04**2 + 0.01 / 0.02**2, 0.02 / 0.02**2 + 0.01 / 0.02**2])
        k = 4 / 3 * modulus * elliptic(high, low)
        assert peak == pytest.approx(k**0.4 * (1.25 * 0.03) ** 0.6, rel=1e-8)


def test_a_run_says_where_waves_are_as_slow_as_the_impact():
    """A ball of 2 cm strikes for .24 ms, a wave needs .054 ms; .15 ms in a rod of 40 cm of the same mass."""
    ball = struck(carom.Sphere(0.02))
    assert not ball.warnings
    assert ball.impacts.duration[0] == pytest.approx(2.4e-4, rel=5e-3)
    assert waves._wave(ball.scene["body"], 2e9) == pytest.approx(5.35e-5, rel=1e-3)
    rod = struck(
        carom.Capsule(0.02, 0.4),
        orientation=carom.euler("xyz", (0, 3, 0)),
        height=0.25,
        radius=0.02,
    )
    (said,) = [str(one) for one in rod.warnings if "wave" in str(one)]
    assert "'body-floor'" in said
    assert "'body'" in said
    wave = 4 * 0.22 * np.sqrt(0.03 / carom.Capsule(0.02, 0.4).volume / 2e9)
    assert wave == pytest.approx(1.47e-4, rel=2e-3)
    assert f"{wave:.2g} s to pass" in said


@verifies("add_stop(stiffness=)", "M = (k J)^(1/2) w, T = pi/2 (J/k)^(1/2) (1 + e)", "closed form")
@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_a_stop_of_an_angle_has_a_torque(exponent, tmp_path):
    """A rod that falls on a stop is a spring in its hinge: M = (k J)^(1/2) w, T = pi/2 (J/k)^(1/2) (1 + e)."""
    scene = carom.Scene(gravity=(0, 0, 0))
    rod = scene.add_body(
        carom.Box(0.5, 0.02, 0.02), mass=2.0, position=(0.25, 0, 0), angular_velocity=(0, 3, 0),
        velocity=(0, 0, -0.75), name="rod",
    )  # fmt: skip
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)
    stiffness = Stiffness(4e4, exponent)
    scene.add_stop(hinge, upper=0.3, restitution=0.6, stiffness=stiffness, name="stop")
    solution = carom.simulate(scene, 0.2)
    hit = solution.impacts[0]
    J = 2.0 / 12 * (0.5**2 + 0.02**2) + 2.0 * 0.25**2
    expected = carom.resolve_impact(np.diag([1 / J, 0, 0]), (-3, 0, 0), 0, 0.6, stiffness=stiffness)
    agree(hit.peak_force, expected.peak_force, rtol=1e-9)
    agree(hit.duration, expected.duration, rtol=1e-9)
    assert hit.force(stiffness).peak_force == pytest.approx(hit.peak_force, rel=1e-9)
    if exponent == 1.0:
        agree(hit.peak_force, np.sqrt(4e4 * J) * 3, rtol=1e-9)
        agree(hit.duration, np.pi / 2 * np.sqrt(J / 4e4) * 1.6, rtol=1e-9)
    with pytest.raises(TypeError, match="of a stop of an angle"):
        hit.force(Hertz(1e9, radius=0.1))
    solution.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    assert again.scene["stop"].stiffness == stiffness
    assert again.impacts.peak_force[0] == pytest.approx(hit.peak_force, rel=1e-12)
    assert scene.copy().replace("stop", lower=None, stiffness=None) is not None


def test_a_stop_of_a_slide_has_a_force():
    scene = carom.Scene(gravity=(0, 0, 0))
    ram = scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=4.0, velocity=(2, 0, 0), name="ram")
    way = scene.add_joint(carom.joints.Prismatic((1, 0, 0)), carom.GROUND, ram)
    scene.add_stop(way, upper=0.1, restitution=1.0, stiffness=Stiffness(1e6))
    hit = carom.simulate(scene, 0.1).impacts[0]
    assert hit.peak_force == pytest.approx(2 * np.sqrt(4e6), rel=1e-9)
    assert hit.duration == pytest.approx(np.pi * np.sqrt(4e-6), rel=1e-9)
