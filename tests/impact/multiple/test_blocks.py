"""Rocking blocks (Housner), and the rod that jams (Painleve): closed forms (W7, W8)."""

import numpy as np
import pytest

from carom.impact.api import resolve_impact
from carom.impact.multiple.api import resolve_impacts, stated_contacts, stated_laws
from carom.impact.multiple.layout import SIMULTANEOUS, MultipleSettings, new_multiple_result
from carom.impact.multiple.workspace import new_multiple_workspace
from references.painleve import impact_without_collision
from verified import agree, verifies


def rock(b, h, e, mu):
    """Block of half sizes b, h turning about its right corner comes down on the left one; w+/w-.

    Planar: corners at (+-b, -h) from the centre, 1 kg; the right corner touches, w- = 1 about y.
    """
    inertia = (b * b + h * h) / 3
    G = np.zeros((6, 3))  # (vx, vz, w)
    for i, x in enumerate((-b, b)):
        # u = v + w y x r with r = (x, -h): u_z = v_z - w x, u_x = v_x - w h
        G[3 * i] = [0, 1, -x]
        G[3 * i + 1] = [1, 0, -h]
    w = -1.0  # the left corner comes down
    v = np.array([h * w, b * w, w])
    u = (G @ v).reshape(2, 3)
    u[1, 0] = 0.0
    assert abs(u[1, 1]) < 1e-15
    assert u[0, 0] < 0
    inverse = np.diag([1, 1, 1 / inertia])
    impact = resolve_impacts(G @ inverse @ G.T, u, mu, e, "stronge", rtol=1e-11)
    after = v + inverse @ G.T @ impact.impulse.ravel()
    return after[2] / w, impact


@verifies(
    "resolve_impacts",
    r"rocking block (Housner): $\omega^+/\omega^- = 1 - (1 + e)\,\tfrac32 \sin^2\alpha$",
    "closed form",
)
@pytest.mark.parametrize("e", [0, 0.01, 0.1, 0.5])
@pytest.mark.parametrize(("b", "h"), [(0.05, 0.1), (0.1, 0.1)])
def test_housner_with_restitution(b, h, e):
    # No slip: the impulse acts at the corner that strikes. Moment about it: w+/w- = 1 - (1 + e) 1.5 sin^2 a,
    # tan a = b/h (e = 0: Housner 1963): .7, .697, .67, .55 and .25, ..., -.125 for the square.
    ratio, impact = rock(b, h, e, 2.0)
    sin2 = b * b / (b * b + h * h)
    agree(ratio, 1 - (1 + e) * 1.5 * sin2, atol=1e-9)
    agree(impact.impulse[1], 0, atol=1e-9)


def test_square_that_slips():
    # mu = .5, e = 0: p_t = mu p_n at the corner that strikes, 1/7 of w is left.
    ratio, _ = rock(0.1, 0.1, 0.0, 0.5)
    assert ratio == pytest.approx(1 / 7, abs=1e-10)


ROD = np.array([[1.75, 1.299038105677, 0], [1.299038105677, 3.25, 0], [0, 0, 0]])
SLIPS = np.array([0.0, 1.0, 0.0])


def jam(e, law, mu=1.6):
    settings, workspace, out = MultipleSettings(), new_multiple_workspace(1), new_multiple_result(1)
    laws = stated_laws([mu], [e], [law], [0.0], [1.0])
    contacts = stated_contacts(ROD, SLIPS[None], laws, SIMULTANEOUS)
    return impact_without_collision(1, contacts, laws, settings, workspace, out), out


def test_painleve_rod():
    # Rod of 60 degrees, mu = 1.6 above mu_P = 1.347: k = 1.75 - 1.6 * 1.299 = -.328 < 0. Slip stops at p =
    # .256, compression ends at p_c = .32476. The seed of 1e-7 shows.
    result, out = jam(0.0, 2)
    assert result == (0, 1)
    np.testing.assert_allclose(out.velocity, 0, atol=3e-7)
    np.testing.assert_allclose(out.impulse, (0.3247595264, -0.4375, 0), rtol=0, atol=3e-7)
    result, out = jam(0.5, 2)
    np.testing.assert_allclose(out.velocity, (0.0917266009, 0, 0), rtol=0, atol=3e-7)
    np.testing.assert_allclose(out.impulse, (0.3992873896, -0.4672890884, 0), rtol=0, atol=3e-7)
    assert out.summary[0]["energy_change"] < 0


def test_no_jam_below_the_critical_friction():
    result, out = jam(0.5, 2, mu=1.3)
    assert result == (0, 0)
    np.testing.assert_array_equal(out.impulse, 0)
    np.testing.assert_array_equal(out.velocity, SLIPS)


def test_painleve_by_the_layer():
    # The same through the layer: two contacts at one point. A jam needs no care, normal compliance resolves it.
    u = np.array([-1e-7, 1.0, 0.0])
    exact = resolve_impact(ROD, u, 1.6, 0.5, "stronge")
    both = resolve_impacts(
        np.tile(ROD, (2, 2)), [u, u], 1.6, 0.5, "stronge", stiffness=(1, 3), rtol=1e-10
    )
    np.testing.assert_allclose(both.velocity_after[0], exact.velocity_after, rtol=0, atol=1e-8)


@pytest.mark.parametrize("seed", range(1, 8))
def test_round_off_across_a_plane_is_no_direction(seed):
    """W of joined bodies that move in a plane is round-off across it: 1e-16, and 1e-32 on the diagonal."""
    random = np.random.default_rng(seed)
    G = np.zeros((9, 5))
    for i in range(3):
        G[3 * i : 3 * i + 2] = random.normal(size=(2, 5))
    W = G @ G.T
    u = np.zeros((3, 3))
    u[:, 0], u[:, 1] = [-1.0, 0.0, 0.0], [0.3, 0.0, 0.1]
    across = np.zeros((9, 9))
    across[2::3] = 1e-16 * random.normal(size=(3, 9))
    across[2::3, 2::3] = 5e-33 * np.eye(3)
    exact = resolve_impacts(W, u, 0.5, 0.3, "poisson")
    noisy = resolve_impacts(W + across + across.T, u, 0.5, 0.3, "poisson")
    np.testing.assert_allclose(noisy.impulse, exact.impulse, rtol=0, atol=1e-7)
