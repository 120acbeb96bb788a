"""Impacts of bodies with few freedoms: W of rank 1 to 3, regular or nearly singular, all laws (§1.9)."""

import numpy as np
import pytest
from cases import LAWS, W_SPACE, planar
from singular_cases import EPS, draw, follow, least_in_cone, resolve_all

from carom.impact import layout as o
from carom.impact.api import resolve_impact
from carom.impact.history import impact_layer


def on_a_slide(degrees):
    """W and u of a body of 1 kg that moves along a slide inclined by so much, at 1 m/s towards the plane."""
    n, t = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return planar(n * n, n * t, t * t), np.array([-n, -t, 0.0])


@pytest.fixture(scope="module")
def many():
    given = draw(np.random.default_rng(0), 100_000)
    return given, *resolve_all(*given[:5])


@pytest.mark.plain
@pytest.mark.parametrize("law", LAWS)
def test_body_on_a_slide_wedges(law):
    # Rank 1: p_c = v0/(W_nn + mu |W_nt|), slip and approach end together. In restitution u_n' would be
    # W_nn - mu |W_nt| < 0: nothing moves, whatever the impulse is.
    W, u = on_a_slide(60)
    impact = resolve_impact(W, u, 1.0, 0.5, law)
    p_c = 0.5 / (W[0, 0] + W[0, 1])
    assert impact.wedged
    assert "wedged" in impact.phases
    np.testing.assert_allclose(impact.velocity_after, 0.0, atol=4 * EPS)
    np.testing.assert_allclose(impact.compression_impulse, [p_c, p_c, 0], rtol=4 * EPS)
    whole = 1.5 if law == "poisson" else 1.0
    assert impact.impulse[0] == pytest.approx(whole * p_c, rel=4 * EPS)
    assert impact.energy_change == pytest.approx(-0.5, rel=4 * EPS)  # all of 1/2 m v^2
    assert impact.restitution_work == pytest.approx(0.0, abs=1e-15)


@pytest.mark.plain
@pytest.mark.parametrize("law", LAWS)
def test_body_on_a_slide_below_the_critical_friction(law):
    # u is linear in p in each phase: slopes k = W_nn +- mu |W_nt|.
    (W, u), mu, e = on_a_slide(60), 0.4, 0.5
    there, back = W[0, 0] + mu * W[0, 1], W[0, 0] - mu * W[0, 1]
    p_c = 0.5 / there
    p_r = {"newton": e * 0.5 / back, "poisson": e * p_c, "stronge": e * 0.5 / np.sqrt(back * there)}
    impact = resolve_impact(W, u, mu, e, law)
    assert not impact.wedged
    np.testing.assert_allclose(impact.impulse[0], p_c + p_r[law], rtol=1e-14)
    np.testing.assert_allclose(impact.velocity_after[0], p_r[law] * back, rtol=1e-14)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("offset", [0.0, 1e-16, -1e-16, 1e-14, -1e-14, 1e-12, -1e-12, -1e-10])
def test_friction_within_round_off_of_critical(law, offset):
    # A slide of 45 degrees and mu = 1: below the critical value by 1e-12, Newton's law asks for 1e12 times
    # the impulse of compression, of which no energy can be told.
    W, u = on_a_slide(45)
    impact = resolve_impact(W, u, 1.0 + offset, 0.5, law)
    most = {"newton": 1.0, "poisson": 1.5, "stronge": 1e6}[law]
    assert impact.impulse[0] <= most * impact.compression_impulse[0] * (1 + 1e-12)
    assert impact.energy_change == pytest.approx(-0.5, abs=1e-6)


def test_what_is_driven_against_a_wedge_is_refused():
    # z = (1, -cot 60, 0): W z = 0, z.u < 0. No impulse stops it, and mu holds it.
    W, u = on_a_slide(60)
    with pytest.raises(ValueError, match="wedged and still approaches"):
        resolve_impact(W, u + [-0.5, 0, 0], 1.0, 0.5)
    assert (
        resolve_impact(W, u + [-0.5, 0, 0], 0.1, 0.5).velocity_after[0] > 0
    )  # less friction: it slips


@pytest.mark.parametrize("law", LAWS)
def test_ends_of_the_ranges(law):
    W, u = on_a_slide(60)
    none = resolve_impact(W, u, 1.0, 0.0, law)  # e = 0 ends with compression: no law is missed
    assert not none.wedged
    np.testing.assert_array_equal(none.impulse, none.compression_impulse)
    smooth = resolve_impact(W, u, 0.0, 0.5, law)
    np.testing.assert_allclose(smooth.velocity_after, -0.5 * u, rtol=1e-14)
    slow = resolve_impact(W, 1e-12 * u, 1.0, 0.5, law)
    np.testing.assert_allclose(
        slow.impulse, 1e-12 * resolve_impact(W, u, 1.0, 0.5, law).impulse, rtol=1e-14
    )
    grazing = resolve_impact(W_SPACE, (-1e-12, 0.8, 0.5), 0.2, 0.5, law)  # k > 0: hardly an impulse
    assert 0.0 < grazing.impulse[0] < 1e-11


