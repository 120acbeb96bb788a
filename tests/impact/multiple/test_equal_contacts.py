"""The normal law of the corner against the exact resolver of one contact.

Two contacts at one point of a body share the load of one, whatever their stiffnesses: W has four equal blocks.
"""

import numpy as np
import pytest
from cases import LAWS, U_SPACE, W_SPACE, planar

from carom.impact.api import resolve_impact
from carom.impact.multiple.api import resolve_impacts

# mathematics page, W1: V4 with mu below, at and above stick, V6 (reversal), V8 (stick from slip).
ONE = {
    "slip": (W_SPACE, U_SPACE, 0.2, 0.5),
    "slip, mu .5": (W_SPACE, U_SPACE, 0.5, 0.5),
    "stick": (W_SPACE, U_SPACE, 0.9, 0.5),
    "slip bends past rest": (W_SPACE, np.array([-1, -0.2, 0.1]), 0.25, 0.5),
    "reversal": (planar(2.5, -1.5, 2.5), np.array([-1, 0.2, 0]), 0.3, 0.5),
    "rod sticks": (planar(2.5, -1.5, 2.5), np.array([-1, 0.6, 0]), 0.8, 0.9),
}


@pytest.mark.parametrize("name", ONE)
def test_stronge(name):
    # Law D returns e^2 of the work it took for any history of friction: Stronge's law. rtol 1e-10, sums of
    # some ten steps.
    W, u, mu, e = ONE[name]
    exact = resolve_impact(W, u, mu, e, "stronge")
    both = resolve_impacts(
        np.tile(W, (2, 2)), [u, u], mu, e, "stronge", stiffness=(1, 3), rtol=1e-10
    )
    for after in both.velocity_after:
        np.testing.assert_allclose(after, exact.velocity_after, rtol=0, atol=1e-9)
    np.testing.assert_allclose(both.impulse.sum(axis=0), exact.impulse, rtol=0, atol=1e-9)
    assert both.compression_work.sum() == pytest.approx(exact.compression_work, abs=1e-9)
    assert both.restitution_work.sum() == pytest.approx(exact.restitution_work, abs=1e-9)
    assert both.friction_loss.sum() == pytest.approx(exact.friction_loss, abs=1e-9)


@pytest.mark.parametrize("law", ["newton", "poisson"])
@pytest.mark.parametrize("name", ["slip", "slip, mu .5", "stick"])
def test_newton_and_poisson_by_iteration(name, law):
    # §2.4: the outer fixed point meets the laws of one contact. It stops at 3 rtol.
    W, u, mu, e = ONE[name]
    exact = resolve_impact(W, u, mu, e, law)
    both = resolve_impacts(np.tile(W, (2, 2)), [u, u], mu, e, law, stiffness=(1, 3), rtol=1e-10)
    for after in both.velocity_after:
        np.testing.assert_allclose(after, exact.velocity_after, rtol=0, atol=2e-9)
    assert both.law_missed == 0


@pytest.mark.parametrize("law", LAWS)
def test_alike_contacts_are_one(law):
    # Equal stiffness: m contacts at one point, or one alone, are the exact resolver.
    W, u, mu, e = ONE["slip"]
    exact = resolve_impact(W, u, mu, e, law)
    alone = resolve_impacts(W, [u], mu, e, law)
    np.testing.assert_array_equal(alone.impulse[0], exact.impulse)
    np.testing.assert_allclose(alone.velocity_after[0], exact.velocity_after, rtol=1e-14)
    three = resolve_impacts(np.tile(W, (3, 3)), [u, u, u], mu, e, law)
    np.testing.assert_allclose(three.impulse, np.tile(exact.impulse / 3, (3, 1)), rtol=1e-14)
    assert three.steps < 20
