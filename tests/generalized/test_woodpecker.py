"""The woodpecker toy of Glocker and Studer (Multibody System Dynamics 13, 2005), by two laws of friction."""

import numpy as np
import pytest
import sympy as sp

import carom
from verified import agree, verifies

#: law of impact, options, period [s] and fall [m] of the limit cycle, slip after the first beat [m/s]
LAWS = {
    "moreau": ({"impact_law": "moreau"}, {}, 0.14597, 0.01944, 0.179082),  # as published
    "newton": ({}, {"options": carom.Options(multiple="newton")}, 0.15121, 0.01929, 0.236528),
}
BEAK = 0


def toy(**law):
    m, M, J_m, J, c, g = 0.0003, 0.0045, 5e-9, 7e-7, 0.0056, 9.81
    h_m, l_m, l_g, h_b, l_b, r_o, r_m = 0.0058, 0.010, 0.015, 0.02, 0.0201, 0.0025, 0.0031
    y, a, b, dy, da, db = sp.symbols("y a b dy da db")
    speed = dy + l_m * da + l_g * db
    system = carom.GeneralizedSystem.from_sympy(
        [y, a, b], [dy, da, db],
        kinetic_energy=(m * dy**2 + M * speed**2 + J_m * da**2 + J * db**2) / 2,
        potential=g * ((m + M) * y + M * (l_m * a + l_g * b)) + c * (a - b) ** 2 / 2,
        position=[0, -(r_m - r_o) / h_m, -0.2788], velocity=[-0.3411, 0, -7.4583],
    )  # fmt: skip
    gap, beak = l_m + l_g - l_b - r_o - h_b * b, dy + l_m * da + (l_g - l_b) * db
    system.add_contact(gap, tangent=beak, restitution=0.5, friction=0.3, name="beak", **law)
    for name, side in (("low", h_m * a), ("up", -h_m * a)):
        edge = dy + r_m * da
        system.add_contact(
            r_m - r_o + side, tangent=edge, restitution=0.0, friction=0.3, name=name, **law
        )
    return system


PUBLISHED = verifies(
    "GeneralizedSystem",
    "period, fall and slip of the woodpecker toy",
    "publication: Glocker and Studer, Multibody System Dynamics 13, 2005",
)


@pytest.mark.parametrize("name", [pytest.param("moreau", marks=PUBLISHED), "newton"])
def test_limit_cycle(name):
    law, options, period, fall, slip = LAWS[name]
    run = carom.simulate(toy(**law), 6.0, save_at=1e-2, **options)
    hits = run.impacts
    beats = hits.contact == BEAK
    agree(np.diff(hits.time[beats])[-1], period, atol=1e-5)
    agree(-np.diff(hits.position[beats, 0])[-1], fall, atol=1e-5)
    first = hits[int(np.argmax(beats))]
    agree(first.relative_velocity_after, (0.169314, slip, 0.0), atol=1e-6)
    assert np.abs(run.ledger.residual).max() < 1e-9
    # the laws hold at all impacts
    goal = -hits.restitution * np.minimum(hits.relative_velocity_before[:, 0], 0.0)
    assert np.abs(hits.relative_velocity_after[:, 0] - goal).max() < 1e-9
    rub = np.abs(hits.impulse[:, 1]) - 0.3 * hits.impulse[:, 0]
    assert rub.max() < 1e-15
    if name == "moreau":
        W, u = first.inverse_mass.copy(), first.relative_velocity_before * (1 + 0.5, 1, 1)
        W[2, 2] = W[0, 0]
        one = carom.solve_contacts(W, u, 0.3)
        np.testing.assert_allclose(first.impulse, one.impulse[0], rtol=1e-9, atol=1e-15)
        assert first.friction_loss < 0.0  # the slip after is not that before: friction gives energy
        assert (hits.energy_change <= 1e-15).all()
