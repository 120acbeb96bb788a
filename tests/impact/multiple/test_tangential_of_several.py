"""Tangential restitution where several contacts strike: systems solved by hand, cones, energies."""

import numpy as np
import pytest

import carom
from carom import resolve_impacts

X, Y, Z = np.eye(3)


def rows(*contacts):
    """Return G of a free body from (normal, tangent 1, tangent 2, arm) of each contact."""
    return np.array([[*axis, *np.cross(arm, axis)] for *axes, arm in contacts for axis in axes])


def of_body(G, mass, inertia, v):
    """Return W and velocities (k, 3) of contacts of one body that moves with v (6,)."""
    inverse = np.diag(1 / np.array([mass] * 3 + list(inertia)))
    return G @ inverse @ G.T, (G @ v).reshape(-1, 3), inverse


@pytest.mark.parametrize("multiple", ["simultaneous", "sequential", "newton"])
@pytest.mark.parametrize("e_t", [1.0, 0.4, -0.7])
def test_a_ball_in_a_corner(e_t, multiple):
    # e = 0: floor and wall stop v_x, v_z and w_y; what is left is motion along the corner, v_y and the spins
    # w_x (floor) and w_z (wall). Slips s_f = v_y + r w_x, s_w = v_y - r w_z, and 2/5 m r^2 gives
    # m (3.5, 1; 1, 3.5) for their inverse masses: P = m (3.5, 1; 1, 3.5)^-1 (s^+ - s^-), s^+ = -e_t s^-.
    m, r, v_y, w_x, w_z = 1.3, 0.1, 0.8, 3.0, -5.0
    G = rows((Z, X, Y, -r * Z), (X, Z, Y, -r * X))
    W, u, inverse = of_body(G, m, [0.4 * m * r * r] * 3, np.array([-1, v_y, -1, w_x, 0, w_z]))
    hit = resolve_impacts(W, u, 3.0, 0.0, tangential_restitution=e_t, multiple=multiple)
    slips = np.array([v_y + r * w_x, v_y - r * w_z])
    P = m * np.linalg.solve([[3.5, 1], [1, 3.5]], -(1 + e_t) * slips)
    after = [0, v_y + P.sum() / m, 0, w_x + 2.5 * P[0] / (m * r), 0, w_z - 2.5 * P[1] / (m * r)]
    assert G.T @ hit.impulse.ravel() @ inverse + [-1, v_y, -1, w_x, 0, w_z] == pytest.approx(
        after, abs=1e-9
    )
    assert hit.velocity_after[:, 2] == pytest.approx(-e_t * slips, abs=1e-9)


def rod(v, e, e_t, **more):
    """Return W, u and the impact of a thin rod that strikes flat with both ends and turns about Z."""
    m, a = 0.7, 0.3
    G = rows((Z, X, Y, a * X), (Z, X, Y, -a * X))
    W, u, _ = of_body(G, m, [1e-3 * m, m * a * a / 3, m * a * a / 3], np.array(v))
    return W, u, resolve_impacts(W, u, 20.0, e, tangential_restitution=e_t, **more)


@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_elastic_ends_reverse_their_slip_and_keep_the_energy(law):
    # the ends slip along +-Y by w_z and both along X: all four speeds are independent of each other
    _, u, hit = rod([0.5, 0, -1, 0, 0, 4.0], 1.0, 1.0, law=law)
    assert hit.velocity_after == pytest.approx(-u, abs=1e-7)
    assert abs(hit.energy_change) <= 1e-7
    _, u, hit = rod([0.5, 0, -1, 0, 0, 4.0], 0.6, -0.3, law=law)
    assert hit.velocity_after == pytest.approx(u * [-0.6, 0.3, 0.3], abs=1e-7)


