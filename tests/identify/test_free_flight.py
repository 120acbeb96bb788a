"""The state of a free body from recorded poses, against closed forms and with known noise."""

import contextlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.geometry import quaternion
from carom.studies.identify import fit_free_flight, free_samples
from verified import agree, verifies

G = np.array([0.3, -0.2, -9.7])
X0, V0, W0 = np.array([0.1, 0.2, 1.5]), np.array([0.5, -1.0, 2.0]), np.array([3.0, -8.0, 5.0])
R0 = quaternion.exp([0.4, -1.1, 0.7])


def parabola(t):
    return X0 + np.outer(t, V0) + 0.5 * np.outer(t * t, G)


def spinning(t, w=W0, start=R0):
    """R = exp(w t) R0: constant angular velocity in the world."""
    return quaternion.multiply(quaternion.exp(np.outer(t, w)), start)


def precessing(t, A, C, start=R0, w=W0):
    """Body with moments (A, A, C): R = exp(L t/A) R0 exp((1 - C/A) W_3 t e_3), L = R0 J R0^T w."""
    W = quaternion.rotate_back(start, w)
    L = quaternion.rotate(start, np.array([A, A, C]) * W)
    outer = quaternion.exp(np.outer(t, L / A))
    inner = quaternion.exp(np.outer(t * (1 - C / A) * W[2], [0, 0, 1]))
    return quaternion.multiply(quaternion.multiply(outer, start), inner)


def same_rotation(a, b):
    return np.linalg.norm(quaternion.between(a, b))


@settings(deadline=None, max_examples=25, derandomize=True)
@given(
    w=st.tuples(*[st.floats(-20, 20)] * 3),
    first=st.floats(-3, 3),
    n=st.integers(3, 30),
    gaps=st.floats(0.002, 0.03),
)
def test_exact_samples_give_the_state_to_round_off(w, first, n, gaps):
    t = first + np.linspace(0, 1, n) ** 1.2 * (n - 1) * gaps  # not uniform; below half a turn each
    since = t - t[0]
    flight = fit_free_flight(t, parabola(since), spinning(since, np.array(w)), G)
    # round-off of poses is 4e-16, of slopes that over the duration; x 100 for few samples
    tolerance = 4e-14 / since[-1]
    assert flight.time == t[0]
    np.testing.assert_allclose(flight.position, X0, rtol=0, atol=1e-13)
    np.testing.assert_allclose(flight.velocity, V0, rtol=0, atol=tolerance)
    np.testing.assert_allclose(flight.angular_velocity, w, rtol=0, atol=tolerance)
    assert same_rotation(flight.orientation, R0) < 1e-13
    assert flight.position_noise < 1e-14
    assert flight.rotation_noise < 1e-13


@verifies("studies.identify.fit_free_flight", "parabola and constant spin", "closed form")
def test_gravity_is_fitted_where_none_is_given():
    t = np.arange(12) / 100
    flight = fit_free_flight(t, parabola(t), spinning(t), None)
    agree(flight.acceleration, G, atol=1e-11)
    agree(flight.velocity, V0, atol=1e-12)
    assert np.all(flight.acceleration_error > 0)


@verifies("studies.identify.fit_free_flight", "precession of a symmetric top", "closed form")
def test_torque_free_motion_of_a_symmetric_top():
    t = np.arange(20) / 50
    q = precessing(t, 0.3, 0.5)
    flight = fit_free_flight(t, parabola(t), q, G, inertia=(0.3, 0.3, 0.5))
    # Euler's equations are integrated to 1e-12
    agree(flight.angular_velocity, W0, atol=1e-9)
    assert same_rotation(flight.orientation, R0) < 1e-10
    assert flight.rotation_noise < 1e-10
    # a constant w does not describe it
    assert fit_free_flight(t, parabola(t), q, G).rotation_noise > 0.05


def test_inertia_may_be_in_any_body_axes():
    t, turn = np.arange(20) / 50, quaternion.exp([0.5, 0.2, -0.9])
    q = quaternion.multiply(
        precessing(t, 0.3, 0.5), turn
    )  # body axes turned against the principal ones
    M = quaternion.matrix(quaternion.conjugate(turn))
    flight = fit_free_flight(t, parabola(t), q, G, inertia=M @ np.diag([0.3, 0.3, 0.5]) @ M.T)
    np.testing.assert_allclose(flight.angular_velocity, W0, rtol=0, atol=1e-9)
    assert same_rotation(flight.orientation, quaternion.multiply(R0, turn)) < 1e-10


def test_equal_moments_are_the_constant_spin():
    t = np.arange(9) / 50
    flight = fit_free_flight(t, parabola(t), spinning(t), G, inertia=(0.2, 0.2, 0.2))
    np.testing.assert_allclose(flight.angular_velocity, W0, rtol=0, atol=1e-12)


