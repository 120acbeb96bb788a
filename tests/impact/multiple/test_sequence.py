"""Blow by blow, pair by pair: the textbook's cradle, faces that land flat, what is symmetric stays so."""

import numpy as np
import pytest
from multiple_cases import DIE, strike_row

import carom
from carom import Options, Scene
from carom.impact.multiple.api import resolve_impacts

R = 0.01  # radius of a ball [m]
BALLS = (1, 0, 0, 0, 0), (1, 1, 0, 0, 0), (1, 1, 1, 0, 0), (1, 0, 0, 0, -1), (1, 1, 0, 0, -1)


def cradle(speeds, e=1.0, multiple="simultaneous", gap=0.0, **options):
    """Velocities after of balls in a row, those that move 1 mm away from the others; and the solution."""
    scene = Scene(gravity=(0, 0, 0))
    for i, v in enumerate(speeds):
        x = i * (2 * R + gap) - 1e-3 * v
        scene.add_body(carom.Sphere(R), mass=0.03, position=(x, 0, 0), velocity=(v, 0, 0))
    scene.set_contact_default(restitution=e, impact_law="stronge", multiple=multiple)
    s = carom.simulate(scene, 0.02, step=1e-3, options=Options(**options))
    return s.velocity[-1, :, 0], s


def textbook(speeds):
    """Equal balls that exchange velocities at each blow: they are sorted in the end."""
    return np.sort(speeds)


@pytest.mark.parametrize("speeds", BALLS)
def test_the_textbook_is_named_in_the_scene(speeds):
    # e = 1: exchanged in each blow. Speeds are exact but for rounding of the normals.
    after, s = cradle(speeds, multiple="sequential")
    np.testing.assert_allclose(after, textbook(speeds), rtol=0, atol=1e-12)
    assert abs(s.kinetic_energy[-1] / s.kinetic_energy[0] - 1) < 1e-12


@pytest.mark.parametrize("speeds", BALLS)
def test_the_option_names_it_for_all_contacts(speeds):
    scene = Scene(gravity=(0, 0, 0))
    for i, v in enumerate(speeds):
        scene.add_body(
            carom.Sphere(R), mass=1.0, position=(2 * R * i - 1e-3 * v, 0, 0), velocity=(v, 0, 0)
        )
    scene.set_contact_default(restitution=1.0)
    s = carom.simulate(scene, 0.02, step=1e-3, options=Options(multiple="sequential"))
    np.testing.assert_allclose(s.velocity[-1, :, 0], textbook(speeds), rtol=0, atol=1e-12)


@pytest.mark.parametrize("e", [1.0, 0.95, 0.5])
def test_balls_that_do_not_quite_touch_are_the_sequence(e):
    # 10 micrometres apart each blow is over before the next begins, whatever the exponent.
    apart, s = cradle((1, 0, 0, 0, 0), e, gap=1e-5)
    assert np.all(s.impacts.together == 1)
    in_sequence, _ = cradle((1, 0, 0, 0, 0), e, multiple="sequential")
    np.testing.assert_allclose(in_sequence, apart, rtol=0, atol=1e-12)


def hertz(speeds):
    """Velocities after of equal balls that touch, with F = d^(3/2) at each contact: integrated."""
    from scipy.integrate import solve_ivp

    n = len(speeds)

    def rates(t, y):
        force = np.maximum(y[: n - 1] - y[1:n], 0) ** 1.5
        return np.concatenate([y[n:], np.append(0, force) - np.append(force, 0)])

    start = np.concatenate([np.zeros(n), speeds])
    run = solve_ivp(rates, (0, 100), start, method="DOP853", rtol=1e-10, atol=1e-12)
    return run.y[n:, -1]


@pytest.mark.parametrize("speeds", BALLS)
def test_balls_that_touch_follow_hertz(speeds):
    after, s = cradle(speeds)
    np.testing.assert_allclose(after, hertz(speeds), rtol=0, atol=1e-6)
    assert abs(s.kinetic_energy[-1] / s.kinetic_energy[0] - 1) < 1e-12  # no part of 1e-8 is lost


