"""Standard errors from the curvature, and parameters that the recordings do not determine."""

import numpy as np
import pytest

import carom
from carom.studies.identify import (
    Parameter,
    Recording,
    RollOut,
    identify,
    roll_out,
    squared_error,
    varied,
)
from carom.studies.identify.curvature import curvature
from carom.studies.identify.evaluate import Evaluator
from carom.studies.identify.parameters import Space
from identify.tossed import POSITION_NOISE, ROTATION_NOISE, G, noisy

LEAST_SQUARES = squared_error(POSITION_NOISE, ROTATION_NOISE)
BEGIN = {"restitution": (0.5, 0.1), "friction": (0.2, 0.05)}
FALL, E = 0.05, 0.7  # of the ball to the table [m]
# a ball of moment 2/5 m r^2 sticks if mu (1 + e) v_n is at least 2/7 of its speed of slip
NORMAL = np.sqrt(1 + 2 * G * FALL)
STICKS_FROM = 2 / 7 * 0.3 / ((1 + E) * NORMAL)


def ball():
    scene = carom.Scene(gravity=(0, 0, -G))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    body = scene.add_body(carom.Sphere(0.05), mass=0.1, position=(0, 0, 0.05 + FALL))
    scene.add_contact(body, table, restitution=0.5, friction=0.3)
    return scene


def throw(speed, friction, seed):
    """Recording of a ball that strikes a table with this speed of slip once, with noise."""
    t = np.arange(20) / 100
    start = ([0, 0, 0.05 + FALL], [1, 0, 0, 0], [speed, 0, -1], [0, 0, 0])
    blank = Recording(t, np.zeros((20, 3)), np.tile([1.0, 0, 0, 0], (20, 1)), start)
    run = roll_out(varied(ball(), restitution=E, friction=friction, start=blank.start), blank)
    return noisy(blank, run, np.random.default_rng(seed))


def fitted(recordings, begin=BEGIN, scene=None, **more):
    return identify(scene or ball(), recordings, begin, LEAST_SQUARES, **more)


@pytest.mark.parametrize("count", [1, 6])  # by the curvature, and with bootstrap samples
def test_friction_of_impacts_that_stick_has_only_a_least_value(count):
    begin = {"restitution": (0.71, 0.01), "friction": (0.2, 0.05)}
    recordings = [throw(0.3, 0.15, seed) for seed in range(count)]
    fit = fitted(recordings, begin, restarts=0, tolerance=0.05, resamples=20)
    assert fit.undetermined == ("friction",)
    assert np.isinf(fit.error["friction"])
    least, most = fit.interval["friction"]
    # with less friction it slips; noise hides 1 % of it, and the interval is halved 12 times
    assert least == pytest.approx(STICKS_FROM, rel=0.02)
    assert most == np.inf
    line = next(line for line in str(fit).splitlines() if line.startswith("friction"))
    assert line.split(maxsplit=1)[1] == f"not determined by these data: from {least:.3g} to inf"
    assert abs(fit.parameters["restitution"] - E) < 3 * fit.error["restitution"] < 0.003


@pytest.mark.parametrize("draws", [6, pytest.param(30, marks=pytest.mark.slow)])
def test_errors_of_one_recording_are_those_of_known_noise(draws):
    # 6 draws: the mean square of standardised errors is 1 with a standard error of sqrt(2/6) = 0.58; 30: 0.26
    begin = {"restitution": (0.702, 0.002), "friction": (0.1005, 0.0005)}
    fits = [
        fitted([throw(2.0, 0.1, seed)], begin, restarts=0, tolerance=0.02) for seed in range(draws)
    ]
    for name, true in {"restitution": E, "friction": 0.1}.items():
        off = np.array([fit.parameters[name] - true for fit in fits])
        error = np.array([fit.error[name] for fit in fits])
        assert np.all(error < 0.001)
        assert 0.5 < np.sqrt(np.mean((off / error) ** 2)) < 2.0
        # 95 of 100 in the mean, with a standard deviation of sqrt(0.95 0.05 draws); four of them
        inside = sum(f.interval[name][0] < true < f.interval[name][1] for f in fits)
        assert inside >= 0.95 * draws - 4 * np.sqrt(0.95 * 0.05 * draws)
    assert not any(fit.undetermined for fit in fits)


def test_a_second_recording_that_slips_determines_friction():
    sticks, slips = throw(0.3, 0.1, 1), throw(2.0, 0.1, 2)
    one, two = (fitted(thrown, restarts=0) for thrown in ([slips], [sticks, slips]))
    assert two.undetermined == ()
    assert abs(two.parameters["friction"] - 0.1) < 3 * two.error["friction"]
    # both show e, one shows mu; e is known sqrt(2) times better
    assert two.error["restitution"] / one.error["restitution"] == pytest.approx(0.71, abs=0.15)
    assert abs(two.smooth["friction"] - two.parameters["friction"]) < two.error["friction"]


