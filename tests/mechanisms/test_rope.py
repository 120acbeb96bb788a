"""Ropes over points and pulleys: closed forms of tension, acceleration and jerks; results, files and errors."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from carom import GROUND, joints
from files.compare import goes_on
from verified import agree, verifies

G = 9.81
R = 0.1


def atwood(masses, inertia=0.01, friction=None, length=None, e=0.0, height=(-1.0, -1.0)):
    """Two loads on a rope over a wheel; `inertia` is that of the wheel."""
    scene = carom.Scene(gravity=(0, 0, -G))
    wheel = scene.add_body(carom.Cylinder(R, 0.02), mass=0.5, inertia=(inertia,) * 3, name="wheel")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, wheel, name="hinge")
    for name, side, mass, z in zip("ab", (-R, R), masses, height):
        scene.add_body(carom.Sphere(0.03), mass=mass, position=(side, 0, z), name=name)
    pulley = carom.Pulley(wheel, R, (0, 1, 0), friction=friction)
    scene.add_rope(["a", pulley, "b"], length, restitution=e)
    return scene


@verifies("Pulley", r"$a = (m_2 - m_1)\,g/(m_1 + m_2 + I/R^2)$", "closed form")
@verifies("add_rope", "tensions $m_1 (g + a)$, $m_2 (g - a)$", "closed form")
@pytest.mark.parametrize("friction", [None, 0.0])
@pytest.mark.parametrize("how", [{}, {"rtol": 1e-10}, {"step": 1e-2}])
def test_atwood(friction, how):
    """a = (m_2 - m_1) g/(m_1 + m_2 + I/R^2), tensions m_1 (g + a), m_2 (g - a); a rope that slips has I = 0."""
    s = carom.simulate(atwood((2.0, 2.5), friction=friction), 1.2, **how)
    a = 0.5 * G / (4.5 + (1.0 if friction is None else 0.0))
    fall = 0.5 * a * s.t**2
    agree(s["a"].position[:, 2], -1 + fall, atol=1e-8)
    agree(s["b"].position[:, 2], -1 - fall, atol=1e-8)
    turn = fall / R if friction is None else 0.0 * fall
    agree(s["hinge"].coordinate, turn, atol=1e-7)
    tensions = (2.0 * (G + a), 2.5 * (G - a))
    for name, tension in zip(("rope1.1", "rope1.2") if friction is None else ("rope1",), tensions):
        agree(s[name].force[1:, 0], tension, rtol=1e-9)
        agree(s[name].gap, 0.0, atol=1e-10)
    # the hinge carries both tensions and the weight of the wheel
    total = sum(tensions) if friction is None else 2.0 * tensions[0]
    agree(s["hinge"].force[-1], (0, 0, total + 0.5 * G), atol=1e-8)


@verifies("add_rope", "$P = (1 + e)(v_1 + v_2)/(1/m_1 + 1/m_2)$", "closed form")
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_a_rope_gets_taut(e):
    """Both loads fall freely until .1 m of slack is out: P = (1 + e) (v_1 + v_2)/(1/m_1 + 1/m_2)."""
    slack = 0.1
    scene = atwood((1.0, 2.0), friction=0.0, length=2.0 + np.pi * R + slack, e=e)
    s = carom.simulate(scene, 0.2, rtol=1e-10)
    t = np.sqrt(slack / G)  # each falls half of it
    agree(s.impacts.time[0], t, atol=1e-10)
    impulse = (1 + e) * 2 * G * t / 1.5
    agree(s.impacts.impulse[0, 0], impulse, rtol=1e-9)
    agree(s.impacts.energy_change[0], -0.5 * (1 - e * e) * (2 * G * t) ** 2 / 1.5, atol=1e-9)


def tackle(load, block):
    """A block on four strands: under its two sheaves, over two fixed ones, to a load."""
    scene = carom.Scene(gravity=(0, 0, -G))
    made = scene.add_body(carom.Box(0.6, 0.1, 0.1), mass=block, position=(0.3, 0, -2), name="block")
    scene.add_joint(joints.Prismatic((0, 0, 1)), GROUND, made, name="guide")
    scene.add_body(carom.Sphere(0.03), mass=load, position=(0.8, 0, -1), name="load")
    under, over = (0, -1, 0), (0, 1, 0)
    scene.add_rope(
        [
            (GROUND, (0, 0, 0)),
            carom.Pulley(made, R, under, friction=0, center=(0.1, 0, -2)),
            carom.Pulley(GROUND, R, over, center=(0.3, 0, 0)),
            carom.Pulley(made, R, under, friction=0, center=(0.5, 0, -2)),
            carom.Pulley(GROUND, R, over, center=(0.7, 0, 0)),
            "load",
        ],
        name="fall",
    )
    return scene


def test_block_and_tackle():
    """4 : 1: in balance for M = 4 m; else the load has (m + M/16) a = (m - M/4) g."""
    s = carom.simulate(tackle(1.0, 4.0), 1.0)
    np.testing.assert_allclose(s["load"].position[-1, 2], -1.0, atol=1e-9)
    np.testing.assert_allclose(s["fall"].force[1:, 0], G, rtol=1e-9)
    s = carom.simulate(tackle(1.5, 4.0), 0.5, rtol=1e-9)
    a = 0.5 * G / (1.5 + 0.25)
    np.testing.assert_allclose(s["load"].position[:, 2], -1.0 - 0.5 * a * s.t**2, atol=1e-8)
    np.testing.assert_allclose(s["block"].position[:, 2], -2.0 + 0.125 * a * s.t**2, atol=1e-8)


def rolling_tackle(load, block, sheave, **rope):
    """The same with wheels that the rope turns: two on the block, two on the ground."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Box(0.6, 0.1, 0.1), mass=block, position=(0.3, 0, -2), name="block")
    scene.add_joint(joints.Prismatic((0, 0, 1)), GROUND, "block", name="guide")
    scene.add_body(carom.Sphere(0.03), mass=load, position=(0.8, 0, -1), name="load")
    over = [(GROUND, (0, 0, 0))]
    for k, x in enumerate((0.1, 0.3, 0.5, 0.7)):
        place, carrier = (x, 0, 0 if k % 2 else -2), GROUND if k % 2 else "block"
        wheel = scene.add_body(
            carom.Cylinder(R, 0.02), mass=0.2, inertia=(sheave, sheave, sheave), position=place,
            orientation=carom.euler("x", 90), name=f"sheave{k}",
        )  # fmt: skip
        scene.add_joint(joints.Revolute(place, (0, 1, 0)), carrier, wheel, name=f"pin{k}")
        over.append(carom.Pulley(wheel, R, (0, 1 if k % 2 else -1, 0)))
    scene.add_rope([*over, "load"], name="fall", **rope)
    return scene


