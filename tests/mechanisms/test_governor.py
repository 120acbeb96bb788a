"""The flyball governor (IFToMM A05), stiff: against an account in two coordinates, as the example reads it.

By symmetry both rods lean alike, by alpha below the horizontal; s is the height of the slider, H the momentum
about the axis, which nothing changes. Then 2 T = H^2/I(alpha) + 2 I_r alpha'^2 + m s'^2, V = m g s -
(m_r + 2 m_p) g sin(alpha) + K (l - l_0)^2, power 2 C l'^2 is lost.
"""

import functools
import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

import carom

EXAMPLE = runpy.run_path(str(Path(__file__).parents[2] / "examples/mechanisms/a05_governor.py"))
mechanism = EXAMPLE["mechanism"]
g, K, C, l_0, a, b, m_p, m_r, m = (
    EXAMPLE[k] for k in ("g", "K", "C", "l_0", "a", "b", "m_p", "m_r", "m")
)


def about_axis(alpha):
    """I(alpha) of the whole, and its derivative."""
    c, s = np.cos(alpha), np.sin(alpha)
    I = m_r * (a * a + a * c + c * c / 3 + b * b / 12 * (1 + s * s)) + m_p * (a + c) ** 2
    slope = -s * (m_r * (a + 2 * c / 3 - b * b / 6 * c) + 2 * m_p * (a + c))
    return 2 * I + m * 0.01 / 6 + m_r * b * b / 6, 2 * slope


def rates(t, y, H):
    alpha, s, d_alpha, d_s = y
    I, slope = about_axis(alpha)
    x, z = np.cos(alpha) / 2, 1 - np.sin(alpha) / 2 - s  # from the slider to the middle of a rod
    l = np.hypot(x, z)
    l_alpha, l_s = (-x * np.sin(alpha) - z * np.cos(alpha)) / (2 * l), -z / l
    pull = K * (l - l_0) + C * (l_alpha * d_alpha + l_s * d_s)
    I_r = m_r / 3 + m_r * b * b / 12 + m_p
    torque = H * H / I**2 * slope / 2 + (m_r + 2 * m_p) * g * np.cos(alpha) - 2 * pull * l_alpha
    return [d_alpha, d_s, torque / (2 * I_r), -g - 2 * pull * l_s / m]


@functools.cache
def reference(duration, method="Radau"):
    H = about_axis(np.pi / 6)[0] * 2 * np.pi
    return solve_ivp(
        rates, (0, duration), [np.pi / 6, 0.5, 0, 0], method, rtol=1e-11, atol=1e-13,
        dense_output=True, args=(H,),
    ).sol  # fmt: skip


def test_height_of_the_slider_in_the_example_is_that_of_the_two_coordinates():
    # LSODA is within 5e-11 of Radau there, in a thirtieth of its time
    assert reference(10.0, "LSODA")(10.0)[1] == pytest.approx(EXAMPLE["END"], abs=1e-9)


def test_order_and_energy():
    exact = reference(0.5)
    errors, drifts = [], []
    for h in (2e-4, 1e-4):
        s = carom.simulate(mechanism(), 0.5, step=h)
        errors.append(np.max(np.abs(s.position[:, 1, 2] - exact(s.t)[1])))
        drifts.append(np.max(np.abs(s.ledger.residual)))
        assert np.max(s.constraint_errors) < 1e-12
    # h C-rate is 1.6 and 0.8: above what a Taylor series of rk4 is good for
    assert errors[0] / errors[1] > 14.0
    assert errors[1] < 1e-9
    assert drifts[1] < 1e-6  # of 239 J
    assert s.ledger.loads[-1] < 0.0  # dampers take, and what they take is in the ledger


def steady(w):
    """The lean and height at which it turns at w: no rate of alpha or s changes.

    Sought in alpha and the force p = K (l - l_0) of a spring, which scale alike: s is that of this l.
    """

    def place(y):
        alpha, l = y[0], l_0 + y[1] / K
        return alpha, 1 - np.sin(alpha) / 2 - np.sqrt(l * l - np.cos(alpha) ** 2 / 4)

    def at_rest(y):
        return rates(0.0, [*place(y), 0.0, 0.0], about_axis(y[0])[0] * w)[2:]

    found = root(at_rest, [0.5, 30.0], tol=1e-13)
    assert np.max(np.abs(found.fun)) < 1e-8  # round-off of K (l - l_0)/m: 1e-10
    return place(found.x)


@pytest.mark.parametrize("w", [4.0, 2 * np.pi])
def test_steady_turning_is_kept(w):
    alpha, s = steady(w)
    solution = carom.simulate(mechanism(alpha, s, w), 0.5, step=1e-4, save_every=100)
    assert np.ptp(solution.position[:, 1, 2]) < 1e-10
    np.testing.assert_allclose(solution.angular_velocity[..., 2], w, rtol=1e-10)