def test_each_contact_has_its_own():
    # ends with e_t = .8 and -.5: along Y each slip is free; along X the rod is rigid, and both have the mean
    _, u, hit = rod([0.5, 0, -1, 0, 0, 4.0], 0.5, [0.8, -0.5])
    assert hit.velocity_after[:, 2] == pytest.approx([-0.8 * u[0, 2], 0.5 * u[1, 2]], abs=1e-7)
    assert hit.velocity_after[:, 1] == pytest.approx([-0.15 * 0.5] * 2, abs=1e-7)
    assert hit.velocity_after[:, 0] == pytest.approx(-0.5 * u[:, 0], abs=1e-7)


def test_two_balls_on_a_floor():
    # the upper strikes the lower, at rest on the floor: normal velocities are those without e_t, the slip of
    # each contact differs by -e_t u_t^- (the floor had none), momentum and energy do what they must
    m, r = 1.0, 0.1
    inverse = np.diag(1 / np.array([m, m, m, *[0.4 * m * r * r] * 3] * 2))
    low, high = rows((Z, X, Y, -r * Z)), rows((Z, X, Y, -r * Z))
    G = np.zeros((6, 12))
    G[:3, :6], G[3:, 6:], G[3:, :6] = low, high, -rows((Z, X, Y, r * Z))
    v = np.array([0.0] * 6 + [0.3, -0.1, -1.0, 2.0, 5.0, 0.0])
    W, u = G @ inverse @ G.T, (G @ v).reshape(2, 3)
    plain, hit = (
        resolve_impacts(W, u, 2.0, 0.7, law="stronge", tangential_restitution=e_t)
        for e_t in (0, 0.6)
    )
    change = hit.velocity_after - plain.velocity_after
    assert change[:, 0] == pytest.approx(0, abs=1e-9)
    assert change[:, 1:] == pytest.approx(-0.6 * u[:, 1:], abs=1e-9)
    assert hit.velocity_after.ravel() == pytest.approx(
        u.ravel() + W @ hit.impulse.ravel(), abs=1e-9
    )
    assert plain.energy_change < hit.energy_change < 0


def random_impact(rng):
    """Return W and velocities of 2 to 6 contacts of up to as many bodies, of which one at least strikes."""
    k = int(rng.integers(2, 7))
    bodies = int(rng.integers(1, k + 1))
    G = np.zeros((3 * k, 6 * bodies))
    for i in range(k):
        axes, (one, other) = np.linalg.qr(rng.normal(size=(3, 3)))[0], rng.integers(bodies, size=2)
        for body, side in ((one, 1), (other, -1)):
            if side == 1 or (body != one and rng.random() < 0.7):
                G[3 * i : 3 * i + 3, 6 * body : 6 * body + 6] = side * rows(
                    (*axes, rng.normal(size=3))
                )
    mass = np.outer(10 ** rng.uniform(-1, 1, bodies), [1, 1, 1, 0.5, 0.4, 0.3]).ravel()
    u = (G @ rng.normal(size=6 * bodies)).reshape(k, 3)
    u *= -1.0 if u[:, 0].min() > -1e-3 else 1.0
    u[(u[:, 0] > 0) & (rng.random(k) < 0.3), 0] = 0.0
    return G / mass @ G.T, u


