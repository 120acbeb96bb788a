"""The boundary layer in time: closed forms, order, agreement with the resolver, invariants."""

import numpy as np
import pytest
from cases import KNOWN, LAWS, U_SPACE, W_SPACE, planar
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.impact.api import resolve_impact
from carom.impact.geometry import NormalMotion
from carom.impact.history import impact_layer
from verified import agree, verifies

B = 1e-3
ROUND_OFF = 1e-13


def pass_layer(W, u, mu, e, law="newton", steps=2, delta=0.8, width=B):
    return impact_layer(W, u, mu, e, penetration=delta, width=width, law=law, steps=steps)


@verifies("impact_layer", "law A: the depth is a parabola in each phase", "closed form")
@pytest.mark.plain
@pytest.mark.parametrize("law", LAWS)
def test_two_steps_are_exact_for_e_1(law):
    # Law A: s is a parabola in each phase, so the cubic of one step a phase is exact (§1.8, §1.11).
    layer = pass_layer(np.diag([2.0, 1, 1]), (-3, 0, 0), 0.3, 1.0, law)
    exact = NormalMotion(3.0, 1.0, B, 0.8)
    assert len(layer.t) == 3
    t = np.linspace(0, layer.duration, 101)
    x, u = layer.evaluate(t)
    agree(x / B, exact.x(t) / B, atol=ROUND_OFF)
    agree(u[:, 0] / 3, exact.normal_velocity(t) / 3, atol=ROUND_OFF)
    assert np.all(u[:, 1:] == 0)


@verifies("impact_layer", r"$x_{\min} = (1 - \delta)\,b$, duration $T_c (1 + 1/e)$", "closed form")
@settings(max_examples=40, deadline=None)
@given(e=st.floats(1e-3, 1.0), delta=st.floats(0.01, 0.99), law=st.sampled_from(KNOWN))
def test_exit_speed_depth_and_duration(e, delta, law):
    # Without coupling all laws part with e v0; x_min = (1-delta) b; duration T_c (1 + 1/e).
    v0, W = 1.7, np.diag([0.5, 2.0, 3.0])
    layer = pass_layer(W, (-v0, 0.3, 0.1), 0.1, e, law, delta=delta)
    agree(layer.velocity_after[0], e * v0, rtol=1e-12)
    agree(np.min(layer.x), (1 - delta) * B, rtol=1e-12)
    agree(layer.x[[0, -1]], B, rtol=1e-12)
    t_c = -2 * B * np.log1p(-delta) / v0
    agree(layer.duration, t_c * (1 + 1 / e), rtol=1e-12)
    # N = m_n a (b/x) is constant in s: m_n a_c in compression, e^2 of it in restitution.
    agree(layer.normal_force[0], v0 / t_c / W[0, 0], rtol=1e-12)
    agree(layer.normal_force[-1], e**2 * v0 / t_c / W[0, 0], rtol=1e-11)


# Orders 4 (§1.11): errors of u+ at 1, 2, 4, 8 steps a phase as the mathematics page prints them.
@verifies("impact_layer", "errors of order 4 in the number of steps", "closed form")
def test_order_in_space():
    exact = resolve_impact(W_SPACE, U_SPACE, 0.2, 0.5).velocity_after
    errors = np.array([
        np.max(np.abs(pass_layer(W_SPACE, U_SPACE, 0.2, 0.5, steps=2 * n).velocity_after - exact))
        for n in (1, 2, 4, 8)
    ])  # fmt: skip
    agree(errors, (5.4e-6, 3.2e-7, 2.0e-8, 1.25e-9), rtol=0.02)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("mu", [0.2, 0.5])
def test_order_of_every_law(law, mu):
    exact = resolve_impact(W_SPACE, U_SPACE, mu, 0.5, law).velocity_after
    errors = [
        np.max(np.abs(pass_layer(W_SPACE, U_SPACE, mu, 0.5, law, steps=n).velocity_after - exact))
        for n in (16, 32, 64)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.8)
    assert errors[-1] < 1e-9


@pytest.mark.parametrize("law", LAWS)
def test_stick_and_planar_reversal_need_two_steps(law):
    # Straight pieces split where slip ends: exact, as in the impulse form.
    for W, u, mu in (
        (planar(2.5, -1.5, 2.5), (-1, 0.2, 0), 0.3),
        (planar(2.5, -1.5, 2.5), (-1, 0.6, 0), 0.8),
        (W_SPACE, (-1, 0, 0), 0.9),
    ):
        layer, impact = pass_layer(W, u, mu, 0.5, law), resolve_impact(W, u, mu, 0.5, law)
        np.testing.assert_allclose(layer.velocity_after, impact.velocity_after, atol=1e-13)
        np.testing.assert_allclose(layer.impulse, impact.impulse, atol=1e-13)
        assert layer.energy_change == pytest.approx(impact.energy_change, abs=1e-13)
        assert layer.phases == impact.phases


