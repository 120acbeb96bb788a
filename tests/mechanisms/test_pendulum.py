"""The simple pendulum (IFToMM A01) against elliptic functions: joints, methods, orders."""

import numpy as np
import pytest
from mechanism_scenes import G, orders, pendulum, run
from scipy.special import ellipj, ellipk

import carom
from verified import agree, verifies

#: methods of order 2 miss the energy by 1e-4 to 1e-3 of it at these steps, and say so
pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")

KINDS = ("Distance", "Revolute", "Spherical")


def exact(t):
    """Place of the tip: sin(theta/2) = k cd(sqrt(g/l) t; k), k = sin(theta_0/2) = 1/sqrt(2)."""
    _, cn, dn, _ = ellipj(np.sqrt(G) * np.asarray(t), 0.5)
    theta = 2.0 * np.arcsin(np.sqrt(0.5) * cn / dn)
    return np.stack([-np.sin(theta), -np.cos(theta)], axis=-1)


def tip(solution, kind):
    """The bob, or twice the centre of the body that stands for it."""
    return solution.position[:, 0, :2] * (1.0 if kind == "Distance" else 2.0)


def largest_error(kind, duration, step, **more):
    every = round(0.1 / step)
    solution = carom.simulate(pendulum(kind), duration, step=step, save_every=every, **more)
    return np.max(np.abs(tip(solution, kind) - exact(solution.t))), solution


def test_the_closed_form_is_that_of_the_library():
    assert 4.0 * ellipk(0.5) / np.sqrt(G) == pytest.approx(2.3678419475762373, abs=1e-14)
    np.testing.assert_allclose(exact(10.0), [-0.275087462576, -0.961419205099], rtol=0, atol=1e-12)


@verifies("joints.{kind}", r"$\sin(\theta/2) = k\,\mathrm{cd}(\sqrt{g/l}\,t; k)$", "closed form")
@pytest.mark.parametrize("kind", KINDS)
def test_default_method_has_order_four(kind):
    # error of the period grows with time: at 10 s the steps must be smaller than at 2 s
    errors = [largest_error(kind, 2.0, h)[0] for h in (0.005, 0.0025, 0.00125)]
    np.testing.assert_allclose(orders(errors), 4.0, rtol=0, atol=0.1)
    agree(errors[-1], 0.0, atol=1e-10)
    at_ten = run(pendulum(kind), 10.0, 0.00125)
    agree(tip(at_ten, kind)[-1], exact(10.0), atol=1e-9)  # h^4 t^2 is 2e-10


@pytest.mark.parametrize("kind", KINDS)
def test_papers_method_has_order_two(kind):
    errors = [largest_error(kind, 2.0, h, method="paper")[0] for h in (0.01, 0.005, 0.0025)]
    np.testing.assert_allclose(orders(errors), 2.0, rtol=0, atol=0.1)


@verifies(
    'method="paper"',
    "errors of the three-field scheme for a pendulum",
    "own integration: the same scheme, written independently",
)
@pytest.mark.parametrize(("step", "error"), [(0.01, 2.1e-3), (0.005, 5.5e-4), (0.0025, 1.4e-4)])
def test_papers_method_has_the_errors_of_its_scheme(step, error):
    # two figures of an independent program of the same three-field scheme, at t = 10 s
    end = run(pendulum(), 10.0, step, method="paper")
    worst = np.max(np.abs(tip(end, "Distance")[-1] - exact(10.0)))
    agree(worst, error, rtol=0.03)


@pytest.mark.parametrize("kind", KINDS)
def test_ode_form_keeps_the_joint_to_third_order(kind):
    # (m phi')' + c phi' + k phi = 0 of frequency ~ 1/h takes away the scheme's own error of
    # phi, O(h^3) a step, within some steps: phi = O(h^3), phi' = O(h^2)
    runs = [largest_error(kind, 2.0, h, method="paper-ode") for h in (0.0025, 0.00125, 0.000625)]
    np.testing.assert_allclose(orders([e for e, _ in runs]), 2.0, rtol=0, atol=0.1)
    gaps, rates = (
        [np.max(s.constraint_errors[level]) for _, s in runs] for level in (0, 1)
    )  # fmt: skip
    np.testing.assert_allclose(orders(gaps), 3.0, rtol=0, atol=0.1)
    np.testing.assert_allclose(orders(rates), 2.0, rtol=0, atol=0.1)


@pytest.mark.parametrize("method", ["rk4", "paper"])
@pytest.mark.parametrize("kind", KINDS)
def test_joints_hold_to_round_off(kind, method):
    solution = carom.simulate(pendulum(kind), 10.0, step=0.01, method=method)
    position, velocity = solution.constraint_errors
    assert np.max(position) < 1e-12
    assert np.max(velocity) < 1e-12
    # and by this test's own account: the anchor's distance, and motion in the plane
    assert np.max(np.abs(np.linalg.norm(tip(solution, kind), axis=1) - 1.0)) < 1e-12
    assert np.max(np.abs(solution.position[..., 2])) == 0.0


@pytest.mark.parametrize("method", ["rk4", "paper", "paper-ode"])
def test_hinge_and_ball_joint_move_alike(method):
    hinge, ball = (run(pendulum(k), 2.0, 0.01, method=method) for k in ("Revolute", "Spherical"))
    np.testing.assert_allclose(hinge.position, ball.position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(hinge.angular_velocity, ball.angular_velocity, rtol=0, atol=1e-11)


@pytest.mark.plain
@pytest.mark.parametrize("kind", KINDS)
def test_a_few_steps(kind):
    end = run(pendulum(kind), 0.1, 0.01)
    np.testing.assert_allclose(tip(end, kind)[-1], exact(0.1), rtol=0, atol=1e-9)  # h^4 t
