"""Play in a sum s of joint coordinates: impacts, contact that stays, friction along it, results and files."""

import numpy as np
import pytest
from scipy.optimize import brentq

import carom
from carom import GROUND, constraints, forces, joints
from files.compare import goes_on
from verified import agree, verifies

INERTIA = np.array([0.02, 0.05, 0.03])
SOON = carom.Options(max_impacts_per_step=1)


def wheels(rates, factors, lower, upper, **play):
    """Return a scene of wheels on axles of their own, with play in the sum of their angles."""
    scene = carom.Scene(gravity=(0, 0, 0))
    for k, rate in enumerate(rates):
        place = (0.3 * k, 0, 0)
        wheel = scene.add_body(
            carom.Cylinder(0.1, 0.02), mass=1.0, inertia=(INERTIA[k],) * 3, position=place,
            angular_velocity=(0, 0, rate), name=f"wheel {k}",
        )  # fmt: skip
        scene.add_joint(joints.Revolute(place, (0, 0, 1)), GROUND, wheel, name=f"axle {k}")
    named = {f"axle {k}": factor for k, factor in enumerate(factors)}
    scene.add_play(named, lower, upper, name="teeth", **play)
    return scene


def turns(solution, times=None):
    """Return the angles (T, n) of the wheels."""
    count = len(solution.scene.joints)
    return np.column_stack([solution[f"axle {k}"].coordinate for k in range(count)])


@verifies("add_play", r"impulse $(1 + e)\,\lvert\dot s\rvert/\sum a_k^2/I_k$", "closed form")
@pytest.mark.parametrize("factors", [(1.0, 2.0), (1.0, -0.5), (1.0, 1.0, -2.0)])
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("how", [{}, {"step": 1e-2}, {"rtol": 1e-10}])
def test_teeth_strike(factors, e, how):
    """s' = sum a_k w_k, W = sum a_k^2/I_k: impulse (1 + e)|s'|/W, and wheel k changes by a_k P/I_k.

    Of three wheels the row moves more than two bodies: a differential with play.
    """
    a, inertia = np.array(factors), INERTIA[: len(factors)]
    rates = np.array([3.0, 0.0, 0.0])[: len(factors)]
    s = carom.simulate(wheels(rates, factors, -0.01, 0.02, restitution=e), 0.02, **how)
    speed, W = a @ rates, np.sum(a * a / inertia)
    first = s.impacts[0]
    agree(first.time, 0.02 / speed, atol=1e-11)
    agree(first.impulse[0], (1.0 + e) * speed / W, rtol=1e-12)
    assert first.unit == "rad/s"
    after = rates - a * (1.0 + e) * speed / W / inertia
    next_one = np.searchsorted(s.t, first.time + 1e-9)
    agree(s.angular_velocity[next_one, :, 2], after, rtol=1e-12)
    agree(s.ledger.impacts[next_one], -0.5 * (1 - e * e) * speed**2 / W, atol=1e-13)


@pytest.mark.parametrize("factors", [(1.0, 2.0), (1.0, 1.0, -2.0)])
def test_teeth_that_stay_closed(factors):
    """With M = diag(I) and a torque on the first, N = (a_1 tau/I_1)/W; the wheels turn together."""
    a, inertia = np.array(factors), INERTIA[: len(factors)]
    scene = wheels(0.0 * a, factors, -0.01, 0.0, restitution=0.5)
    scene.add_force(forces.JointForce("axle 0", 0.3))
    s = carom.simulate(scene, 1.0)
    W = np.sum(a * a / inertia)
    force = a[0] * 0.3 / inertia[0] / W
    acceleration = np.append(0.3 / inertia[0], 0.0 * a[1:]) - a * force / inertia
    np.testing.assert_allclose(turns(s)[-1], 0.5 * acceleration, rtol=1e-9)
    np.testing.assert_allclose(s["teeth.upper"].force[1:-1, 0], force, rtol=1e-9)
    assert set(s["teeth.upper"].mode[1:]) == {"sticking"} or not s["teeth.lower"].force.any()
    np.testing.assert_allclose(s["teeth.upper"].gap, 0.0, atol=1e-12)