def test_all_that_must_hold_of_any_impact(many):
    (W, u, mu, e, law, _), code, out = many
    assert set(code) <= {o.OK, o.NO_END, o.TOO_MANY_STEPS}
    assert np.mean(code == o.TOO_MANY_STEPS) < 1e-4
    W, u, mu, e, law, out = (x[code == o.OK] for x in (W, u, mu, e, law, out))
    after, P, P_c = out[:, 0:3], out[:, 3:6], out[:, 6:9]
    assert np.isfinite(out).all()
    assert (after[:, 0] >= 0.0).all()

    # u+ = u- + W P; slower approach than 1e-9 of the speed counts as none where the pair is wedged.
    terms = np.einsum("nij,nj->ni", np.abs(W), np.abs(P))
    size = np.linalg.norm(u, axis=1) + np.max(terms, axis=1)
    error = np.max(np.abs(after - u - np.einsum("nij,nj->ni", W, P)), axis=1)
    assert np.max(error / size) < 2e-9
    assert np.mean(error / size > 1e-12) < 1e-3
    assert np.all(np.hypot(*P[:, 1:].T) <= (mu + 1e-9 * (1 + mu)) * P[:, 0])

    # dE = A_c + A_r - loss, but for the round-off of P.W P; only Newton's law may gain.
    works, loss = out[:, [o.WORK_C, o.WORK_R]], out[:, o.FRICTION_LOSS]
    square = np.sum(np.abs(P) * terms, axis=1)
    turned = np.abs(works).sum(axis=1) + loss
    change = out[:, o.ENERGY_CHANGE]
    assert np.all(loss >= 0)
    assert np.all(np.abs(works.sum(axis=1) - loss - change) <= 1e-7 * turned + 1e5 * EPS * square)
    assert np.all(change[law > 0] <= 1e-12 * turned[law > 0] + 1e2 * EPS * square[law > 0])

    # What each law says: its goal, or wedged with what was reached.
    wedged = out[:, o.PHASES].astype(int) & o.WEDGED != 0
    meets = ~wedged & (law == 0)
    assert np.all(np.abs(after[:, 0] + e * u[:, 0])[meets] <= 1e-10 * size[meets])
    poisson = law == 1
    np.testing.assert_allclose(P[poisson, 0], ((1 + e) * P_c[:, 0])[poisson], rtol=1e-14)
    stronge = ~wedged & (law == 2) & (works[:, 0] < -1e-3 * loss)
    missed = np.abs(works[:, 1] + e**2 * works[:, 0])[stronge]
    assert np.all(missed <= (1e-8 * np.abs(works[:, 0]) + 1e-12 * turned)[stronge])
    assert np.all(
        after[wedged, 0] <= -u[wedged, 0] * e[wedged] * (1 + 1e-9) + (law > 0)[wedged] * 1e300
    )
    assert wedged.sum() > 1000


def test_no_impulse_is_greater_than_what_stops_the_body(many):
    # Coulomb: k = z.W z + mu d|u_t|/dp with z = (1, tau), |tau| <= mu, in slip and in stick. So over any impact
    #     s p <= (1 + e') v0 + mu (|u_t-| - |u_t+|),   s = min z.W z in the cone,   e' v0 = u_n+,
    # which is (1 + e') times v0/s, what stops the inverse mass s, and what the slip has to give.
    (W, u, mu, e, law, sound), code, out = many
    W, u, mu, e, law, out, sound = (x[code == o.OK] for x in (W, u, mu, e, law, out, sound))
    after, p, p_c = out[:, 0:3], out[:, o.IMPULSE], out[:, o.P_C]
    slip = np.linalg.norm(u[:, 1:], axis=1) - np.linalg.norm(after[:, 1:], axis=1)
    least = least_in_cone(W, mu)
    terms = np.einsum("nij,nj->ni", np.abs(W), np.abs(out[:, 3:6]))
    size = np.linalg.norm(u, axis=1) + np.max(terms, axis=1)
    room = (1e-9 + 1e2 * EPS * (1 + mu)) * size * (1 + mu)
    assert np.all(least * p <= after[:, 0] - u[:, 0] + mu * slip + room)

    # Wedged without any rebound, s = 0: what compression took, and by Poisson's law e times that again.
    wedged = out[:, o.PHASES].astype(int) & o.WEDGED != 0
    wedged &= out[:, o.WORK_R] <= -1e-12 * out[:, o.WORK_C]
    assert wedged.sum() > 10_000
    whole = np.where(law == 1, 1 + e, 1.0)
    np.testing.assert_allclose(p[wedged], (whole * p_c)[wedged], rtol=1e-5)

    # And that of compression: d sqrt(2 E)/dp <= -min(1, mu) sqrt(lambda), the least eigenvalue that is not 0,
    # for what moves in the range of W alone.
    jams = out[:, o.PHASES].astype(int) & o.PHASE_JAM != 0
    of = sound & ~jams & (mu > 0.0)
    values, V = np.linalg.eigh(W[of])
    keeps = values > 1e-12 * values[:, -1:]
    values = np.where(keeps, values, np.inf)
    energy = np.sum(np.einsum("nij,ni->nj", V, u[of]) ** 2 / values, axis=1)
    smallest = np.min(values, axis=1)
    most = np.sqrt(energy / smallest) / np.minimum(1.0, mu[of])
    assert np.all(p_c[of] <= most * (1 + 1e-6))


