"""Points on curves against closed forms, and what a run keeps and says about them."""

import math
import re

import numpy as np
import pytest
from mechanism_scenes import orders
from scipy.special import ellipj, ellipk

import carom
from campaigns import rails
from campaigns.case import as_row, run, wrong
from carom.dynamics.methods import METHODS
from verified import agree, verifies

G = 9.81
CYCLOID = 0.5  # generating radius [m]
FINE = {"rtol": 1e-12, "atol": 1e-12}


def cycloid(u):
    return CYCLOID * (u + math.sin(u)), 0.0, -CYCLOID * math.cos(u)


def circle(u):
    return math.sin(u), 0.0, -math.cos(u)


def knot(u):
    return math.cos(2 * u) * (1 + 0.4 * math.cos(3 * u)), math.sin(2 * u), 0.4 * math.sin(3 * u)


def ring(function):
    return carom.curves.Curve(function, 0.0, 2 * math.pi, closed=True)


def on_wire(curve, s=0.0, speed=0.0, gravity=(0, 0, -G)):
    """A bead at the arc length s of a wire, which turns."""
    scene = carom.Scene(gravity=gravity)
    bead = scene.add_body(
        mass=2.0, inertia=(0.1, 0.2, 0.3), position=curve.point(s), velocity=speed * curve.tangent(s),
        angular_velocity=(1.0, 2.0, 3.0), name="bead",
    )  # fmt: skip
    joint = scene.add_joint(carom.joints.PointOnCurve(curve), carom.GROUND, bead, name="wire")
    return scene, joint


@verifies(
    "joints.PointOnCurve", r"a cycloid: $s = A \cos\sqrt{g/4a}\,t$ for each $A$", "closed form"
)
@verifies("curves.Curve", r"a cycloid: $s = A \cos\sqrt{g/4a}\,t$ for each $A$", "closed form")
@pytest.mark.parametrize("amplitude", [0.1, 0.5, 0.9, 0.99])
def test_cycloid_has_one_period(amplitude):
    """The arc length from the lowest point is 4 a sin(u/2), and harmonic: w^2 = g/(4 a)."""
    wire, whole = carom.curves.Curve(cycloid, -3.1, 3.1), 4 * CYCLOID * amplitude
    scene, _ = on_wire(wire, 0.5 * wire.length + whole)
    w = math.sqrt(G / (4 * CYCLOID))
    s = carom.simulate(scene, 4 * math.pi / w, **FINE)
    # near a cusp the curvature is 1/(4 a (1 - A^2)^1/2), and so are errors of the table of the curve
    agree(s["wire"].coordinate, whole * (np.cos(w * s.t) - 1.0), atol=1e-9)


@verifies(
    "joints.PointOnCurve",
    "a circle: the pendulum's elliptic functions, and its reaction",
    "closed form",
)
def test_circle_is_a_pendulum():
    start, k = 2.5, math.sin(1.25)
    scene, joint = on_wire(ring(circle), start)
    s = carom.simulate(scene, 3.0, **FINE)
    angle = 2.0 * np.arcsin(k * ellipj(ellipk(k * k) - math.sqrt(G) * s.t, k * k)[0])
    agree(s.joint_coordinates(joint)[0][:, 0], angle - start, atol=1e-9)
    agree(np.ptp(s.total_energy), 0.0, atol=1e-8)
    # the wire bears m (v^2/r + g cos) towards the centre, and turns nothing
    x, v = s.position[:, 0], s.velocity[:, 0]
    force = -2.0 * x * (np.sum(v**2, axis=1) - G * x[:, 2])[:, None]
    agree(s["wire"].force, force, rtol=1e-7, atol=1e-7)
    assert np.all(s["wire"].torque == 0.0)


def test_helix_is_an_inclined_plane():
    r, pitch = 0.5, 0.2
    helix = carom.curves.Curve(lambda u: (r * math.cos(u), r * math.sin(u), -pitch * u), 0, 40)
    s = carom.simulate(on_wire(helix)[0], 1.5, **FINE)
    slope = pitch / math.hypot(r, pitch)
    np.testing.assert_allclose(s["wire"].coordinate, 0.5 * G * slope * s.t**2, atol=1e-10)


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
@pytest.mark.parametrize("method", METHODS)
def test_method_has_its_order(method):
    """Of order 8 the third derivatives of the curve count, which jump by about 1e-5."""
    order, errors = METHODS[method].order, []
    k, t = math.sin(0.5), 1.0
    exact = 2.0 * math.asin(k * ellipj(ellipk(k * k) - math.sqrt(G) * t, k * k)[0])
    h = {1: 1e-3, 2: 0.01, 4: 0.02, 5: 0.05, 6: 0.1, 8: 0.2}[order]
    for step in (h, h / 2):
        s = carom.simulate(on_wire(ring(circle), 1.0)[0], t, step=step, method=method)
        errors.append(abs(s["wire"].coordinate[-1] + 1.0 - exact))
    assert orders(errors)[0] > order - 0.5 or errors[1] < 5e-9, errors