def test_the_exponent_is_that_of_the_shapes():
    # Points of balls and ellipsoids: p = 3/2, but where the option says otherwise.
    def three(last, **options):
        scene = Scene(gravity=(0, 0, 0))
        for i, shape in enumerate((carom.Sphere(R), carom.Sphere(R), last)):
            scene.add_body(
                shape, mass=1.0, position=(2 * R * i - (1e-3 if i == 0 else 0), 0, 0),
                velocity=(1.0 if i == 0 else 0.0, 0, 0),
            )  # fmt: skip
        scene.set_contact_default(restitution=1.0)
        s = carom.simulate(scene, 0.01, step=1e-3, options=Options(**options))
        return s.velocity[-1, :, 0]

    round_, linear = (
        (-0.0709523536, 0.0764030391, 0.9945493146),
        (-0.1302616951, 0.1502295694, 0.9800321256),
    )
    ellipsoid = carom.Ellipsoid(R, R, R)  # others have other curvatures: test_hertz.py
    np.testing.assert_allclose(three(carom.Sphere(R)), round_, rtol=0, atol=1e-6)
    np.testing.assert_allclose(three(ellipsoid), round_, rtol=0, atol=1e-6)
    np.testing.assert_allclose(
        three(carom.Sphere(R), corner_exponent=1.0), linear, rtol=0, atol=1e-6
    )
    cube = carom.Box(2 * R, 2 * R, 2 * R)
    scene_of_two_exponents = three(cube), three(cube, corner_exponent=1.5)
    # A ball on the face of a box touches in a point, too.
    np.testing.assert_allclose(*scene_of_two_exponents, rtol=0, atol=1e-9)


def test_a_box_on_a_box_is_no_point_of_a_ball():
    def landing(**options):
        scene = Scene(gravity=(0, 0, 0))
        scene.add_half_space((0, 0, 0), (0, 0, 1))
        for z, v in ((0.05, 0.0), (0.15 + 1e-3, -1.0)):
            scene.add_body(
                carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, z), velocity=(0, 0, v)
            )
        scene.set_contact_default(restitution=0.8)
        s = carom.simulate(scene, 2e-3, step=1e-3, options=Options(**options))
        return s.velocity[-1, :, 2]

    np.testing.assert_array_equal(landing(), landing(corner_exponent=1.0))
    assert np.abs(landing() - landing(corner_exponent=1.5)).max() > 1e-3


@pytest.mark.parametrize("by", ["contact", "option"])
@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_a_box_that_lands_flat_does_not_rock(by, turn):
    # Four points of one pair are one blow: it rises as it fell, times e, and does not turn.
    scene = Scene(gravity=(0, 0, -9.81))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    box = scene.add_body(
        carom.Box(0.1, 0.06, 0.04), mass=1.0, position=(0, 0, 0.1),
        orientation=(np.cos(turn / 2), 0, 0, np.sin(turn / 2)),
    )  # fmt: skip
    multiple = {"multiple": "sequential"}
    scene.add_contact(
        box, ground, restitution=0.6, friction=0.4, **multiple if by == "contact" else {}
    )
    options = Options(**multiple if by == "option" else {})
    s = carom.simulate(scene, 0.15, step=1e-3, options=options)
    before, after = (s.evaluate(s.impacts.time[0], side) for side in ("left", "right"))
    np.testing.assert_allclose(after[2][0], -0.6 * before[2][0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(s.angular_velocity[-1, 0], 0, rtol=0, atol=1e-10)


@pytest.mark.parametrize("multiple", ["simultaneous", "sequential"])
def test_points_of_one_pair_strike_together(multiple):
    # A box with a turn of its own: its points on one half-space are one pair, and by either way the same.
    def thrown(multiple):
        scene = Scene(gravity=(0, 0, 0))
        ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
        box = scene.add_body(
            carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, 0.05), velocity=(0.2, 0, -1),
            angular_velocity=(2, 1, 0),
        )  # fmt: skip
        scene.add_contact(box, ground, restitution=0.6, friction=0.4, multiple=multiple)
        s = carom.simulate(scene, 1e-3, step=1e-3)
        return np.concatenate([s.velocity[-1, 0], s.angular_velocity[-1, 0]])

    np.testing.assert_array_equal(thrown(multiple), thrown("simultaneous"))


@pytest.mark.parametrize("e", [1.0, 0.7])
@pytest.mark.parametrize("multiple", ["simultaneous", "sequential"])
def test_what_is_symmetric_stays_so(multiple, e):
    # The break of a triangle, struck in its axis of symmetry: y -> -y exchanges pairs of balls.
    scene = Scene(gravity=(0, 0, 0))
    places = [(np.sqrt(3) * R * i, R * (2 * j - i)) for i in range(3) for j in range(i + 1)]
    for x, y in places:
        scene.add_body(carom.Sphere(R), mass=0.17, position=(x, y, 0))
    scene.add_body(carom.Sphere(R), mass=0.17, position=(-2.1 * R, 0, 0), velocity=(1, 0, 0))
    scene.set_contact_default(restitution=e, friction=0.1, impact_law="stronge", multiple=multiple)
    s = carom.simulate(scene, 0.01, step=1e-3)
    v = s.velocity[-1]
    mirror = [
        places.index(min(places, key=lambda p: np.hypot(p[0] - x, p[1] + y))) for x, y in places
    ]
    np.testing.assert_allclose(v[mirror] * (1, -1, 1), v[:6], rtol=0, atol=1e-7)
    np.testing.assert_allclose(v[6, 1], 0, atol=1e-7)
    assert np.all(np.diff(s.kinetic_energy) <= 1e-12 * s.kinetic_energy[0])


def test_a_box_between_two_others_stays_level():
    # It falls on two equal boxes at once: two pairs that approach equally fast are one blow.
    scene = Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for x in (-0.1, 0.1):
        scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(x, 0, 0.05))
    top = scene.add_body(carom.Box(0.3, 0.1, 0.02), mass=0.5, position=(0, 0, 0.15))
    scene.set_contact_default(restitution=0.5, friction=0.3, multiple="sequential")
    s = carom.simulate(scene, 0.1, step=1e-3)
    assert s.velocity[-1, top.index, 2] > 0
    np.testing.assert_allclose(s.angular_velocity[-1, top.index], 0, atol=1e-8)
    np.testing.assert_allclose(s.velocity[-1, top.index, 0], 0, atol=1e-9)