def play_operator(driven, width, ratio):
    """Return where a wheel with much friction is, moved by -`driven`/`ratio` within a play of +-`width`."""
    out, here = [], 0.0
    for q in driven:
        low, high = sorted(((-width - q) / ratio, (width - q) / ratio))
        here = min(max(here, low), high)
        out.append(here)
    return np.array(out)


def test_a_train_with_three_plays():
    """The first wheel swings; the others, which friction stops, follow by the play operator."""
    scene, swing = carom.Scene(gravity=(0, 0, 0)), 2.0
    for k in range(4):
        wheel = scene.add_body(
            carom.Cylinder(0.1, 0.02), mass=1.0, position=(0.3 * k, 0, 0), name=f"wheel {k}"
        )
        axle = joints.Revolute((0.3 * k, 0, 0), (0, 0, 1))
        hinge = scene.add_joint(axle, GROUND, wheel, name=f"axle {k}")
        if k > 0:
            scene.add_force(forces.JointFriction(hinge, 0.5))
    for k, ratio in enumerate((1.0, 0.5, -1.5)):
        scene.add_play({f"axle {k}": 1.0, f"axle {k + 1}": ratio}, -0.1, 0.1)

    def motion(t):
        w = 2.0 * np.pi
        return (
            0.5 * swing * (1 - np.cos(w * t)),
            0.5 * swing * w * np.sin(w * t),
            0.5 * swing * w**2 * np.cos(w * t),
        )

    scene.add_constraint(constraints.Driver("axle 0", motion=motion))
    times = np.linspace(0, 2.0, 401)
    s = carom.simulate(scene, 2.0, rtol=1e-9, save_at=times)
    dense = np.linspace(0, 2.0, 40001)
    expected = [0.5 * swing * (1 - np.cos(2.0 * np.pi * dense))]
    for ratio in (1.0, 0.5, -1.5):
        expected.append(play_operator(expected[-1], 0.1, ratio))
    for k in range(4):
        np.testing.assert_allclose(s[f"axle {k}"].coordinate, expected[k][::100], atol=2e-8)


def rattle(end, e, width, amplitude, w):
    """Return the times of impacts of a wheel between teeth at a(1 - cos wt) -+ width; it flies between them."""
    times, now, place, rate = [], 0.0, 0.0, 0.0

    def gap(t, side):
        driver = amplitude * (1.0 - np.cos(w * t))
        return width - side * (driver - place - rate * (t - now))

    while True:
        grid = now + 1e-9 + np.linspace(0, 1.0, 4001)
        hits = []
        for side in (1.0, -1.0):
            values = gap(grid, side)
            below = np.flatnonzero(values < 0)
            if len(below):
                k = below[0]
                low = grid[k - 1] if k else grid[0]
                hits.append(brentq(gap, low, grid[k], args=(side,), xtol=1e-15))
        if not hits or min(hits) > end:
            return np.array(times)
        t = min(hits)
        place, now = place + rate * (t - now), t
        speed = amplitude * w * np.sin(w * t)
        rate = speed - e * (rate - speed)  # the driver has no finite mass
        times.append(t)


@verifies(
    "add_play", r"$u^+ = -e\,u^-$ between teeth that swing", "own integration: flights and roots"
)
def test_a_driven_gear_rattles():
    """Against an integration of its own: flight between teeth that swing, u+ = -e u- relative to them."""
    e, width, amplitude, w = 0.6, 0.05, 0.3, 2.0 * np.pi
    scene = wheels((0.0, 0.0), (1.0, -1.0), -width, width, restitution=e)

    def motion(t):
        c, s = np.cos(w * t), np.sin(w * t)
        return amplitude * (1 - c), amplitude * w * s, amplitude * w * w * c

    scene.add_constraint(constraints.Driver("axle 0", motion=motion))
    s = carom.simulate(scene, 4.0, rtol=1e-10)
    expected = rattle(4.0, e, width, amplitude, w)
    strong = s.impacts.time[:12]
    assert len(expected) >= 12
    agree(strong, expected[:12], atol=1e-8)


