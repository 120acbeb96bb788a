"""Systems in coordinates without a step: errors are what the tolerances ask for."""

import numpy as np
import pytest
from coordinate_systems import double_pendulum, falling_rod, slider_crank

import carom

CASES = {
    "double pendulum": (lambda: double_pendulum((1.2, -0.4), (0.0, 0.0))[0], 2.0),
    "crank on its stop": (lambda: slider_crank(-0.9, 4.0, True), 1.0),
    "rod that falls": (lambda: falling_rod(0.3, (0.5, -1), 1.0, 0.5, 0.3, "newton"), 0.8),
    "rod that slides to rest": (lambda: falling_rod(0.0, (2.5, 0), 0.0, 0.0, 0.3, "newton"), 1.2),
}


@pytest.mark.parametrize("name", CASES)
def test_errors_are_those_that_were_asked_for(name):
    """Against fixed steps of order 8, 1 ms: 1e-12 of these motions."""
    make, duration = CASES[name]
    system = make()
    exact = carom.simulate(system, duration, step=1e-3, method="rk8")
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10):
        found = carom.simulate(system, duration, rtol=rtol)
        assert np.abs(found.q[-1] - exact.q[-1]).max() < 10.0 * rtol
        assert len(found.impacts) == len(exact.impacts)


def test_longer_steps_for_less_and_shorter_ones_for_more():
    system = double_pendulum((1.2, -0.4), (0.0, 0.0))[0]
    counts = []
    for rtol in (1e-5, 1e-7, 1e-9):
        found = carom.simulate(system, 2.0, rtol=rtol, method="rk5", save_at=1.0)
        counts.append(found.stats["trial_steps"] - found.stats["rejected"])
    # order 5: a step is shorter by 100^(1/5) = 2.5 each time
    assert 2.0 < counts[1] / counts[0] < 3.0
    assert 2.0 < counts[2] / counts[1] < 3.0


def test_bounces_that_are_lower_than_the_tolerance_end():
    """A rod dropped level, e = .5: its bounces end at t (1 + 2 e/(1 - e)), t = sqrt(2 h/g)."""
    system = falling_rod(0.0, (0.0, 0.0), 0.0, 0.5, 0.3, "newton")
    solution = carom.simulate(system, 4.0)
    drop = solution.q[0, 1] - solution.q[-1, 1]
    held = solution.events.time[solution.events.kind == "held"]
    assert held[0] == pytest.approx(3.0 * np.sqrt(2.0 * drop / 9.81), rel=1e-4)
    assert len(solution.impacts) < 100


def test_methods_without_an_estimate_need_a_step():
    system = double_pendulum((1.2, -0.4), (0.0, 0.0))[0]
    with pytest.raises(ValueError, match=r"step must be .* method='rk4'"):
        carom.simulate(system, 1.0, method="rk4")


@pytest.mark.parametrize("name", CASES)
def test_states_between_saved_ones(name):
    """The same run with every state saved and with every fourth: the states that were left out are found."""
    make, duration = CASES[name]
    system = make()
    whole, few = (carom.simulate(system, duration, save_every=n) for n in (1, 4))
    times = whole.t[1:-1:7]
    q, v = few.evaluate(times)
    assert np.abs(q - whole.q[1:-1:7]).max() < 1e-9
    assert np.abs(v - whole.v[1:-1:7]).max() < 1e-7


@pytest.mark.parametrize("name", CASES)
def test_states_between_saved_ones_of_a_given_step(name):
    """They are those of the run: it is stepped again from the last event, with its active contacts."""
    make, duration = CASES[name]
    whole, few = (carom.simulate(make(), duration, step=0.01, save_every=n) for n in (1, 20))
    times = whole.t[1:-1:7]
    q, v = few.evaluate(times)
    np.testing.assert_allclose(q, whole.q[1:-1:7], rtol=0, atol=1e-14)
    np.testing.assert_allclose(v, whole.v[1:-1:7], rtol=0, atol=1e-13)
