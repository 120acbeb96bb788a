"""What a flexible body does to a ball that strikes it, and its weight to itself, beside closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom import flexible
from verified import agree, verifies

STEEL = {"density": 7800.0, "young": 210e9}


@verifies(
    "add_body(modes=)", "v = v_0 exp(-2 m/M) of a ball that strikes the end of a bar", "closed form"
)
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_a_ball_on_the_end_of_a_bar(restitution):
    """Waves: the bar pushes with M v' = -(m c/L) v until 2 L/c. With 40 modes their front has a length."""
    modes = flexible.beam(1.0, flexible.Circle(0.02), **STEEL, modes=40, kinds=("stretch",))
    for ratio in (1.0, 3.0):
        scene = carom.Scene()
        bar = scene.add_body(carom.Box(1.0, 0.03, 0.03), modes=modes, name="bar")
        ball = scene.add_body(
            carom.Sphere(0.02),
            mass=ratio * modes.mass,
            position=(-0.5201, 0, 0),
            velocity=(1, 0, 0),
        )
        scene.add_contact(ball, bar, restitution=restitution)
        run = carom.simulate(scene, duration=1e-3)
        agree(run[ball].velocity[-1, 0], np.exp(-2.0 / ratio), atol=5e-3)
        together = run["bar"].velocity[-1, 0] + ratio * run[ball].velocity[-1, 0]
        assert together == pytest.approx(ratio, rel=1e-9)


@verifies(
    "add_static(modes=)",
    "weight rho A L^4/(384 E I), and its share 5 of pinned ends",
    "closed form",
)
@pytest.mark.parametrize(("ends", "share"), [("clamped", 1.0), ("pinned", 5.0)])
def test_a_beam_hangs_by_its_weight(ends, share):
    section = flexible.Rectangle(0.04, 0.01)
    modes = flexible.beam(1.0, section, **STEEL, modes=60, kinds=("bend",), ends=ends)
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_static(carom.Box(1.0, 0.04, 0.01), modes=modes, name="beam")
    run = carom.simulate(scene, duration=0.01)
    exact = share * 7800.0 * section.area * 9.81 / (384.0 * 210e9 * section.second_moments[0])
    agree(run["beam"].displacement((0, 0, 0))[:, 2], -exact, rtol=1e-6)
    agree(run["beam"].modal_rates, 0.0, atol=1e-9)
