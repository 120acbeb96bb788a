"""The knife edge: Chaplygin's sleigh and a sled on an incline, in closed form."""

import numpy as np
import pytest
from mechanism_scenes import G, orders, run

import carom
from carom import GROUND, Scene, joints
from references import chaplygin
from verified import agree, verifies

#: methods of order 2 miss the energy by 1e-4 to 1e-3 of it at these steps, and say so
pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")

METHODS = {"rk4": 4.0, "paper": 2.0, "paper-ode": 2.0}
SLOPE, TURN = 0.3, 1.5
ALONG = G * np.sin(SLOPE)


def sleigh():
    """Mass centre 1 m ahead of the blade; conventions of the reference."""
    scene = Scene(gravity=(0, 0, 0))
    body = scene.add_body(
        mass=chaplygin.MASS, inertia=[1, 1, chaplygin.INERTIA],
        position=(chaplygin.AHEAD, 0, 0), velocity=(0, 1, 0), angular_velocity=(0, 0, 1),
    )  # fmt: skip
    scene.add_joint(joints.KnifeEdge((0, 0, 0), (1, 0, 0)), GROUND, body)
    return scene


def sled(turn=TURN):
    """Blade under the mass centre, on a plane whose slope is along +x; it is kept in the plane."""
    scene = Scene(gravity=(ALONG, 0, 0))
    body = scene.add_body(mass=1.0, inertia=[1, 1, 1], angular_velocity=(0, 0, turn))
    scene.add_joint(joints.KnifeEdge((0, 0, 0), (1, 0, 0)), GROUND, body)
    return scene


def sled_place(t):
    """x = (g s/2 w^2) sin^2 wt, y = (g s/2 w^2)(wt - sin(2 wt)/2), s = sin(slope)."""
    f, a = ALONG / (2.0 * TURN**2), TURN * t
    return f * np.array([np.sin(a) ** 2, a - 0.5 * np.sin(2.0 * a), 0.0])


def heading(solution):
    q = solution.orientation[:, 0]
    return np.unwrap(2.0 * np.arctan2(q[:, 3], q[:, 0]))


def sideways(solution, ahead):
    """Velocity of the blade across itself, by this test's own account."""
    a, w = heading(solution), solution.angular_velocity[:, 0, 2]
    across = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=1)
    return np.sum(solution.velocity[:, 0] * across, axis=1) - ahead * w


@verifies("joints.KnifeEdge", "path and heading of Chaplygin's sleigh", "closed form")
@pytest.mark.parametrize("method", METHODS)
def test_sleigh_follows_the_closed_form(method):
    found = []
    for h in (0.02, 0.01, 0.005):
        end = run(sleigh(), 4.0, h, method=method)
        error = end.position[-1, 0, :2] - chaplygin.mass_centre(4.0)
        found.append(np.max(np.abs([*error, heading(end)[-1] - chaplygin.heading(4.0)])))
    np.testing.assert_allclose(orders(found), METHODS[method], rtol=0, atol=0.1)
    agree(found[-1], 0.0, atol={4.0: 1e-11, 2.0: 1e-4}[METHODS[method]])


@verifies("joints.KnifeEdge", r"Chaplygin's sleigh turns by $\pi/\sqrt2$ in all", "closed form")
@pytest.mark.parametrize("method", METHODS)
def test_sleigh_runs_straight_ahead_in_the_end(method):
    end = run(sleigh(), 20.0, 0.01, method=method)
    agree(heading(end)[-1], np.pi / np.sqrt(2.0), atol=1e-4)
    speed, turning = chaplygin.speeds(20.0)
    agree(np.linalg.norm(end.velocity[-1, 0]), speed, atol=1e-4)
    agree(end.angular_velocity[-1, 0, 2], turning, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("make", "ahead"), [(sleigh, 1.0), (sled, 0.0)])
def test_blade_does_not_slip(make, ahead, method):
    solution = carom.simulate(make(), 4.0, step=0.02, method=method)
    assert np.max(np.abs(sideways(solution, ahead))) < 1e-12
    assert np.max(solution.constraint_errors[1]) < 1e-12
    assert np.max(np.abs(solution.position[..., 2])) == 0.0


@pytest.mark.parametrize("method", METHODS)
def test_sled_does_not_slide_down(method):
    # it drifts along the slope's level line; place at t = 4 s: (0.0502972983, 4.0382435753)
    np.testing.assert_allclose(
        sled_place(4.0)[:2], [0.0502972983, 4.0382435753], rtol=0, atol=1e-10
    )
    ends = [run(sled(), 4.0, h, method=method) for h in (0.02, 0.01, 0.005)]
    found = [np.max(np.abs(s.position[-1, 0] - sled_place(4.0))) for s in ends]
    np.testing.assert_allclose(orders(found), METHODS[method], rtol=0, atol=0.1)
    if method == "paper":  # two figures of an independent program of the same scheme
        np.testing.assert_allclose(found, [5.5e-4, 1.4e-4, 3.5e-5], rtol=0.02)


def test_energy_without_forces():
    solution = carom.simulate(sleigh(), 4.0, step=0.005)
    assert np.max(np.abs(solution.kinetic_energy - 1.0)) < 1e-12


@pytest.mark.plain
def test_blade_reaction():
    """Chaplygin's sleigh: m (dv/dt) across = m (d(aw)/dt + u w), all of it from the blade."""
    solution = carom.simulate(sleigh(), 0.05, step=0.01)
    u, w = chaplygin.speeds(solution.t)
    turning = -chaplygin.AHEAD * u * w / chaplygin.K
    force, a = chaplygin.AHEAD * turning + u * w, heading(solution)
    expected = force[:, None] * np.stack([-np.sin(a), np.cos(a)], axis=1)
    np.testing.assert_allclose(solution.joint_reactions[:, 0, :2], expected, rtol=0, atol=1e-9)
