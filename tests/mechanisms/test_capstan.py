"""Ropes that rub on what they go round: T_2 <= T_1 exp(mu phi), in stick, slip and jerks, by closed forms."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from carom import GROUND, joints
from files.compare import goes_on
from verified import agree, verifies

G, R = 9.81, 0.1
HOW = [({}, 1e-8), ({"rtol": 1e-10}, 1e-10), ({"step": 1e-2}, 1e-10)]


def post(masses, mu, speed=0.0, on=GROUND, turns=0, height=(-1.0, -1.0), **rope):
    """Two loads on a rope over a round post, or a wheel; the second goes down at a speed."""
    scene = carom.Scene(gravity=(0, 0, -G))
    if on != GROUND:
        scene.add_body(carom.Cylinder(R, 0.02), mass=0.5, inertia=(0.01,) * 3, name="wheel")
        scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "wheel", name="hinge")
    for name, side, mass, z in zip("ab", (-1, 1), masses, height):
        scene.add_body(
            carom.Sphere(0.03), mass=mass, position=(side * R, 0, z), velocity=(0, 0, -side * speed), name=name
        )  # fmt: skip
    guide = carom.Pulley(on, R, (0, 1, 0), friction=mu, center=(0, 0, 0), turns=turns)
    scene.add_rope(["a", guide, "b"], name="rope", **rope)
    return scene


@verifies("Pulley", r"$T_2 = T_1 e^{\mu\pi}$, $(m + E M)\,a = (M - E m)\,g$", "closed form")
@pytest.mark.parametrize(("how", "error"), HOW)
@pytest.mark.parametrize("masses", [(1.0, 2.0), (2.0, 1.0)])
def test_slip(how, error, masses):
    """The heavy side has exp(mu pi) times the tension of the light one: (m + E M) a = (M - E m) g."""
    s = carom.simulate(post(masses, 0.2), 0.6, **how)
    grip, side = np.exp(0.2 * np.pi), 1 if masses[1] > masses[0] else -1
    small, large = sorted(masses)
    a = (large - grip * small) * G / (large + grip * small)
    agree(s["b"].position[:, 2], -1 - side * 0.5 * a * s.t**2, atol=error)
    agree(s["a"].position[:, 2], -1 + side * 0.5 * a * s.t**2, atol=error)
    tension = np.array([small * (G + a), large * (G - a)])[::side]
    agree(s["rope"].tension[1:], np.tile(tension, (len(s.t) - 1, 1)), rtol=1e-9)
    heat = abs(tension[0] - tension[1]) * 0.5 * a * s.t**2
    agree(-s.ledger.friction, heat, atol=error)
    agree(s.total_energy, s.total_energy[0] - heat, atol=10 * error)


@pytest.mark.parametrize("turns", [0, 1, 3])
@pytest.mark.parametrize(("factor", "holds"), [(1 - 1e-6, True), (1 + 1e-6, False)])
def test_at_the_limit(turns, factor, holds):
    """A small weight holds exp(mu (2 turns + 1) pi) times its own, and no more."""
    mu = 0.25
    most = np.exp(mu * (2 * turns + 1) * np.pi)
    s = carom.simulate(post((1.0, factor * most), mu, turns=turns), 0.5, rtol=1e-10)
    fallen = -1 - s["b"].position[-1, 2]
    a = (factor - 1) * most * G / (factor * most + most)
    assert abs(fallen - (0.0 if holds else 0.5 * a * 0.25)) < 1e-12
    assert s["rope"].mode[-1] == ("sticking" if holds else "slipping")


def posts(masses, frictions, places, **rope):
    """Two loads on a rope over posts of the ground, beneath those that are lower than the first."""
    scene = carom.Scene(gravity=(0, 0, -G))
    for name, x, mass in zip("ab", (-R, places[-1][0] + R), masses):
        scene.add_body(carom.Sphere(0.03), mass=mass, position=(x, 0, -1), name=name)
    guides = [
        carom.Pulley(GROUND, R, (0, 1 if z >= 0 else -1, 0), mu, center=(x, 0, z))
        for mu, (x, z) in zip(frictions, places)
    ]
    scene.add_rope(["a", *guides, "b"], name="rope", **rope)
    return scene


@verifies("Pulley", r"guides in series: $T_2 = T_1 e^{\sum_i \mu_i\varphi_i}$", "closed form")
@pytest.mark.parametrize(("factor", "holds"), [(1 - 1e-6, True), (1 + 1e-6, False)])
@pytest.mark.parametrize("middle", [0.0, 0.4])
def test_posts_in_series_at_the_limit(middle, factor, holds):
    """Over a post, beneath a second one, over a third: the exponents add up."""
    steep = np.arctan2(0.5, 1.0) + np.arcsin(2 * R / np.hypot(1.0, 0.5))
    outer = 0.5 * np.pi + steep
    most = np.exp(0.3 * outer + middle * 2 * steep + 0.2 * outer)
    places = [(0.0, 0.0), (1.0, -0.5), (2.0, 0.0)]
    for large in (0, 1):
        masses = [1.0, 1.0]
        masses[large] = factor * most
        s = carom.simulate(posts(masses, (0.3, middle, 0.2), places), 0.5, rtol=1e-10)
        fallen = -1 - s["ab"[large]].position[-1, 2]
        a = (factor - 1) * most * G / (factor * most + most)
        assert abs(fallen - (0.0 if holds else 0.5 * a * 0.25)) < 1e-11
        assert s["rope"].mode[-1] == ("sticking" if holds else "slipping")
        tension = s["rope"].tension[-1]
        agree(tension[large] / tension[1 - large], min(factor, 1.0) * most, rtol=1e-9)


@pytest.mark.parametrize(("how", "error"), HOW)
def test_it_stops_and_is_held(how, error):
    """A load that goes down is slowed down, (E m - M) g/(M + E m), and is held."""
    mu, v = 0.3, 1.0
    s = carom.simulate(post((1.0, 2.0), mu, v), 1.2, **how)
    grip = np.exp(mu * np.pi)
    slow = (grip - 2) * G / (2 + grip)
    t = np.minimum(s.t, v / slow)
    np.testing.assert_allclose(s["b"].position[:, 2], -1 - v * t + 0.5 * slow * t**2, atol=error)
    np.testing.assert_allclose(s["rope"].tension[-1], (G, 2 * G), rtol=1e-9)
    np.testing.assert_allclose(
        s.total_energy[-1] - s.total_energy[0], s.ledger.friction[-1], atol=error
    )


@pytest.mark.parametrize("e", [0.0, 0.5])
@pytest.mark.parametrize("large", [1.5, 4.0])
def test_a_jerk(e, large):
    """Both fall freely until the slack is out. Impulses are in the ratio exp(mu pi), or both sides stick."""
    mu, slack = 0.2, 0.1
    scene = post((1.0, large), mu, length=2.0 + np.pi * R + slack, restitution=e)
    s = carom.simulate(scene, 0.2, rtol=1e-10)
    grip, v = np.exp(mu * np.pi), np.sqrt(slack * G)
    np.testing.assert_allclose(s.impacts.time[0], v / G, atol=1e-10)
    first = s.impacts.impulse[0]
    before, behind = first[0] + 0.5 * first[1], first[0] - 0.5 * first[1]
    if large > grip:
        small = (1 + e) * 2 * v / (1 + grip / large)
        np.testing.assert_allclose((before, behind), (small, grip * small), rtol=1e-9)
    else:  # each load is stopped alone, and thrown back
        np.testing.assert_allclose((before, behind), ((1 + e) * v, large * (1 + e) * v), rtol=1e-9)
    after = np.array([v - before, v - behind / large])
    lost = 0.5 * (1 + large) * v * v - 0.5 * (after**2 @ (1.0, large))
    np.testing.assert_allclose(-s.impacts.energy_change[0], lost, atol=1e-9)
    np.testing.assert_allclose(after.sum(), -e * 2 * v, atol=1e-9)


def jerk(rng, **rope):
    """Simulate a rope with slack over a post or a wheel, with e = 1 and drawn masses, speeds and friction."""
    on = GROUND if rng.random() < 0.5 else "wheel"
    slack = rng.uniform(0.0, 0.1)
    scene = post(
        10.0 ** rng.uniform(-0.5, 0.5, 2), rng.uniform(0.05, 0.6), rng.normal(), on, int(rng.integers(2)),
        rng.uniform(-1.6, -1.0, 2), restitution=1.0, **rope,
    )  # fmt: skip
    scene.replace("rope", upper=scene["rope"].upper + slack)
    for name in "ab":
        scene.replace(name, velocity=scene[name].velocity + (0.3 * rng.normal(), 0, rng.normal()))
    return carom.simulate(scene, 0.25, step=5e-3)


def test_jerks_gain_nothing_and_what_newtons_law_gains_is_said():
    """By default a rope that rubs returns at most what it took; a law that adds energy says so."""
    gains = []
    for seed in range(40):
        ours, newton = (
            jerk(np.random.default_rng([72, seed]), **rope)
            for rope in ({}, {"impact_law": "newton"})
        )
        exchanged = np.max(ours.kinetic_energy)
        assert np.diff(ours.ledger.impacts).max() < 1e-13 * exchanged, seed
        assert ours.warnings == (), seed
        assert abs(ours.ledger.residual).max() < 1e-9 * exchanged, seed
        gain = newton.impacts.energy_change[newton.impacts.energy_change > 0.0].sum()
        gains.append(gain / np.max(newton.kinetic_energy))
        if gains[-1] > 1e-6:
            assert newton.warnings[0].startswith("Newton's law with friction added energy"), seed
    assert np.count_nonzero(np.array(gains) > 1e-6) > 5
    assert np.any((np.array(gains) > 1e-6) & (np.array(gains) < 1e-4))


@pytest.mark.parametrize(("how", "error"), HOW)
@pytest.mark.parametrize("way", [1, -1])
def test_band_brake(how, error, way):
    """A band round a drum, with a weight m at one end: the torque m g R (E - 1), or (1 - 1/E) the other way."""
    mu, m, inertia, spin = 0.3, 0.4, 0.05, 20.0
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(
        carom.Cylinder(R, 0.02), mass=2.0, inertia=(inertia,) * 3, name="drum",
        angular_velocity=(0, way * spin, 0),
    )  # fmt: skip
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "drum", name="hinge")
    scene.add_body(carom.Sphere(0.03), mass=m, position=(R, 0, -1), name="weight")
    band = carom.Pulley("drum", R, (0, 1, 0), friction=mu)
    scene.add_rope([(GROUND, (-R, 0, -1)), band, "weight"], name="band")
    grip = np.exp(mu * np.pi)
    torque = m * G * R * (grip - 1 if way > 0 else 1 - 1 / grip)
    stops = inertia * spin / torque
    s = carom.simulate(scene, 1.2 * stops, **how)
    t = np.minimum(s.t, stops)
    turned = way * (spin * t - 0.5 * torque / inertia * t**2)
    np.testing.assert_allclose(
        s["hinge"].coordinate, turned, atol=1e-5 if "step" in how else 1e3 * error
    )
    np.testing.assert_allclose(s["weight"].position[:, 2], -1, atol=1e-12)
    np.testing.assert_allclose(-s.ledger.friction[-1], 0.5 * inertia * spin**2, rtol=1e-8)
    late = (s.t > 0) & (s.t < 0.99 * stops)
    held = m * G * (grip if way > 0 else 1 / grip)
    np.testing.assert_allclose(
        s["band"].tension[late], np.tile((held, m * G), (late.sum(), 1)), rtol=1e-8
    )


@pytest.mark.parametrize(("how", "error"), HOW)
@pytest.mark.parametrize("mu", [0.05, 0.5])
def test_a_wheel(how, error, mu):
    """The rope turns the wheel by what its friction bears: I alpha = R (T_2 - T_1), or without slip."""
    s = carom.simulate(post((1.0, 2.0), mu, on="wheel"), 0.5, **how)
    grip, inertia = np.exp(mu * np.pi), 0.01 / R**2
    a = G / (3.0 + inertia)
    turns = a / R
    if 2 * (G - a) > grip * (G + a):
        a = (2 - grip) * G / (2 + grip)
        turns = (grip - 1) * (G + a) * R / 0.01
    np.testing.assert_allclose(s["b"].position[:, 2], -1 - 0.5 * a * s.t**2, atol=error)
    np.testing.assert_allclose(s["hinge"].coordinate, 0.5 * turns * s.t**2, atol=10 * error)
    np.testing.assert_allclose(
        s.total_energy, s.total_energy[0] + s.ledger.friction, atol=10 * error
    )


def test_a_wheel_that_spins_takes_the_rope_along():
    """Till it turns as fast as the rope runs; both are linear in time, and from then on there is no slip."""
    mu, spin = 0.1, 20.0
    scene = post((1.0, 1.0), mu, on="wheel")
    scene.replace("wheel", angular_velocity=(0, spin, 0))
    s = carom.simulate(scene, 0.6, rtol=1e-10)
    grip = np.exp(mu * np.pi)
    a = (grip - 1) / (grip + 1) * G
    slow = (grip - 1) * (G - a) * R / 0.01  # the tension at b is m (g - a), the smaller one
    end = spin * R / (a + R * slow)
    t = np.minimum(s.t, end)
    down = 0.5 * a * t**2 + a * end * (s.t - t)
    np.testing.assert_allclose(-1 - s["b"].position[:, 2], down, atol=1e-9)
    np.testing.assert_allclose(s["hinge"].rate[-1] * R, a * end, atol=1e-9)


@verifies(
    "Pulley", r"$T_2 = T_1 e^{\mu\varphi}$ with an angle that changes", "own integration: SciPy"
)
@pytest.mark.parametrize(("how", "error"), [({}, 1e-6), ({"rtol": 1e-10}, 1e-9)])
@pytest.mark.parametrize("other", [None, 0.05, 0.25])
def test_a_load_that_swings(how, error, other):
    """The angle on the post, the last of two, follows the strand: against an integration of its own."""
    m1, m2, mu, v = 1.0, 3.0, 0.15, 0.8
    more = 0.0 if other is None else (other - mu) * 0.5 * np.pi
    scene = post((m1, m2), mu)
    if other is not None:
        scene.remove("rope")
        scene.replace("a", position=(-1 - R, 0, -1))
        guides = [
            carom.Pulley(GROUND, R, (0, 1, 0), k, center=(x, 0, 0))
            for k, x in ((other, -1), (mu, 0))
        ]
        scene.add_rope(["a", *guides, "b"], name="rope")
    scene.replace("b", velocity=(v, 0, 0))
    s = carom.simulate(scene, 0.5, **how)

    def strand(x, z):
        d = np.hypot(x, z)
        length = np.sqrt(d * d - R * R)
        # by the right-hand rule about y: (z, x) is a right-handed pair
        e = np.array([length * x + R * z, length * z - R * x]) / d**2
        return length, e

    def rates(t, y):
        x, z, vx, vz, _, v1 = y
        length, e = strand(x, z)
        turn = (e[0] * vz - e[1] * vx) / length
        phi = np.pi + np.arctan2(-e[0], -e[1])
        grip = np.exp(mu * phi + more)  # b goes down, all the time
        # z1'' = T1/m1 - g, s'' = e.r'' + l turn^2 = z1'', r'' = -T2 e/m2 + g
        T1 = (G - G * e[1] + length * turn**2) / (1 / m1 + grip / m2)
        T2 = grip * T1
        return vx, vz, -T2 * e[0] / m2, -T2 * e[1] / m2 - G, v1, T1 / m1 - G

    known = solve_ivp(
        rates,
        (0, s.t[-1]),
        (R, -1, v, 0, -1, 0),
        method="DOP853",
        rtol=1e-12,
        atol=1e-13,
        t_eval=s.t,
    )
    agree(s["b"].position[:, 0], known.y[0], atol=error)
    agree(s["b"].position[:, 2], known.y[1], atol=error)
    agree(s["a"].position[:, 2], known.y[4], atol=error)
    agree(s.total_energy, s.total_energy[0] + s.ledger.friction, atol=10 * error)


def test_a_guide_that_a_joint_keeps_from_turning():
    """A post on a carriage: the carriage bears the sum of both tensions."""
    scene = post((1.0, 2.0), 0.2)
    scene.remove("rope")
    scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, 0), name="carriage")
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, "carriage", name="rail")
    guide = carom.Pulley("carriage", R, (0, 1, 0), friction=0.2)
    scene.add_rope(["a", guide, "b"], name="rope")
    s = carom.simulate(scene, 0.3)
    grip = np.exp(0.2 * np.pi)
    a = (2 - grip) * G / (2 + grip)
    np.testing.assert_allclose(s["b"].position[:, 2], -1 - 0.5 * a * s.t**2, atol=1e-8)
    np.testing.assert_allclose(s["rail"].force[-1, 2], G + (1 + grip) * (G + a), rtol=1e-8)


def test_beside_a_wheel_without_slip():
    """A rope that a wheel turns, and rubs behind it: two parts, the second with the friction."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Cylinder(R, 0.02), mass=0.5, inertia=(0.01,) * 3, name="wheel")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "wheel", name="hinge")
    for name, x, mass in (("a", -R, 1.0), ("b", 1 + R, 3.0)):
        scene.add_body(carom.Sphere(0.03), mass=mass, position=(x, 0, -1), name=name)
    guide = carom.Pulley(GROUND, R, (0, 1, 0), friction=0.2, center=(1, 0, 0))
    rope = scene.add_rope(["a", carom.Pulley("wheel", R, (0, 1, 0)), guide, "b"], name="rope")
    assert [one.friction for one in rope.stops] == [0.0, 0.2]
    s = carom.simulate(scene, 0.3)
    grip = np.exp(0.2 * 0.5 * np.pi)  # a quarter of a turn lies on each
    a = (3 - grip) * G / (3 + grip * (1 + 0.01 / R**2))
    np.testing.assert_allclose(s["b"].position[:, 2], -1 - 0.5 * a * s.t**2, atol=1e-8)
    np.testing.assert_allclose(s["hinge"].coordinate, 0.5 * a / R * s.t**2, atol=1e-7)
    tensions = (G + a, G + a + a)  # I a/R^2 = a for the wheel
    np.testing.assert_allclose(s["rope.1"].tension[-1], tensions[0], rtol=1e-8)
    np.testing.assert_allclose(s["rope.2"].tension[-1], (tensions[1], 3 * (G - a)), rtol=1e-8)