def test_reported_errors_are_those_of_known_noise():
    # Standardised errors have mean square 1 but for what estimating the noise from 3 n - 6 = 30 residuals adds:
    # E t^2 = 30/28 = 1.07. Over 400 draws of 3 components its standard error is 0.04; 5 of them.
    t, draws, random = np.arange(12) / 148, 400, np.random.default_rng(1)
    x, q, squares, noises = parabola(t), spinning(t), [], []
    for _ in range(draws):
        moved = x + 6e-5 * random.normal(size=x.shape)
        turned = quaternion.multiply(quaternion.exp(4e-4 * random.normal(size=x.shape)), q)
        f = fit_free_flight(t, moved, turned, G)
        off = quaternion.log(quaternion.multiply(f.orientation, quaternion.conjugate(R0)))
        squares.append(
            [
                np.mean(((f.position - X0) / f.position_error) ** 2),
                np.mean(((f.velocity - V0) / f.velocity_error) ** 2),
                np.mean((off / f.orientation_error) ** 2),
                np.mean(((f.angular_velocity - W0) / f.angular_velocity_error) ** 2),
            ]
        )
        noises.append([f.position_noise, f.rotation_noise])
    np.testing.assert_allclose(np.mean(squares, axis=0), 30 / 28, rtol=0, atol=0.25)
    # sqrt of a chi^2 of 30: low by 1/(4 * 30); standard error 1/sqrt(2 * 30 * 400) = 0.6 %
    np.testing.assert_allclose(np.mean(noises, axis=0), [6e-5, 4e-4], rtol=0.04)


def test_residuals_are_recorded_less_fitted():
    t = np.arange(8) / 100
    x, q = parabola(t), spinning(t)
    x[3, 1] += 1e-3
    f = fit_free_flight(t, x, q, G)
    model = f.position + np.outer(t, f.velocity) + 0.5 * np.outer(t * t, f.acceleration)
    np.testing.assert_allclose(f.position_residual, x - model, rtol=0, atol=1e-15)
    assert np.argmax(np.abs(f.position_residual).max(axis=1)) == 3
    assert np.abs(f.rotation_residual).max() < 1e-13


@pytest.mark.parametrize("seed", range(12))
def test_attitudes_of_no_free_body_are_seen(seed):
    # random ones are 2.2 rad from any model in the mean: refused, or a noise of about a radian
    t, q = np.arange(30) / 100, np.random.default_rng(seed).normal(size=(30, 4))
    with contextlib.suppress(RuntimeError):
        assert fit_free_flight(t, parabola(t), quaternion.normalize(q), G).rotation_noise > 0.8


GOOD = {"t": np.arange(6) / 100, "position": np.zeros((6, 3)), "orientation": [[1, 0, 0, 0]] * 6}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"t": [0, 1]}, "position must have shape"),
        ({"t": [0.0]}, "t must have at least 2 times"),
        ({"t": [0, 1, 1, 2, 3, 4]}, r"t must increase, got t\[1\] = 1 and t\[2\] = 1"),
        ({"t": [0, 1, np.nan, 2, 3, 4]}, "t must be finite"),
        ({"position": np.full((6, 3), np.inf)}, "position must be finite"),
        ({"position": np.zeros((6, 2))}, r"position must have shape \(6, 3\)"),
        ({"position": np.zeros((6, 2, 3))}, "position must be of one body, got 2"),
        ({"orientation": [[1, 1, 0, 0]] * 6}, "orientation must be unit quaternions"),
        ({"orientation": np.zeros((6, 4))}, "orientation must be unit quaternions"),
        ({"gravity": (0, 0)}, "gravity must have shape"),
        ({"inertia": (1, 1, 5)}, "no principal moment above the sum"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises(ValueError, match=message):
        fit_free_flight(**{**GOOD, **change})


@pytest.mark.parametrize(("gravity", "least"), [(G, 3), (None, 4)])
def test_too_few_samples(gravity, least):
    few = {name: value[: least - 1] for name, value in GOOD.items()}
    with pytest.raises(ValueError, match=f"t must have at least {least} times"):
        fit_free_flight(**few, gravity=gravity)


@verifies(
    "studies.identify.free_samples",
    r"gap of a box that turns: $z - a (\cos\alpha + \sin\alpha)$",
    "closed form",
)
def test_samples_before_a_body_comes_near():
    # a box of half edge .1 that turns about y by 45 degrees while it sinks: gap z - .1 (cos + sin)
    angle, z = np.linspace(0, np.pi / 4, 11), np.linspace(0.3, 0.1, 11)
    q = quaternion.exp(np.outer(angle, [0, 1, 0]))
    x = np.stack([0 * z, 0 * z, z], axis=1)
    gap = z - 0.1 * (np.cos(angle) + np.sin(angle))
    box = carom.Box(0.2, 0.2, 0.2)
    for clearance in (0.0, 0.02, 0.05):
        expected = int(np.argmax(gap < clearance))
        assert 0 < expected < 11
        agree(free_samples(x, q, box, clearance=clearance), expected)
    assert free_samples(x, q, carom.Sphere(0.01)) == 11
    moved = free_samples(x - [1, 0, 0], q, box, point=(-1, 0, -0.5), normal=(0, 0, 2))
    assert moved == 11
