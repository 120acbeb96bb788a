"""Explicit methods through positions in which rows depend on each other that do not elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from carom import GROUND, joints
from carom.bench.problems import four_bar

Z = np.array([0.0, 0.0, 1.0])
RATE = 4.89  # [rad/s], of the bars where all are in line


def four_bars(lean: float, loops: int = 2):
    """The four-bars of A02 at this lean from upright, turning with RATE."""
    scene, bar = carom.Scene(gravity=(0, -9.81, 0)), {"mass": 1.0, "inertia": np.full(3, 1 / 12)}
    up = np.array([np.sin(lean), np.cos(lean), 0.0])
    swing = RATE * np.array([up[1], -up[0], 0.0])
    turned = {"orientation": (np.cos(lean / 2), 0, 0, -np.sin(lean / 2))}
    foot = [np.array([k, 0.0, 0.0]) for k in range(loops + 1)]
    ups = [
        scene.add_body(
            position=p + up / 2, velocity=swing / 2, angular_velocity=-RATE * Z, **turned, **bar
        )
        for p in foot
    ]
    for p, body in zip(foot, ups):
        scene.add_joint(joints.Revolute(p, Z), GROUND, body)
    for k in range(loops):
        across = scene.add_body(position=foot[k] + up + (0.5, 0, 0), velocity=swing, **bar)
        for end in (k, k + 1):
            scene.add_joint(joints.Revolute(foot[end] + up, Z), ups[end], across)
    return scene


def exact(duration, lean, rate, loops):
    """theta'' = g sin(theta) ((N + 1)/2 + N)/((N + 1)/3 + N)."""
    k = 9.81 * ((loops + 1) / 2 + loops) / ((loops + 1) / 3 + loops)
    path = solve_ivp(
        lambda t, y: (y[1], k * np.sin(y[0])), (0, duration), (lean, rate),
        method="DOP853", rtol=1e-13, atol=1e-14,
    )  # fmt: skip
    return path.y[:, -1]


@pytest.mark.parametrize("method", ["rk4", "rk5", "rk8"])
def test_a_step_may_meet_the_position_anywhere(method):
    """At any part of the step, and at its ends. The order of rk4 leaves 1.1e-10 J, of the others round-off."""
    h = 2.2e-3
    for part in np.linspace(-0.05, 1.05, 111):
        run = carom.simulate(four_bars(np.pi / 2 - part * h * RATE), h, step=h, method=method)
        assert np.ptp(run.total_energy) < 5e-10  # of 12 J
        rates = -run.angular_velocity[-1, :3, 2]
        assert (
            np.ptp(rates) < 1e-4
        )  # in such a position what bars differ by is round-off over their angle


@pytest.mark.few(3)
@pytest.mark.parametrize(
    ("step", "loops"),
    [(1.436e-3, 2), (2e-3, 2), (2.2014e-3, 2), (3.1425e-3, 2), (5.1721e-3, 2)]
    + [(2.2014e-3, 5), (5.1721e-3, 5)],
)
def test_order_8_for_ten_seconds(step, loops):
    """Some twenty passages; with 0.3 m as the worst where stages in singular positions were taken as others."""
    run = carom.simulate(four_bar.scene(loops), 10.0, step=step, method="rk8", save_every=10**9)
    lean = exact(10.0, 0.0, 1.0, loops)[0]
    tip = 2.0 * run.position[-1, 0, :2]
    np.testing.assert_allclose(tip, (np.sin(lean), np.cos(lean)), rtol=0, atol=1e-8)
