"""HHT-alpha in the boundary layer: the paper's remark, and the numbers of the mathematics page."""

import numpy as np
import pytest

from carom.baselines import (
    completing_steps,
    first_completing_steps,
    hht_alpha_layer,
)
from carom.impact.geometry import NormalMotion
from verified import agree, verifies

LAYER = dict(mass=0.16, width=1e-3, penetration=0.8)
SPEED = np.sqrt(2 * 9.81 * 0.4)  # the sphere dropped from 0.4 m


@verifies(
    "baselines.first_completing_steps",
    "at least seven steps",
    "publication: Natsiavas, Passas and Paraskevopoulos",
)
@verifies(
    "baselines.completing_steps",
    "at least seven steps",
    "publication: Natsiavas, Passas and Paraskevopoulos",
)
def test_first_runs_with_seven_steps():
    """The paper: "at least seven steps before it can run" (e = 1, delta = 0.8)."""
    agree(first_completing_steps(SPEED, 1.0, penetration=0.8), 7)
    agree(completing_steps(SPEED, 1.0, penetration=0.8), range(7, 21))


def test_fewer_steps_leave_through_zero():
    for steps in range(2, 7):
        run = hht_alpha_layer(SPEED, 1.0, steps=steps, **LAYER)
        assert not run.completed
        assert "x = 0" in run.message
        assert run.velocity_error == np.inf
        assert np.all(run.x > 0.0)
        assert np.all(np.isfinite(run.velocity))


@pytest.mark.parametrize("alpha", [0.1, 0.2, 0.3, 1 / 3])
def test_numerical_damping_only_jumps_over_the_layer(alpha):
    """With alpha >= 0.1 five steps "complete" in one jump of no meaning; proper runs start at 8."""
    found = completing_steps(SPEED, 1.0, penetration=0.8, alpha=alpha)
    assert found == (5, *range(8, 21))
    run = hht_alpha_layer(SPEED, 1.0, steps=5, alpha=alpha, **LAYER)
    assert run.t.size == 2
    assert run.velocity_error > 1.0


@verifies(
    "baselines.hht_alpha_layer",
    "errors of HHT-alpha in the layer",
    "own integration: the same scheme, written independently",
)
@pytest.mark.parametrize(
    ("steps", "error"), [(8, 2.63), (20, 0.158), (40, 3.6e-2), (80, 8.9e-3), (320, 5.5e-4)]
)
def test_error_of_the_velocity(steps, error):
    """Greatest |xdot - exact| / v0 over the nodes, alpha = 0, e = 1, delta = 0.8."""
    run = hht_alpha_layer(SPEED, 1.0, steps=steps, **LAYER)
    assert run.completed
    assert run.t.size == steps + 1
    agree(run.velocity_error, error, rtol=0.01)


@verifies("baselines.hht_alpha_layer", "order 2", "closed form")
@pytest.mark.parametrize("alpha", [0.0, 0.1, 1 / 3])
def test_order_two_for_a_symmetric_passage(alpha):
    errors = [
        hht_alpha_layer(SPEED, 1.0, steps=n, alpha=alpha, **LAYER).velocity_error
        for n in (160, 320, 640)
    ]
    agree(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)


def test_restitution_is_met_to_first_order():
    """The phase is that of the step's beginning: the turning point errs by less than a step."""
    for steps in (80, 320, 1280):
        run = hht_alpha_layer(SPEED, 0.5, steps=steps, **LAYER)
        assert run.completed
        assert abs(run.u[-1] / SPEED - 0.5) < 1.0 / steps


def test_exact_motion_starts_turns_and_leaves():
    """x_min = (1 - delta) b at T_c = 2 b l / v0; exit at x = b with e v0, after T_c (1 + 1/e)."""
    compression = 2 * 1e-3 * np.log(5.0) / SPEED
    times = compression * np.array([0.0, 1.0, 1.0 + 1.0 / 0.8])
    motion = NormalMotion(SPEED, 0.8, 1e-3, 0.8)
    x, v = motion.x(times), motion.x_rate(times)
    np.testing.assert_allclose(x, [1e-3, 2e-4, 1e-3], rtol=1e-14)
    np.testing.assert_allclose(v, [-SPEED, 0.0, 0.8 * SPEED], rtol=1e-14, atol=1e-14)


def test_mass_and_width_only_scale():
    one = hht_alpha_layer(SPEED, 1.0, steps=20, mass=1.0, width=1e-3, penetration=0.8)
    two = hht_alpha_layer(SPEED, 1.0, steps=20, mass=3.0, width=2e-5, penetration=0.8)
    np.testing.assert_allclose(two.x / 2e-5, one.x / 1e-3, rtol=1e-10)
    np.testing.assert_allclose(one.normal_force[0], SPEED**2 / (2e-3 * np.log(5.0)), rtol=1e-13)
    np.testing.assert_allclose(two.normal_force[0] / one.normal_force[0], 150.0, rtol=1e-13)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("speed", 0.0), ("speed", np.nan), ("restitution", 0.0), ("restitution", 1.1), ("mass", -1),
        ("width", 0.0), ("penetration", 1.0), ("steps", 0), ("steps", 2.5), ("alpha", 0.34),
        ("alpha", -0.1),
    ],
)  # fmt: skip
def test_bad_input_names_the_argument(name, value):
    given = dict(speed=1.0, restitution=0.5, steps=8, **LAYER) | {name: value}
    with pytest.raises(ValueError, match=name):
        hht_alpha_layer(given.pop("speed"), given.pop("restitution"), **given)
