"""One impact whose friction is a law of the slip, or whose restitution is one of the approach."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from verified import agree, verifies

SLIP = carom.Friction(static=0.4, kinetic=0.1, speed=0.5)
W = np.array([[2.5, -1.5, 0.2], [-1.5, 2.6, 0.1], [0.2, 0.1, 2.2]])
U = np.array([-1.0, 1.5, 0.6])


def integrated(W, u, e, law=SLIP):
    """Return the velocity after, by du/dp = W (1, -mu(|u_t|) u_t/|u_t|), with Newton's law."""

    def rate(p, v):
        slip = np.linalg.norm(v[1:])
        return W @ [1.0, *(-float(law(slip)) * v[1:] / slip)]

    def arrives(p, v):
        return v[0] + e * u[0]

    arrives.terminal = True
    return solve_ivp(rate, (0, 10), u, rtol=1e-12, atol=1e-13, events=arrives).y_events[0][0]


@verifies(
    "Friction",
    r"impact: $\mathrm du/\mathrm dp = W (1, -\mu(\lvert u_t\rvert)\,u_t/\lvert u_t\rvert)$",
    "own integration: SciPy",
)
def test_against_an_integration():
    # The pair of order 5 has 1e-12 of the velocity a step, and the reference the same.
    found = carom.resolve_impact(W, U, SLIP, 0.5)
    agree(found.velocity_after, integrated(W, U, 0.5), atol=1e-10)
    agree(found.velocity_after, U + W @ found.impulse, atol=1e-14)
    many = carom.resolve_impacts(W, [U], SLIP, 0.5)
    agree(found.velocity_after, many.velocity_after[0], atol=1e-10)


def test_restitution_by_the_approach():
    law = carom.Restitution.power(0.6, speed=0.1)
    for solve in (
        lambda e: carom.resolve_impact(W, U, 0.3, e).velocity_after,
        lambda e: carom.resolve_impacts(W, [U], 0.3, e).velocity_after[0],
    ):
        np.testing.assert_array_equal(solve(law), solve(float(law(1.0))))


def test_laws_and_numbers_side_by_side():
    approach, law = np.array([0.5, 1.0, 2.0]), carom.Restitution.power(0.6)
    speeds = np.stack([-approach, [0.7] * 3, [0.2] * 3], axis=1)
    found = carom.resolve_impact(W, speeds, [[SLIP], [0.3]], [law, 0.2, law])
    assert found.velocity_after.shape == (2, 3, 3)
    e = [float(law(0.5)), 0.2, float(law(2.0))]
    np.testing.assert_allclose(found.velocity_after[..., 0], [e * approach] * 2, rtol=1e-12)
    for k in range(3):
        one = carom.resolve_impact(W, speeds[k], SLIP, e[k])
        np.testing.assert_array_equal(found.velocity_after[0, k], one.velocity_after)


def test_in_the_plane():
    found = carom.resolve_impact(W[:2, :2], U[:2], SLIP, 0.5)
    space = carom.resolve_impact(np.pad(W[:2, :2], (0, 1)), (*U[:2], 0.0), SLIP, 0.5)
    np.testing.assert_array_equal(found.velocity_after, space.velocity_after[:2])


def test_bad_laws():
    grain = carom.Friction(axis=(1, 0, 0), along=0.1, across=0.2)
    with pytest.raises(ValueError, match="friction must not depend on the direction here"):
        carom.resolve_impact(W, U, grain, 0.5)
    with pytest.raises(ValueError, match="first axes that go together"):
        carom.resolve_impact(W, [U, U, U], SLIP, [carom.Restitution.power(0.6), 0.5])
    with pytest.raises(ValueError, match="restitution must be"):
        carom.resolve_impact(W, U, SLIP, SLIP)
