"""What every impact must satisfy (V15), on random problems, and refused input."""

import subprocess
import sys

import numpy as np
import pytest
from cases import KNOWN, LAWS, U_SPACE, W_SPACE, problems
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.impact.api import resolve_impact
from carom.impact.slip_directions import critical_friction, invariant_directions
from carom.law.impact_laws import GAINING, NUMBERS
from verified import agree, verifies

laws = st.sampled_from(LAWS)
few = settings(max_examples=40, deadline=None)


def kinetic(W, u):
    return 0.5 * u @ np.linalg.solve(W, u)


@verifies("resolve_impact", "$u^+ = u^- + W P$, energy by works of the force", "invariant")
@pytest.mark.plain
@few
@given(problem=problems(), law=laws)
def test_momentum_work_energy_and_cone(problem, law):
    W, u, mu, e = problem
    a = resolve_impact(W, u, mu, e, law)
    # u+ = u- + W P;  |P_t| <= mu P_n;  dE = A_c + A_r - friction loss = E(u+) - E(u-).
    size = np.linalg.norm(u) + np.linalg.norm(a.velocity_after)
    agree(a.velocity_after, u + W @ a.impulse, atol=1e-10 * size)
    # Slip below 1e-12 of the speed counts as rest: that much goes into the impulse.
    assert np.hypot(*a.impulse[1:]) <= (mu + 1e-9) * a.impulse[0]
    scale = abs(a.compression_work) + a.restitution_work + a.friction_loss
    ledger = a.compression_work + a.restitution_work - a.friction_loss
    agree(a.energy_change, ledger, atol=1e-10 * scale)
    change = kinetic(W, a.velocity_after) - kinetic(W, u)
    agree(a.energy_change, change, atol=1e-8 * kinetic(W, u))
    # Where strong coupling compresses again, compression ends with the last zero of u_n; only
    # Stronge's law then keeps the work before it negative.
    if law == "stronge" or "jam" not in a.phases:
        assert a.compression_work < 0
    assert a.restitution_work >= -1e-15 * scale  # e near round-off
    assert a.friction_loss >= 0


@few
@given(problem=problems())
def test_each_law_says_what_it_says(problem):
    W, u, mu, e = problem
    newton, poisson, stronge = (resolve_impact(W, u, mu, e, law) for law in KNOWN)
    assert newton.velocity_after[0] == pytest.approx(-e * u[0], rel=1e-11, abs=1e-14)
    p_c = poisson.compression_impulse[0]
    assert poisson.impulse[0] == pytest.approx((1 + e) * p_c, rel=1e-11)
    lost = -stronge.compression_work
    assert stronge.restitution_work == pytest.approx(e**2 * lost, rel=1e-9, abs=1e-13 * lost)
    if (
        "jam" not in newton.phases
    ):  # where it compresses again, compression ends with the last zero of u_n
        both = newton.compression_impulse, stronge.compression_impulse
        np.testing.assert_allclose(*both, rtol=1e-12)


@few
@given(problem=problems(), law=laws.filter(lambda law: NUMBERS[law] not in GAINING))
def test_energy_never_grows(problem, law):
    # Stronge: A_r = e^2 |A_c| <= |A_c| and friction dissipates. Poisson: proven for one contact.
    W, u, mu, e = problem
    assert resolve_impact(W, u, mu, e, law).energy_change <= 1e-12 * kinetic(W, u)


@few
@given(problem=problems(), law=laws, angle=st.floats(0, 6.28), mirror=st.booleans())
def test_tangent_axes_do_not_matter(problem, law, angle, mirror):
    W, u, mu, e = problem
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
    if mirror:
        turn = np.diag([1.0, 1.0, -1.0]) @ turn
    a = resolve_impact(W, u, mu, e, law)
    b = resolve_impact(turn @ W @ turn.T, turn @ u, mu, e, law)
    size = np.linalg.norm(u) + np.linalg.norm(a.velocity_after)
    np.testing.assert_allclose(b.velocity_after, turn @ a.velocity_after, atol=1e-7 * size)
    np.testing.assert_allclose(b.impulse[0], a.impulse[0], rtol=1e-7)