def test_what_moves_in_the_range_of_w_always_ends(many):
    # Rank 1 and 2, u = W x: z.u = 0 wherever W z = 0, so nothing is driven, and nothing is refused.
    (_, _, _, _, _, sound), code, _ = many
    assert sound.sum() > 20_000
    assert np.all(code[sound] == o.OK)


def test_the_path_of_an_independent_integrator():
    # Steps of p/4000 with stick by projection, each located to a step: what one step changes is the error.
    given = draw(np.random.default_rng(1), 3000)
    W, u, mu, e, law = (x[given[5]] for x in given[:5])
    W, u, mu, e, law = (x[mu < 30][:400] for x in (W, u, mu, e, law))
    code, out = resolve_all(W, u, mu, e, law)
    p = out[:, o.IMPULSE]
    step = (1.0 + mu) * p * np.trace(W.T) / 4000
    keeps = (code == o.OK) & (step < 0.02 * np.linalg.norm(u, axis=1))  # else steps too long
    W, u, mu, out, p, step = (x[keeps] for x in (W, u, mu, out, p, step))
    assert len(p) > 300
    speed = np.linalg.norm(u, axis=1)
    after, _, work = follow(W, u, mu, p, 4000, speed)
    assert np.all(np.max(np.abs(after - out[:, 0:3]), axis=1) <= 2.0 * step)
    total = out[:, o.WORK_C] + out[:, o.WORK_R]
    assert np.all(np.abs(work - total) <= 2.0 * step * p)
    # Beyond a wedge nothing moves: the same impulse again. Not where mu is critical to 1e-6, k of that size.
    tau = np.einsum("nij,nj->ni", np.linalg.pinv(W[:, 1:, 1:], 1e-10), W[:, 1:, 0])
    wedged = (out[:, o.PHASES].astype(int) & o.WEDGED != 0) & (mu > 1.001 * np.hypot(*tau.T))
    assert wedged.sum() > 50
    again, _, _ = follow(W[wedged], out[wedged, 0:3], mu[wedged], p[wedged], 100, speed[wedged])
    assert np.all(np.max(np.abs(again - out[wedged, 0:3]), axis=1) <= 1e-12 * speed[wedged])


def test_scales_do_not_matter(many):
    # Powers of two: the same bits; others to round-off of the path. From 1e-90 to 1e90.
    given, code, out = many
    for w, v in ((2.0**300, 2.0**-200), (2.0**-300, 2.0**100)):
        W, u, mu, e, law = (x[:3000] for x in given[:5])
        there, scaled = resolve_all(W * w, u * v, mu, e, law)
        np.testing.assert_array_equal(there, code[:3000])
        ok = there == o.OK
        np.testing.assert_array_equal(scaled[ok, :3], out[:3000][ok, :3] * v)
        np.testing.assert_array_equal(scaled[ok, 3:9], out[:3000][ok, 3:9] * (v / w))
        np.testing.assert_array_equal(scaled[ok, 9:13], out[:3000][ok, 9:13] * (v * (v / w)))


@pytest.mark.parametrize("law", LAWS)
def test_layer_of_what_wedges(law):
    # The spline ends with compression, at the depth delta b, and has the impulse of the resolver.
    W, u = on_a_slide(60)
    layer = impact_layer(W, u, 1.0, 0.5, law=law, penetration=0.25, width=1e-3)
    exact = resolve_impact(W, u, 1.0, 0.5, law)
    np.testing.assert_allclose(layer.velocity_after, 0.0, atol=1e-14)
    np.testing.assert_allclose(layer.impulse, exact.impulse, rtol=1e-13)
    assert layer.x[-1] == pytest.approx(0.75e-3, rel=1e-12)
    assert np.isfinite(layer.t).all()
    assert layer.phases == exact.phases