@verifies(
    "Pulley", r"$(m + M/16 + 30 I/16 R^2)\,a = (m - M/4)\,g$ of wheels on a block", "closed form"
)
@pytest.mark.parametrize(
    ("how", "error"), [({}, 1e-8), ({"rtol": 1e-10}, 1e-10), ({"step": 1e-2}, 1e-9)]
)
def test_block_and_tackle_with_wheels(how, error):
    """Four wheels turn 1, 2, 3, 4 times as fast as the block rises; tensions differ by their inertia."""
    m, M, inertia = 1.5, 4.0, 0.01
    s = carom.simulate(rolling_tackle(m, M - 0.4, inertia), 0.5, **how)
    a = (m - M / 4) * G / (m + M / 16 + inertia / R**2 * (1 + 4 + 9 + 16) / 16)
    agree(s["load"].position[:, 2], -1.0 - 0.5 * a * s.t**2, atol=error)
    agree(s["block"].position[:, 2], -2.0 + 0.125 * a * s.t**2, atol=error)
    tension = m * (G - a)
    for k in (4, 3, 2, 1):
        agree(s[f"fall.{k + 1}"].tension[1:], tension, rtol=1e-8)
        tension -= inertia / R**2 * k * a / 4
        turn = s[f"sheave{k - 1}"].angular_velocity[:, 1]
        agree(abs(turn), k * a / 4 * s.t / R, atol=10 * error)
    agree(s.total_energy, s.total_energy[0], atol=10 * error)


