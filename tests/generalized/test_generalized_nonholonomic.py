"""Constraints on velocities, in closed form."""

import numpy as np
import sympy as sp
from coordinate_systems import symbols

import carom
from carom import GeneralizedSystem
from verified import agree, verifies


def sleigh(m, J, a, start, rates):
    """Blade at (x, y), mass centre a distance a ahead of it."""
    q, v = symbols("x y th")
    th, (dx, dy, w) = q[2], v
    T = m * ((dx - a * w * sp.sin(th)) ** 2 + (dy + a * w * sp.cos(th)) ** 2) / 2 + J * w**2 / 2
    return GeneralizedSystem.from_sympy(
        q, v, kinetic_energy=T, rates=[-dx * sp.sin(th) + dy * sp.cos(th)],
        position=start, velocity=rates,
    )  # fmt: skip


def test_chaplygin_sleigh():
    # With k = J + m a^2: w = W sech(c t + b), v = V tanh(c t + b), V = W sqrt(k/m), c = a W sqrt(m/k).
    m, J, a, W, b = 2.0, 0.5, 0.4, 3.0, -1.5
    k = J + m * a * a
    V, c = W * np.sqrt(k / m), a * W * np.sqrt(m / k)
    start = [V * np.tanh(b), 0.0, W / np.cosh(b)]
    errors = []
    for step in (0.02, 0.01):
        run = carom.simulate(sleigh(m, J, a, [0, 0, 0], start), 2.0, step=step)
        along = run.v[:, 0] * np.cos(run.q[:, 2]) + run.v[:, 1] * np.sin(run.q[:, 2])
        spin_error = np.max(np.abs(run.v[:, 2] - W / np.cosh(c * run.t + b)))
        errors.append(max(spin_error, np.max(np.abs(along - V * np.tanh(c * run.t + b)))))
        assert np.max(run.constraint_errors[1]) < 1e-14
    assert errors[1] < 1e-7
    assert errors[0] / errors[1] > 12.0


@verifies(
    "GeneralizedSystem.from_sympy",
    r"knife edge on a slope: $x = g'(1 - \cos 2\omega t)/4\omega^2$",
    "closed form",
)
def test_knife_edge_on_an_incline():
    # Neimark and Fufaev: from rest with spin w the blade rises and falls within g sin / (2 w^2), and drifts
    # across: x = g' (1 - cos 2 w t) / (4 w^2), y = g' (w t - sin(2 w t) / 2) / (2 w^2).
    q, v = symbols("x y th")
    pull, w = 4.0, 2.0
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, 1, sp.Rational(1, 10)), potential=-pull * q[0],
        rates=[v[0] * sp.sin(q[2]) - v[1] * sp.cos(q[2])],
        position=[0, 0, 0], velocity=[0, 0, w],
    )  # fmt: skip
    run = carom.simulate(system, 3.0, step=5e-3)
    x = pull * (1 - np.cos(2 * w * run.t)) / (4 * w * w)
    y = pull * (w * run.t - np.sin(2 * w * run.t) / 2) / (2 * w * w)
    agree(run.q[:, 0], x, atol=1e-8)
    agree(run.q[:, 1], y, atol=1e-8)
    agree(run.total_energy, run.total_energy[0], atol=1e-8)


def test_a_redundant_constraint_changes_nothing():
    q, v = symbols("x y")
    x, y = q
    runs = []
    for constraints in ([x**2 + y**2 - 1], [x**2 + y**2 - 1, 2 * x**2 + 2 * y**2 - 2]):
        system = GeneralizedSystem.from_sympy(
            q, v, metric=sp.eye(2), potential=9.81 * y, constraints=constraints,
            position=[0.6, -0.8], velocity=[0.8, 0.6],
        )  # fmt: skip
        runs.append(carom.simulate(system, 1.0, step=2e-3))
    np.testing.assert_allclose(runs[1].q, runs[0].q, rtol=0, atol=1e-12)
    assert np.max(runs[1].constraint_errors[0]) < 1e-14