def test_slip_to_stick_in_space():
    exact = resolve_impact(W_SPACE, U_SPACE, 0.9, 0.5)
    layer = pass_layer(W_SPACE, U_SPACE, 0.9, 0.5)
    np.testing.assert_allclose(layer.velocity_after, exact.velocity_after, atol=1e-14)
    assert pass_layer(W_SPACE, U_SPACE, 0.9, 0.5, steps=64).energy_change == pytest.approx(
        exact.energy_change, abs=1e-5
    )


def test_sharp_turn_is_followed():
    # Slip passes u_t = 0 at 3e-4 of the speed: steps are halved there, two in all are asked for.
    exact = resolve_impact(W_SPACE, (-1, -0.2, 0.1), 0.25, 0.5)
    layer = pass_layer(W_SPACE, (-1, -0.2, 0.1), 0.25, 0.5)
    np.testing.assert_allclose(layer.velocity_after, exact.velocity_after, atol=1e-3)


def test_jam_goes_through_the_impulse_form():
    # k(tau) < 0 at first: law A has no force there; constant force a phase, depth delta b still.
    W = planar(1.75, 1.299038105677, 3.25)
    layer, impact = (f(W, (-0.01, 1, 0), 1.6, 0.5) for f in (pass_layer, resolve_impact))
    assert layer.phases == ("slip", "jam", "stick")
    np.testing.assert_allclose(layer.velocity_after, impact.velocity_after, atol=1e-13)
    assert np.min(layer.x) == pytest.approx(0.2 * B, rel=1e-12)
    assert layer.x[-1] == pytest.approx(B, rel=1e-12)


@pytest.mark.parametrize("law", LAWS)
def test_no_restitution_ends_with_compression(law):
    for e in (0.0, 1e-7):
        layer = pass_layer(W_SPACE, U_SPACE, 0.2, e, law)
        assert layer.velocity_after[0] == 0.0
        assert layer.x[-1] == pytest.approx(0.2 * B, rel=1e-12)


@settings(max_examples=25, deadline=None)
@given(
    delta=st.floats(0.05, 0.95),
    width=st.floats(1e-6, 1.0),
    law=st.sampled_from(LAWS),
    mu=st.sampled_from([0.1, 0.2, 0.5]),
)
def test_result_does_not_depend_on_the_layer(delta, width, law, mu):
    # V15: b and delta scale the time, not the velocities.
    a = pass_layer(W_SPACE, U_SPACE, mu, 0.5, law, steps=4)
    b = pass_layer(W_SPACE, U_SPACE, mu, 0.5, law, steps=4, delta=delta, width=width)
    np.testing.assert_allclose(a.velocity_after, b.velocity_after, rtol=0, atol=1e-12)
    np.testing.assert_allclose(a.impulse, b.impulse, rtol=0, atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(law=st.sampled_from(LAWS), mu=st.floats(0, 1.5), x=st.floats(-1, 1), y=st.floats(-1, 1))
def test_momentum_of_the_layer(law, mu, x, y):
    # u+ = u- + W P to round-off at any number of steps: u is built from the impulse.
    u = np.array([-1.0, x, y])
    layer = pass_layer(W_SPACE, u, mu, 0.6, law)
    np.testing.assert_allclose(layer.velocity_after, u + W_SPACE @ layer.impulse, atol=1e-11)
    assert np.hypot(*layer.impulse[1:]) <= mu * layer.impulse[0] * (1 + 1e-12) + 1e-14


def test_evaluate_meets_the_knots():
    layer = pass_layer(W_SPACE, U_SPACE, 0.5, 0.5, "stronge", steps=8)
    x, u = layer.evaluate(layer.t)
    np.testing.assert_allclose(x, layer.x, rtol=1e-13)
    np.testing.assert_allclose(u, layer.velocity, atol=1e-12)
    with pytest.raises(ValueError, match="within"):
        layer.evaluate(2 * layer.duration)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"penetration": 1.0}, "penetration"),
        ({"penetration": 0.0}, "penetration"),
        ({"width": 0.0}, "width"),
        ({"steps": 1}, "steps"),
        ({"steps": 2.0}, "steps"),
        ({"law": "stronge "}, "did you mean 'stronge'"),
    ],
)
def test_bad_input(change, message):
    arguments = {"penetration": 0.2, "width": B, **change}
    with pytest.raises(ValueError, match=message):
        impact_layer(W_SPACE, U_SPACE, 0.2, 0.5, **arguments)
