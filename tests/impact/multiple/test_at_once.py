"""Where the boundary layer cannot be passed, the impact is one contact problem."""

from pathlib import Path

import numpy as np

import carom

DATA = Path(__file__).parents[2] / "data"


def test_eight_points_of_a_rim():
    """Rows far from independent, slip all but uniform: the layer ended with 1e17 m/s."""
    case = np.load(DATA / "rim_of_eight_points.npz")
    W, u = case["inverse_mass"], case["velocity"]
    mu, e = 0.4, 0.3
    r = carom.resolve_impacts(W, u, mu, e)
    size = np.max(np.abs(u))
    np.testing.assert_allclose(
        r.velocity_after.ravel(), u.ravel() + W @ r.impulse.ravel(), rtol=0, atol=1e-12 * size
    )
    n = r.impulse[:, 0]
    assert np.all(n >= 0.0)
    assert np.all(np.linalg.norm(r.impulse[:, 1:], axis=1) <= mu * n * (1 + 1e-9))
    assert np.min(r.velocity_after[:, 0]) >= -1e-9 * size
    assert np.max(np.abs(r.velocity_after)) < 2 * size
    assert r.energy_change < 0.0
    works = r.compression_work + r.restitution_work - r.friction_loss
    np.testing.assert_allclose(works.sum(), r.energy_change, rtol=1e-9)
    if r.at_once:  # Newton's law where a contact has an impulse
        struck = n > 1e-9 * n.max()
        goal = -e * np.minimum(u[:, 0], 0.0)
        np.testing.assert_allclose(r.velocity_after[struck, 0], goal[struck], atol=1e-9 * size)
