"""Joints with clearance: closed forms, the same motion on curved ground, conservation, drawers that jam."""

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints
from carom.geometry import quaternion
from carom.visual.bodies import links_of
from files.compare import differences
from verified import agree, verifies

G = 9.81
RADIUS, BORE = 0.02, 0.1  # of a ball, and of the pipe in which it rolls


def hanging(e=0.0, radial=1e-3, **more):
    """A body on a pin in a bush, its centre on the axis of the bush at the start."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Sphere(0.05), mass=2.0, name="body")
    scene.add_joint(
        joints.Clearance((0, 0, 0), (0, 1, 0), radial=radial, restitution=e, **more),
        GROUND, "body", name="pin",
    )  # fmt: skip
    return scene


@verifies("joints.Clearance", r"strikes at $\sqrt{2c/g}$, bounces for $2 e v/g$", "closed form")
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("axis", [(0, 1, 0), (1, 2, 0)])
def test_a_pin_falls_through_its_play(e, axis):
    # It strikes at t = sqrt(2 c/g) with sqrt(2 g c), and bounces for a time of 2 e v/g.
    c = 1e-3
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Sphere(0.05), mass=2.0, name="body")
    scene.add_joint(
        joints.Clearance((0, 0, 0), axis, radial=c, restitution=e), GROUND, "body", name="pin"
    )
    run = carom.simulate(scene, 0.2)
    t, v = np.sqrt(2 * c / G), np.sqrt(2 * G * c)
    assert run.success
    agree(run.impacts.time[0], t, atol=1e-14)
    agree(run.impacts.impulse[0, 0], 2.0 * (1 + e) * v, rtol=1e-13)
    if e > 0.0:
        agree(run.impacts.time[1], t + 2 * e * v / G, atol=1e-13)
    assert run["pin"].gap.min() >= -1e-15
    if e < 1.0:
        agree(run["pin"].gap[-1], 0.0, atol=1e-14)
        agree(run["pin"].force[-1], [2.0 * G, 0, 0], atol=1e-9)
    else:
        agree(np.ptp(run.total_energy), 0.0, atol=1e-14)


def rolling(where, mu, e, spin):
    """A ball in a pipe, or a body with a pin of its radius in a bush, from the axis."""
    scene = carom.Scene(gravity=(0, 0, -G))
    ball = scene.add_body(
        carom.Sphere(RADIUS), mass=1.0, inertia=np.full(3, 0.4 * RADIUS**2), velocity=(0.3, 0, 0.1),
        angular_velocity=(0, spin, 0), name="ball",
    )  # fmt: skip
    if where == "pipe":
        turn = carom.euler("x", 90)
        pipe = scene.add_surface(carom.surfaces.InsideCylinder(BORE), orientation=turn)
        scene.add_contact(ball, pipe, restitution=e, friction=mu)
        return scene
    play = {"radial": BORE - RADIUS, "radius": RADIUS, "friction": mu, "restitution": e}
    scene.add_joint(joints.Clearance((0, 0, 0), (0, 1, 0), **play), GROUND, ball)
    return scene


@pytest.mark.parametrize(
    ("mu", "e", "spin"), [(0, 0.5, 0), (0.3, 0.5, 20), (0.1, 0.0, -40), (0.8, 0.8, 5)]
)
def test_a_pin_moves_in_its_bush_as_a_ball_in_a_pipe(mu, e, spin):
    """Impacts with friction, slip that stops, rolling up and down: the same as on curved ground."""
    pipe, bush = (
        carom.simulate(rolling(where, mu, e, spin), 1.0, rtol=1e-10) for where in ("pipe", "bush")
    )
    for name in ("position", "velocity"):
        error = np.abs(getattr(pipe, name)[-1] - getattr(bush, name)[-1]).max()
        assert error < 1e-11
    assert np.abs(pipe.angular_velocity[-1] - bush.angular_velocity[-1]).max() < 1e-9
    assert len(pipe.impacts) == len(bush.impacts) > 0


def in_space(seed, **play):
    rng = np.random.default_rng(seed)
    scene = carom.Scene(gravity=(0, 0, 0))
    for name, mass, place in (("ring", 2.0, (0.05, 0.02, 0)), ("pin", 1.0, (0, 0.01, 0.03))):
        scene.add_body(
            mass=mass, inertia=mass * np.array([0.01, 0.015, 0.012]), position=place,
            velocity=0.1 * rng.normal(size=3), angular_velocity=2.0 * rng.normal(size=3),
            orientation=carom.euler("x", 30), name=name,
        )  # fmt: skip
    scene.add_joint(joints.Clearance((0, 0, 0), (0.1, 1, 0.2), **play), "ring", "pin", name="joint")
    return scene


def momenta(run):
    """Linear and angular momentum (T, 3) of all bodies."""
    P, L = 0.0, 0.0
    for k, body in enumerate(run.scene.bodies):
        turn = quaternion.matrix(run.orientation[:, k])
        spin = np.einsum("tij,jk,tlk,tl->ti", turn, body.inertia, turn, run.angular_velocity[:, k])
        P = P + body.mass * run.velocity[:, k]
        L = L + body.mass * np.cross(run.position[:, k], run.velocity[:, k]) + spin
    return P, L


@pytest.mark.parametrize("seed", range(4))
def test_two_bodies_in_each_others_arms(seed):
    """Both ends and both faces of a loose pin strike: momenta stay, and with e = 1 the energy."""
    elastic = seed % 2 == 0
    play = (
        {"restitution": 1.0} if elastic else {"restitution": 0.5, "friction": 0.2, "radius": 0.01}
    )
    scene = in_space(seed, radial=5e-3, axial=0.02, length=0.05, **play)
    assert [stop.name for stop in scene.stops] == [
        "joint.1", "joint.2", "joint.lower", "joint.upper",
    ]  # fmt: skip
    run = carom.simulate(scene, 0.5)
    assert run.success
    assert len(run.impacts) > 5
    for one in momenta(run):
        assert np.ptp(one, axis=0).max() < 1e-11
    energy = run.total_energy
    if elastic:
        assert np.ptp(energy) < 1e-11
    else:
        assert np.diff(energy).max() < 1e-9
    assert min(run[stop.name].gap.min() for stop in scene.stops) > -1e-9


def drawer(y, L=0.4, mu=0.3):
    """A drawer of 1 kg in a guide of length L, pulled with 2 N beside its middle."""
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1.0, inertia=(0.1, 0.1, 0.1), name="drawer")
    scene.add_joint(joints.Planar((0, 0, 1)), GROUND, body)
    guide = joints.Clearance((0, 0, 0), (1, 0, 0), radial=1e-3, length=L, friction=mu)
    scene.add_joint(guide, GROUND, body, name="guide")
    scene.add_force(forces.Force((2.0, 0, 0), (0, y, 0)), body)
    return scene


@verifies(
    "joints.Clearance", r"$m a = F (1 - 2\mu y/L)$, and it jams from $2\mu y = L$ on", "closed form"
)
@pytest.mark.parametrize("y", [0.3, 0.5, 0.66, 0.68, 0.8])
def test_a_drawer_jams(y):
    # Both ends press with F y/L each, so friction takes 2 mu y/L of the force; above 1 it stays.
    run = carom.simulate(drawer(y), 1.0)
    share = 2 * 0.3 * y / 0.4
    assert run.success
    # it turns by the play within the first hundredth of a second, and then moves with the rest of the force
    after = run.t > 0.1
    gained = run.velocity[-1, 0, 0] - run.velocity[after, 0, 0][0]
    pull = gained / (run.t[-1] - run.t[after][0])
    agree(pull, max(0.0, 2.0 * (1.0 - share)), atol=1e-6)
    for end in ("guide.1", "guide.2"):
        agree(run[end].force[-1, 0], 2.0 * y / 0.4, rtol=1e-4)


def test_a_ball_in_a_socket():
    c = 1e-3
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Sphere(0.05), mass=2.0, name="body")
    socket = scene.add_joint(joints.Clearance((0, 0, 0), radial=c, restitution=0.3), GROUND, "body")
    run = carom.simulate(scene, 0.2)
    assert run.impacts.time[0] == pytest.approx(np.sqrt(2 * c / G), abs=1e-14)
    assert socket.name == "pin1"
    assert run[socket].force[-1, 0] == pytest.approx(2.0 * G, abs=1e-9)


def crank(**play):
    """A slider-crank whose slider hangs on a loose pin."""
    scene, a, b = carom.Scene(gravity=(0, 0, 0)), 0.05, 0.12
    for name, mass, x in (("crank", 0.3, a / 2), ("rod", 0.2, a + b / 2), ("slider", 0.15, a + b)):
        scene.add_body(mass=mass, inertia=np.full(3, 1e-3 * mass), position=(x, 0, 0), name=name)
    axle = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "crank")
    scene.add_joint(joints.Revolute((a, 0, 0), (0, 1, 0)), "crank", "rod")
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, "slider", name="way")
    scene.add_joint(joints.Clearance((a + b, 0, 0), (0, 1, 0), **play), "rod", "slider", name="pin")

    def turn(t):
        return 30 * t - np.sin(30 * t), 30 - 30 * np.cos(30 * t), 900 * np.sin(30 * t)

    scene.add_constraint(constraints.Driver(axle, motion=turn), name="motor")
    return scene


def test_a_crank_with_a_loose_pin_comes_to_that_with_a_tight_one():
    """The slider is away from that of a mechanism without play by at most the play, and the ledger closes."""
    places = []
    for radial in (1e-3, 1e-4):
        play = {"radial": radial, "restitution": 0.3, "friction": 0.05, "radius": 0.01}
        run = carom.simulate(crank(**play), 0.4)
        assert run.status is carom.Status.SUCCESS
        assert np.abs(run.ledger.residual).max() < 1e-4 * np.abs(run.ledger.loads).max()
        assert run["pin"].gap.min() > -1e-9
        turn = 30 * run.t - np.sin(30 * run.t)
        tight = 0.05 * np.cos(turn) + np.sqrt(0.12**2 - (0.05 * np.sin(turn)) ** 2)
        places.append(np.abs(run["way"].coordinate + 0.17 - tight).max() / radial)
    assert all(0.5 < one < 1.1 for one in places)


def test_impulses_in_joints_beside_a_loose_pin():
    """What a blow with friction gives to the slider across its way, the way takes."""
    run = carom.simulate(crank(radial=1e-3, restitution=0.3, friction=0.3, radius=0.01), 0.1)
    way, impacts, y = run.joint_impulses["way"], run.impacts, np.array([0.0, 1.0, 0.0])
    held = run.events.time[run.events.kind == "held"]  # what ends bounces is no impact
    assert len(way) > 3
    for row in way:
        k = row.impact
        n, (p, t, along) = impacts.normal[k], impacts.impulse[k]
        given = p * n + t * np.cross(y, n) + along * y
        assert row.impulse[2] == pytest.approx(-given[2], abs=1e-12)
        if row.time in held:
            continue
        change = run.evaluate(row.time)[2][2, 0] - run.evaluate(row.time, side="left")[2][2, 0]
        assert 0.15 * change == pytest.approx(given[0], abs=1e-10)


def test_files_names_and_pictures(tmp_path):
    scene = in_space(1, radial=5e-3, axial=0.02, length=0.05, friction=0.2)
    assert not links_of(scene)
    run = carom.simulate(scene, 0.3)
    pytest.importorskip("h5netcdf")
    run.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    assert not differences(run, again)
    assert np.array_equal(carom.simulate(again.scene, 0.3).position, run.position)
    runs = carom.ensemble(hanging(), 0.1, vary={"pin.upper": [1e-3, 2e-3]})
    np.testing.assert_allclose(runs.position[:, 0, 2], [-1e-3, -2e-3], atol=1e-12)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"radial": 0.0}, "radial must be finite and above 0, got 0"),
        ({"radial": 1e-3, "length": -1.0}, "length must be finite and above 0"),
        ({"radial": 1e-3, "friction": -0.1}, "friction must be finite and at least 0"),
        (
            {"radial": 1e-3, "axis": None, "friction": 0.1},
            "friction must be left out of a ball in a socket",
        ),
        ({"radial": 1e-3, "axis": (0, 0, 0)}, "axis must not be the zero vector"),
    ],
)
def test_values_that_it_does_not_take(given, message):
    with pytest.raises(ValueError, match=message):
        joints.Clearance((0, 0, 0), given.pop("axis", (0, 1, 0)), **given)