@pytest.mark.bits
def test_a_file_has_all_guides(tmp_path):
    scene = posts((1.0, 1.5), (0.1, 0.2), [(0.0, 0.0), (1.0, 0.0)])
    whole = goes_on(scene, 0.4, tmp_path / "run.h5", step=1e-2)
    again = carom.Solution.load(tmp_path / "run.h5").scene
    assert again.stops[0].joint.guides == scene.stops[0].joint.guides
    np.testing.assert_array_equal(carom.simulate(again, 0.4, step=1e-2).position, whole.position)


def test_files_and_changes(tmp_path):
    scene = post((1.0, 2.0), 0.2, length=2.0 + np.pi * R + 0.02)
    path = tmp_path / "run.h5"
    whole = goes_on(scene, 0.4, path, step=1e-2)
    again = carom.Solution.load(path).scene
    assert repr(again.stops) == repr(scene.stops)
    np.testing.assert_array_equal(carom.simulate(again, 0.4, step=1e-2).position, whole.position)
    scene.replace("a", mass=3.0)
    assert scene["rope"].joint.terms[0][0].child is scene["a"]
    scene.remove("a", dependents=True)
    assert not scene.stops


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"stiffness": 10.0}, "stiffness must be left out of a rope with friction"),
        ({"over": 2}, "friction must be above 0 for one pulley"),
        ({"over": 2, "wheel": "free"}, "friction must be above 0 for one pulley"),
        ({"wheel": "free"}, r"must have a Revolute joint about its axis, on carom\.GROUND"),
        ({"friction": -0.1}, "friction must be"),
        ({"turns": 0.5}, "turns must be"),
    ],
)
def test_wrong_input(more, message):
    scene = post((1.0, 1.0), 0.1)
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 1), name="free")
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(1, 0, 0), name="moved")
    scene.add_joint(joints.Fixed(), GROUND, "moved")
    other = carom.Pulley("moved", R, (0, 1, 0), friction=0.1, center=(1, 0, 0))

    def add(stiffness=None, over=1, wheel=GROUND, friction=0.2, turns=0):
        guide = carom.Pulley(wheel, R, (0, 1, 0), friction, center=(0, 0, 0), turns=turns)
        scene.add_rope(["a", guide, *[other] * (over - 1), "b"], stiffness=stiffness, name="other")

    with pytest.raises((ValueError, TypeError), match=message):
        add(**more)
