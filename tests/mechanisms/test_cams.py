"""Cams: lift-off in closed form, jumps against `solve_ivp`, the ledger, ratchets, a Geneva drive."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import carom
from carom.geometry import quaternion
from mechanisms.cams import G, Lift, cam_scene, flat_height, follower, roller_height

C, R = 0.02, 0.05  # eccentricity and radius of a disc


def eccentric(omega, shape, load=0.0, mass=0.5):
    """Return a flat follower on an eccentric disc, whose lift is C sin(omega t)."""
    flat = carom.Box(0.2, 0.02, 0.02)
    start = (R + 0.01, omega * C)
    scene = cam_scene(shape, omega, flat, start, mass=mass, offset=(C, 0.0))
    if load:
        scene.add_force(carom.forces.Force((0, -load, 0)), carom.GROUND, "follower")
    return scene


def disc():
    return carom.Profile(lambda a: (C + R * math.cos(a), R * math.sin(a)), thickness=0.02)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-10])
def test_flat_follower_leaves_an_eccentric_disc(tolerance):
    # N = m (g - c w^2 sin(w t)) + F is 0 at sin(w t) = (g + F/m)/(c w^2), never for c w^2 < g + F/m.
    load, mass = 3.0, 0.5
    pull = G + load / mass
    below = eccentric(0.99 * math.sqrt(pull / C), disc(), load, mass)
    s = carom.simulate(below, 0.4, rtol=tolerance, atol=tolerance, save_at=0.01)
    lift = s["follower"].position[:, 1] - R - 0.01
    np.testing.assert_allclose(lift, C * np.sin(s["axle"].coordinate), atol=1e-12)
    assert len(s.impacts) == 0
    omega = 1.3 * math.sqrt(pull / C)
    leaves = math.asin(pull / (C * omega**2)) / omega
    runs = [
        carom.simulate(eccentric(omega, shape, load, mass), 0.3, rtol=tolerance, atol=tolerance)
        for shape in (disc(), carom.Cylinder(R, 0.02))
    ]
    place, rate = C * math.sin(omega * leaves), C * omega * math.cos(omega * leaves)

    def above(t):
        flight = t - leaves
        return place + rate * flight - 0.5 * pull * flight**2 - C * math.sin(omega * t)

    lands = brentq(above, leaves + 0.02, leaves + 0.2, xtol=1e-14)
    for run in runs:  # the same disc as a profile and as a cylinder
        opened = run.events.time[run.events.kind == "opens"]
        assert 0.0 <= opened[0] - leaves < 0.3 / 200  # the end of its step
        assert run.impacts.time[0] == pytest.approx(lands, abs=10 * tolerance)


HEXAGON = [
    (0.03 * math.cos(a), 0.03 * math.sin(a), z)
    for a in np.arange(6) * math.pi / 3
    for z in (-0.02, 0.02)
]


@pytest.mark.few(3)
@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize(
    "shape", [carom.Box(0.06, 0.06, 0.04), carom.Convex(HEXAGON), carom.Cylinder(0.03, 0.04)]
)
def test_partner_that_tips_ends_the_run(shape, held):
    # In flight it turns by .9 degrees, and the blow turns it on; or its weight is beyond the edge of the cam.
    scene = carom.Scene(gravity=(0, -G, 0))
    scene.add_static(carom.Profile(lambda a: R * (1 - 0.1 * math.sin(3 * a)), 0.02), name="cam")
    height = 1.1 * R - shape.support((0, -1, 0))[1] + (0.0 if held else 0.012)
    body = scene.add_body(
        shape, mass=0.2, position=(0, height, 0.011 if held else 0.0), name="follower",
        angular_velocity=(0.0 if held else 0.3, 0, 0),
    )  # fmt: skip
    scene.add_contact(body, "cam", restitution=0.0 if held else 0.3, friction=0.2, name="lift")
    s = carom.simulate(scene, 0.5, step=2e-3, throw=False)
    assert s.status is carom.Status.OUT_OF_PLANE
    assert "'lift'" in s.message
    assert s.t[-1] < 0.1
    tip = 2 * math.asin(math.hypot(*s["follower"].orientation[-1, 1:3]))
    assert f"({math.degrees(tip):.1f} degrees" in s.message
    assert math.degrees(tip) < 3.0  # some steps at most beyond the degree, in flight


def wavy(lobes=3, depth=0.12):
    return lambda a: R * (1.0 + depth * math.cos(lobes * (a - 0.3)))


@pytest.mark.few(3)
@pytest.mark.parametrize("tolerance", [1e-6, 1e-10])
@pytest.mark.parametrize(
    ("fast", "stiffness", "e"), [(0.9, 0.0, 0.0), (2.5, 2000.0, 0.0), (1.4, 0.0, 0.4)]
)
def test_roller_on_a_cam_that_is_not_convex(tolerance, fast, stiffness, e, roller_lift):
    # From the lift of the axis of the roller alone: it leaves where the cam would have to pull.
    shape, lift, r = roller_lift
    omega = fast * math.sqrt(G / (0.12 * R)) / 3
    start = (lift(0.0), omega * lift(0.0, 1))
    scene = cam_scene(
        shape,
        omega,
        carom.Cylinder(r, 0.02),
        start,
        stiffness=stiffness,
        e=e,
        offset=shape.centroid[:2],
    )
    end = 3.0 * math.pi / omega
    s = carom.simulate(scene, end, rtol=tolerance, atol=tolerance, save_at=end / 200)
    exact = follower(lift, omega, s.t, stiffness=stiffness, e=e)
    assert (len(exact.lands) > 1) == (fast > 1.0)
    struck = np.unique(s.impacts.time[s.impacts.time > 0.0])  # of both ends of the line of contact
    np.testing.assert_allclose(struck, exact.lands, atol=100 * tolerance)
    np.testing.assert_allclose(s["follower"].position[:, 1], exact.y, atol=10 * tolerance)
    assert np.max(np.abs(s.ledger.residual)) < 100.0 * tolerance * np.max(np.abs(s.ledger.loads))


@pytest.fixture(scope="module")
def roller_lift():
    shape = carom.Profile(wavy(), thickness=0.02)
    assert len(shape.pieces[0].hollows) == 3
    return shape, Lift(roller_height(wavy(), 0.012), 192), 0.012


def test_flat_follower_jumps_and_lands():
    lift = Lift(flat_height(lambda a: R * (1.0 + 0.2 * math.cos(a))), 128)
    shape = carom.Profile(lambda a: R * (1.0 + 0.2 * math.cos(a)), thickness=0.02)
    omega = 1.5 * math.sqrt(G / (0.2 * R))
    scene = cam_scene(
        shape, omega, carom.Box(0.3, 0.02, 0.02), (lift(0.0) + 0.01, omega * lift(0.0, 1)),
        offset=shape.centroid[:2],
    )  # fmt: skip
    s = carom.simulate(scene, 0.5, rtol=1e-10, atol=1e-10, save_at=0.005)
    exact = follower(lift, omega, s.t)
    assert exact.lands
    np.testing.assert_allclose(s["follower"].position[:, 1] - 0.01, exact.y, atol=1e-9)


def ratchet(torque):
    """Return a wheel of twelve teeth, whose radial sides stop a pawl if it turns backwards."""
    turns = [0.5 * math.pi + math.pi * k / 6 for k in range(12)]
    wheel = carom.Profile(
        [(r * math.cos(a), r * math.sin(a)) for a in turns for r in (0.05, 0.06)],
        0.01,
        corners="all",
    )
    scene = carom.Scene(gravity=(0, -G, 0))
    body = scene.add_body(wheel, mass=0.5, position=wheel.centroid, name="wheel")
    axle = scene.add_joint(
        carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 0, 1)), carom.GROUND, body, name="axle"
    )
    scene.add_force(carom.forces.JointFriction(axle, 0.02), name="bearing")
    c, s, length, width = math.cos(0.15), math.sin(0.15), 0.06, 0.008
    tip = np.array([0.002, 0.0505])
    middle = tip + 0.5 * np.array([c * length - s * width, s * length + c * width])
    pawl = scene.add_body(
        carom.Box(length, width, 0.01), mass=0.05, position=(*middle, 0),
        orientation=carom.euler("z", np.degrees(0.15)),
        name="pawl",
    )  # fmt: skip
    pivot = (tip[0] + length, tip[1] + 0.02, 0)
    scene.add_joint(carom.joints.Revolute(anchor=pivot, axis=(0, 0, 1)), carom.GROUND, pawl)
    scene.add_contact(pawl, body, restitution=0.2, friction=0.2)
    scene.add_force(carom.forces.Torque((0, 0, torque)), carom.GROUND, body)
    return scene


def test_ratchet_holds_one_way():
    s = carom.simulate(ratchet(-0.5), 0.3, rtol=1e-6, atol=1e-6, save_at=0.01)
    angle = s["axle"].coordinate
    assert -math.pi / 6 < angle[-1] < 0.0  # less than a tooth
    assert np.ptp(angle[15:]) < 1e-9
    assert abs(s["axle"].rate[-1]) < 1e-9


def test_ratchet_turns_the_other_way():
    s = carom.simulate(ratchet(0.1), 0.3, rtol=1e-6, atol=1e-6, save_at=0.01)
    assert s["axle"].coordinate[-1] > math.pi / 3  # some teeth
    assert np.min(np.diff(s["axle"].coordinate)) > -0.05
    assert len(np.unique(s.impacts.time)) >= 2
    assert np.max(np.abs(s.ledger.residual)) < 1e-6


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_geneva_wheel_advances_by_a_quarter_a_turn(friction):
    # The pin enters a slot along it at 45 degrees before the line of centres, and leaves 45 degrees behind.
    centre, pin, omega = 0.1, 0.006, 2.0
    arm, width = centre / math.sqrt(2.0), pin + 3e-4
    slot = [(0.72 * centre, -width), (centre - arm - pin - 0.003, -width)]
    slot += [(x, -y) for x, y in slot[::-1]]
    points = []
    for k in range(4):
        c, s = math.cos(math.pi * (0.5 * k - 0.25)), math.sin(math.pi * (0.5 * k - 0.25))
        points += [(c * x - s * y, s * x + c * y) for x, y in slot]
    wheel = carom.Profile(points, 0.01, corners="all")
    scene = carom.Scene(gravity=(0, 0, -G))
    body = scene.add_body(wheel, mass=0.3, position=wheel.centroid, name="wheel")
    axle = scene.add_joint(
        carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 0, 1)), carom.GROUND, body, name="axle"
    )
    scene.add_force(carom.forces.JointFriction(axle, 0.005), name="brake")
    crank = scene.add_body(
        carom.Cylinder(pin, 0.01), mass=0.05, position=(centre, -arm, 0), velocity=(-omega * arm, 0, 0),
        angular_velocity=(0, 0, -omega), name="pin",
    )  # fmt: skip
    joint = carom.joints.Revolute(anchor=(centre, 0, 0), axis=(0, 0, 1))
    turn = scene.add_joint(joint, carom.GROUND, crank, name="crank")
    scene.add_constraint(carom.constraints.Driver(turn, rate=-omega))
    scene.add_contact(crank, body, restitution=0.0, friction=friction)
    s = carom.simulate(scene, 2 * math.pi, rtol=1e-6, atol=1e-6, save_at=math.pi / 50)
    quarter = s["axle"].coordinate[::50] / (0.5 * math.pi)
    # within the play of the pin in the slot, at the distance of its mouth
    np.testing.assert_allclose(quarter, [0, 1, 2], atol=0.03)
    assert np.max(np.abs(s.ledger.residual)) < 1e-6
    assert s.stats["whole_steps"] == 0


@pytest.mark.parametrize("ground", ["half-space", "box"])
def test_egg_rocks_and_rolls_without_loss(ground):
    # Rolling without slip does no work; the axis is at the height of the support function.
    shape = carom.Profile(lambda a: R * (1.0 + 0.15 * math.cos(2 * a)), thickness=0.02)
    scene = carom.Scene(gravity=(0, -G, 0))
    turn = 0.4
    c, s = math.cos(turn), math.sin(turn)
    low = shape.support((-s, -c, 0))
    egg = scene.add_body(
        shape, mass=1.0, position=(0, low[:2] @ (-s, -c), 0),
        orientation=carom.euler("z", np.degrees(turn)), name="egg"
    )  # fmt: skip
    scene.add_joint(carom.joints.Planar(normal=(0, 0, 1)), carom.GROUND, egg)
    if ground == "box":
        floor = scene.add_static(carom.Box(2.0, 0.1, 0.1), position=(0, -0.05, 0))
    else:
        floor = scene.add_half_space((0, 0, 0), (0, 1, 0))
    scene.add_contact(egg, floor, restitution=0.0, friction=1.0)
    run = carom.simulate(scene, 0.6, rtol=1e-9, atol=1e-9, save_at=0.01)
    energy = run.kinetic_energy + run.potential_energy
    np.testing.assert_allclose(energy, energy[0], atol=1e-7)
    assert np.ptp(run["egg"].position[:, 0]) > 0.01
    for x, q in zip(run["egg"].position, run["egg"].orientation):
        down = quaternion.rotate_back(q, np.array([0.0, -1.0, 0.0]))
        assert x[1] == pytest.approx(shape.support(down) @ down, abs=1e-10)
