"""The same system as a scene of rigid bodies and in coordinates: double pendulum, slider-crank, rod."""

import json
from pathlib import Path

import numpy as np
import pytest
from coordinate_systems import (
    double_pendulum,
    double_pendulum_scene,
    falling_rod,
    falling_rod_scene,
    slider_crank,
    slider_crank_scene,
)

import carom
from verified import agree, verifies

WALL = json.loads((Path(__file__).parents[1] / "data" / "double_pendulum_wall.json").read_text())
START = ([-1.3, 0.5], [1.0, -2.0])


@pytest.fixture(scope="module")
def pendulum():
    return double_pendulum(*START)[0]


# 3e-4 of the energy at the longest step
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
def test_double_pendulum_converges_with_order_four(pendulum):
    # Against rk8 in steps of 1 ms, whose error is below 1e-13.
    exact = carom.simulate(pendulum, 1.0, step=1e-3, method="rk8").q[-1]
    whole = carom.Options(energy_tolerance=1.0)  # no step is cut for its energy
    runs = [carom.simulate(pendulum, 1.0, step=h, options=whole) for h in (0.02, 0.01, 0.005)]
    errors = [np.max(np.abs(run.q[-1] - exact)) for run in runs]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.7)
    assert np.all(orders < 4.5)


@pytest.mark.parametrize(("method", "step", "most"), [("rk5", 2e-3, 1e-9), ("rk8", 1e-2, 1e-9)])
def test_methods_of_higher_order(pendulum, method, step, most):
    exact = carom.simulate(pendulum, 1.0, step=1e-3, method="rk8").q[-1]
    error = np.max(np.abs(carom.simulate(pendulum, 1.0, step=step, method=method).q[-1] - exact))
    assert error < most


@verifies(
    "GeneralizedSystem",
    "double pendulum: the same motion as its bodies",
    "invariant: two descriptions of one system",
)
def test_double_pendulum_moves_as_its_bodies(pendulum):
    # Both of order 4: errors of 1e-10 at a step of 1 ms.
    here = carom.simulate(pendulum, 1.0, step=1e-3)
    scene = carom.simulate(double_pendulum_scene(*START), 1.0, step=1e-3)
    agree(-scene.angular_velocity[:, :, 1], here.v, atol=2e-9)
    elbow = np.stack([np.sin(here.q[:, 0]), -np.cos(here.q[:, 0])], axis=1)
    agree(2.0 * scene.position[:, 0, ::2], elbow, atol=1e-9)
    agree(here.ledger.residual, 0.0, atol=3e-8)  # energy: order 4 too


@verifies(
    "GeneralizedSystem",
    "double pendulum that strikes a wall, by three laws",
    "own integration: SciPy and Routh's method",
)
@pytest.mark.few(6)
@pytest.mark.parametrize("case", WALL["cases"])
@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_tip_strikes_a_wall(case, law):
    # The reference is good to 1e-12; the step of 0.5 ms has an error of 1e-11 at the impact.
    known = WALL["cases"][case]
    given, end = known["input"], known["laws"][law]
    start = np.radians([given["a0"], given["b0"]]), [0.0, 0.0]
    system, x, z, rate = double_pendulum(*start)
    system.add_contact(
        given["wall"] - x, tangent=rate(z), restitution=given["restitution"],
        friction=given["friction"], impact_law=law,
    )  # fmt: skip
    run = carom.simulate(system, known["impact_time"] + WALL["after"], step=5e-4)
    first = run.impacts[0]
    assert len(run.impacts) == 1
    agree(first.time, known["impact_time"], atol=1e-11)
    close = 2e-10
    agree(first.position, known["angles"], atol=close)
    agree(first.inverse_mass, known["inverse_mass"], atol=close)
    agree(first.relative_velocity_before, known["contact_velocity_before"], atol=close)
    agree(first.relative_velocity_after, end["contact_velocity_after"], atol=close)
    agree(first.impulse, end["impulse"], atol=close)
    agree(run.evaluate(first.time, "left")[1], known["rates_before"], atol=close)
    agree(run.evaluate(first.time)[1], end["rates_after"], atol=close)
    agree(run.q[-1], end["angles_end"], atol=close)


