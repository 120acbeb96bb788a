"""Tethers: slack, jerks, tension, in closed form; momenta and energy of chains; results, files and errors."""

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from carom.visual.bodies import links_of
from files.compare import goes_on
from verified import agree, verifies

G = 9.81
SOON = carom.Options(max_impacts_per_step=1)


def ball(speed, length=1.0, mass=0.3, e=0.0):
    """A ball at the lowest point of its string, thrown to the side."""
    scene = carom.Scene(gravity=(0, 0, -G))
    made = scene.add_body(
        carom.Sphere(0.05), mass=mass, position=(0, 0, -length), velocity=(speed, 0, 0), name="ball"
    )
    scene.add_joint(
        joints.Tether(anchor_parent=(0, 0, 0), restitution=e), GROUND, made, name="string"
    )
    return scene


@verifies(
    "joints.Tether",
    r"slack at $\cos\varphi = -(k - 2)/3$ for $v^2 = k g L$, then a parabola",
    "closed form",
)
@pytest.mark.parametrize("k", [2.5, 3.0, 4.5])
@pytest.mark.parametrize(
    ("how", "error"), [({}, 1e-9), ({"rtol": 1e-10}, 1e-12), ({"step": 5e-3}, 1e-7)]
)
def test_a_ball_on_a_string_goes_slack(k, how, error):
    """With v^2 = k g L at the bottom, 2 < k < 5, at cos phi = -(k - 2)/3; then it flies a parabola till taut.

    There it loses the part of its velocity along the string (e = 0).
    """
    s = carom.simulate(ball(np.sqrt(k * G)), 1.3, **how)
    slack = s.events.time[s.events.kind == "opens"][0]
    x, _, v, _ = s.evaluate(slack)
    cosine = -x[0, 2]
    agree(cosine, -(k - 2) / 3, atol=error)
    # |x + v t - g t^2/2| = 1 for the second time: t^3 g^2/4 - t^2 v_z g + t (v^2 - x_z g) + 2 x.v = 0
    roots = np.roots([G * G / 4, -v[0, 2] * G, v[0] @ v[0] - x[0, 2] * G, 2 * x[0] @ v[0]])
    flight = min(root.real for root in roots if abs(root.imag) < 1e-12 and root.real > 1e-3)
    taut = s.impacts.time[0]
    agree(taut, slack + flight, atol=100 * error)
    end = x[0] + v[0] * flight - (0, 0, 0.5 * G * flight**2)
    speed = (v[0] - (0, 0, G * flight)) @ end
    agree(s.impacts.impulse[0, 0], 0.3 * speed, rtol=1000 * error)
    agree(s.impacts.energy_change[0], -0.15 * speed**2, rtol=1000 * error)


@verifies("joints.Tether", r"$T = m (g \cos\varphi + v^2/L)$", "closed form")
def test_tension_of_a_pendulum():
    """T = m (g cos phi + v^2/L), at all saved times, and no slack for v^2 > 5 g L."""
    s = carom.simulate(ball(np.sqrt(6 * G)), 1.0, rtol=1e-10)
    x, v = s.position[:, 0], s.velocity[:, 0]
    expected = 0.3 * (-G * x[:, 2] + np.sum(v * v, axis=1))
    agree(s["string"].force[1:, 0], expected[1:], atol=1e-8)
    agree(s["string"].gap, 0.0, atol=1e-12)
    assert len(s.impacts) == 0
    agree(s.total_energy, s.total_energy[0], atol=1e-9)


