"""Numbers of the mathematics page (V4 to V10): one impact each, to the digits printed there."""

import numpy as np
import pytest
from cases import LAWS, U_SPACE, W_SPACE, planar

from carom.impact.api import resolve_impact
from carom.impact.slip_directions import critical_friction, invariant_directions
from verified import agree, verifies

DIGITS = 1e-11  # twelve decimals are printed; the last ones are off by up to five units

# (law, mu): velocity after; W_SPACE, u = (-1, .8, .5), e = .5 (V4).
V4 = {
    ("newton", 0.2): (0.5, 0.822494711356, 0.024340923781),
    ("poisson", 0.2): (0.492785218819, 0.822409353774, 0.026222271528),
    ("stronge", 0.2): (0.495145036520, 0.822437192882, 0.025606481775),
    ("newton", 0.5): (0.5, 0.113352256012, -0.082566678892),
    ("poisson", 0.5): (0.467931080278, 0.122222734816, -0.084707152203),
    ("stronge", 0.5): (0.479001381151, 0.119104218216, -0.084026339620),
    ("newton", 0.9): (0.5, 0.0, 0.0),
    ("poisson", 0.9): (0.545, 0.0, 0.0),
    ("stronge", 0.9): (0.524906766186, 0.0, 0.0),
}


@pytest.mark.plain
@pytest.mark.parametrize(("law", "mu"), V4)
def test_slip_and_stick_in_space(law, mu):
    impact = resolve_impact(W_SPACE, U_SPACE, mu, 0.5, law)
    np.testing.assert_allclose(impact.velocity_after, V4[law, mu], rtol=0, atol=DIGITS)
    assert impact.phases == (("slip", "stick") if mu == 0.9 else ("slip",))


def test_impulses_in_space():
    slip = resolve_impact(W_SPACE, U_SPACE, 0.2, 0.5)
    expected = (0.985442977802, -0.186686455497, -0.055448210884)
    np.testing.assert_allclose(slip.impulse, expected, rtol=0, atol=DIGITS)
    assert slip.energy_change == pytest.approx(-0.412346520871, abs=DIGITS)
    assert slip.compression_impulse[0] == pytest.approx(0.653759452461, abs=DIGITS)
    stick = resolve_impact(W_SPACE, U_SPACE, 0.9, 0.5)
    expected = (1.12313372933, -0.573125702359, 0.034837052496)
    np.testing.assert_allclose(stick.impulse, expected, rtol=0, atol=1e-11)
    assert stick.compression_impulse[0] == pytest.approx(0.769947021994, abs=DIGITS)


def test_slip_bends_past_rest():
    # mu < mu_crit: the hodograph turns close by u_t = 0 and leaves along the outgoing ray.
    newton = resolve_impact(W_SPACE, (-1, -0.2, 0.1), 0.25, 0.5)
    expected = (0.5, 0.075336546406, -0.061074650739)
    np.testing.assert_allclose(newton.velocity_after, expected, rtol=0, atol=DIGITS)
    stronge = resolve_impact(W_SPACE, (-1, -0.2, 0.1), 0.25, 0.5, "stronge")
    expected = (0.474413541324, 0.073633433358, -0.059693952531)
    np.testing.assert_allclose(stronge.velocity_after, expected, rtol=0, atol=DIGITS)
    assert newton.phases == ("slip",)


@verifies("impact.critical_friction", r"$\mu_c = \lvert W_{tt}^{-1} W_{tn}\rvert$", "closed form")
@verifies(
    "impact.invariant_directions",
    "directions in which slip keeps its direction",
    "own integration: roots of the hodograph",
)
def test_directions_and_critical_friction():
    agree(critical_friction(W_SPACE), 0.3207123399, atol=1e-10)
    rays = invariant_directions(W_SPACE, 0.2)
    agree(rays.angle, (2.760279, 5.624978), atol=1e-6)
    assert rays.outgoing.tolist() == [False, True]
    # The stick ratio of V4, for which |tau| is the critical friction.
    tau = -np.linalg.solve(W_SPACE[1:, 1:], W_SPACE[1:, 0])
    agree(tau, (-0.243181818182, 0.209090909091), atol=DIGITS)


def test_slip_from_rest_takes_the_outgoing_direction():
    impact = resolve_impact(W_SPACE, (-1, 0, 0), 0.2, 0.5)
    rays = invariant_directions(W_SPACE, 0.2)
    (angle,) = rays.angle[rays.outgoing]
    u = impact.velocity_after
    np.testing.assert_allclose(u[1:] / np.hypot(*u[1:]), (np.cos(angle), np.sin(angle)), atol=1e-13)


@verifies(
    'impact_law="{law}"',
    r"ball: $u_t^+ = u_t (1 - \tfrac72 \mu (1 + e) \lvert u_n\rvert/\lvert u_t\rvert)$, or 0",
    "closed form",
)
@pytest.mark.parametrize("law", LAWS)
def test_sphere(law):
    # V5, W = diag(1, 3.5, 3.5)/m: slip u_t (1 - 3.5 mu (1+e) |u_n|/|u_t|), or stick at u_t = 0.
    slip = resolve_impact(np.diag([1, 3.5, 3.5]), (-2, 1, 0.5), 0.05, 0.8, law)
    kept = 1 - 3.5 * 0.05 * 1.8 * 2 / np.hypot(1, 0.5)
    agree(slip.velocity_after, (1.6, kept, 0.5 * kept), rtol=1e-14)
    assert slip.velocity_after[1] == pytest.approx(0.436510869, abs=1e-9)
    stick = resolve_impact(np.diag([1, 3.5, 3.5]), (-2, 1, 0.5), 0.5, 0.8, law)
    agree(stick.velocity_after, (1.6, 0, 0), atol=1e-15)