@verifies("curves.Spline", r"$\ddot s = g \sin\alpha \mp F/m$ with blows at a stop", "closed form")
def test_friction_and_a_stop_on_a_straight_spline():
    line = carom.curves.Spline([(0, 0, 0), (1, 0, -0.5), (3, 0, -1.5), (4, 0, -2)])
    scene, joint = on_wire(line)
    scene.add_force(carom.forces.JointFriction(joint, 5.0))
    scene.add_stop(joint, upper=2.0, restitution=0.5, name="buffer")
    s = carom.simulate(scene, 2.5)
    pull, rub = G * 2 / math.hypot(4, 2), 5.0 / 2.0
    down, up = pull - rub, pull + rub
    first = math.sqrt(2 * 2.0 / down)
    speed = 0.5 * down * first
    second = first + speed / up + math.sqrt(2 * (0.5 * speed**2 / up) / down)
    agree(s.impacts.time[:2], (first, second), atol=1e-8)
    before = s.t < first
    agree(s["wire"].coordinate[before], 0.5 * down * s.t[before] ** 2, atol=1e-8)
    balance = s.total_energy - s.total_energy[0] - s.ledger.friction - s.ledger.impacts
    agree(balance, 0.0, atol=1e-7)


def test_motor_drives_laps_and_branches_are_kept_where_the_curve_crosses_itself():
    eight = ring(lambda u: (math.sin(u), math.sin(2 * u), 0.0))
    scene, joint = on_wire(eight, 1.0, speed=5.0)
    scene.add_constraint(carom.constraints.Driver(joint, rate=5.0))
    s = carom.simulate(scene, 4.0)
    assert 20.0 / eight.length > 2.0
    np.testing.assert_allclose(s["wire"].coordinate, 5.0 * s.t, atol=1e-9)
    np.testing.assert_allclose(s.position[:, 0], eight.point(1.0 + 5.0 * s.t), atol=1e-9)
    run = carom.Run(scene)
    run.advance(4.0)
    assert run.state.joint_coordinates("wire")[0][0] == pytest.approx(20.0, abs=1e-9)


@verifies(
    "joints.CurveOnPoint",
    "a circular slot is a rod to its centre",
    "invariant: two joints with one motion",
)
def test_slot_about_a_point_is_a_rod():
    """A circular slot keeps its centre at a distance from the pin."""
    centre, found = np.array([0.3, 0.0, 0.2]), []
    pin = centre + 0.7 * np.array(circle(2.0))
    slot = ring(lambda u: centre + 0.7 * np.array(circle(u)))
    for kind in (carom.joints.CurveOnPoint(slot, pin), carom.joints.Distance(pin, centre)):
        scene = carom.Scene(gravity=(0, 0, -G))
        plate = scene.add_body(
            mass=2.0, inertia=(0.1, 0.2, 0.3), position=(0.4, 0, -0.2), name="plate"
        )
        scene.add_joint(kind, carom.GROUND, plate, name="joint")
        s = carom.simulate(scene, 2.0, save_at=np.linspace(0, 2, 21), **FINE)
        found.append((s.position, s.joint_reactions))
    for slot, rod in zip(*found):
        agree(slot, rod, atol=2e-6)


def test_two_bodies_in_frames_and_as_the_scene_places_them():
    """A joint by frames of its bodies is that of the world, on a wire that moves."""
    found = []
    for framed in (False, True):
        scene = carom.Scene(gravity=(0, 0, -G))
        wire = scene.add_body(
            mass=3.0, inertia=(0.5, 0.6, 0.7), angular_velocity=(0.5, 2.0, 0.3), name="wire"
        )
        start = np.array(knot(0.0))
        bead = scene.add_body(
            mass=1.0, inertia=(0.1, 0.1, 0.1), position=start + (0.1, 0, 0), name="bead",
            velocity=np.cross((0.5, 2.0, 0.3), start + (0.1, 0, 0)), angular_velocity=(0.5, 2.0, 0.3),
        )  # fmt: skip
        given = {"anchor": start}
        frames = {}
        if framed:
            given = {"anchor": (0, 0, 0)}
            frames = {
                "parent_frame": ((0, 0, 0), (1, 0, 0, 0)),
                "child_frame": ((-0.1, 0, 0), (1, 0, 0, 0)),
            }
        joint = carom.joints.PointOnCurve(ring(knot), **given)
        scene.add_joint(joint, wire, bead, name="hole", **frames)
        s = carom.simulate(scene, 1.0)
        assert np.ptp(s.total_energy) < 1e-6
        assert max(map(np.max, s.constraint_errors)) < 1e-12
        q = s["hole"].coordinate
        found.append((s.position[-1], q - q[0], s["hole"].rate, s["hole"].force))
    for world, frames in zip(*found):
        np.testing.assert_allclose(world, frames, atol=1e-9)


