"""Bodies that strike each other: closed forms, Newton's cradle, conservation."""

import numpy as np
import pytest

import carom
from carom import Options, Scene

R = 0.05


def row_of_balls(n, speeds, e, *, start=0.1, law="stronge", **options):
    """Balls along x that touch, but the moving ones, which start `start` away."""
    scene = Scene(gravity=(0, 0, 0))
    for i, v in enumerate(speeds):
        x = 2 * R * i - (start if v else 0.0)
        scene.add_body(carom.Sphere(R), mass=1.0, position=(x, 0, 0), velocity=(v, 0, 0))
    assert len(speeds) == n
    scene.set_contact_default(restitution=e, impact_law=law)
    return carom.simulate(scene, 0.15, step=0.01, options=Options(**options))


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("masses", [(1, 1), (1, 3)])
def test_two_balls_head_on(e, masses):
    # They meet at gap/closing speed; u+ = -e u-, momentum kept: v_i = (p -+ e m_j u)/(m_1 + m_2).
    m1, m2 = masses
    scene = Scene(gravity=(0, 0, -9.81))  # both fall alike
    a = scene.add_body(carom.Sphere(R), mass=m1, position=(0, 0, 0), velocity=(2, 0, 0))
    b = scene.add_body(carom.Sphere(2 * R), mass=m2, position=(0.45, 0, 0), velocity=(-1, 0, 0))
    scene.add_contact(a, b, restitution=e, friction=0.3)
    s = carom.simulate(scene, 0.3, step=0.01)
    (hit,) = s.impacts
    assert hit.time == pytest.approx(0.1, abs=1e-14)
    np.testing.assert_allclose(hit.normal, (-1, 0, 0), atol=1e-14)
    p, u = 2 * m1 - m2, 3.0
    after = (p - e * m2 * u) / (m1 + m2), (p + e * m1 * u) / (m1 + m2)
    np.testing.assert_allclose(s.velocity[-1, :, 0], after, rtol=0, atol=1e-13)
    loss = -0.5 * m1 * m2 / (m1 + m2) * u**2 * (1 - e**2)
    assert hit.energy_change == pytest.approx(loss, abs=1e-12)


#: e, balls: velocities after (mathematics page, part 2; equal linear layers)
CRADLE = [
    (1.0, (-0.1302616951, 0.1502295694, 0.9800321256)),
    (1.0, (-0.1322752748, -0.0649747653, 0.2369776074, 0.9602724328)),
    (0.5, (0.1827348569, 0.2339841796, 0.5832809634)),
    (0.5, (0.1629181757, 0.1759577781, 0.2004155963, 0.4607084499)),
]


@pytest.mark.parametrize(("e", "after"), CRADLE)
def test_newtons_cradle_with_equal_layers(e, after):
    n = len(after)
    s = row_of_balls(n, (1.0,) + (0.0,) * (n - 1), e, corner_exponent=1.0)
    np.testing.assert_allclose(s.velocity[-1, :, 0], after, rtol=0, atol=2e-8)
    assert np.all(s.impacts.together == n - 1)


@pytest.mark.parametrize("n", [2, 3, 5, 7])
def test_newtons_cradle_one_blow_after_the_other(n):
    # e = 1: each blow exchanges velocities, the last ball alone flies off: (0, ..., 0, 1).
    s = row_of_balls(n, (1.0,) + (0.0,) * (n - 1), 1.0, multiple="sequential")
    np.testing.assert_allclose(s.velocity[-1, :, 0], (0.0,) * (n - 1) + (1.0,), atol=1e-13)


@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_oblique_blow_keeps_momenta(law):
    # Linear and angular momentum (about the origin) are kept; energy falls; for spheres
    # W_t = 7/2 W_n without coupling, so stick takes the impulse 2/7 u_t m*.
    scene = Scene(gravity=(0, 0, 0))
    a = scene.add_body(
        carom.Sphere(R), mass=1.0, position=(-0.2, 0.03, 0), velocity=(2, 0, 0.4),
        angular_velocity=(3, 20, -8),
    )  # fmt: skip
    b = scene.add_body(carom.Sphere(R), mass=2.5, position=(0, 0, 0), angular_velocity=(0, 9, 30))
    scene.add_contact(a, b, restitution=0.6, friction=0.25, impact_law=law)
    s = carom.simulate(scene, 0.2, step=0.01)
    assert len(s.impacts) == 1
    m, J = np.array([1.0, 2.5]), 0.4 * np.array([1.0, 2.5]) * R**2
    p = np.einsum("n,tnk->tk", m, s.velocity)
    L = np.einsum("n,tnk->tk", m, np.cross(s.position, s.velocity)) + np.einsum(
        "n,tnk->tk", J, s.angular_velocity
    )
    np.testing.assert_allclose(p, p[:1].repeat(len(p), 0), atol=1e-14)
    np.testing.assert_allclose(L, L[:1].repeat(len(L), 0), atol=1e-14)
    hit = s.impacts[0]
    assert hit.energy_change < 0
    u0, u1 = hit.relative_velocity_before, hit.relative_velocity_after
    assert u1[0] == pytest.approx(-0.6 * u0[0], abs=1e-12)
    Pt = np.hypot(*hit.impulse[1:])
    stick = 2 / 7 * np.hypot(*u0[1:]) * (2.5 / 3.5)
    assert Pt == pytest.approx(min(0.25 * hit.impulse[0], stick), rel=1e-9)


def test_a_box_thrown_at_a_box():
    # Corners and edges: momenta kept, energy never grows. (Where edges stay on each other in between, what is
    # lost there is not in the ledger: 1.5e-3 of the energy in one of these.)
    rng = np.random.default_rng(3)
    for _ in range(6):
        q = rng.normal(size=(2, 4))
        q /= np.linalg.norm(q, axis=1, keepdims=True)
        scene = Scene(gravity=(0, 0, 0))
        a = scene.add_body(
            carom.Box(0.1, 0.06, 0.08), mass=0.5, position=(-0.3, 0.01, 0.02), orientation=q[0],
            velocity=(2, 0, 0), angular_velocity=rng.normal(size=3) * 5,
        )  # fmt: skip
        b = scene.add_body(
            carom.Box(0.08, 0.1, 0.12), mass=0.8, position=(0, 0, 0), orientation=q[1],
            angular_velocity=rng.normal(size=3) * 5,
        )  # fmt: skip
        scene.add_contact(a, b, restitution=0.4, friction=0.3, impact_law="stronge")
        s = carom.simulate(scene, 0.3, step=0.005)
        assert len(s.impacts) >= 1
        p = 0.5 * s.velocity[:, 0] + 0.8 * s.velocity[:, 1]
        np.testing.assert_allclose(p, p[:1].repeat(len(p), 0), atol=1e-13)
        assert np.all(s.impacts.energy_change <= 1e-15)
        allowed = 1e-9 if s.stats["whole_steps"] == 0 else 1e-6
        assert np.max(np.abs(s.ledger.residual)) < allowed * s.total_energy[0]
        assert np.min(s.ledger.residual) > -1e-2 * s.total_energy[0]