V6 = {
    "newton": (0.5, -0.452845528456),
    "poisson": (0.46, -0.438211382114),
    "stronge": (0.463944441118, -0.439654470328),
}


@verifies('impact_law="{law}"', "rod whose slip reverses: Routh's method, by pieces", "closed form")
@pytest.mark.plain
@pytest.mark.parametrize("law", LAWS)
def test_rod_whose_slip_reverses(law):
    impact = resolve_impact(planar(2.5, -1.5, 2.5), (-1, 0.2, 0), 0.3, 0.5, law)
    agree(impact.velocity_after[:2], V6[law], atol=DIGITS)
    assert impact.phases == ("slip", "reversal")


def test_rod_that_leaves_faster_than_it_came():
    # V7: 60 degrees, mu = 1, e = .9; u_n+/|u_n-| of Poisson and Stronge is above 1.
    W = planar(1 + 3 * 0.25, -3 * np.sqrt(3) / 4, 1 + 3 * 0.75)
    for law, ratio in (("poisson", 1.079866814632), ("stronge", 1.055959796693)):
        impact = resolve_impact(W, (-1, -0.5, 0), 1.0, 0.9, law)
        assert impact.velocity_after[0] == pytest.approx(ratio, abs=DIGITS)


@verifies("resolve_impact", "rod at 45°: $E^+/E^- = 81/64$ by Newton's law", "closed form")
def test_newton_gains_energy_and_the_others_do_not():
    # V8: E+/E- = 81/64 for Newton; that is the law with friction, not an error.
    W, u = planar(2.5, -1.5, 2.5), np.array([-1, 0.6, 0])
    before = 0.5 * u[:2] @ np.linalg.solve(W[:2, :2], u[:2])
    ratio = {law: 1 + resolve_impact(W, u, 0.8, 0.9, law).energy_change / before for law in LAWS}
    agree(ratio["newton"], 81 / 64, rtol=1e-14)
    agree(ratio["poisson"], 0.5184, rtol=1e-13)
    assert ratio["stronge"] == pytest.approx(0.643371429, abs=1e-9)


# First impacts of the paper's die, m = .016, edge .02, J = m a^2/6, e = .5 (V9, V10).
DIE = {
    # Time of the first impact, arm of the corner, angular velocity; v = (.5, 0, -.5 - g t).
    "plane": (0.196210991904, (0.005430058093, 0.0, -0.013058118896), (0, 10, 0)),
    "space": (0.195621524091, (-0.006714252038, 0.006714252038, -0.014485773681), (10, 10, 0)),
}


def die(case, mu, law="newton"):
    """v+ and w+ of the die in world axes, and the impact."""
    mass, inertia, turn = 0.016, 0.016 * 0.02**2 / 6, np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    t, r, w = DIE[case]
    v = np.array([0.5, 0.0, -0.5 - 9.81 * t])
    hat = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
    W = turn @ (np.eye(3) / mass - hat @ hat / inertia) @ turn.T
    impact = resolve_impact(W, turn @ (v + np.cross(w, r)), mu, 0.5, law)
    P = turn.T @ impact.impulse
    return v + P / mass, w + np.cross(r, P) / inertia, impact


@pytest.mark.parametrize(
    ("case", "mu", "v", "w"),
    [
        ("plane", 0.05, (0.36614761225, 0, 0.252217924424), (0, -181.829966521, 0)),
        ("plane", 0.2, (-0.104880400909, 0, 0.599572173967), (0, -117.861175844, 0)),
        (
            "space", 0.05,
            (0.528582186665, -0.062722126057, -0.905573683307),
            (148.79895691882, 156.217108451561, 3.438362364711),
        ),
        (
            "space", 0.2,
            (0.678863048248, -0.26376962503, -0.68768930434),
            (127.057987913752, 145.50704974308, 8.551262343217),
        ),
    ],
)  # fmt: skip
def test_first_impact_of_the_die(case, mu, v, w):
    # r_c is printed with nine digits: that bounds v+ to 1e-9 and w+ to 1e-7 (lever arms in mm).
    after, spin, impact = die(case, mu)
    np.testing.assert_allclose(after, v, rtol=0, atol=2e-9)
    np.testing.assert_allclose(spin, w, rtol=0, atol=2e-6)
    assert impact.phases == ("slip",)


def test_die_in_space_by_the_other_laws():
    for law, u_n in (("stronge", 1.110828064109), ("poisson", 1.108096434391)):
        assert die("space", 0.2, law)[2].velocity_after[0] == pytest.approx(u_n, abs=2e-9)


def test_jam_passes_through():
    # Painleve rod (§3.6), an impact without collision: slip stops at p = .2563470311.
    W = planar(1.75, 1.299038105677, 3.25)
    impact = resolve_impact(W, (-1e-9, 1, 0), 1.6, 0.5, "stronge")
    assert impact.phases == ("slip", "jam", "stick")
    np.testing.assert_allclose(impact.velocity_after, (0.0917266009, 0, 0), atol=1e-8)
    np.testing.assert_allclose(impact.impulse[:2], (0.3992873896, -0.4672890884), atol=1e-8)