def test_file_has_the_curve_and_goes_on_to_the_bit(tmp_path):
    scene, _ = on_wire(ring(knot), 1.0, speed=3.0)
    s = carom.simulate(scene, 0.5, step=2e-3)
    s.save(tmp_path / "wire.nc")
    again = carom.Solution.load(tmp_path / "wire.nc")
    curve, kept = (one.scene["wire"].definition.curve for one in (s, again))
    assert np.array_equal(curve.ends, kept.ends)
    assert kept.closed
    assert isinstance(kept, type(curve))
    assert np.array_equal(s["wire"].coordinate, again["wire"].coordinate)
    assert np.array_equal(s["wire"].force, again["wire"].force)
    more, whole = again.simulate(0.5), carom.simulate(scene, 1.0, step=2e-3)
    assert np.array_equal(more.position[-1], whole.position[-1])


def test_ensemble_seeks_the_foot_of_each_start():
    wire = ring(circle)
    scene, _ = on_wire(wire)
    feet = np.array([0.5, 2.0, 4.0])
    starts = np.array([wire.point(s) for s in feet])
    runs = carom.ensemble(scene, 0.5, vary={"bead.position": starts}, workers=1)
    alone = [carom.simulate(on_wire(wire, s)[0], 0.5).position[-1, 0] for s in feet]
    np.testing.assert_allclose(runs.position[:, 0], alone, atol=1e-12)


def test_ends_of_an_open_curve():
    line = carom.curves.Spline([(0, 0, 0), (2, 0, -1)])
    with pytest.raises(carom.SimulationError, match="passed an end of its curve") as failed:
        carom.simulate(on_wire(line)[0], 3.0)
    end = failed.value.solution
    assert end.status is carom.Status.LEFT_CURVE
    assert end["wire"].coordinate[-1] == pytest.approx(line.length, abs=0.1)
    beyond = "must be on the curve, between -2.23607 m and 0 m"
    for place, what in (((4, 0, -2), beyond), ((1, 0, 0), "its error")):
        scene = carom.Scene()
        bead = scene.add_body(carom.Sphere(0.1), mass=1.0, position=place)
        scene.add_joint(carom.joints.PointOnCurve(line), carom.GROUND, bead, name="rail")
        with pytest.raises(ValueError, match=f"position violates 'rail'.*{re.escape(what)}"):
            carom.simulate(scene, 0.1)


def test_blow_on_a_rail_is_shared_by_contact_and_rail():
    rail = carom.curves.Spline([(0, 0, 1), (2, 0, 0)])
    scene = carom.Scene(gravity=(0, 0, -G))
    ball = scene.add_body(carom.Sphere(0.1), mass=2.0, position=(0, 0, 1), name="ball")
    scene.add_joint(carom.joints.PointOnCurve(rail), carom.GROUND, ball, name="rail")
    ground = scene.add_half_space((0, 0, 0.3), (0, 0, 1))
    scene.add_contact(ball, ground, restitution=0.5, friction=0.0)
    assert scene.check().degrees_of_freedom == 4
    s = carom.simulate(scene, 1.0)
    blow, share = s.impacts[0], s.joint_impulses[0]
    speed = math.sqrt(2 * G * 0.6) * rail.tangent(0)  # e at the contact is that along the rail
    change = -1.5 * 2.0 * speed
    np.testing.assert_allclose(share.impulse + (0, 0, blow.impulse[0]), change, atol=1e-6)
    assert share.impulse @ rail.tangent(0) == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(share.angular_impulse, 0.0, atol=1e-12)


def test_other_bodies_make_no_difference():
    """Islands move with a step of their own, and have copies of the coordinates."""
    found = []
    for others in (0, 3):
        scene, _ = on_wire(ring(knot), 1.0, speed=3.0)
        ground = scene.add_half_space((0, 0, -9), (0, 0, 1))
        for k in range(others):
            ball = scene.add_body(carom.Sphere(0.2), mass=1.0, position=(3.0 + k, 0, -8.0))
            scene.add_contact(ball, ground, restitution=0.5)
        s = carom.simulate(scene, 2.0, step=2e-3)
        found.append((s.position[-1, 0], s["wire"].coordinate[-1], s["wire"].force[-1]))
    for alone, among in zip(*found):
        np.testing.assert_allclose(among, alone, rtol=0, atol=1e-9)


@pytest.mark.parametrize("seed", [3, 10, 17, 24, 33])
def test_random_rails(seed):
    """The short form of benchmarks/campaigns/rails.py."""
    case = rails.case(seed)
    assert wrong(as_row("rails", seed, case, run(case))) == []
