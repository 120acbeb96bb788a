"""Distances between motions, in closed form."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.geometry import quaternion
from carom.studies.identify import Recording, face_up, mean_error, squared_error, trajectory_error
from verified import agree, verifies

T = np.arange(5) / 10
Q = quaternion.exp(np.outer(T, [3.0, 1.0, -2.0]))
X = np.outer(T, [1.0, 2.0, 0.5])


@verifies("studies.identify.trajectory_error", "a constant offset and turn", "closed form")
@verifies("studies.identify.mean_error", "a constant offset and turn", "closed form")
@verifies("studies.identify.squared_error", r"$(d^2/s^2 + \alpha^2/r^2)/6$", "closed form")
@settings(deadline=None, max_examples=40, derandomize=True)
@given(st.floats(0, np.pi), st.floats(0, 2))
def test_a_constant_offset_is_its_size(angle, distance):
    turn = quaternion.exp(angle * np.array([2.0, -1.0, 2.0]) / 3)
    a = Recording(T, X + distance * np.array([0.6, 0, -0.8]), quaternion.multiply(turn, Q))
    b = Recording(T, X, -Q)  # q and -q are one rotation
    error = trajectory_error(a, b, length=0.5)
    agree(error.position, 2 * distance, atol=1e-14)
    agree(error.rotation, angle, atol=2e-15)
    agree(mean_error(0.5, 0.1)(a, b), distance + 5 * angle, atol=1e-13)
    # |d|^2 / s^2 has three components, so has the angle: (d^2/s^2 + a^2/r^2) / 6
    expected = (distance**2 / 0.25 + angle**2 / 0.01) / 6
    agree(squared_error(0.5, 0.1)(a, b), expected, rtol=1e-12, atol=1e-13)


def test_angle_is_that_of_the_frobenius_distance():
    other = quaternion.normalize(np.random.default_rng(0).normal(size=(5, 4)))
    a, b = Recording(T, X, other), Recording(T, X, Q)
    gap = np.linalg.norm(quaternion.matrix(other) - quaternion.matrix(Q), axis=(1, 2))
    expected = np.mean(2 * np.arcsin(gap / np.sqrt(8)))
    assert trajectory_error(a, b).rotation == pytest.approx(expected, abs=1e-14)


def test_all_bodies_count_alike():
    x = np.stack([X, X + [0, 0, 1]], axis=1)
    q = np.stack([Q, Q], axis=1)
    a, b = Recording(T, x, q), Recording(T, x + [[[0.1, 0, 0], [0.3, 0, 0]]], q)
    assert trajectory_error(a, b).position == pytest.approx(0.2)


@verifies("studies.identify.face_up", "quarter turns of a cube", "closed form")
def test_face_up():
    half = np.pi / 2
    turns = [[0, 0, 0], [2 * half, 0, 0], [half, 0, 0], [-half, 0, 0], [0, half, 0], [0, -half, 0]]
    # body z up, down; turned about x by 90 degrees body y points up; about y by 90 degrees body -x
    agree(face_up(quaternion.exp(np.array(turns))), [2, 5, 1, 4, 3, 0])
    assert face_up(quaternion.exp([0, 0, 0.3]), up=(1, 0, 0)) == 0


@pytest.mark.parametrize("make", [mean_error, squared_error])
def test_bad_scales(make):
    with pytest.raises(ValueError, match="length must be finite and above 0"):
        make(0.0, 1.0)
    with pytest.raises(ValueError, match="angle must be finite and above 0"):
        make(1.0, np.nan)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"t": T[:4]}, ValueError, r"position must have shape \(4, 3\)"),
        ({"orientation": np.stack([Q, Q], axis=1)}, ValueError, "have as many bodies as position"),
        ({"orientation": 2 * Q}, ValueError, "of length 2 at sample 0"),
        ({"start": (1, 2)}, TypeError, "start must be a State"),
        (
            {"start": (X[0], Q[0], X[:2], X[0])},
            ValueError,
            r"start.velocity must have shape \(1, 3",
        ),
    ],
)
def test_bad_recording(change, error, message):
    with pytest.raises(error, match=message):
        Recording(**{"t": T, "position": X, "orientation": Q, **change})
