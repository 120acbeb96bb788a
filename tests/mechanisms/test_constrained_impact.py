"""The tip of a double pendulum strikes a wall with friction, against two generalised coordinates.

Only the tip may touch (the elbow passes the wall's plane), so the lower rod carries there, welded
on, a body of a tenth of its mass with the shape of a point: a ball of radius 1e-10 m. The rest of the rod makes
up for it, so that both together have mass, centre and inertia of a uniform rod.
"""

import functools
import json
from pathlib import Path

import numpy as np
import pytest
from mechanism_scenes import about, matrix

import carom
from carom import GROUND, Scene, joints
from references.double_pendulum_wall import rods

DATA = json.loads((Path(__file__).parents[1] / "data" / "double_pendulum_wall.json").read_text())
LAWS = ("newton", "poisson", "stronge")
ALL = [(name, law) for name in DATA["cases"] for law in LAWS]


POINT, PART, OWN = 1e-10, 0.1, 1e-4  # radius, mass, inertia of the body at the tip
OPTIONS = carom.Options(gap_tolerance=1e-3, layer_width=1e-6)  # 1e-13 m


def scene_of(case, law, state=None):
    """At the case's start, or at `state` (two angles, two rates)."""
    given = DATA["cases"][case]["input"]
    y = state or [np.radians(given["a0"]), np.radians(given["b0"]), 0.0, 0.0]
    scene = Scene(gravity=(0, 0, -DATA["gravity"]))
    hinge, J = (0, 1, 0), DATA["rod"]["inertia"]
    (upper, *drift, turn, rate), lower = rods(np.array(y))
    scene.add_body(
        mass=1.0, inertia=[J, J, 1e-4], position=upper, orientation=about(hinge, turn),
        velocity=drift[0], angular_velocity=(0, rate, 0), name="upper",
    )  # fmt: skip
    centre, drift, turn, rate = lower
    spin, elbow = np.array([0.0, rate, 0.0]), 2.0 * upper
    tip = 2.0 * centre - elbow
    back = -PART / (1.0 - PART) * (tip - centre)  # centre of the rest of the rod
    rest = J - 0.25 * PART - (1.0 - PART) * back @ back - OWN
    common = dict(orientation=about(hinge, turn), angular_velocity=spin)
    scene.add_body(
        mass=1.0 - PART, inertia=[rest, rest, 1e-4], position=centre + back,
        velocity=drift + np.cross(spin, back), name="lower", **common,
    )  # fmt: skip
    scene.add_body(
        carom.Sphere(POINT), mass=PART, inertia=[OWN] * 3, position=tip,
        velocity=drift + np.cross(spin, tip - centre), name="tip", **common,
    )  # fmt: skip
    scene.add_joint(joints.Revolute((0, 0, 0), hinge), GROUND, scene["upper"], name="shoulder")
    scene.add_joint(joints.Revolute(elbow, hinge), scene["upper"], scene["lower"], name="elbow")
    scene.add_joint(joints.Fixed(centre), scene["lower"], scene["tip"], name="weld")
    x = max(given["wall"], tip[0]) + POINT
    wall = scene.add_half_space((x, 0, 0), (-1, 0, 0), name="wall")
    friction = dict(friction=given["friction"], restitution=given["restitution"])
    scene.add_contact(scene["tip"], wall, impact_law=law, **friction)
    return scene


@functools.cache
def to_the_wall(case, law, method="rk4", step=5e-4):
    """The run up to 0.2 s after the impact, in steps of 0.5 ms."""
    end = DATA["cases"][case]["impact_time"] + DATA["after"]
    return carom.simulate(scene_of(case, law), end, step=step, method=method, options=OPTIONS)


def rates(solution, t, side):
    return -solution.evaluate(t, side)[3][:2, 1]


@pytest.mark.parametrize(("case", "law"), ALL)
def test_time_and_place_of_the_impact(case, law):
    s, known = to_the_wall(case, law), DATA["cases"][case]
    first = s.impacts[0]
    assert first.time == pytest.approx(known["impact_time"], abs=1e-11)
    np.testing.assert_allclose(first.point, known["tip"], rtol=0, atol=1e-9)


@pytest.mark.parametrize(("case", "law"), ALL)
def test_rates_before_and_after(case, law):
    s, known = to_the_wall(case, law), DATA["cases"][case]
    t = s.impacts[0].time
    np.testing.assert_allclose(rates(s, t, "left"), known["rates_before"], rtol=0, atol=1e-9)
    after = known["laws"][law]["rates_after"]
    np.testing.assert_allclose(rates(s, t, "right"), after, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("case", "law"), ALL[:3])
