"""What must not matter: order of contacts, mirror, tangent axes, how a face is split into points."""

import numpy as np
import pytest
from multiple_cases import CORNERS, DIE, Body

from carom.impact.multiple.api import resolve_impacts

FALL = np.array([0.3, 0.1, -2, 3, 1, 5])
TIGHT = 1e-10


@pytest.mark.parametrize("mu", [0.05, 0.3, 1.0])
@pytest.mark.parametrize("order", [(3, 1, 0, 2), (2, 3, 0, 1)])
def test_order_of_contacts(order, mu):
    after, impact = DIE.strike(FALL, mu, 0.5, "stronge", rtol=TIGHT)
    other, permuted = Body([CORNERS[i] for i in order]).strike(FALL, mu, 0.5, "stronge", rtol=TIGHT)
    # Velocities of the contacts (w counts by the arm .01 m), to what rtol leaves of the change of stick.
    np.testing.assert_allclose(DIE.G @ other, DIE.G @ after, rtol=0, atol=1e-8)
    np.testing.assert_allclose(
        permuted.impulse[:, 0], impact.impulse[list(order), 0], rtol=0, atol=1e-9
    )


@pytest.mark.parametrize("mu", [0.05, 0.3, 1.0])
def test_mirror(mu):
    # y -> -y: v_y, w_x, w_z change sign. The corners are the same set.
    sign = np.array([1, -1, 1, -1, 1, -1.0])
    after, _ = DIE.strike(FALL, mu, 0.5, "stronge", rtol=TIGHT)
    mirrored, _ = DIE.strike(sign * FALL, mu, 0.5, "stronge", rtol=TIGHT)
    np.testing.assert_allclose(DIE.G @ (sign * mirrored), DIE.G @ after, rtol=0, atol=1e-8)


@pytest.mark.parametrize("mu", [0.05, 0.3, 1.0])
def test_tangent_axes(mu):
    # Each contact with axes of its own: velocities turn with them.
    turn = np.zeros((12, 12))
    for i, angle in enumerate((0.3, 1.0, 2.0, -1.4)):
        c, s = np.cos(angle), np.sin(angle)
        turn[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = [[1, 0, 0], [0, c, s], [0, -s, c]]
    u = DIE.G @ FALL
    a = resolve_impacts(DIE.W, u.reshape(4, 3), mu, 0.5, "stronge", rtol=TIGHT)
    b = resolve_impacts(
        turn @ DIE.W @ turn.T, (turn @ u).reshape(4, 3), mu, 0.5, "stronge", rtol=TIGHT
    )
    np.testing.assert_allclose(
        b.velocity_after.ravel(), turn @ a.velocity_after.ravel(), rtol=0, atol=1e-8
    )


def test_turned_axes_of_a_flat_fall_are_not_alike():
    # Contacts whose axes differ have different rows: solved in full, the same answer as the exact one.
    velocity = np.array([0.3, 0.1, -2, 0, 0, 0])
    u = DIE.G @ velocity
    turn = np.eye(12)
    turn[4:6, 4:6] = [[0, 1], [-1, 0]]
    whole = resolve_impacts(DIE.W, u.reshape(4, 3), 0.1, 0.5, "stronge", rtol=TIGHT)
    full = resolve_impacts(
        turn @ DIE.W @ turn.T, (turn @ u).reshape(4, 3), 0.1, 0.5, "stronge", rtol=TIGHT
    )
    np.testing.assert_allclose(
        full.velocity_after.ravel(), turn @ whole.velocity_after.ravel(), rtol=0, atol=1e-9
    )


@pytest.mark.parametrize("mu", [0.1, 0.5])
@pytest.mark.parametrize("law", ["stronge", "poisson"])
def test_splitting_a_face(law, mu):
    # Each corner as two points with half the stiffness, then with 1/4 and 3/4: nothing changes.
    after, _ = DIE.strike(FALL, mu, 0.5, law, rtol=TIGHT)
    twice = Body([p for p in CORNERS for _ in range(2)])
    halves, _ = twice.strike(FALL, mu, 0.5, law, stiffness=[0.5] * 8, rtol=TIGHT)
    uneven, _ = twice.strike(FALL, mu, 0.5, law, stiffness=[0.25, 0.75] * 4, rtol=TIGHT)
    np.testing.assert_allclose(DIE.G @ halves, DIE.G @ after, rtol=0, atol=1e-8)
    np.testing.assert_allclose(DIE.G @ uneven, DIE.G @ after, rtol=0, atol=1e-8)


def test_uncoupled_contacts_do_not_know_of_each_other():
    # Two dice, one falling flat, one at rest on the ground: two problems.
    zero = np.zeros((12, 12))
    W = np.block([[DIE.W, zero], [zero, DIE.W]])
    u = (DIE.G @ FALL).reshape(4, 3)
    both = resolve_impacts(W, np.vstack([u, 0 * u]), 0.3, 0.5, "stronge")
    alone = resolve_impacts(DIE.W, u, 0.3, 0.5, "stronge")
    np.testing.assert_array_equal(both.impulse[:4], alone.impulse)
    np.testing.assert_array_equal(both.impulse[4:], 0)
    np.testing.assert_array_equal(both.velocity_after[4:], 0)


def test_nothing_strikes():
    u = (DIE.G @ np.array([0.3, 0, 1.0, 0, 0, 0])).reshape(4, 3)
    impact = resolve_impacts(DIE.W, u, 0.3, 0.5)
    np.testing.assert_array_equal(impact.velocity_after, u)
    assert impact.energy_change == 0