@verifies("joints.Tether", r"$P = (1 + e)\,u/(d \cdot W d)$", "closed form")
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_a_jerk_between_two_bodies(e):
    """P = (1 + e) u/(d.W d), W of both bodies with their rotation; momenta and the ledger close."""
    scene = carom.Scene(gravity=(0, 0, 0))
    a = scene.add_body(carom.Box(0.2, 0.1, 0.1), mass=1.0, name="a")
    b = scene.add_body(
        carom.Box(0.1, 0.2, 0.3), mass=2.0, position=(0.6, 0, 0), velocity=(2, 0.5, 0.2), name="b"
    )
    ends = np.array([0.1, 0.05, 0.0]), np.array([0.6, 0.1, 0.15])
    tether = joints.Tether(1.0, anchor_parent=ends[0], anchor_child=ends[1], restitution=e)
    scene.add_joint(tether, a, b, name="cord")
    s = carom.simulate(scene, 0.5, rtol=1e-10)
    t = s.impacts.time[0]
    d = ends[1] + b.velocity * t - ends[0]
    agree(np.linalg.norm(d), 1.0, atol=1e-11)
    arms = ends[0], ends[1] - (0.6, 0, 0)
    inverse = sum(
        1 / body.mass + np.cross(r, d) @ np.linalg.solve(body.inertia, np.cross(r, d))
        for body, r in zip((a, b), arms)
    )
    agree(s.impacts.impulse[0, 0], (1 + e) * (b.velocity @ d) / inverse, rtol=1e-9)
    momentum = s.velocity[:, 0] + 2.0 * s.velocity[:, 1]
    agree(momentum, np.tile(momentum[0], (len(s.t), 1)), atol=1e-12)
    assert np.min(s["cord"].gap) > -1e-10
    agree(s.ledger.residual, 0.0, atol=1e-9)
    assert s.total_energy[-1] <= s.total_energy[0] + 1e-12
    if e == 1.0:
        agree(s.total_energy, s.total_energy[0], atol=1e-9)


def chain(count, e=0.0):
    """Balls on tethers of the same length, one after another, let fall from a heap."""
    scene, rng = carom.Scene(gravity=(0, 0, -G)), np.random.default_rng(count)
    last = GROUND
    for k in range(count):
        place = np.array([0.03 * k, 0.0, -0.1 - 0.05 * k]) + 0.01 * rng.normal(size=3)
        body = scene.add_body(carom.Sphere(0.02), mass=0.1, position=place)
        anchor = {"anchor_parent": (0, 0, 0)} if last is GROUND else {}
        scene.add_joint(joints.Tether(0.25, restitution=e, **anchor), last, body)
        last = body
    return scene


@pytest.mark.parametrize("e", [0.0, 0.6])
def test_a_chain_of_tethers_falls(e):
    """No tether gets longer, and the energy only falls."""
    s = carom.simulate(chain(5, e), 1.5)
    ends = np.concatenate([np.zeros((len(s.t), 1, 3)), s.position], axis=1)
    lengths = np.linalg.norm(np.diff(ends, axis=1), axis=2)
    assert len(s.impacts) >= 5
    assert np.max(lengths) < 0.25 + 1e-9
    assert np.max(np.diff(s.ledger.impacts)) <= 1e-12
    scale = np.ptp(s.potential_energy)
    np.testing.assert_allclose(s.ledger.residual, 0.0, atol=1e-6 * scale)


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
def test_whole_steps():
    """The same as one contact problem a step."""
    s = carom.simulate(chain(5, 0.0), 1.0, step=5e-3, options=SOON)
    assert s.stats["whole_steps"] > 0
    ends = np.concatenate([np.zeros((len(s.t), 1, 3)), s.position], axis=1)
    assert np.max(np.linalg.norm(np.diff(ends, axis=1), axis=2)) < 0.25 + 1e-4
    assert np.max(np.diff(s.total_energy)) <= 1e-6 * np.ptp(s.potential_energy)


def test_a_lamp_that_falls_past_its_cord_onto_a_floor():
    """A box on a slack cord lands on a floor first; with a shorter cord it hangs above it."""
    for length, height in ((1.2, 0.05), (0.5, 0.45)):
        scene = carom.Scene(gravity=(0, 0, -G))
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
        lamp = scene.add_body(carom.Box(0.2, 0.2, 0.1), mass=1.0, position=(0, 0, 0.8))
        scene.add_contact(lamp, floor, restitution=0.2, friction=0.5)
        cord = joints.Tether(length, anchor_parent=(0, 0, 1), anchor_child=(0, 0, 0.85))
        scene.add_joint(cord, GROUND, lamp, name="cord")
        s = carom.simulate(scene, 3.0)
        np.testing.assert_allclose(s.position[-1, 0], (0, 0, height), atol=1e-6)
        tension = s["cord"].force[-1, 0]
        np.testing.assert_allclose(tension, 0.0 if height < 0.1 else G, atol=1e-6)


