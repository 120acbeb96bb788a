"""Routh's closed form against published numbers of the uniform rod (m = L = 1)."""

import numpy as np
import pytest

from references.planar_routh import impact

ROD45 = [[2.5, -1.5], [-1.5, 2.5]]
LAWS = ("newton", "poisson", "stronge")


def test_reversal_of_the_rod():
    """45 degrees, mu = 0.3, e = 0.5, u = (-1, 0.2)."""
    after = {law: impact(ROD45, [-1.0, 0.2], 0.3, 0.5, law) for law in LAWS}
    expected = dict(
        newton=(0.5, -0.452845528456),
        poisson=(0.46, -0.438211382114),
        stronge=(0.463944441118, -0.439654470328),
    )
    for law in LAWS:
        assert after[law]["slip"] == "reversal"
        np.testing.assert_allclose(after[law]["velocity"], expected[law], atol=2e-12)


def test_newton_gains_energy():
    """45 degrees, mu = 0.8, e = 0.9, u = (-1, 0.6): E+/E- = 81/64; the others lose."""
    ratios = dict(newton=81 / 64, poisson=0.5184, stronge=0.643371429)
    inverse = np.linalg.inv(ROD45)
    for law, ratio in ratios.items():
        u = impact(ROD45, [-1.0, 0.6], 0.8, 0.9, law)["velocity"]
        start = np.array([-1.0, 0.6])
        assert (u @ inverse @ u) / (start @ inverse @ start) == pytest.approx(ratio, rel=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_balance(law):
    """u+ = u- + W P, the cone, and the laws by their definitions, on random impacts."""
    random = np.random.default_rng(5)
    for _ in range(200):
        F = random.normal(size=(2, 2))
        W, mu, e = F @ F.T + 0.2 * np.eye(2), random.uniform(0, 0.6), random.uniform(0, 1)
        if mu * abs(W[0, 1]) > 0.9 * W[0, 0]:
            continue
        u = np.array([-random.uniform(0.1, 2.0), random.normal()])
        out = impact(W, u, mu, e, law)
        np.testing.assert_allclose(out["velocity"], u + W @ out["impulse"], atol=1e-11)
        assert abs(out["impulse"][1]) <= mu * out["impulse"][0] * (1 + 1e-12)
        met = dict(
            newton=out["velocity"][0] + e * u[0],
            poisson=out["impulse"][0] - (1 + e) * out["compression_impulse"],
            stronge=out["restitution_work"] + e**2 * out["compression_work"],
        )[law]
        assert met == pytest.approx(0.0, abs=1e-11)


def test_jam_is_refused():
    with pytest.raises(ValueError, match="jam"):
        impact([[1.75, 1.299038105677], [1.299038105677, 3.25]], [-1.0, 1.0], 1.6, 0.5, "newton")
