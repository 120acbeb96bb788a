"""Friction by the slip after the impact, u_n+ = -e u_n- (the law of Moreau): of one contact and of several."""

import numpy as np
import pytest

import carom
from verified import agree, verifies

FACE = np.array([[2.5, -1.5, 0.0], [-1.5, 2.5, 0.0], [0.0, 0.0, 1.0]])  # of a rod at 45 degrees


def problem(rng, k):
    """Return W, u, mu and e of k contacts, of a random rank from 3 up."""
    n = 3 * k
    A = rng.normal(size=(n, rng.integers(3, n + 3)))
    u = rng.normal(size=(k, 3))
    u[:, 0] = -np.abs(u[:, 0]) - 0.05
    if A.shape[1] < n:  # a velocity that the contacts can have
        u = (A @ rng.normal(size=A.shape[1])).reshape(k, 3)
        u *= -np.sign(u[0, 0])
    whole = 0.01 * np.eye(n) if A.shape[1] >= n else 0.0  # nearly singular W have round-off in W P
    return A @ A.T / n + whole, u, rng.uniform(0, 2, k), rng.uniform(0, 1, k)


def misses(u, after, P, mu, e):
    """Return the misses of the law, in units of the greatest speed, and of the cone, of the impulses."""
    size, push = np.abs(u).max(), np.abs(P).max() + 1e-300
    goal = after[:, 0] + e * np.minimum(u[:, 0], 0.0)
    normal = np.minimum(P[:, 0] / push, goal / size)
    slip, rub = after[:, 1:], P[:, 1:]
    cone = np.hypot(*rub.T) - mu * P[:, 0]
    against = np.hypot(*slip.T)[:, None] * rub + (mu * P[:, 0])[:, None] * slip
    return np.abs(normal).max(), cone.max() / push, np.abs(against).max() / (size * push)


@verifies(
    'impact_law="moreau"', "two linear equations for slip against the final slip", "closed form"
)
def test_one_impact_by_hand():
    """Both sides of slip are linear equations: the final slip keeps its direction, the path turns it round."""
    found = carom.resolve_impact(FACE, (-1.0, 0.2, 0.0), 0.3, 0.5, impact_law="moreau")
    p = 1.5 / (
        2.5 - 1.5 * 0.3
    )  # u_n: -1 + (2.5 - 1.5 * .3) p = .5 with P_t = .3 p, against slip backwards
    agree(found.impulse, (p, 0.3 * p, 0.0), rtol=1e-14)
    agree(found.velocity_after, (0.5, 0.2 - 1.5 * p + 0.75 * p, 0), atol=1e-15)
    assert found.phases == ("slip",)
    path = carom.resolve_impact(FACE, (-1.0, 0.2, 0.0), 0.3, 0.5)
    assert abs(path.velocity_after[1] - found.velocity_after[1]) > 0.1
    agree(found.restitution_work, -0.25 * found.compression_work, rtol=1e-14)


def test_random_impacts():
    rng = np.random.default_rng(63)
    for trial in range(2000):
        k = 1 + trial % 4
        W, u, mu, e = problem(rng, k)
        found = carom.resolve_impacts(W, u, mu, e, "moreau")
        after, P = found.velocity_after, found.impulse
        if found.plastic_change != 0.0:  # friction wedges it, and there is no velocity with this e
            e = np.zeros(k)
        elif found.law_missed or found.at_once:
            e = np.full(k, e.min())
        assert max(misses(u, after, P, mu, e)) <= 1e-10, trial
        assert (P[:, 1:] * after[:, 1:]).sum(axis=1).max() <= 1e-10 * np.abs(P).max() * np.abs(
            u
        ).max()
        works = found.compression_work + found.restitution_work - found.friction_loss
        change = 0.5 * P.ravel() @ (u + after).ravel()
        scale = np.abs(P.ravel()) @ np.abs(u).ravel()
        assert works.sum() == pytest.approx(change, abs=1e-13 * scale)
        assert found.energy_change == pytest.approx(change, abs=1e-13 * scale)
        if k == 1:
            one = carom.resolve_impact(W, u[0], mu[0], e[0], "moreau")
            np.testing.assert_allclose(one.velocity_after, after[0], atol=1e-10 * np.abs(u).max())
            assert one.energy_change == pytest.approx(change, abs=1e-10 * scale)