@pytest.mark.parametrize("law", ["newton", "stronge", "poisson"])
@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_a_sequence_gains_nothing(law, mu):
    # The four corners of a die, each for itself.
    fall = np.array([0.3, 0.1, -2, 3, 1, 5])
    u = (DIE.G @ fall).reshape(4, 3)
    impact = resolve_impacts(DIE.W, u, mu, 0.7, law, multiple="sequential")
    assert impact.energy_change <= 0
    assert impact.velocity_after[:, 0].min() >= -1e-9


def test_equal_speeds_strike_together():
    # Both ends of a row at once: the middle ball stays, to the last bit.
    v, _ = strike_row((1, 0, 0, 0, -1), 0.8, multiple="sequential")
    np.testing.assert_allclose(v, -v[::-1], rtol=0, atol=1e-15)
    assert v[2] == 0


def test_no_other_name():
    with pytest.raises(ValueError, match="multiple must be"):
        Scene().set_contact_default(multiple="newton")


@pytest.mark.few(4)
@pytest.mark.parametrize("gravity", [(0, 0, 0), (0, 0, -9.81)])
@pytest.mark.parametrize("speeds", BALLS)
def test_any_direction(speeds, gravity):
    # Normals are rounded, and balls that stop keep 1e-16 m/s: no impacts without end, no step taken whole.
    rng = np.random.default_rng(1)
    for way in rng.normal(size=(6, 3)):
        way /= np.linalg.norm(way)
        scene = Scene(gravity=gravity)
        for i, v in enumerate(speeds):
            x = 2 * R * i - 1e-3 * v
            scene.add_body(carom.Sphere(R), mass=0.03, position=x * way, velocity=v * way)
        scene.set_contact_default(restitution=1.0, multiple="sequential")
        s = carom.simulate(scene, 0.02, step=1e-3)
        after = (s.velocity[-1] - 0.02 * np.array(gravity)) @ way
        np.testing.assert_allclose(after, textbook(speeds), rtol=0, atol=1e-9)
        assert s.stats["whole_steps"] == 0


def test_the_break_of_a_triangle_by_hertz():
    # 16 balls in a plane, struck 3 mm beside the axis: corners and cue ball as of scipy's integration of
    # F = d^(3/2) at all contacts (4 digits).
    r = 0.0286
    scene = Scene(gravity=(0, 0, 0))
    for i in range(5):
        for j in range(i + 1):
            scene.add_body(
                carom.Sphere(r), mass=0.17, position=(np.sqrt(3) * r * i, r * (2 * j - i), 0)
            )
    scene.add_body(carom.Sphere(r), mass=0.17, position=(-2.1 * r, 0.003, 0), velocity=(5, 0, 0))
    scene.set_contact_default(restitution=1.0)
    s = carom.simulate(scene, 0.01, step=1e-3)
    speeds = np.linalg.norm(s.velocity[-1], axis=1)
    np.testing.assert_allclose(speeds[10:15], (2.926, 1.284, 1.314, 1.279, 2.656), atol=1e-3)
    np.testing.assert_allclose(s.velocity[-1, 15, :2], (-0.875, 0.309), atol=1e-3)
