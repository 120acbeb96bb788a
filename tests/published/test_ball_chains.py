"""Chains of ten steel balls that touch: Hertz's law against its integration in time (RK4, energy to 5e-9)."""

import runpy
from pathlib import Path

import numpy as np
import pytest

import carom

ROOT = Path(__file__).parents[2]
EQUAL = np.full(10, 0.01)
TAPERED = 0.01 * 0.95 ** np.arange(1, 11)
AFTER = {
    "equal": (
        EQUAL,
        [
            -0.071085, -0.030274, -0.015833, -0.008886, -0.005127, -0.002986, -0.001738, 0.002672, 0.147390,
            0.985866,
        ],
    ),
    "tapered": (
        TAPERED,
        [
            -0.002314, 0.044320, 0.065972, 0.080199, 0.092682, 0.106213, 0.138456, 0.234254, 0.573821,
            1.852094,
        ],
    ),
}  # fmt: skip


def chain(radii, **contact):
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.set_contact_default(restitution=1, friction=0, **contact)
    x = np.concatenate([[0], np.cumsum(radii[:-1] + radii[1:])])
    x[0] -= 1e-3
    for k, radius in enumerate(radii):
        scene.add_body(
            carom.Sphere(radius),
            density=7780,
            position=(x[k], 0, 0),
            velocity=(0.0 if k else 1.0, 0, 0),
        )
    return scene


@pytest.mark.parametrize("name", AFTER)
def test_a_chain_ends_as_hertz_s_law_integrated_in_time(name):
    radii, after = AFTER[name]
    solution = carom.simulate(chain(radii), 0.02)
    np.testing.assert_allclose(solution.velocity[-1, :, 0], after, rtol=0, atol=6e-7)
    np.testing.assert_allclose(solution.total_energy, solution.total_energy[0], rtol=1e-13)
    assert len(solution.impacts) == 9


@pytest.mark.parametrize("name", ["EQUAL", "TAPERED"])
def test_velocities_and_forces_are_within_what_the_page_says(name):
    """1e-7 m/s, and 1e-5 of the greatest force."""
    picture = runpy.run_path(str(ROOT / "docs" / "pictures" / "ball_chains.py"))
    page = picture["page"]()
    exact, k = picture["springs"](page[name])
    solution = carom.simulate(page["chain"](page[name]), 0.02)
    np.testing.assert_allclose(solution.velocity[-1, :, 0], exact.y[10:, -1], rtol=0, atol=1e-7)
    force = solution.impact_forces(0)
    t = np.linspace(0, force.duration, 1000)
    x = exact.sol(t)[:10]
    F = k * np.maximum(x[:9] - x[1:], 0.0).T ** 1.5
    np.testing.assert_allclose(force.evaluate(t), F, rtol=0, atol=1e-5 * F.max())


def test_one_after_another_the_speeds_are_products():
    solution = carom.simulate(chain(TAPERED, multiple="sequential"), 0.02)
    last = (2 / (1 + 0.95**3)) ** 9
    assert solution.velocity[-1, -1, 0] == pytest.approx(last, rel=1e-12)
    assert round(last, 3) == 1.946


def test_one_contact_problem_moves_the_others_together():
    solution = carom.simulate(chain(EQUAL), 0.02, options=carom.Options(multiple="newton"))
    np.testing.assert_allclose(np.ptp(solution.velocity[-1, 1:, 0]), 0.0, atol=1e-9)
