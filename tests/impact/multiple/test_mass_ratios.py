"""Masses far apart: balls that lie on each other fall together on a floor (closed forms; mostly e = 1)."""

import numpy as np
import pytest

import carom

LIGHT, SPEED, G = 0.06, 4.4, 9.81
RATIOS = [1e4, 1e7, 1e9, 1e12]


def fall(masses, restitution=1.0, **options):
    """Velocities of balls that fall with SPEED, from the lowest, and the impact."""
    k = len(masses)
    G_n = np.eye(k) - np.eye(k, k=-1)  # u_i = v_i - v_(i-1), the floor below
    W = np.zeros((3 * k, 3 * k))
    W[::3, ::3] = G_n @ np.diag(1.0 / np.array(masses)) @ G_n.T
    u = np.zeros((k, 3))
    u[:, 0] = G_n @ np.full(k, -SPEED)
    impact = carom.resolve_impacts(W, u, 0.0, restitution, **options)
    return np.cumsum(impact.velocity_after[:, 0]), impact


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_light_on_heavy(ratio, exponent):
    # The light contact is (M/m)^1/2 times as fast: the light ball stays in equilibrium on the heavy one, and
    # both rebound with v, in the limit. It was 0 beyond 1e6, all energy lost.
    v, impact = fall([ratio * LIGHT, LIGHT], exponent=exponent)
    np.testing.assert_allclose(v, SPEED, rtol=2.0 * ratio**-0.5)
    assert abs(impact.energy_change) <= 1e-12 * ratio * LIGHT * SPEED**2


@pytest.mark.parametrize("ratio", RATIOS)
def test_light_on_heavy_one_after_another(ratio):
    # v_M = v; then the light one meets it with 2 v: v_m = v (3 M - m)/(M + m), v_M = v (M - 3 m)/(M + m).
    v, _ = fall([ratio * LIGHT, LIGHT], multiple="sequential")
    expected = np.array([ratio - 3.0, 3.0 * ratio - 1.0]) / (ratio + 1.0) * SPEED
    np.testing.assert_allclose(v, expected, rtol=1e-14)


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_heavy_on_light(ratio, exponent):
    # The heavy ball carries all energy and rebounds with v; the light one below is anywhere in [0, v]. Its
    # velocity is a difference of impulses 2 M v/m, each with a round-off of some 1e-16 M/m.
    v, impact = fall([LIGHT, ratio * LIGHT], exponent=exponent)
    known = 3e-15 * ratio
    assert v[1] == pytest.approx(SPEED, rel=2.0 / ratio + known)
    assert -known * SPEED <= v[0] <= v[1] + known * SPEED
    assert abs(impact.energy_change) <= (1e-8 + known) * ratio * LIGHT * SPEED**2


@pytest.mark.parametrize("e", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("order", [1, -1])
def test_restitution_of_masses_far_apart(e, order):
    # In the same limit the heavy ball rebounds with e v.
    masses = [1e8 * LIGHT, LIGHT][::order]
    v, _ = fall(masses, e)
    np.testing.assert_allclose(v, e * SPEED, rtol=0, atol=1e-6 * SPEED)


def test_contacts_of_heavy_bodies_keep_their_own_coupling():
    # Round-off of W belongs to each contact: a light ball in the same impact must not make the four corners of
    # a heavy box alike, whose mass centre is not above their middle. Alone the box has the same result.
    corners = [(x, y, -0.1) for x in (-0.3, 0.1) for y in (-0.1, 0.05)]
    rows = np.array([[0, 0, 1, y, -x, 0] for x, y, _ in corners], float)
    heavy = np.diag([1e-9] * 3 + [3e-8, 2e-8, 1e-8])
    inverse = np.zeros((7, 7))
    inverse[:6, :6], inverse[6, 6] = heavy, 1e6
    G_n = np.zeros((5, 7))
    G_n[:4, :6], G_n[4, 6] = rows, 1.0

    def strike(n):
        W, u = np.zeros((3 * n, 3 * n)), np.zeros((n, 3))
        W[::3, ::3] = G_n[:n] @ inverse @ G_n[:n].T
        u[:, 0] = -1.0
        return carom.resolve_impacts(W, u, 0.0, 0.5, "stronge")

    alone, beside = strike(4), strike(5)
    assert np.ptp(alone.velocity_after[:, 0]) > 0.1
    np.testing.assert_allclose(
        beside.velocity_after[:4, 0], alone.velocity_after[:, 0], rtol=0, atol=1e-9
    )


def drop(low, high, e=1.0):
    """Two balls, one on the other, dropped half a metre."""
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    one = scene.add_body(carom.Sphere(0.1), mass=low, position=(0, 0, 0.6))
    two = scene.add_body(carom.Sphere(0.1), mass=high, position=(0, 0, 0.8))
    scene.add_contact(one, floor, restitution=e)
    scene.add_contact(two, one, restitution=e)
    return carom.simulate(scene, 0.5)


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
@pytest.mark.parametrize("masses", [(1e6, LIGHT), (LIGHT, 60.0), (LIGHT, 6000.0), (1.0, 1.0)])
def test_dropped_balls_keep_their_energy(masses):
    s = drop(*masses)
    heavy = int(np.argmax(masses))
    kinetic = 0.5 * masses[heavy] * G  # of half a metre
    assert np.ptp(s.total_energy) <= 1e-9 * kinetic
    if masses[0] != masses[1]:  # it is where it would be alone
        t = 0.5 - np.sqrt(1.0 / G)
        rise = np.sqrt(G) * t - 0.5 * G * t * t
        height = s.position[-1, heavy, 2] - s.position[0, heavy, 2] + 0.5
        assert height == pytest.approx(rise, abs=3.0 * min(masses) / max(masses))


def test_a_loss_that_no_law_explains_is_no_success():
    # A ball between two rigid walls, which move on each other: e = 1 has no velocity after.
    scene = carom.Scene(gravity=(0, 0, 0))
    walls = [
        scene.add_half_space((0, 0, -0.1), (0, 0, 1)),
        scene.add_half_space((0, 0, 0.1), (0, 0, -1)),
    ]
    ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0), velocity=(0, 0, -1))
    for wall in walls:
        scene.add_contact(ball, wall, restitution=1.0)
    s = carom.simulate(scene, 0.1, step=0.01, throw=False)
    assert s.status is carom.Status.INACCURATE
    assert any("no entry of the ledger explains" in sentence for sentence in s.warnings)
    assert any("had no restitution although e > 0" in sentence for sentence in s.warnings)
    assert s.ledger.impacts[-1] == 0.0