def on_an_arm(inertia, friction=None, length=None, e=0.0):
    """A load on a rope over a wheel at the end of an arm that swings, from a point of the ground."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Box(0.8, 0.05, 0.05), mass=1.0, position=(0.4, 0, 0), name="arm")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "arm", name="pivot")
    scene.add_force(carom.forces.JointSpring("pivot", stiffness=60.0, rest=-0.6), name="spring")
    scene.add_body(
        carom.Cylinder(R, 0.02),
        mass=0.3,
        inertia=(inertia,) * 3,
        position=(0.8, 0, 0),
        name="wheel",
    )
    scene.add_joint(joints.Revolute((0.8, 0, 0), (0, 1, 0)), "arm", "wheel", name="pin")
    scene.add_body(carom.Sphere(0.03), mass=0.8, position=(0.9, 0, -0.6), name="load")
    pulley = carom.Pulley("wheel", R, (0, 1, 0), friction)
    scene.add_rope([(GROUND, (0.5, 0, -0.7)), pulley, "load"], length, restitution=e, name="rope")
    return scene


@pytest.mark.bits
def test_a_file_has_wheels_that_move(tmp_path):
    scene = rolling_tackle(1.5, 3.6, 0.01)
    whole = goes_on(scene, 0.3, tmp_path / "run.h5", step=1e-2)
    again = carom.Solution.load(tmp_path / "run.h5").scene
    np.testing.assert_array_equal(carom.simulate(again, 0.3, step=1e-2).position, whole.position)
    assert repr(again.stops) == repr(scene.stops)


def strand(d, rho):
    """Return length and direction (T, 3) of strands whose centres are d apart, by rho = r_1 - r_2 about y."""
    square = np.sum(d * d, axis=1, keepdims=True)
    length = np.sqrt(square - rho * rho)
    return length[:, 0], (length * d + rho * np.cross((0, 1, 0), d)) / square


def test_a_wheel_on_an_arm_that_swings():
    """Without slip its material is kept: l + rho psi +- R theta, with angles in the world."""
    inertia = 0.004
    s = carom.simulate(on_an_arm(inertia), 0.45, rtol=1e-10)
    assert np.ptp(s["pivot"].coordinate) > 0.1
    wheel = s["wheel"].position
    turned = R * (s["pivot"].coordinate + s["pin"].coordinate)
    ends = (wheel - (0.5, 0, -0.7), -R, 1.0), (s["load"].position - wheel, R, -1.0)
    for d, rho, way in ends:
        length, e = strand(d, rho)
        material = length + rho * np.unwrap(np.arctan2(e[:, 0], e[:, 2])) + way * turned
        np.testing.assert_allclose(material, material[0], atol=1e-9)
    np.testing.assert_allclose(s.total_energy, s.total_energy[0], atol=1e-8)
    apart = s["rope.2"].tension - s["rope.1"].tension
    spun = inertia * np.gradient(s["wheel"].angular_velocity[:, 1], s.t)
    np.testing.assert_allclose(R * apart[2:-2], spun[2:-2], atol=2e-3 * abs(spun).max())


def test_a_light_wheel_on_an_arm_is_one_over_which_the_rope_slips():
    light, slips = (
        carom.simulate(on_an_arm(inertia, friction), 0.5, rtol=1e-10)
        for inertia, friction in ((1e-9, None), (0.004, 0.0))
    )
    np.testing.assert_allclose(light["load"].position[-1], slips["load"].position[-1], atol=1e-5)
    np.testing.assert_allclose(light["arm"].position[-1], slips["arm"].position[-1], atol=1e-5)


@pytest.mark.parametrize("mu", [0.02, 3.0])
def test_friction_turns_a_wheel_on_an_arm(mu):
    """With little friction it slips, and the tensions have Euler's ratio; with much it does not."""
    s = carom.simulate(on_an_arm(0.004, mu), 0.3, rtol=1e-10)
    rolls = carom.simulate(on_an_arm(0.004), 0.3, rtol=1e-10)
    assert abs(s.ledger.residual).max() < 1e-8
    if mu > 1.0:
        np.testing.assert_allclose(s["load"].position[-1], rolls["load"].position[-1], atol=1e-8)
    else:
        slips = np.flatnonzero(s["rope"].mode == "slipping")
        assert len(slips) > 10
        first, second = s["rope"].tension[slips].T
        wheel, load = s["wheel"].position[slips], s["load"].position[slips]
        (_, before), (_, behind) = strand(wheel - (0.5, 0, -0.7), -R), strand(load - wheel, R)
        phi = np.arctan2(np.cross(before, behind)[:, 1], np.sum(before * behind, axis=1)) % (
            2 * np.pi
        )
        np.testing.assert_allclose(abs(np.log(second / first)), mu * phi, rtol=1e-8)


