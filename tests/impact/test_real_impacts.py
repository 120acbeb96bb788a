"""The impacts of the real cube."""

import numpy as np
import pytest

import real_impacts as real
from verified import agree, verifies


def test_only_clean_impacts_and_all_approach():
    before, _, G, _, heights, flights = real.load()
    assert len(before) == 181
    assert np.all(np.einsum("kij,kj->ki", G, before)[:, 0] < 0.0)
    assert np.all((flights > 2.4 / 148) & (flights < 3.6 / 148))
    assert np.all((heights > 0.05) & (heights <= np.sqrt(3) * real.HALF))


def test_impact_laws_are_far_better_than_none():
    """Elsewhere: 0.26 m/s and 1.9 rad/s, at e = 0.3 0.105 and 2.2, without impact 1.09 and 8.2."""
    assert real.medians(real.after(*real.NOMINAL, "newton")) == pytest.approx((0.26, 1.9), rel=0.15)
    assert real.medians(real.after(0.3, 0.18, "newton")) == pytest.approx((0.105, 2.2), rel=0.15)
    assert real.medians(real.after(0, 0, None)) == pytest.approx((1.09, 8.2), rel=0.15)


@verifies(
    "resolve_impact",
    "first impacts of a tossed cube: median errors of 181, m/s and rad/s, two parameters fitted",
    "experiment: ContactNets",
)
@pytest.mark.parametrize("law", real.LAWS)
def test_a_fit_is_a_minimum(law):
    e, mu = real.fit(law)
    agree(real.medians(real.after(e, mu, law)), 0.0, atol=(0.1, 2.5))
    assert 0.25 < e < 0.4
    assert 0.17 < mu < 0.23
    if law == "stronge":
        assert (round(e, 3), round(mu, 3)) == real.THERE["FITTED"]
    least = real.objective((e, mu), law)
    assert least < real.objective(real.NOMINAL, law)
    for de, dmu in ((0.02, 0), (-0.02, 0), (0, 0.01), (0, -0.01)):
        assert real.objective((e + de, mu + dmu), law) > least
    assert real.objective((-0.1, mu), law) == np.inf


@verifies(
    "simulate",
    "first impacts of a tossed cube: median errors of 181, m/s and rad/s, two parameters fitted",
    "experiment: ContactNets",
)
def test_the_simulation_agrees_where_one_corner_strikes_once():
    """Most impacts are alone until the measured sample; then both are the same to round-off."""
    e, mu = real.fit("stronge")
    simulated = real.simulated(e, mu, "stronge")
    agree(real.medians(simulated), 0.0, atol=(0.1, 2.5))
    apart = np.abs(simulated - real.after(e, mu, "stronge")).max(axis=1)
    assert np.mean(apart < 1e-4) > 0.8