def test_order_eight_in_steps_of_10_ms(case, law):
    """A twentieth of the steps; the impact is located by steps of the method itself."""
    s, known = to_the_wall(case, law, "rk8", 0.01), DATA["cases"][case]
    assert s.impacts[0].time == pytest.approx(known["impact_time"], abs=1e-11)
    np.testing.assert_allclose(
        -s.angular_velocity[-1, :2, 1], known["laws"][law]["rates_end"], rtol=0, atol=1e-8
    )


@pytest.mark.parametrize(("case", "law"), ALL)
def test_impulse_energy_and_inverse_mass(case, law):
    s, known = to_the_wall(case, law), DATA["cases"][case]
    first, expected = s.impacts[0], known["laws"][law]
    axes = s._run.compiled.system.contacts.axes[0]  # rows n, t1, t2 of the program
    turn = np.array([[-1.0, 0, 0], [0, 0, 1.0], [0, 1.0, 0]]) @ axes.T  # to those of the reference
    W = turn @ first.inverse_mass @ turn.T
    np.testing.assert_allclose(W, known["inverse_mass"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(turn @ first.impulse, expected["impulse"], rtol=0, atol=1e-9)
    before, after = first.relative_velocity_before, first.relative_velocity_after
    np.testing.assert_allclose(turn @ before, known["contact_velocity_before"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(turn @ after, expected["contact_velocity_after"], rtol=0, atol=1e-9)
    assert first.energy_change == pytest.approx(expected["energy_change"], abs=1e-9)
    assert first.compression_work == pytest.approx(expected["compression_work"], abs=1e-9)
    assert first.restitution_work == pytest.approx(expected["restitution_work"], abs=1e-9)


@pytest.mark.parametrize(("case", "law"), ALL)
def test_state_after_another_fifth_of_a_second(case, law):
    s, expected = to_the_wall(case, law), DATA["cases"][case]["laws"][law]
    assert len(s.impacts) == 1
    q = s.orientation[-1, :2]
    angles = -2.0 * np.arctan2(q[:, 2], q[:, 0])
    error = (angles - expected["angles_end"] + np.pi) % (2.0 * np.pi) - np.pi
    np.testing.assert_allclose(error, 0.0, rtol=0, atol=1e-9)
    np.testing.assert_allclose(
        -s.angular_velocity[-1, :2, 1], expected["rates_end"], rtol=0, atol=1e-8
    )
    np.testing.assert_allclose(s.position[-1, 2], expected["tip_end"], rtol=0, atol=1e-9)


@pytest.mark.parametrize(("case", "law"), ALL)
def test_joints_hold_before_and_after(case, law):
    s = to_the_wall(case, law)
    t = s.impacts[0].time
    assert max(np.max(e) for e in s.constraint_errors) < 1e-12
    for side in ("left", "right"):
        x, Q, v, w = s.evaluate(t, side)
        half, whole = matrix(Q[0]) @ [0, 0, 0.5], matrix(Q[1]) @ [0, 0, 1.0]
        elbow = v[0] - np.cross(w[0], half)
        assert np.max(np.abs(v[0] + np.cross(w[0], half))) < 1e-12
        assert np.max(np.abs(elbow - np.cross(w[1], whole) - v[2])) < 1e-12
        assert np.max(np.abs(w[2] - w[1])) < 1e-12
        assert np.max(np.abs(x[0] - half - whole - x[2])) < 1e-12
        assert np.max(np.abs([x[:, 1], v[:, 1], w[:, 0], w[:, 2]])) < 1e-12


@pytest.mark.parametrize("case", DATA["cases"])
def test_papers_method_strikes_alike(case):
    """Order 2 up to the wall; the jump itself is that of the same law."""
    s, known = to_the_wall(case, "newton", "paper"), DATA["cases"][case]
    first = s.impacts[0]
    assert first.time == pytest.approx(known["impact_time"], abs=1e-6)
    ratio = first.relative_velocity_after[0] / -first.relative_velocity_before[0]
    assert ratio == pytest.approx(known["input"]["restitution"], abs=1e-9)
    expected = known["laws"]["newton"]["rates_after"]
    np.testing.assert_allclose(rates(s, first.time, "right"), expected, rtol=0, atol=2e-5)


@pytest.mark.plain
def test_impact_without_approach():
    """From the reference's state at the impact, one short step: the jump alone."""
    case = "slip"
    known = DATA["cases"][case]
    scene = scene_of(case, "newton", [*known["angles"], *known["rates_before"]])
    s = carom.simulate(scene, 1e-6, step=1e-6, options=OPTIONS)
    assert len(s.impacts) == 1
    expected = known["laws"]["newton"]["rates_after"]
    np.testing.assert_allclose(-s.angular_velocity[-1, :2, 1], expected, rtol=0, atol=2e-4)  # g h/l