@verifies(
    'impact_law="moreau"', r"the contact problem for $(1 + e)\,u_n^-$", "invariant: two solvers"
)
def test_several_are_one_contact_problem():
    rng = np.random.default_rng(7)
    for k in (2, 3, 4):
        A = rng.normal(size=(3 * k, 3 * k))
        W, u = A @ A.T / (3 * k), rng.normal(size=(k, 3))
        u[:, 0] = -np.abs(u[:, 0]) - 0.05
        e, mu = np.linspace(0.2, 0.8, k), np.full(k, 0.4)
        bias = u.copy()
        bias[:, 0] *= 1 + e
        problem_of_one_instant = carom.solve_contacts(W, bias, mu)
        found = carom.resolve_impacts(W, u, mu, e, "moreau")
        size = np.abs(problem_of_one_instant.impulse).max()
        agree(found.impulse, problem_of_one_instant.impulse, atol=1e-11 * size)


def test_laws_of_slip_and_of_speed():
    """The coefficient is that at the slip after, of one contact and of several."""
    law = carom.Friction(0.5, 0.1, speed=0.3)
    one = carom.resolve_impact(FACE, (-1.0, 1.6, 0.0), law, 0.5, "moreau")
    slip = np.hypot(*one.velocity_after[1:])
    assert slip > 0.01
    assert np.hypot(*one.impulse[1:]) == pytest.approx(float(law(slip)) * one.impulse[0], rel=1e-12)
    two = carom.resolve_impacts(FACE, [(-1.0, 1.6, 0.0)], law, 0.5, "moreau")
    np.testing.assert_allclose(two.velocity_after[0], one.velocity_after, atol=1e-8)


def test_wedged():
    """W of a mechanism that moves one way only: with this friction no velocity has e above 0."""
    row = np.array([-0.546222, 0.686425, -1.032717])
    mu, e = 0.724458, 0.8
    u = 0.649 * row
    found = carom.resolve_impact(np.outer(row, row), u, mu, e, "moreau")
    assert found.wedged
    assert abs(found.velocity_after).max() < 1e-12
    assert found.energy_change == pytest.approx(-0.5 * 0.649**2, rel=1e-12)
    assert found.restitution_work == 0.0
    several = carom.resolve_impacts(np.outer(row, row), [u], mu, e, "moreau")
    assert several.plastic_change < 0.0
    np.testing.assert_allclose(several.velocity_after[0], 0.0, atol=1e-9)


def test_many_at_once_and_a_plane_one():
    mu = np.linspace(0, 1, 5)
    many = carom.resolve_impact(FACE[:2, :2], (-1.0, 0.2), mu, 0.5, ["moreau"] * 5)
    for i in range(5):
        one = carom.resolve_impact(FACE, (-1.0, 0.2, 0.0), mu[i], 0.5, "moreau")
        np.testing.assert_allclose(many.velocity_after[i], one.velocity_after[:2], atol=1e-14)


def test_it_may_add_energy():
    found = carom.resolve_impact(FACE, (-1.0, 0.6, 0.0), 0.8, 0.9, "moreau")
    assert found.energy_change > 0.0
    several = carom.resolve_impacts(FACE, [(-1.0, 0.6, 0.0)], 0.8, 0.9, "moreau")
    assert several.energy_change == pytest.approx(found.energy_change, rel=1e-12)
    assert not several.capped


def test_what_needs_a_path_is_refused():
    W, u = np.diag([1.0, 3.5, 3.5]), (-1.0, 1.0, 0.0)
    impact = carom.resolve_impact(W, u, 0.1, 0.5, "moreau", stiffness=carom.Stiffness(1e5))
    assert np.isnan(impact.peak_force)
    assert np.isnan(impact.duration)
    with pytest.raises(ValueError, match="force in time must be of an impact with a course"):
        impact.force()
    with pytest.raises(ValueError, match="layer must be of an impact with a course"):
        carom.impact_layer(W, u, 0.1, 0.5, penetration=0.5, width=1e-6, law="moreau")
    with pytest.raises(ValueError, match="must be of an impact with a course"):
        impact.plot()
    with pytest.raises(ValueError, match="map of outcomes must be of an impact with a course"):
        carom.plots.e_mu(W, u, law="moreau")
