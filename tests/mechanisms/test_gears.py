"""Profiles that touch profiles: distances, involute gears, lobes and a Geneva drive against closed forms."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

import carom
from carom import GROUND, constraints, forces, joints
from carom.collision.api import nearest_points
from files.compare import goes_on
from verified import agree, verifies

MODULE, ANGLE = 0.002, math.radians(20.0)
UPRIGHT = np.array([1.0, 0, 0, 0])


def disc(radius, off=0.0):
    return carom.Profile(
        lambda a: (off + radius * math.cos(a), radius * math.sin(a)), thickness=0.02
    )


def lobes(count=5, size=0.05, depth=0.2):
    return carom.Profile(lambda a: size * (1.0 + depth * math.cos(count * a)), thickness=0.02)


def ratchet():
    turns = [0.25 * math.pi * k for k in range(8)]
    teeth = [(r * math.cos(a), r * math.sin(a)) for a in turns for r in (0.04, 0.05)]
    return carom.Profile(teeth, thickness=0.02, corners="all")


def dense(shape, spacing=2e-5):
    """Return points (K, 2) of the curve of a profile."""
    corners = shape.points(6000)
    parts = []
    for p, q in zip(corners, np.roll(corners, -1, axis=0)):
        count = max(1, int(np.linalg.norm(q - p) / spacing))
        parts.append(p + (q - p) * np.arange(count)[:, None] / count)
    return np.concatenate(parts)


def turned(points, angle, flip=False):
    c, s = math.cos(angle), math.sin(angle)
    return (points * [1.0, -1.0 if flip else 1.0]) @ np.array([[c, s], [-s, c]])


@pytest.mark.parametrize("flip", [False, True])
def test_distances_are_those_of_points_of_the_curves(flip):
    shapes = lobes(), ratchet(), disc(0.05, 0.01), carom.Profile.involute(18, 0.0025, 0.02)
    clouds, rng, count = [dense(shape) for shape in shapes], np.random.default_rng(3), 0
    over = carom.euler("x", 180) if flip else UPRIGHT
    for _ in range(60):
        i, j = rng.integers(len(shapes), size=2)
        angles, way, far = (
            rng.uniform(0, 2 * np.pi, 2),
            rng.uniform(0, 2 * np.pi),
            rng.uniform(0.1, 0.13),
        )
        x = far * np.array([math.cos(way), math.sin(way), 0.0])
        spin = [carom.euler("z", np.degrees(a)) for a in angles]
        spin[0] = carom.geometry.quaternion.multiply(np.array(spin[0]), np.array(over))
        one = (np.zeros(3), spin[0])
        gap = nearest_points(shapes[i], one, shapes[j], (x, spin[1])).gap
        # the curve of a body that is turned over runs the other way
        a = turned(clouds[i], angles[0], flip)
        exact = cKDTree(turned(clouds[j], angles[1]) + x[:2]).query(a)[0].min()
        if gap > 1e-4:
            count += 1
            assert -1e-12 < exact - gap < 1e-5
        else:
            assert exact < 1.2e-4
    assert count > 20


@pytest.mark.parametrize("distance", [0.2, 0.0801, 0.08, 0.0799])
def test_discs_have_the_distance_of_circles(distance):
    """Also where they overlap a little: the gap goes on through 0."""
    way = np.array([0.6, 0.8, 0.0])
    found = nearest_points(
        disc(0.05), (np.zeros(3), UPRIGHT), disc(0.03), (distance * way, UPRIGHT)
    )
    np.testing.assert_allclose(found.gap, distance - 0.08, atol=1e-13)
    np.testing.assert_allclose(found.normal, -way, atol=1e-9)


def thrown(shape, e, mu):
    """A disc that is thrown on a lobed hill that turns."""
    scene = carom.Scene(gravity=(0, -9.81, 0))
    hill = scene.add_body(lobes(3, 0.1, 0.1), mass=2.0, angular_velocity=(0, 0, 1.0), name="hill")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, hill, name="axle")
    body = scene.add_body(
        shape, mass=0.5, position=(0.01, 0.16, 0), velocity=(0.2, 0, 0), name="disc"
    )
    scene.add_joint(joints.Planar((0, 0, 1)), GROUND, body)
    scene.add_contact(body, hill, restitution=e, friction=mu, impact_law="poisson")
    return scene


@pytest.mark.parametrize(("e", "mu"), [(0.0, 0.0), (0.0, 0.3), (0.6, 0.2)])
def test_a_disc_is_a_cylinder(e, mu):
    """The same disc as a profile and as a cylinder: bounces, slip, rolling round lobes."""
    runs = [
        carom.simulate(thrown(shape, e, mu), 0.25, rtol=1e-10, atol=1e-12)
        for shape in (disc(0.03), carom.Cylinder(0.03, 0.02))
    ]
    one, two = (run.evaluate(0.25) for run in runs)
    for a, b in zip(one, two):
        np.testing.assert_allclose(a, b, atol=1e-6)
    assert max(np.max(np.abs(run.ledger.residual)) for run in runs) < 1e-8
    assert len(runs[0].impacts) == len(runs[1].impacts) > 0


def gears(
    n1=20, n2=30, rate=10.0, load=0.05, backlash=1e-4, distance=None, friction=0.0, drive=True
):
    """Two wheels with a tooth of the first in contact, which drives; `load` is a torque on the second."""
    r1, r2 = 0.5 * MODULE * n1, 0.5 * MODULE * n2
    scene, hinges = carom.Scene(gravity=(0, 0, 0)), []
    places = (0.0, r1 + r2 if distance is None else distance)
    turns = 0.5 * backlash / r1, math.pi + math.pi / n2
    for name, n, x, turn, spin in zip("ab", (n1, n2), places, turns, (rate, -rate * n1 / n2)):
        shape = carom.Profile.involute(n, MODULE, 0.01, backlash=backlash)
        wheel = scene.add_body(
            shape, density=7800.0, position=(x, 0, 0), orientation=carom.euler("z", np.degrees(turn)),
            angular_velocity=(0, 0, spin), name=name,
        )  # fmt: skip
        hinge = joints.Revolute((x, 0, 0), (0, 0, 1))
        hinges.append(scene.add_joint(hinge, GROUND, wheel, name=f"hinge {name}"))
    if drive:
        scene.add_constraint(constraints.Driver(hinges[0], rate=rate), name="motor")
    if load:
        scene.add_force(forces.JointForce(hinges[1], load), name="load")
    scene.add_contact("a", "b", restitution=0.0, friction=friction, name="mesh")
    return scene


@verifies(
    "Profile.involute",
    r"$\omega_2 = -\omega_1 n_1/n_2$, force $M_2/r_{b2}$ along the line of action",
    "closed form",
)
@pytest.mark.few(2)
@pytest.mark.parametrize("how", [{"rtol": 1e-8}, {"step": 1e-3}])
@pytest.mark.parametrize(("n1", "n2"), [(20, 30), (40, 25), (30, 90)])
def test_the_ratio_of_involute_gears_is_constant(n1, n2, how):
    """It is that of the teeth, the force is M_2/r_b2 along the line of action, and teeth take over."""
    s = carom.simulate(gears(n1, n2), 0.15, **how)
    assert s.warnings == ()
    on = (
        s["mesh"].force[:, 0] > 0.0
    )  # with given steps a tooth may leave some microseconds before the next strikes
    assert np.mean(on[1:-1]) > (0.999 if "rtol" in how else 0.94)
    ratio = s["hinge b"].rate / s["hinge a"].rate
    agree(ratio[on], -n1 / n2, atol=1e-9)
    agree(s["hinge b"].coordinate, -1.5 * s.t / 0.15 * n1 / n2, atol=1e-9)
    base = 0.5 * MODULE * n2 * math.cos(ANGLE)
    on[[0, -1]] = False
    agree(s["mesh"].force[on, 0], 0.05 / base, rtol=1e-6)
    agree(s["motor"].torque[on], 0.05 * n1 / n2, rtol=1e-6)
    # the line of action is at the pressure angle to the common tangent
    force = s["hinge b"].force[on]
    agree(np.abs(force[:, 0] / force[:, 1]), math.tan(ANGLE), rtol=1e-6)
    # n1 1.5 rad of teeth have come into mesh, and as many have left it
    passed = 1.5 * n1 / (2.0 * math.pi)
    assert abs(np.sum(s.events.kind == "opens") / 2 - passed) < 2.0
    agree(s["mesh"].gap, 0.0, atol=1e-12)


def test_gears_keep_their_ratio_at_a_larger_distance():
    """The pressure angle becomes acos(r_b1 + r_b2)/a; the backlash grows, which the first blow takes."""
    n1, n2, far = 25, 25, 1.005
    s = carom.simulate(gears(n1, n2, distance=0.5 * MODULE * (n1 + n2) * far), 0.15, rtol=1e-9)
    touching = s["mesh"].force[:, 0] > 0.0
    assert np.mean(touching) > 0.9
    ratio = s["hinge b"].rate / s["hinge a"].rate
    np.testing.assert_allclose(ratio[touching], -1.0, atol=1e-9)
    force = s["hinge b"].force[touching]
    angle = math.acos(math.cos(ANGLE) / far)
    np.testing.assert_allclose(np.abs(force[:, 0] / force[:, 1]), math.tan(angle), rtol=1e-6)


def test_a_torque_against_a_load():
    """I_1 w_1' + (n_1/n_2)^2 I_2 w_1' = M_1 - n_1/n_2 M_2."""
    scene = gears(drive=False, rate=0.0, load=0.1)
    scene.add_force(forces.Torque((0, 0, 0.2)), "a")
    s = carom.simulate(scene, 0.05, rtol=1e-9)
    i1, i2 = (scene[name].inertia[2, 2] for name in "ab")
    rate = (0.2 - 0.1 * 2 / 3) / (i1 + i2 * 4 / 9)
    np.testing.assert_allclose(s["hinge a"].rate, rate * s.t, atol=1e-6 * rate * 0.05)
    np.testing.assert_allclose(s["hinge b"].rate, -s["hinge a"].rate * 2 / 3, atol=1e-8 * rate)


def test_backlash_is_what_was_given():
    """Driven back, the other flank strikes after the first wheel has turned by backlash/r_1."""
    backlash, rate = 2e-4, 5.0
    scene = gears(rate=-rate, load=0.0, backlash=backlash)
    scene.replace("b", angular_velocity=(0, 0, 0))
    s = carom.simulate(scene, 2.0 * backlash / (0.02 * rate), rtol=1e-10)
    np.testing.assert_allclose(s.impacts.time[0], backlash / (0.02 * rate), rtol=1e-9)
    np.testing.assert_allclose(s["hinge b"].rate[-1], rate * 2 / 3, rtol=1e-9)


def test_friction_of_teeth_is_in_the_ledger():
    """Sliding on each other they lose some percent, none at the pitch point; the motor gives it."""
    s = carom.simulate(gears(friction=0.1), 0.15, rtol=1e-8)
    lost = -s.ledger.friction[-1]
    assert 0.005 < lost / (0.05 * 1.5 * 2 / 3) < 0.06
    assert np.max(np.abs(s.ledger.residual)) < 1e-6 * s.ledger.loads.max() + 1e-8
    np.testing.assert_allclose(s["hinge b"].rate, -s["hinge a"].rate * 2 / 3, atol=1e-8)


def test_an_egg_rocks_on_a_hill_without_loss():
    """Rolling without slip does no work: the energy is kept, and the point of contact is at rest."""
    scene = carom.Scene(gravity=(0, -9.81, 0))
    hill = carom.Profile(
        lambda a: (
            0.4 * math.cos(a),
            0.3 * math.sin(a) - 0.15 * math.cos(a) ** 2 * math.sin(a) - 0.4,
        ),
        thickness=0.04,
    )
    x, y, _ = hill.centroid
    scene.add_static(hill, position=(x, y, 0), name="hill")
    egg = carom.Profile(lambda a: 0.03 * (1.0 + 0.15 * math.cos(2 * a)), thickness=0.02)
    # laid down at x = 0, upright to the normal there
    top = max(p[1] + y for p in hill.points(20000) if abs(p[0] + x) < 1e-4)
    body = scene.add_body(
        egg, mass=0.5, position=(0, top + 0.03 * 0.85, 0), orientation=carom.euler("z", 0)
    )
    scene.add_joint(joints.Planar((0, 0, 1)), GROUND, body)
    scene.replace(body, angular_velocity=(0, 0, -2.0), velocity=(2.0 * 0.03 * 0.85, 0, 0))
    scene.add_contact(body, "hill", restitution=0.0, friction=2.0, name="rolls")
    s = carom.simulate(scene, 0.5, rtol=1e-10)
    kept = s["rolls"].mode == "sticking"
    assert np.mean(kept) > 0.9
    np.testing.assert_allclose(s.total_energy[1:], s.total_energy[1], atol=1e-9)
    assert np.ptp(s[body].position[:, 0]) > 2e-3


@pytest.mark.parametrize("seed", range(4))
def test_lobes_strike_and_lose_nothing_without_a_name(seed):
    rng = np.random.default_rng(seed)
    scene = carom.Scene(gravity=(0, -9.81, 0))
    scene.add_static(lobes(7, 0.15, 0.05), name="hill")
    for k in range(2):
        body = scene.add_body(
            lobes(3, 0.05, 0.15), mass=0.5, position=(0.02 * k + 0.02 * rng.normal(), 0.25 + 0.13 * k, 0),
            orientation=carom.euler("z", rng.uniform(0, 360)), name=f"b{k}",
        )  # fmt: skip
        scene.add_joint(joints.Planar((0, 0, 1)), GROUND, body)
    scene.set_contact_default(restitution=0.5 * (seed % 2), friction=0.2, impact_law="poisson")
    s = carom.simulate(scene, 0.5, rtol=1e-8)
    assert s.warnings == ()
    assert len(s.impacts) > 4
    assert np.max(np.abs(s.ledger.residual)) < 1e-7
    assert np.all(np.diff(s.total_energy) < 1e-7)
    last = [(s.position[-1, k], s.orientation[-1, k]) for k in range(2)]
    shapes = [body.shape for body in scene.bodies]
    assert nearest_points(shapes[0], last[0], shapes[1], last[1]).gap > -1e-9


def test_files_and_pictures(tmp_path):
    scene = gears()
    path = tmp_path / "run.h5"
    goes_on(scene, 0.04, path, step=1e-3)
    np.testing.assert_array_equal(
        carom.Solution.load(path).scene["a"].shape.rows, scene["a"].shape.rows
    )


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"teeth": 3}, "teeth must"),
        ({"module": 0.0}, "module must"),
        ({"pressure_angle": 20.0}, "pressure_angle must"),
        ({"backlash": 0.01}, "backlash must"),
        ({"addendum": 1.9}, "addendum must leave"),
        ({"teeth": 4, "dedendum": 2.0}, "dedendum must leave"),
        ({"teeth": 8, "shift": 1.0}, "addendum must leave"),
    ],
)
def test_gears_that_are_none(given, match):
    with pytest.raises(ValueError, match=match):
        carom.Profile.involute(**{"teeth": 20, "module": 0.002, "thickness": 0.01} | given)


APART, PIN, PLAY, DISC = (
    0.1,
    0.006,
    2e-4,
    0.045,
)  # of a Geneva drive: axles, pin, its play, locking disc
ARM = APART / math.sqrt(2.0)
TIP = 0.073  # radius at which the arcs of the wheel end


def geneva_wheel(clearance=3e-4):
    """Four slots for a pin, and between them hollow arcs for a disc that locks it; and an end of an arc."""
    radius, width = DISC + clearance, PIN + PLAY
    x = (APART**2 + TIP**2 - radius**2) / (2.0 * APART)
    end = math.atan2(math.sqrt(TIP**2 - x * x), APART - x)
    arc = [(APART - radius * math.cos(q), radius * math.sin(q)) for q in np.linspace(-end, end, 41)]
    depth, mouth = APART - ARM - PIN - 0.004, math.sqrt(TIP**2 - width**2)
    slot = turned(
        np.array([(mouth, -width), (depth, -width), (depth, width), (mouth, width)]), 0.25 * math.pi
    )
    quarter = np.concatenate([arc, slot])
    sharp = [0, 40, 41, 42, 43, 44]
    points = np.concatenate([turned(quarter, 0.5 * math.pi * k) for k in range(4)])
    corners = [len(quarter) * k + n for k in range(4) for n in sharp]
    return carom.Profile(points, 0.01, corners=corners), np.array(arc[-1])


@verifies(
    "Profile", r"Geneva wheel: $\varphi = \arctan(y/x) - \arcsin(p/\lvert r\rvert)$", "closed form"
)
def test_a_geneva_wheel_follows_its_pin():
    """The pin presses the side of a slot: its angle is that of the pin less asin(play/distance)."""
    shape, _ = geneva_wheel()
    omega, begin = 2.0, math.radians(-60.0)  # of the crank, from the line to the wheel
    scene = carom.Scene(gravity=(0, 0, 0))
    wheel = scene.add_body(shape, mass=0.3, position=shape.centroid, name="wheel")
    axle = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, wheel, name="axle")
    scene.add_force(forces.JointFriction(axle, 0.02))
    start = (APART - ARM * math.cos(begin), ARM * math.sin(begin), 0)
    pin = scene.add_body(
        disc(PIN), mass=0.05, position=start, angular_velocity=(0, 0, -omega), name="pin",
        velocity=(omega * start[1], omega * (APART - start[0]), 0),
    )  # fmt: skip
    crank = scene.add_joint(joints.Revolute((APART, 0, 0), (0, 0, 1)), GROUND, pin, name="crank")
    scene.add_constraint(constraints.Driver(crank, rate=-omega))
    scene.add_contact(pin, wheel, restitution=0.0, friction=0.1, name="slot")
    s = carom.simulate(scene, math.radians(120.0) / omega, rtol=1e-8, atol=1e-10)
    assert s.warnings == ()
    turn = begin - s["crank"].coordinate
    x, y = APART - ARM * np.cos(turn), ARM * np.sin(turn)
    angle = np.arctan2(y, x) - np.arcsin(PLAY / np.hypot(x, y)) + 0.25 * math.pi
    within = (turn > math.radians(-38)) & (turn < math.radians(42))
    agree(s["axle"].coordinate[within], angle[within], atol=1e-8)
    assert abs(s["axle"].coordinate[-1] - 0.5 * math.pi) < 0.01
    agree(s["axle"].rate[-1], 0.0, atol=1e-60)


@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_a_disc_locks_a_geneva_wheel(way):
    """Between two turns the ends of an arc touch the disc: the wheel gives by the clearance, and no more."""
    shape, end = geneva_wheel()
    scene = carom.Scene(gravity=(0, 0, -9.81))  # a scale of rest
    wheel = scene.add_body(shape, mass=0.3, position=shape.centroid, name="wheel")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, wheel, name="axle")
    scene.add_force(forces.Torque((0, 0, way * 0.2)), wheel)
    scene.add_static(disc(DISC), position=(APART, 0, 0), name="disc")
    scene.add_contact(wheel, "disc", restitution=0.0, friction=0.1, name="lock")
    s = carom.simulate(scene, 0.2, rtol=1e-9)
    # turned by -g the end (x, y) is nearer to the axle of the disc
    reach = math.hypot(*end)
    cosine = (APART**2 + reach**2 - DISC**2) / (2.0 * APART * reach)
    gives = math.atan2(end[1], end[0]) - math.acos(cosine)
    np.testing.assert_allclose(s["axle"].coordinate[-1], way * gives, atol=1e-10)
    assert s["axle"].rate[-1] == pytest.approx(0.0, abs=1e-12)
    arm = APART * math.sin(math.acos((APART**2 + DISC**2 - reach**2) / (2 * APART * DISC)))
    total = s["lock"].vector[-1]
    assert np.linalg.norm(total) * arm == pytest.approx(0.2, rel=0.15)  # with friction