def test_a_jerk_over_a_wheel_on_an_arm():
    """Energy of e = 1 is kept, of e = 0 lost in the ledger; no slack is left negative."""
    for e in (0.0, 1.0):
        s = carom.simulate(on_an_arm(0.004, length=2.15, e=e), 0.4)
        assert len(s.impacts) > 0
        assert abs(s.ledger.residual).max() < 1e-6
        assert (abs(s.ledger.impacts[-1]) < 1e-9) == (e == 1.0)


@verifies("add_rope", r"$(m + M)\,\ddot r = m h^2/r^3 - M g$", "own integration: SciPy")
def test_a_string_through_a_hole():
    """A ball circles and a load hangs on its string: (m + M) r'' = m h^2/r^3 - M g, h = r^2 phi'."""
    scene = carom.Scene(gravity=(0, 0, 0))
    ball = scene.add_body(
        carom.Sphere(0.03), mass=1.0, position=(1, 0, 0), velocity=(0, 3, 0), name="ball"
    )
    load = scene.add_body(carom.Sphere(0.03), mass=2.0, position=(0, 0, -1), name="load")
    scene.add_force(carom.forces.Force((0, 0, -2.0 * G)), load)
    scene.add_rope([ball, (GROUND, (0, 0, 0)), load], name="string")
    s = carom.simulate(scene, 1.5, rtol=1e-10)
    known = solve_ivp(
        lambda t, y: (y[1], (9.0 / y[0] ** 3 - 2 * G) / 3.0), (0, 1.5), (1.0, 0.0), method="DOP853",
        rtol=1e-12, atol=1e-12, t_eval=s.t,
    )  # fmt: skip
    agree(np.linalg.norm(s["ball"].position, axis=1), known.y[0], atol=1e-7)
    agree(s["load"].position[:, 2], known.y[0] - 2.0, atol=1e-7)
    agree(s["string"].gap, 0.0, atol=1e-9)


def test_a_pendulum_that_winds_round_a_drum():
    """Its string is laid on the drum as it swings: l + R (arc) is constant, and so is the energy."""
    scene = carom.Scene(gravity=(0, 0, -G))
    bob = scene.add_body(
        carom.Sphere(0.03), mass=0.5, position=(R, 0, -1), velocity=(-3.0, 0, 0), name="bob"
    )
    drum = carom.Pulley(GROUND, R, (0, 1, 0), center=(0, 0, 0))
    scene.add_rope([(GROUND, (-0.5, 0, R)), drum, bob], name="string")
    s = carom.simulate(scene, 2.0, rtol=1e-10)
    x, z = bob_path = s["bob"].position[:, [0, 2]].T
    assert bob_path.shape[0] == 2
    d = np.hypot(x, z)
    straight = np.sqrt(d * d - R * R)
    # from the top of the drum, where the string comes in, round to where it leaves
    leaves = np.unwrap(np.arctan2(x, z)) - np.arccos(R / d)
    taut = s["string"].force[1:-1, 0] > 0.0
    whole = straight + R * leaves
    np.testing.assert_allclose(whole[1:-1][taut], whole[0], atol=1e-9)
    np.testing.assert_allclose(s.total_energy, s.total_energy[0], atol=1e-7)