@few
@given(problem=problems(), law=laws, mass=st.floats(1e-6, 1e6), speed=st.floats(1e-6, 1e6))
def test_units_do_not_matter(problem, law, mass, speed):
    # u -> c u, W -> W/m: u+ -> c u+, P -> c m P, energies -> c^2 m.
    W, u, mu, e = problem
    a = resolve_impact(W, u, mu, e, law)
    b = resolve_impact(W / mass, speed * u, mu, e, law)
    size = np.linalg.norm(u) + np.linalg.norm(a.velocity_after)
    np.testing.assert_allclose(b.velocity_after / speed, a.velocity_after, atol=1e-7 * size)
    np.testing.assert_allclose(b.impulse[0] / (speed * mass), a.impulse[0], rtol=1e-7)
    loss = b.friction_loss / (speed**2 * mass)
    assert loss == pytest.approx(a.friction_loss, rel=1e-6, abs=1e-9 * kinetic(W, u))


@verifies("resolve_impact", r"$P = (1 + e)\,\lvert u_n\rvert/W_{nn}$", "closed form")
@few
@given(problem=problems(), law=st.sampled_from(KNOWN))
def test_without_friction(problem, law):
    # mu = 0: P = (1+e) |u_n|/W_nn along the normal, each law.
    W, u, _, e = problem
    impact = resolve_impact(W, u, 0.0, e, law)
    agree(impact.impulse, [-(1 + e) * u[0] / W[0, 0], 0, 0], rtol=1e-12)
    assert impact.friction_loss == 0.0


@few
@given(problem=problems(), law=laws)
def test_no_restitution(problem, law):
    W, u, mu, _ = problem
    impact = resolve_impact(W, u, mu, 0.0, law)
    assert impact.velocity_after[0] == 0.0
    assert impact.restitution_work == 0.0
    np.testing.assert_array_equal(impact.impulse, impact.compression_impulse)


@few
@given(problem=problems())
def test_one_direction_leads_away_below_the_critical_friction(problem):
    # The ray in which slip starts from rest is an invariant direction, the outgoing one.
    W, _, mu, _ = problem
    mu_c = critical_friction(W)
    impact = resolve_impact(W, (-1, 0, 0), mu, 0.5)
    if mu == 0:
        assert impact.phases == ()
    elif mu >= mu_c:
        assert impact.phases == ("stick",)
    elif mu < 0.99 * mu_c and mu > 1e-3:
        rays = invariant_directions(W, mu)
        e = impact.velocity_after[1:] / np.hypot(*impact.velocity_after[1:])
        near = np.cos(rays.angle) * e[0] + np.sin(rays.angle) * e[1]
        assert rays.outgoing[np.argmax(near)]
        assert np.max(near) == pytest.approx(1.0, abs=1e-9)


def test_particle_on_a_rail():
    # Nothing moves in the tangent plane: u_t is kept, friction only dissipates mu int |u_t| dp.
    impact = resolve_impact(np.diag([2.0, 0, 0]), (-1, 3, 4), 0.5, 0.5)
    np.testing.assert_allclose(impact.velocity_after, (0.5, 3, 4), rtol=1e-14)
    assert impact.friction_loss == pytest.approx(0.5 * 5 * 0.75, rel=1e-13)
    rest = resolve_impact(np.diag([2.0, 0, 0]), (-1, 0, 0), 0.5, 0.5)
    np.testing.assert_allclose(rest.impulse, (0.75, 0, 0), rtol=1e-14)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inverse_mass": np.eye(2)}, r"velocity must have shape \(\.\.\., 2\)"),
        ({"inverse_mass": W_SPACE + [[0, 1, 0], [0, 0, 0], [0, 0, 0]]}, "symmetric"),
        ({"inverse_mass": np.diag([1.0, -1, 1])}, "positive semidefinite"),
        ({"inverse_mass": np.diag([0.0, 1, 1])}, r"inverse_mass\[0, 0\]"),
        ({"inverse_mass": np.diag([np.nan, 1, 1])}, "finite"),
        ({"velocity": (1, 0, 0)}, "approach is negative"),
        ({"velocity": (0, 0, 0)}, "approach is negative"),
        ({"velocity": (-1, np.inf, 0)}, "finite"),
        ({"friction": -0.1}, "friction must be finite and at least 0"),
        ({"restitution": 1.1}, "at most 1"),
        ({"law": "newtn"}, "did you mean 'newton'"),
    ],
)
def test_bad_input(change, message):
    arguments = {
        "inverse_mass": W_SPACE,
        "velocity": U_SPACE,
        "friction": 0.2,
        "restitution": 0.5,
        **change,
    }
    with pytest.raises(ValueError, match=message):
        resolve_impact(**arguments)


def test_import_is_light():
    names = "api, slip_directions, geometry, history"
    code = f"import sys; from carom.impact import {names}; assert 'numba' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