def test_a_tether_on_a_mechanism():
    """It stops a pendulum: the impulse along it, with the inertia about the hinge."""
    scene = carom.Scene(gravity=(0, 0, -G))
    rod = scene.add_body(carom.Box(1, 0.05, 0.05), mass=1.0, position=(0.5, 0, 0), name="rod")
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, rod, name="hinge")
    tip = np.array([1.0, 0.0, 0.0])
    cord = joints.Tether(1.2, anchor_parent=(1, 0, 1), anchor_child=tip)
    scene.add_joint(cord, GROUND, rod, name="cord")
    s = carom.simulate(scene, 1.0, rtol=1e-10)
    angles = np.linspace(0, 1, 1000001)  # of a tip at a distance of 1.2 from (1, 0, 1)
    angle = np.interp(1.2**2, 3 - 2 * np.cos(angles) + 2 * np.sin(angles), angles)
    inertia = rod.inertia[1, 1] + 0.25
    rate = np.sqrt(G * np.sin(angle) / inertia)
    place = np.array([np.cos(angle), 0, -np.sin(angle)])
    along = (place - (1, 0, 1)) / 1.2
    lever = along @ (-np.sin(angle), 0, -np.cos(angle))
    np.testing.assert_allclose(s.impacts.impulse[0, 0], inertia * rate / lever, rtol=1e-7)
    change = s.joint_impulses.impulse[0]
    # m times the velocity that the centre had, plus the pull of the cord, is what the hinge gives
    centre = 0.5 * rate * np.array([-np.sin(angle), 0, -np.cos(angle)])
    np.testing.assert_allclose(change, s.impacts.impulse[0, 0] * along - centre, atol=1e-6)
    still = s.angular_velocity[-1, 0, 1]
    np.testing.assert_allclose(still, 0.0, atol=1e-9)
    weight = 0.5 * G * np.cos(angle) / lever  # moments about the hinge
    np.testing.assert_allclose(s["cord"].force[-1, 0], weight, rtol=1e-7)
    np.testing.assert_allclose(s["hinge"].force[-1], weight * along + (0, 0, G), atol=1e-6)
    assert hinge.kind == "Revolute"


def test_files_and_changes(tmp_path):
    scene = chain(3)
    path = tmp_path / "run.h5"
    goes_on(scene, 0.6, path, step=1e-2)
    again = carom.Solution.load(path).scene
    assert repr(again.stops) == repr(scene.stops)
    scene.replace("body2", mass=0.3)
    assert scene["tether2"].joint.child is scene["body2"]
    assert scene["tether3"].joint.parent is scene["body2"]
    scene.remove("body3", dependents=True)
    assert [stop.name for stop in scene.stops] == ["tether1", "tether2"]


def test_pictures_have_the_cord():
    """Taut it is straight; slack it has its length, nearly."""
    scene = ball(0.0)
    scene.add_joint(joints.Tether(2.0, anchor_parent=(1.0, 0, -1)), GROUND, "ball", name="slack")
    taut, slack = links_of(scene)
    x, Q = np.array([[0.0, 0.0, -1.0]]), np.array([[1.0, 0, 0, 0]])
    up = np.array([0.0, 0.0, 1.0])
    assert len(taut.line(x, Q, up)) == 2
    drawn = slack.line(x, Q, up)
    length = np.sum(np.linalg.norm(np.diff(drawn, axis=0), axis=1))
    np.testing.assert_allclose(length, 2.0, rtol=0.02)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "anchor_parent must be given for a point of the ground"),
        ({"length": 0.0, "anchor_parent": (0, 0, 0)}, "length must be finite and above 0"),
        ({"anchor_parent": (0, 0, -1)}, "length must be given if both points are the same"),
        ({"anchor_parent": (0, 0)}, r"anchor_parent must have shape \(3,\)"),
        ({"anchor_parent": (0, 0, 0), "restitution": 2.0}, "restitution must be"),
    ],
)
def test_wrong_input(given, message):
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, -1), name="ball")
    with pytest.raises(ValueError, match=message):
        scene.add_joint(joints.Tether(**given), GROUND, "ball")


def test_too_far_apart_at_the_start():
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, -1), name="ball")
    scene.add_joint(joints.Tether(0.5, anchor_parent=(0, 0, 0)), GROUND, "ball")
    with pytest.raises(
        ValueError, match="must not be exceeded at the start, where the coordinate is 1"
    ):
        carom.simulate(scene, 0.1)
