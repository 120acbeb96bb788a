"""The die of the paper on its edge and on its face: numbers of the mathematics page (W2, W5, W6)."""

import numpy as np
import pytest
from multiple_cases import DIE, EDGE, Body, unlike

from verified import agree, verifies

HALF = EDGE / 2
FALL = np.array([0.3, 0.1, -2, 3, 1, 5])

# v, w after of FALL, e = .5, Stronge; energy; digits printed.
FACE = {
    0.05: (
        (0.158987569, 0.055841910, 1.002983212, 0.796412609, -5.105332165, 1.146848659),
        -0.024528760375,
        2e-9,
    ),
    0.3: ((-0.01212216, 0.00380636, 1.00996182, 0.7625874, -4.6700776, 0.0675522), -0.02464524782, 8e-8),
    1.0: (
        (-0.041779868, -0.007604862, 1.008351353, 0.76048621, -4.1779868, 0),
        -0.02466044184,
        3e-8,
    ),
}  # fmt: skip


@pytest.mark.parametrize("mu", FACE)
def test_face(mu):
    v, energy, digits = FACE[mu]
    after, impact = DIE.strike(FALL, mu, 0.5, "stronge", rtol=1e-10)
    np.testing.assert_allclose(after, v, rtol=0, atol=digits)
    assert impact.energy_change == pytest.approx(energy, abs=2e-11)


# v, w after of FALL by the other laws, e = .5, mu = .3. Newton turns u_n of every corner: w_x -> -e w_x.
LAWS = {
    "poisson": (-0.010176825, 0.003915104, 1.006974478, 0.697051563, -4.227818638, 0.063059014),
    "newton": (0.007005787, 0.016313729, 1.0, -1.5, -0.5, 0.0010056),
}


@pytest.mark.parametrize("law", LAWS)
def test_laws_on_the_face(law):
    # The numbers were found with e_* to 1e-7; for Newton e_* is not unique (redundant corners).
    after, impact = DIE.strike(FALL, 0.3, 0.5, law, rtol=1e-9)
    np.testing.assert_allclose(after[:3], LAWS[law][:3], rtol=0, atol=3e-7)
    np.testing.assert_allclose(after[3:], LAWS[law][3:], rtol=0, atol=3e-5)
    if law == "newton":
        np.testing.assert_allclose(after[2:5], (1, -1.5, -0.5), rtol=0, atol=1e-6)
    assert impact.law_missed == 0
    assert impact.energy_change < 0


@verifies(
    'multiple="simultaneous"',
    "a die that falls flat: $v^+ = e v$, a quarter of the impulse at each corner",
    "closed form",
)
@pytest.mark.parametrize("stiffness", [None, unlike(4)], ids=["as one", "full"])
@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_flat(law, stiffness):
    # Falls flat: e of 2 m/s comes back, each corner bears a quarter of m (1 + e) v = .048.
    after, impact = DIE.strike(
        np.array([0, 0, -2.0, 0, 0, 0]), 0.3, 0.5, law, stiffness=stiffness, rtol=1e-10
    )
    agree(after, (0, 0, 1, 0, 0, 0), atol=1e-9)
    agree(impact.impulse, [(0.012, 0, 0)] * 4, atol=1e-11)


def test_one_stiff_corner():
    after, _ = DIE.strike(
        np.array([0, 0, -2.0, 0, 0, 0]), 0.2, 0.5, "stronge", stiffness=(10, 1, 1, 1), rtol=1e-10
    )
    expected = (0.1500051887, 0.1500051887, 0.7623589109, 25.5165580482, -25.5165580482, 0)
    np.testing.assert_allclose(after[:3], expected[:3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(after[3:], expected[3:], rtol=0, atol=1e-7)


# V9: the die of the paper strikes with an edge; its two vertices are the contact.
CENTRE = np.array([0.005430058093, 0.0, -0.013058118896])
BEFORE = np.array([0.5, 0, -2.424829830578, 0, 10, 0])
EDGE_STRIKE = {
    0.05: (0.366147612250, 0, 0.252217924424, 0, -181.829966521, 0),
    0.2: (-0.104880400909, 0, 0.599572173967, 0, -117.861175844, 0),
}


@pytest.mark.few(4)
@pytest.mark.parametrize("stiffness", [None, unlike(2)], ids=["as one", "full"])
@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
@pytest.mark.parametrize("mu", EDGE_STRIKE)
def test_edge(mu, law, stiffness):
    # It slips one way throughout: all laws agree, and both vertices do what the edge's centre would.
    edge = Body([CENTRE + (0, 0.01, 0), CENTRE - (0, 0.01, 0)])
    after, _ = edge.strike(BEFORE, mu, 0.5, law, stiffness=stiffness, rtol=1e-10)
    expected = EDGE_STRIKE[mu]
    np.testing.assert_allclose(after[:3], expected[:3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(after[3:], expected[3:], rtol=0, atol=1e-7)


# W6: falls about the edge x = -.01, which touches, with w_y = 10. (e, mu): v, w after.
ABOUT_EDGE = {
    (0.5, 0.8): (-0.0125, 0, 0.0875, 0, -1.25, 0),
    (0.5, 0.2): (0.0696766788, 0, 0.0516166061, 0, -4.0093311022, 0),
    (0.1, 0.8): (0.0175, 0, 0.0375, 0, 1.75, 0),
}


def fall_about_edge(e, mu, stiffness=None):
    velocity = np.array([0, 0, 0, 0, 10.0, 0])
    velocity[:3] = np.cross(velocity[3:], (HALF, 0, HALF))  # the centre turns about the edge
    return DIE.strike(velocity, mu, e, "stronge", touching=(0, 1), stiffness=stiffness, rtol=1e-10)


@pytest.mark.parametrize(("e", "mu"), ABOUT_EDGE)
def test_face_falls_about_an_edge(e, mu):
    after, impact = fall_about_edge(e, mu)
    expected = ABOUT_EDGE[e, mu]
    np.testing.assert_allclose(after[:3], expected[:3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(after[3:], expected[3:], rtol=0, atol=1e-7)
    if (e, mu) == (0.5, 0.8):
        assert impact.energy_change == pytest.approx(-1.5e-4, abs=1e-12)


def test_touching_edge_opens_at_once():
    # Where nothing slips the blow lifts the touching edge: its stiffness does not matter. (With mu = .2
    # friction of the corners that strike presses it down, and it does.)
    after, _ = fall_about_edge(0.5, 0.8)
    uneven, impact = fall_about_edge(0.5, 0.8, (1, 50, 1, 1))
    np.testing.assert_allclose(DIE.G @ uneven, DIE.G @ after, rtol=0, atol=1e-10)
    np.testing.assert_array_equal(impact.impulse[:2, 0], 0)