def test_a_sum_of_two_parameters():
    def scene(parameters, recording):
        e = parameters["a"] + parameters["b"]
        return varied(ball(), restitution=e, friction=parameters["mu"], start=recording.start)

    part = Parameter(0.3, 0.05, 0.0, 0.5)
    parameters = {"a": part, "b": part, "mu": (0.2, 0.05)}
    fit = fitted([throw(2.0, 0.1, 1)], parameters, scene, restarts=0)
    assert fit.undetermined == ("a", "b")
    assert fit.interval["a"] == (0.0, 0.5)
    assert "a and b only in combination: the data do not show changes in the ratio " in str(fit)
    a, b, mu = fit.curvature.combinations[0]
    assert a / b == pytest.approx(-1.0, abs=1e-3)
    assert mu == 0.0
    assert abs(fit.parameters["mu"] - 0.1) < 3 * fit.error["mu"]


T = np.arange(1, 101) / 100


class Drawn(Evaluator):
    """Positions (x(parameters), 0, 0) t instead of a simulation, recorded with noise, and `off` t besides."""

    def __init__(self, x, parameters, true, off=0.0):
        self.x = x
        position = 0.01 * np.random.default_rng(0).normal(size=(100, 3))
        position[:, 0] += (x(np.array(true)) + off - T @ position[:, 0] / (T @ T)) * T
        recording = Recording(T, position, [[1, 0, 0, 0]] * 100)
        super().__init__(None, [recording], Space(parameters, None), None, None)
        self.points, self.values = [np.array(true, dtype=float)], [np.zeros(1)]

    def runs(self, point):
        position = np.zeros((100, 1, 3))
        position[:, 0, 0] = self.x(point) * T
        return [RollOut(position, self.recordings[0].orientation, "", 0.0, 0.0)]


SIGMA = 0.01 / np.sqrt(T @ T)  # of a slope


@pytest.mark.parametrize("factor", [1e-6, 1.0, 1e4])
def test_error_of_a_slope_in_any_unit(factor):
    found = curvature(
        Drawn(lambda p: p[0] / factor, {"p": (2.0 * factor, factor)}, [2.0 * factor], off=SIGMA)
    )
    # the noise is known to 1/sqrt(600) = 4 %; two of them
    assert found.error[0] == pytest.approx(SIGMA * factor, rel=0.08)
    assert found.centre[0] == pytest.approx((2.0 + SIGMA) * factor, rel=1e-6)
    assert found.combinations.shape == (0, 1)


@pytest.mark.parametrize("above", [30.0, 1.0, 0.1, -0.1, -0.7])
def test_a_best_value_near_the_end_of_a_flat_side_is_no_estimate(above):
    # x = min(p, 1): a best value less than two errors below 1 may be there by chance
    best = 1.0 + above * SIGMA
    found = curvature(Drawn(lambda p: min(p[0], 1.0), {"p": (1.0, 0.1)}, [best]))
    assert np.isinf(found.error[0])
    assert found.allowed[0, 1] == np.inf
    assert found.allowed[0, 0] == pytest.approx(1.0 - 2 * SIGMA, abs=SIGMA)


def test_an_error_above_the_value_is_no_determination():
    # p = 0.001 and an error of 0.0017
    found = curvature(Drawn(lambda p: p[0], {"p": (0.001, 0.0002)}, [0.001]))
    assert np.isinf(found.error[0])
    np.testing.assert_allclose(found.allowed[0], 0.001 + np.array([-2, 2]) * SIGMA, rtol=0.1)


def test_a_value_near_its_bound_is_determined():
    found = curvature(Drawn(lambda p: p[0], {"p": Parameter(0.5, 0.1, 0.0, 1.0)}, [0.001]))
    assert found.error[0] == pytest.approx(SIGMA, rel=0.08)
    assert found.allowed[0, 0] == 0.0


def test_values_that_give_no_scene_are_excluded():
    def x(p):
        if not 0.0 < p[0] < 2.5:
            raise ValueError("p must be in (0, 2.5)")
        return min(p[0], 1.0)

    found = curvature(Drawn(x, {"p": (1.0, 3.0)}, [2.0]))
    assert np.isinf(found.error[0])
    np.testing.assert_allclose(found.allowed[0], [1 - 2 * SIGMA, 2.5], rtol=0.01)
    assert curvature(Drawn(x, {"p": (0.5, 3.0)}, [0.5])).error[0] == pytest.approx(SIGMA, rel=0.08)
