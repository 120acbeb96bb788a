"""Parameters of simulated motion with known noise are found again, within the reported uncertainty."""

import numpy as np
import pytest

import carom
from carom.studies.identify import Parameter, Recording, identify, mean_error, squared_error
from identify.tossed import POSITION_NOISE, ROTATION_NOISE, box, tosses
from verified import agree, verifies

TRUE = {"restitution": 0.35, "friction": 0.22}
LEAST_SQUARES = squared_error(POSITION_NOISE, ROTATION_NOISE)


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_restitution_and_friction_of_one_impact(seed):
    recordings = tosses(8, 11, seed, **TRUE)
    begin = {"restitution": (0.5, 0.1), "friction": (0.3, 0.05)}
    less = {"tolerance": 1e-4, "restarts": 0, "resamples": 30}
    fit = identify(box(), recordings, begin, LEAST_SQUARES, **less)
    # the noise moves positions after the impact by 1e-4 m of about 0.05 m: parameters are known to a percent
    for name, true in TRUE.items():
        assert 1e-5 < fit.error[name] < 0.01
        # 8 recordings drawn anew: the spread itself is uncertain by 1/4; 4 of them
        assert abs(fit.parameters[name] - true) < 4 * fit.error[name]
        low, high = fit.interval[name]
        assert low < fit.parameters[name] < high
    # as large as the noise: 8 x 11 x 6 numbers, relative spread sqrt(2/528) = 0.06
    assert fit.objective == pytest.approx(1.0, abs=0.25)
    assert fit.objective_at_start > 20.0
    assert fit.converged
    assert fit.evaluations == len(fit.points) == len(fit.values)
    assert not np.any(fit.failed)
    assert np.max(fit.final_turn) < 10 * ROTATION_NOISE


def test_inertia_and_corner_radius_with_a_robust_objective():
    true = {"inertia_factor": 1.2, "corner_radius": 0.006}
    recordings = tosses(8, 11, 5, restitution=0.5, friction=0.3, **true)
    begin = {"inertia_factor": (1.1, 0.15), "corner_radius": (0.003, 0.003)}
    robust = mean_error(POSITION_NOISE, ROTATION_NOISE)
    fit = identify(box(), recordings, begin, robust, resamples=40, restarts=0)
    for name in begin:
        assert abs(fit.parameters[name] - true[name]) < 5 * fit.error[name] < 0.2 * true[name]
    # E |d| of three components with standard deviation 1 is 2 sqrt(2/pi)
    assert fit.objective == pytest.approx(2 * np.sqrt(2 / np.pi), rel=0.1)


def sliding(parameters, recording):
    """A block that slides with 2 m/s on a plane."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    plane = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    block = scene.add_body(
        carom.Box(0.2, 0.1, 0.1), mass=1.0, position=(0, 0, 0.05), velocity=(2, 0, 0)
    )
    scene.add_contact(block, plane, restitution=0.0, friction=0.1, friction_held=parameters["mu"])
    return scene


@verifies("identify", r"$\mu$ of a recording $x = 2t - \mu g t^2/2$", "closed form")
@pytest.mark.parametrize("method", ["Nelder-Mead", "Powell", "COBYQA", "L-BFGS-B"])
def test_a_function_that_makes_the_scene(method):
    # decelerates with mu g: x = 2 t - mu g t^2/2, until it stops at t = 2/(mu g) = 0.82 s
    t, mu = np.arange(12) / 20, 0.25
    x = np.stack([2 * t - 0.5 * mu * 9.81 * t**2, 0 * t, 0.05 + 0 * t], axis=1)
    recording = Recording(t, x, [[1, 0, 0, 0]] * 12)
    start = {"mu": Parameter(0.4, 0.1, 0.0, 2.0)}
    fit = identify(
        sliding, [recording], start, squared_error(1e-3, 1e-3), method=method, resamples=0,
        tolerance=1e-6,
    )  # fmt: skip
    agree(fit.parameters["mu"], mu, atol=1e-4)
    assert np.isnan(fit.error["mu"])


def test_same_result_with_threads_and_by_restarts_no_worse():
    recordings = tosses(6, 11, 4, **TRUE)
    begin = {"restitution": (0.5, 0.1)}
    one, two = (
        identify(box(), recordings, begin, LEAST_SQUARES, resamples=8, workers=n) for n in (1, 2)
    )
    assert one.parameters == two.parameters
    np.testing.assert_array_equal(one.uncertainty.samples, two.uncertainty.samples)
    none = identify(box(), recordings, begin, LEAST_SQUARES, resamples=0, restarts=0)
    assert one.objective <= none.objective


def test_budget():
    seen = []
    fit = identify(
        box(), tosses(2, 6, 4, **TRUE), {"restitution": (0.5, 0.1)}, LEAST_SQUARES, resamples=0,
        max_evaluations=3, progress=lambda *row: seen.append(row),
    )  # fmt: skip
    assert not fit.converged
    assert fit.evaluations == 3
    assert "stopped after 3 evaluations" in str(fit)
    assert [row[0] for row in seen] == [1, 2, 3]
    assert seen[0][1] == {"restitution": 0.5}


ONE = [Recording([0, 0.1], np.zeros((2, 3)), [[1, 0, 0, 0]] * 2)]
E_ONLY = {"restitution": (0.5, 0.1)}


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"scene": None}, TypeError, "scene must be a carom.Scene or a function"),
        ({"recordings": []}, ValueError, "at least one Recording"),
        ({"recordings": [1]}, TypeError, r"recordings\[0\] must be a Recording"),
        ({"parameters": {}}, ValueError, "parameters must be a dict"),
        ({"parameters": {"restituton": (0.5, 0.1)}}, ValueError, "did you mean 'restitution'"),
        ({"parameters": {"restitution": (1.5, 0.1)}}, ValueError, "start must be .* at most 1"),
        ({"parameters": {"restitution": (0.5, -0.1)}}, ValueError, "step must be finite and above 0"),
        ({"parameters": {"corner_radius": 0.1}}, ValueError, r"must be a Parameter or \(start, step\)"),
        ({"objective": 1.0}, TypeError, "objective must be a function"),
        ({"objective": lambda a, b: np.nan}, ValueError, "one finite number, got nan for recording 0"),
        ({"objective": lambda a, b: (1, 2)}, ValueError, r"one finite number, got \(1, 2\)"),
        ({"method": "Nelder"}, ValueError, "method must be one of"),
        ({"tolerance": 0.0}, ValueError, "tolerance must be"),
        ({"step": -1.0}, ValueError, "step must be finite and above 0"),
        ({"workers": 0}, ValueError, "workers must be"),
    ],
)  # fmt: skip
def test_bad_input(change, error, message):
    good = {"scene": box(), "recordings": ONE, "parameters": E_ONLY, "objective": LEAST_SQUARES}
    with pytest.raises(error, match=message):
        identify(**{**good, **change})
