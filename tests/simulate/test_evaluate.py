"""States between those that are saved: as exact as the run, for joints, loads, contact and given steps."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom


def pendulum():
    """Return a rod of 1 m that hangs on its end, released level."""
    scene = carom.Scene()
    rod = scene.add_body(
        carom.Box(1.0, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0), inertia=np.diag([0.01, 0.1, 0.1])
    )
    scene.add_joint(carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0)), carom.GROUND, rod)
    return scene


def block(speed):
    """Return a block that slides on a table, mu = .3."""
    scene = carom.Scene()
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    box = scene.add_body(carom.Box(0.4, 0.3, 0.2), mass=2.0, position=(0, 0, 0.1), velocity=speed)
    scene.add_contact(box, ground, restitution=0.3, friction=0.3)
    return scene


def top():
    """Return a heavy top at 400 rad/s on a ball joint: it turns by 4 rad between two saved states."""
    scene, tilt = carom.Scene(), 0.4
    axis = np.array([math.sin(tilt), 0, math.cos(tilt)])
    body = scene.add_body(
        carom.Cylinder(0.05, 0.1), mass=0.5, position=0.1 * axis, angular_velocity=400.0 * axis,
        orientation=(math.cos(tilt / 2), 0, math.sin(tilt / 2), 0),
    )  # fmt: skip
    scene.add_joint(carom.joints.Spherical(anchor=(0, 0, 0)), carom.GROUND, body)
    return scene


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10])
def test_a_pendulum_between_saved_states(rtol):
    """q'' = -m g l/(I + m l^2) cos q from q = 0, by another integrator to 1e-12."""
    solution = carom.simulate(pendulum(), 2.0, rtol=rtol, save_at=0.1)
    times = np.linspace(0.013, 1.987, 57)
    k = 9.81 * 0.5 / (0.1 + 0.25)
    reference = solve_ivp(
        lambda t, y: (y[1], k * math.cos(y[0])), (0, 2), (0, 0), "DOP853", times, rtol=1e-12, atol=1e-12
    ).y[0]  # fmt: skip
    x = solution.evaluate(times)[0][:, 0]
    assert np.abs(np.arctan2(-x[:, 2], x[:, 0]) - reference).max() < 10.0 * rtol


def test_a_block_that_slides_between_saved_states():
    """x = v t - mu g t^2/2 until it stops."""
    solution = carom.simulate(block((2.0, 0, 0)), 0.5, save_at=0.1)
    times = np.array([0.03, 0.17, 0.38])
    x, _, v, _ = solution.evaluate(times)
    assert x[:, 0, 0] == pytest.approx(2.0 * times - 0.5 * 0.3 * 9.81 * times**2, abs=1e-9)
    assert v[:, 0, 0] == pytest.approx(2.0 - 0.3 * 9.81 * times, abs=1e-9)


@pytest.mark.parametrize("given", [{}, {"step": 2e-4, "method": "rk8"}], ids=["tolerances", "step"])
def test_a_fast_top_between_saved_states(given):
    """A run that saves the times themselves is the same motion; a cubic through the saved states is not."""
    times = np.array([0.0137, 0.0551, 0.0833])
    solution = carom.simulate(top(), 0.1, **given, **({} if given else {"save_at": 0.01}))
    saved = carom.simulate(top(), 0.1, save_at=times, rtol=1e-11)
    found = solution.evaluate(times)
    for part, there in zip(
        (found[0], found[2], found[3] / 400.0), (saved.position, saved.velocity, saved.angular_velocity / 400.0)
    ):  # fmt: skip
        assert np.abs(part - there[1:-1]).max() < 1e-7


def test_saved_states_are_as_they_were():
    solution = carom.simulate(block((2.0, 0.5, 0.0)), 1.0)
    before = solution.position.copy(), solution.velocity.copy()
    x, _, v, _ = solution.evaluate(solution.t)
    assert np.array_equal(x, before[0])
    assert np.array_equal(v, before[1])
    solution.evaluate(np.linspace(0.0, 1.0, 33))
    assert np.array_equal(solution.position, before[0])
    further = solution.simulate(0.5)  # the run itself still stands where it ended
    assert np.array_equal(further.position[: len(before[0])], before[0])


def test_a_state_does_not_depend_on_what_was_asked_before():
    solution = carom.simulate(pendulum(), 1.0, save_at=0.05)
    times = np.array([0.777, 0.111, 0.333, 0.334])
    together = solution.evaluate(times)
    for k in (2, 0, 3, 1):
        for part, all_of_them in zip(solution.evaluate(times[k]), together):
            assert np.array_equal(part, all_of_them[k])


def test_velocities_beside_an_impact():
    """Just before and after an impact of joined bodies velocities are those of that side."""
    scene = pendulum()
    ground = scene.add_half_space(point=(0, 0, -0.6), normal=(0, 0, 1))
    scene.add_contact(scene.bodies[0], ground, restitution=0.5, friction=0.0)
    solution = carom.simulate(scene, 1.0, save_at=0.1)
    at = solution.impacts.time[0]
    before, after = (solution.evaluate(at, side)[3][0, 1] for side in ("left", "right"))
    assert after == pytest.approx(-0.5 * before, rel=1e-9)
    for little in (1e-9, 1e-5):
        assert solution.evaluate(at - little)[3][0, 1] == pytest.approx(before, rel=30.0 * little)
        assert solution.evaluate(at + little)[3][0, 1] == pytest.approx(after, rel=60.0 * little)


def test_a_scene_that_has_changed_since_is_not_stepped_again():
    """The replay does not end at the next saved state then, and a cubic through both is used."""
    scene = pendulum()
    solution = carom.simulate(scene, 1.0, save_at=0.05)
    was = solution.evaluate(0.52)[0]
    again = carom.simulate(scene, 1.0, save_at=0.05)
    scene.add_force(carom.forces.Torque((0.0, 3.0, 0.0)), scene.bodies[0])
    assert again.evaluate(0.52)[0] == pytest.approx(was, abs=1e-4)  # 2e-3 if it were