def test_slider_crank_three_ways():
    # One coordinate, three that close a loop, three bodies; a stop that the slider strikes twice.
    start = (2.0, -4.0)
    one = carom.simulate(slider_crank(*start, reduced=True), 1.0, step=1e-3)
    loop = carom.simulate(slider_crank(*start, reduced=False), 1.0, step=1e-3)
    scene = carom.simulate(slider_crank_scene(*start), 1.0, step=1e-3)
    assert len(one.impacts) == len(loop.impacts) == len(scene.impacts) == 2
    for other in (loop, scene):
        np.testing.assert_allclose(other.impacts.time, one.impacts.time, rtol=0, atol=1e-9)
        np.testing.assert_allclose(other.impacts.impulse, one.impacts.impulse, rtol=0, atol=1e-8)
    np.testing.assert_allclose(loop.q[:, 0], one.q[:, 0], rtol=0, atol=1e-10)
    np.testing.assert_allclose(loop.q[:, 2], scene.position[:, 2, 0], rtol=0, atol=1e-10)
    np.testing.assert_allclose(-scene.angular_velocity[:, 0, 1], one.v[:, 0], rtol=0, atol=1e-8)
    position, velocity = loop.constraint_errors
    assert np.max(position) < 1e-13  # the return to joints leaves 1e-14
    assert np.max(velocity) < 1e-13


@pytest.mark.parametrize("law", ["newton", "stronge"])
def test_rod_bounces_to_rest_on_the_floor(law):
    # Thirty impacts, slip, stick and reversal, then both ends held: round-off all along.
    given = (0.3, (0.5, 0.0), 1.0, 0.5, 0.3, law)
    here = carom.simulate(falling_rod(*given), 1.5, step=1e-3)
    scene = carom.simulate(falling_rod_scene(*given), 1.5, step=1e-3)
    count = 25  # those before bounces end within one step
    ours = here.impacts
    # the two corners of an end are one row, or two where round-off parts them
    time, first = np.unique(scene.impacts.time, return_index=True)
    impulse = np.add.reduceat(scene.impacts.impulse, first)
    np.testing.assert_allclose(ours.time[:count], time[:count], rtol=0, atol=1e-11)
    np.testing.assert_allclose(ours.impulse[:count, 0], impulse[:count, 0], rtol=0, atol=1e-10)
    friction = np.abs(impulse[:count, 1:]).max(axis=1)
    np.testing.assert_allclose(np.abs(ours.impulse[:count, 1]), friction, rtol=0, atol=1e-10)
    # bounces of less than a step, up to 1e-6 m high, are left out: they leave 4e-10 m
    np.testing.assert_allclose(here.q[-1, :2], scene.position[-1, 0, ::2], rtol=0, atol=5e-9)
    np.testing.assert_allclose(here.v[-1], 0.0, atol=1e-15)
    assert np.max(np.abs(here.ledger.residual)) < 1e-11
    assert {str(kind) for kind in here.events.kind} == {"impact", "held"}


def test_rod_without_friction_goes_on_bouncing():
    given = (0.7, (0.5, 0.0), -2.0, 0.8, 0.0, "poisson")
    here = carom.simulate(falling_rod(*given), 2.0, step=1e-3)
    scene = carom.simulate(falling_rod_scene(*given), 2.0, step=1e-3)
    assert len(here.impacts) == len(scene.impacts) == 11
    np.testing.assert_allclose(here.impacts.time, scene.impacts.time, rtol=0, atol=1e-11)
    np.testing.assert_allclose(here.q[-1, :2], scene.position[-1, 0, ::2], rtol=0, atol=1e-11)


def test_mirror_symmetry():
    given = (0.3, (0.5, 0.0), 1.0, 0.5, 0.3, "stronge")
    here = carom.simulate(falling_rod(*given), 1.0, step=2e-3)
    mirrored = carom.simulate(falling_rod(*given, mirrored=True), 1.0, step=2e-3)
    np.testing.assert_allclose(mirrored.q * [-1, 1, -1], here.q, rtol=0, atol=1e-13)
    np.testing.assert_allclose(mirrored.impacts.time, here.impacts.time, rtol=0, atol=1e-13)
