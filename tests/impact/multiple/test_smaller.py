"""Impacts at a corner made smaller: contacts that nothing presses."""

import numpy as np
import pytest
from multiple_cases import CORNERS, DIE, Body

from carom.impact.multiple.api import resolve_impacts

EDGE = Body(
    CORNERS[:2]
)  # both at x = -.01: W between their normals is 1/m > 0, each lifts the other
LANDING = np.array([0.3, 0.2, 0, 0, 0, 4])


def landing(law, mu=0.2, approach=0.0):
    """One end of an edge lies (or approaches a little), the other strikes at 1.5 m/s and slips."""
    u = (EDGE.G @ LANDING).reshape(2, 3)
    u[:, 0] = (-approach, -1.5)
    return u, resolve_impacts(EDGE.W, u, mu, 0.5, law, rtol=1e-10)


@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_an_end_that_is_lifted_takes_no_part(law):
    u, impact = landing(law)
    alone = resolve_impacts(EDGE.W[3:, 3:], u[1:], 0.2, 0.5, law)
    assert np.all(impact.impulse[0] == 0.0)
    assert impact.velocity_after[0, 0] > 0.0
    # the other is one contact, to round-off of its resolver
    np.testing.assert_allclose(impact.impulse[1], alone.impulse[0], rtol=1e-14)
    if law == "newton":
        assert impact.velocity_after[1, 0] == pytest.approx(0.75, rel=1e-14)


@pytest.mark.parametrize("law", ["poisson", "stronge"])
def test_the_layer_agrees(law):
    # An approach of 1e-9 makes the lying end one of those that are pressed: the layer is passed, to rtol 1e-10.
    _, smaller = landing(law)
    _, whole = landing(law, approach=1e-9)
    assert whole.steps > smaller.steps
    np.testing.assert_allclose(whole.velocity_after, smaller.velocity_after, rtol=0, atol=1e-8)


def test_what_is_pressed_by_the_far_side_takes_part():
    # Diagonal corners: W_nn = 1/m - 2 (.01)^2/J < 0, so one that strikes presses the other down.
    u = np.zeros((4, 3))
    u[0, 0] = -1.0
    impact = resolve_impacts(DIE.W, u, 0.1, 0.5, "stronge")
    assert impact.impulse[3, 0] > 0.0


def test_friction_can_press():
    # Parted by the normal force (W_12 = .2), pressed by friction mu |W_n,t| = .5 * .5 > .2: it takes part.
    W = np.eye(6)
    W[0, 3] = W[3, 0] = 0.2
    W[0, 4] = W[4, 0] = 0.5
    u = np.array([[0, 0, 0], [-1.0, 1.0, 0]])
    assert resolve_impacts(W, u, 0.3, 0.5, "stronge").impulse[0, 0] == 0.0  # .15 < .2: only parted
    assert resolve_impacts(W, u, 0.5, 0.5, "stronge").impulse[0, 0] > 0.0


def test_energy_of_one_that_is_left_is_capped():
    # V8: one contact gains energy by Newton's law with friction. Beside one that lies it may not.
    W = np.array([[2.5, -1.5, 0], [-1.5, 2.5, 0], [0, 0, 0]])
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = W
    both[0, 3] = both[3, 0] = 0.1
    u = np.array([[-1, 0.6, 0], [0, 0, 0]])
    impact = resolve_impacts(both, u, [0.8, 0.0], 0.9, "newton")
    assert impact.capped
    assert impact.energy_change <= 0
    assert impact.velocity_after[0, 0] < 0.9