@pytest.mark.parametrize("how", [{}, {"step": 5e-3}])
def test_friction_along_the_sum(how):
    """s'' = -f W until s stops at s'^2/(2 f W); the work is -f s. Then it holds a torque below it."""
    f, a = 0.04, np.array([1.0, 2.0])
    scene = wheels((3.0, 0.0), a, -6.0, 6.0, friction=f)
    scene.add_force(forces.JointForce("axle 1", 0.02))
    s = carom.simulate(scene, 1.0, **how)
    push, W = np.array([0.0, 0.02]), np.sum(a * a / INERTIA[:2])
    slows = f * W - a @ (push / INERTIA[:2])
    stop = 3.0 / slows
    first = np.array([3.0, 0.0]) + (push - f * a) / INERTIA[:2] * stop
    hold = a @ (push / INERTIA[:2]) / W  # in rest relative to each other
    later = first + (push - hold * a) / INERTIA[:2] * (1.0 - stop)
    assert 0.0 < stop < 0.9
    assert hold < f
    np.testing.assert_allclose(s.angular_velocity[-1, :, 2], later, rtol=1e-7)
    np.testing.assert_allclose(turns(s)[-1] @ a, 1.5 * stop, rtol=1e-7)
    np.testing.assert_allclose(s.ledger.friction[-1], -f * 1.5 * stop, rtol=1e-7)
    exerted = s["teeth.friction"].torque
    np.testing.assert_allclose(exerted[0], -f, rtol=1e-9)
    np.testing.assert_allclose(exerted[-1], -hold, rtol=1e-6)