def test_files(tmp_path):
    scene = atwood((1.0, 1.5), length=2.0 + np.pi * R + 0.02)
    path = tmp_path / "run.h5"
    goes_on(scene, 0.4, path, step=1e-2)
    again = carom.Solution.load(path).scene
    assert repr(again.stops) == repr(scene.stops)


def test_changes():
    scene = atwood((1.0, 1.5))
    scene.replace("a", mass=3.0)
    first = scene["rope1.1"].joint.terms[0][0]
    assert first.parent is scene["a"]
    scene.remove("hinge", dependents=True)
    assert not scene.stops


@pytest.mark.parametrize(
    ("over", "more", "message"),
    [
        (["a"], {}, "over must begin and end with a body or a point"),
        (["a", carom.Pulley("wheel", R, (0, 1, 0))], {}, "over must begin and end with"),
        (["a", GROUND, "b"], {}, r"over\[1\] must be a pair"),
        (["a", carom.Pulley(GROUND, R, (0, 1, 0)), "b"], {}, r"center of over\[1\] must be given"),
        (
            ["a", carom.Pulley("wheel", R, (1, 0, 0)), "b"],
            {},
            "must have a Revolute joint about its axis",
        ),
        (
            ["a", carom.Pulley("wheel", 3.0, (0, 1, 0)), "b"],
            {},
            "a strand must be between circles outside",
        ),
        (
            ["a", carom.Pulley("wheel", R, (0, 1, 0)), "b"],
            {"length": 1.0},
            "length must be at least 2.314",
        ),
        ([(GROUND, (0, 0, 0)), (GROUND, (1, 0, 0))], {}, "over must have a body in it that moves"),
        (["a", "c"], {}, r"over\[1\] must be"),
    ],
)
def test_wrong_input(over, more, message):
    scene = atwood((1.0, 1.5))
    with pytest.raises((ValueError, TypeError), match=message):
        scene.add_rope(over, name="other", **more)


def test_a_strand_that_leaves_its_plane_is_told_of():
    scene = atwood((1.0, 1.5))
    assert not carom.simulate(scene, 0.2).warnings
    scene.replace("a", velocity=(0, 0.5, 0))
    with pytest.warns(
        carom.AccuracyWarning, match="out of the plane of its pulley, most at t = 0.2 s"
    ):
        carom.simulate(scene, 0.2)


def test_a_wheel_on_no_hinge_about_its_axis_is_refused():
    scene = carom.Scene()
    boom = scene.add_body(carom.Box(1, 0.1, 0.1), mass=1.0, position=(0.5, 0, 1), name="boom")
    wheel = scene.add_body(carom.Cylinder(R, 0.02), mass=0.5, position=(1, 0, 1), name="wheel")
    scene.add_joint(joints.Revolute((1, 0, 1), (0, 0, 1)), boom, wheel)
    for name, x in (("a", 0.9), ("b", 1.1)):
        scene.add_body(carom.Sphere(0.03), mass=1.0, position=(x, 0, 0), name=name)
    with pytest.raises(ValueError, match=r"about its axis, on carom\.GROUND"):
        scene.add_rope(["a", carom.Pulley(wheel, R, (0, 1, 0)), "b"])


def test_a_mass_centre_is_an_end_wherever_it_is():
    """A load that is placed elsewhere afterwards hangs on its mass centre still."""
    scene = carom.Scene()
    ball = scene.add_body(carom.Box(0.1, 0.2, 0.3), mass=1.0, position=(0, 0, -1), name="ball")
    scene.add_joint(joints.Tether(2.0, anchor_parent=(0, 0, 0)), GROUND, ball, name="cord")
    scene.replace("ball", position=(1.0, 0.0, -1.0))
    assert scene["cord"].joint.ends[1].tolist() == [1.0, 0.0, -1.0]
    s = carom.simulate(scene, 1.5)
    assert not s.angular_velocity.any()
    np.testing.assert_allclose(
        s["cord"].gap, 2.0 - np.linalg.norm(s.position[:, 0], axis=1), atol=1e-9
    )
