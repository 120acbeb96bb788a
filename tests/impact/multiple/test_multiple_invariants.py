"""What every impact at a corner must satisfy, on random problems of any rank; trapped bodies; bad input."""

import numpy as np
import pytest
from cases import LAWS
from hypothesis import given, settings
from hypothesis import strategies as st
from multiple_cases import problems, strike_row

from carom.impact.multiple.api import resolve_impacts

few = settings(max_examples=60, deadline=None, derandomize=True)


def check(W, u, mu, e, impact, rtol):
    flat, P = u.ravel(), impact.impulse.ravel()
    size = np.abs(u).max()
    # Momentum exact: u+ = u + W P to round-off of the sum.
    after = flat + W @ P
    scale = size + (np.abs(W) @ np.abs(P)).max()
    np.testing.assert_allclose(impact.velocity_after.ravel(), after, rtol=0, atol=1e-14 * scale)
    # No contact approaches. Impulses press, and friction stays in the cone, or a little outside where slip
    # below the tolerance was taken for rest.
    assert impact.velocity_after[:, 0].min() >= -1e-8 * size
    total = impact.impulse[:, 0].sum()
    assert impact.impulse[:, 0].min() >= -1e-8 * total
    excess = np.hypot(impact.impulse[:, 1], impact.impulse[:, 2]) - mu * impact.impulse[:, 0]
    assert excess.max() <= 1e2 * rtol * max(total, 1e-300)
    # Energy: dE = P.(u + u+)/2 = works of the normal forces - friction, never more than before.
    change = 0.5 * P @ (flat + after)
    assert impact.energy_change == pytest.approx(change, abs=1e-13 * abs(P) @ abs(flat))
    assert impact.energy_change <= 1e-14 * abs(P) @ abs(flat)
    assert (impact.compression_work <= 0).all()
    assert (impact.restitution_work >= 0).all()
    assert (impact.friction_loss >= 0).all()
    if impact.plastic_change == 0:  # no contact gives back more than it took
        assert (impact.restitution_work <= -impact.compression_work * (1 + 1e-9) + 1e-300).all()


@few
@given(problem=problems(), law=st.sampled_from(LAWS))
def test_simultaneous(problem, law):
    W, u, mu, e, kappa = problem
    impact = resolve_impacts(W, u, mu, e, law, stiffness=kappa, rtol=1e-6)
    check(W, u, mu, e, impact, 1e-6)


@few
@given(problem=problems(), law=st.sampled_from(LAWS))
def test_sequential(problem, law):
    W, u, mu, e, _ = problem
    check(W, u, mu, e, resolve_impacts(W, u, mu, e, law, multiple="sequential"), 1e-8)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(problem=problems(most=4))
def test_hertz(problem):
    W, u, mu, e, kappa = problem
    impact = resolve_impacts(W, u, mu, e, "stronge", stiffness=kappa, exponent=1.5, rtol=1e-5)
    check(W, u, mu, e, impact, 1e-5)


@few
@given(problem=problems(most=4))
def test_plastic(problem):
    W, u, mu, _, _ = problem
    impact = resolve_impacts(W, u, mu, 0.0)
    check(W, u, mu, np.zeros(len(u)), impact, 1e-8)
    # 0 <= p_n _|_ u_n+ >= 0
    product = np.abs(impact.impulse[:, 0] * impact.velocity_after[:, 0]).max()
    assert product <= 1e-7 * np.abs(impact.impulse).max() * np.abs(u).max()
    assert impact.plastic_change == pytest.approx(impact.energy_change)


@few
@given(problem=problems(most=4))
def test_stronge_in_each_contact(problem):
    # A_r = e^2 |A_c| of every contact that opened again; less where it wedged or the end was plastic.
    W, u, mu, e, kappa = problem
    if e.min() < 0.01:
        return
    impact = resolve_impacts(W, u, mu, e, "stronge", stiffness=kappa, rtol=1e-7)
    if impact.plastic_change == 0:
        taken, back = -impact.compression_work, impact.restitution_work
        assert (back <= e**2 * taken * (1 + 1e-9)).all()


@pytest.mark.parametrize("e", [0.5, 0.9, 1.0])
def test_trapped_between_walls(e):
    # A particle between two walls that touch it: e < 1 ends at rest by itself or plastically, e = 1 never
    # would.
    W = np.zeros((6, 6))
    W[0, 0] = W[3, 3] = 1.0
    W[0, 3] = W[3, 0] = -1.0
    u = np.array([[-1.0, 0, 0], [1.0, 0, 0]])
    impact = resolve_impacts(W, u, 0.0, e, "stronge")
    assert np.abs(impact.velocity_after[:, 0]).max() <= 1e-8
    assert impact.energy_change == pytest.approx(-0.5, abs=1e-8)
    assert impact.events <= 2 * 200 + 10


def test_collapse_ends():
    # e = .05 in a row of balls: hundreds of recompressions, but they end by themselves.
    v, impact = strike_row([1, 0, 0, 0, 0], 0.05)
    assert impact.plastic_change == 0
    assert 100 < impact.events < 800
    assert np.diff(v).min() >= -1e-10


def test_energy_of_newton_is_capped():
    # One contact may gain energy by Newton's law with friction (81/64, V8). Several may not: two points
    # of unequal stiffness in the place of one.
    W = np.array([[2.5, -1.5, 0], [-1.5, 2.5, 0], [0, 0, 0]])
    u = np.array([-1, 0.6, 0])
    one = resolve_impacts(W, [u], 0.8, 0.9, "newton")
    assert one.energy_change > 0
    two = resolve_impacts(np.tile(W, (2, 2)), [u, u], 0.8, 0.9, "newton", stiffness=(1, 3))
    assert two.capped
    assert two.energy_change <= 0
    assert two.velocity_after[0, 0] < 0.9


BAD = [
    ({"velocity": np.zeros((2, 2))}, "velocity"),
    ({"velocity": np.zeros((0, 3))}, "velocity"),
    ({"inverse_mass": np.eye(3)}, "inverse_mass"),
    ({"inverse_mass": -np.eye(6)}, "positive semidefinite"),
    ({"inverse_mass": np.triu(np.ones((6, 6)))}, "symmetric"),
    ({"friction": -0.1}, "friction"),
    ({"friction": (0.1, -0.1)}, r"friction\[1\]"),
    ({"restitution": 1.1}, "restitution"),
    ({"law": "newtom"}, "did you mean 'newton'"),
    ({"law": ("newton",)}, "law"),
    ({"multiple": "both"}, "multiple"),
    ({"stiffness": 0.0}, "stiffness"),
    ({"exponent": 0.5}, "exponent"),
    ({"rtol": 0.5}, "rtol"),
]


@pytest.mark.parametrize(("change", "message"), BAD)
def test_bad_input(change, message):
    good = {
        "inverse_mass": np.eye(6),
        "velocity": -np.ones((2, 3)),
        "friction": 0.1,
        "restitution": 0.5,
    }
    with pytest.raises(ValueError, match=message):
        resolve_impacts(**{**good, **change})