@pytest.mark.parametrize("impacts", [250, pytest.param(1000, marks=pytest.mark.slow)])
def test_random_impacts_never_gain(impacts):
    returned = 0
    for seed in range(impacts):
        rng = np.random.default_rng([46, seed])
        W, u = random_impact(rng)
        k = len(u)
        if not u[:, 0].min() < 0.0:
            continue
        mu, e, e_t = rng.uniform(0, 1.2, k), rng.uniform(0, 1, k), rng.uniform(-1, 1, k)
        given = {
            "law": ["newton", "poisson", "stronge"][seed % 3],
            "multiple": ["simultaneous", "sequential", "newton"][seed // 3 % 3],
            "rtol": 1e-4,
        }
        plain = resolve_impacts(W, u, mu, e, **given)
        hit = resolve_impacts(W, u, mu, e, tangential_restitution=e_t, **given)
        p, size = hit.impulse, np.abs(hit.impulse * u).sum()
        returned += not np.array_equal(p, plain.impulse)
        assert hit.energy_change <= 1e-9 * size
        assert np.all(hit.friction_loss >= 0)
        assert np.all(np.hypot(p[:, 1], p[:, 2]) <= mu * p[:, 0] + 1e-9 * np.abs(p).max())
        assert hit.velocity_after[:, 0].min() >= min(-1e-9, 2 * plain.velocity_after[:, 0].min())
        if given["multiple"] != "sequential":  # there the next impacts are others
            assert hit.velocity_after[p[:, 0] > 1e-6 * p.max(), 0] == pytest.approx(
                plain.velocity_after[p[:, 0] > 1e-6 * p.max(), 0], abs=1e-6
            )
    assert returned > 0.2 * impacts


def test_groups_return_slip_each_by_itself():
    # a rod whose friction returns all, and one whose cone allows nothing, in one impact
    W, u, alone = rod([0.5, 0, -1, 0, 0, 4.0], 0.5, 1.0)
    both, slow = np.kron(np.eye(2), W), np.vstack([u, u])
    hit = resolve_impacts(both, slow, [20, 20, 0.1, 0.1], 0.5, tangential_restitution=1.0)
    assert hit.velocity_after[:2] == pytest.approx(alone.velocity_after, abs=1e-7)
    assert np.all(hit.friction_loss[2:] > 0)


def test_equal_contacts_share_it():
    # a plate that falls flat is one contact, W_n = W_t = 1/m: with e = e_t = 1 its slip is reversed, and each
    # corner has a quarter of the impulse
    m = 2.0
    corners = [(Z, X, Y, a * X + b * Y) for a in (-0.1, 0.1) for b in (-0.1, 0.1)]
    W, u, _ = of_body(rows(*corners), m, [0.01] * 3, np.array([0.3, 0, -1, 0, 0, 0]))
    hit = resolve_impacts(W, u, 2.0, 1.0, tangential_restitution=1.0)
    assert hit.velocity_after == pytest.approx(-u, abs=1e-7)
    assert hit.impulse[:, 1] == pytest.approx(-2 * 0.3 * m / 4, abs=1e-7)


def test_of_bodies_and_of_coordinates():
    # a box of two dimensions that falls flat and slips, as four corners of a body and as two in coordinates
    a, h, m = 0.1, 0.05, 2.0
    scene = carom.Scene(gravity=(0, 0, 0))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    v = (0.7, 0.0, -1.0)
    box = scene.add_body(
        carom.Box(2 * a, 2 * a, 2 * h), mass=m, position=(0, 0, h + 0.01), velocity=v
    )
    law = {"restitution": 0.5, "friction": 1.0, "tangential_restitution": 0.5}
    scene.add_contact(box, floor, **law)
    run = carom.simulate(scene, 0.02)
    assert not run.warnings
    assert np.all(run.impacts.together == 4)
    sp = pytest.importorskip("sympy")
    x, z, b, dx, dz, db = sp.symbols("x z b dx dz db")
    system = carom.GeneralizedSystem.from_sympy(
        [x, z, b], [dx, dz, db],
        kinetic_energy=m / 2 * (dx**2 + dz**2 + sp.Rational(1, 3) * (a * a + h * h) * db**2),
        position=[0, h + 0.01, 0], velocity=[v[0], v[2], 0],
    )  # fmt: skip
    for side in (-a, a):
        place = x + side * sp.cos(b) + h * sp.sin(b)
        tangent = dx + sp.diff(place, b) * db
        system.add_contact(z + side * sp.sin(b) - h * sp.cos(b), tangent=tangent, **law)
    last = carom.simulate(system, 0.02).v[-1]
    turn = run.angular_velocity[-1, 0]
    assert last == pytest.approx([*run.velocity[-1, 0, ::2], -turn[1]], abs=1e-7)
    assert last[0] + h * last[2] == pytest.approx(-0.5 * v[0], abs=1e-7)  # the slip