def arm(gravity=9.81, friction=0.0):
    """Return two rods on hinges, with play in the sum of their angles: that of the second against the world."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    first = scene.add_body(carom.Box(1, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0), name="first")
    second = scene.add_body(carom.Box(1, 0.1, 0.1), mass=2.0, position=(1.5, 0, 0), name="second")
    shoulder = scene.add_joint(
        joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, first, name="shoulder"
    )
    elbow = scene.add_joint(joints.Revolute((1, 0, 0), (0, 1, 0)), first, second, name="elbow")
    scene.add_play({shoulder: 1.0, elbow: 1.0}, -0.3, 0.3, friction=friction, name="play")
    return scene


@pytest.mark.parametrize("friction", [0.0, 1.0])
def test_reactions_while_the_play_is_closed(friction):
    """Joints and weight give each rod the change of its velocity, by central differences of 1e-4 s."""
    times = np.concatenate([t + 1e-4 * np.arange(-1, 2) for t in np.linspace(0.1, 0.9, 41)])
    s = carom.simulate(arm(friction=friction), 1.0, rtol=1e-10, save_at=times)
    middle = np.searchsorted(s.t, times.reshape(-1, 3))
    closed = np.all(s["play.upper"].force[middle, 0] > 0.0, axis=1)
    middle = middle[closed]
    assert closed.sum() > 5
    mass, weight = np.array([1.0, 2.0]), np.array([0.0, 0.0, -9.81])
    a = (s.velocity[middle[:, 2]] - s.velocity[middle[:, 0]]) / 2e-4 - weight
    at = middle[:, 1]
    np.testing.assert_allclose(s["elbow"].force[at], mass[1] * a[:, 1], atol=1e-5)
    np.testing.assert_allclose(s["shoulder"].force[at], np.einsum("b,tbi->ti", mass, a), atol=1e-5)


def test_momenta_of_an_impact_in_a_chain():
    """The impulse along s is on both joints; those of the hinges close the balance of each body."""
    s = carom.simulate(arm(), 0.6)
    row = s.joint_impulses
    assert len(s.impacts) > 0
    assert np.all(np.isfinite(row.impulse))
    first = s.impacts[0]
    before, after = s.evaluate(first.time - 1e-9), s.evaluate(first.time + 1e-9)
    change = 2.0 * (after[2][1] - before[2][1])
    own = row.impulse[(row.time == first.time) & (row.joint == 1)]
    np.testing.assert_allclose(own[0], change, atol=1e-6)


@pytest.mark.parametrize("count", [2, 3])
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
def test_whole_steps(count):
    """Teeth that bounce many times in a step are one contact problem: s stays in its play, energy falls."""
    factors = (1.0, 2.0, -1.5)[:count]
    scene = wheels((3.0, 0.0, 1.0)[:count], factors, -1e-4, 1e-4, restitution=0.9)
    s = carom.simulate(scene, 0.2, step=5e-3, options=SOON)
    assert s.stats["whole_steps"] > 0
    assert np.max(np.diff(s.total_energy)) <= 1e-12
    play = turns(s) @ np.array(factors)
    assert np.max(np.abs(play)) < 1e-4 + 1e-6
    # what no row of the play changes stays: momenta across a_k
    momentum = s.angular_velocity[:, :, 2] * INERTIA[:count]
    across = np.linalg.svd(np.array([factors]))[2][1:]
    np.testing.assert_allclose(
        momentum @ across.T, np.tile(momentum[0] @ across.T, (len(s.t), 1)), atol=1e-12
    )


@verifies("add_play(coordinate=)", "$W = r^2/I + 1/m$", "closed form")
def test_rack_and_pinion():
    """An angle times its radius and a displacement: in metres and newtons."""
    scene = carom.Scene(gravity=(0, 0, 0))
    pinion = scene.add_body(carom.Cylinder(0.1, 0.02), mass=1.0, inertia=(0.02,) * 3)
    rack = scene.add_body(
        carom.Box(1, 0.1, 0.1), mass=2.0, position=(0, 0.2, 0), velocity=(0.5, 0, 0)
    )
    turn = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, pinion)
    slide = scene.add_joint(joints.Prismatic((1, 0, 0), anchor=(0, 0.2, 0)), GROUND, rack)
    play = scene.add_play({turn: 0.1, (slide, 0): 1.0}, -0.01, 0.01, restitution=0.25)
    s = carom.simulate(scene, 0.1)
    W = 0.1**2 / 0.02 + 1 / 2.0
    agree(s.impacts.time[0], 0.02, atol=1e-11)
    agree(s.impacts.impulse[0, 0], 1.25 * 0.5 / W, rtol=1e-12)
    assert s.impacts[0].unit == "m/s"
    assert not play.upper.turns


def test_a_play_of_one_joint_is_two_stops():
    """Bit for bit."""
    runs = []
    for made in (True, False):
        scene = wheels((3.0, 0.0), (1.0, 2.0), -1.0, 1.0)
        if made:
            scene.add_play("axle 0", -0.1, 0.05, restitution=0.5)
        else:
            scene.add_stop("axle 0", lower=-0.1, restitution=0.5)
            scene.add_stop("axle 0", upper=0.05, restitution=0.5)
        runs.append(carom.simulate(scene, 0.2))
    np.testing.assert_array_equal(runs[0].position, runs[1].position)
    np.testing.assert_array_equal(runs[0].angular_velocity, runs[1].angular_velocity)


def test_files_and_runs_that_go_on(tmp_path):
    scene = arm(friction=0.5)
    path = tmp_path / "run.h5"
    goes_on(scene, 0.8, path, step=1e-2)
    loaded = carom.Solution.load(path)
    assert repr(loaded.scene.stops) == repr(scene.stops)


def test_changes_of_a_scene():
    scene = arm(friction=0.5)
    scene.replace("elbow", axis=(0, 1, 0))
    assert scene["play.upper"].joint.joints[1] is scene["elbow"]
    assert scene["play.friction"].definition.joint.joints[1] is scene["elbow"]
    with pytest.raises(ValueError, match=r"play\.upper"):
        scene.remove("elbow")
    scene.remove("elbow", dependents=True)
    assert not scene.stops
    assert not scene.forces


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (({"axle 0": 1.0, "axle 1": 2.0}, 0.1, 0.1), "lower must be below upper, got 0.1 and 0.1"),
        (({"axle 0": 0.0}, -0.1, 0.1), r"joint\['axle 0'\] must not be 0"),
        (({}, -0.1, 0.1), "joint must be a mapping from joints to numbers"),
        (({"axel 0": 1.0}, -0.1, 0.1), "each joint must be .*axle 0"),
        (({("axle 0", 3): 1.0}, -0.1, 0.1), "coordinate must be below 1"),
        ((["axle 0"], -0.1, 0.1), "joint must be"),
    ],
)
def test_wrong_input(given, message):
    scene = wheels((0.0, 0.0), (1.0, 2.0), -1.0, 1.0)
    with pytest.raises((ValueError, TypeError), match=message):
        scene.add_play(*given)


def test_a_play_that_is_left_at_the_start():
    scene = wheels((0.0, 0.0), (1.0, 2.0), 0.1, 0.2)
    with pytest.raises(
        ValueError, match=r"stop 'teeth.lower' of '1 axle 0 \+ 2 axle 1' must not be exceeded"
    ):
        carom.simulate(scene, 0.1)
