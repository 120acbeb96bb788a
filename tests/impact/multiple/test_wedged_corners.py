"""A ball or a box strikes two or three walls at once, with any friction: above 1 it may be wedged between them.

The cones of two walls at right angles contain, for mu > 1, impulses that cancel: what a wall presses, the
friction of the other holds. Newton's law may then have no solution, and impulses had no bound (1e13 N s).
"""

import itertools

import numpy as np
import pytest

import carom

MODES = ["simultaneous", "newton", "sequential"]


def rows(normals, arms):
    """Rows (n, t1, t2) of points at `arms[i]` of walls with `normals[i]`."""
    out = []
    for n, points in zip(normals, arms, strict=True):
        t = np.linalg.svd(n[None])[2][1:]
        out += [np.r_[a, np.cross(p, a)] for p in points for a in (n, *t)]
    return np.array(out)


def corner(rng):
    """Return the rows of a random corner, the inverse masses of the body and its velocity."""
    normals = np.eye(3)[: rng.integers(2, 4)]
    if rng.random() < 0.3:
        normals = normals + 0.3 * rng.normal(size=normals.shape)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
    size = rng.uniform(0.05, 0.2, 3)
    inertia = (np.sum(size**2) - size**2) / 3.0
    if rng.random() < 0.5:
        arms, inertia = [[-0.1 * n] for n in normals], np.full(3, 0.004)
    else:
        corners = size * np.array(list(itertools.product((-1, 1), repeat=3)))
        depth = [corners @ n for n in normals]
        arms = [corners[d < d.min() + 1e-9] for d in depth]
    v = rng.normal(size=6) * np.r_[1, 1, 1, np.full(3, rng.choice([0, 1, 10]))]
    v[:3] -= rng.uniform(1, 3) * normals.sum(axis=0)
    return rows(normals, arms), np.r_[1, 1, 1, 1 / inertia] / 10 ** rng.uniform(-1, 1), v


@pytest.mark.parametrize("corners", [75, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("multiple", MODES)
def test_corners_with_any_friction(multiple, corners):
    """No gain, impulses in their cones and of the size of the momentum, no approach; none is refused."""
    wedged = 0
    for seed in range(corners):
        rng = np.random.default_rng([46, seed])
        G, inverse, v = corner(rng)
        k, energy = len(G) // 3, 0.5 * v @ (v / inverse)
        mu = rng.uniform(0.0, 20.0 if seed % 2 else 3.0, k)
        if seed % 3:
            mu[:] = mu[0]
        e = rng.uniform(0, 1, k) if seed % 4 else np.full(k, rng.integers(2))
        e_t = rng.uniform(-1, 1, k) * (seed % 5 > 2)
        u = (G @ v).reshape(k, 3)
        if not u[:, 0].min() < -1e-3:
            continue
        impact = carom.resolve_impacts(
            G * inverse @ G.T, u, mu, e, ["newton", "poisson", "stronge"][rng.integers(3)],
            multiple=multiple, tangential_restitution=e_t,
        )  # fmt: skip
        P = impact.impulse
        after = v + inverse * (G.T @ P.ravel())
        assert 0.5 * after @ (after / inverse) <= energy * (1.0 + 1e-9), seed
        assert impact.energy_change <= 1e-9 * energy, seed
        most = np.abs(P).max()
        assert P[:, 0].min() >= -1e-8 * most, seed
        assert (np.hypot(P[:, 1], P[:, 2]) - mu * P[:, 0]).max() <= 1e-7 * most, seed
        assert most <= 1e3 * np.sqrt(2.0 * energy / inverse[0]), seed
        assert (G @ after).reshape(k, 3)[:, 0].min() >= -1e-6 * np.abs(u).max(), seed
        wedged += impact.plastic_change < 0.0 and e.min() > 0.0
    # one wall after another wedges nothing
    assert (wedged > 3) == (multiple != "sequential")


@pytest.mark.parametrize("multiple", MODES[:2])
@pytest.mark.parametrize("e", [0.5, 1.0])
def test_a_wedged_ball_stops(e, multiple):
    """With u+ = e |u-| at both walls both cannot stick, and slip drives the ball into a wall: plastic.

    u+ = 0 in all rows takes the energy u.W^+ u/2 of motion at the points, and says so.
    """
    G = rows(np.eye(3)[[2, 0]], [[(0, 0, -0.1)], [(-0.1, 0, 0)]])
    W = G * np.r_[1, 1, 1, np.full(3, 250.0)] @ G.T
    u = (G @ (-1, 0.8, -1, 3, 0, -5)).reshape(2, 3)
    impact = carom.resolve_impacts(W, u, 5.0, e, multiple=multiple)
    np.testing.assert_allclose(impact.velocity_after, 0.0, atol=1e-12)
    energy = 0.5 * u.ravel() @ np.linalg.pinv(W) @ u.ravel()
    assert impact.energy_change == pytest.approx(-energy, rel=1e-12)
    assert impact.plastic_change == pytest.approx(-energy, rel=1e-12)
