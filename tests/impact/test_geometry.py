"""Geometry of the layer and the paper's diagonal form, against direct formulas."""

import numpy as np
import pytest
from cases import U_SPACE, W_SPACE

from carom.impact import geometry as g
from verified import agree, verifies


def affinity(x):
    """L^1_11 = -1/x, the only nonzero component of the connection of the layer."""
    return -1.0 / x


def metric(effective_mass, x, width):
    """The metric at x: the effective mass W^-1 with its first row and column times b/x."""
    g = effective_mass.copy()
    g[0, :] *= width / x
    g[:, 0] *= width / x
    return g


def test_numbers_of_law_a():
    # V2: l(.8), l(.2); T_c v0/b = 2 l; F_c of m = 1 kg, b = 1 mm, v0 of a drop from .4 m.
    assert g.depth_number(0.8) == pytest.approx(1.609437912434100, rel=1e-15)
    assert g.depth_number(0.2) == pytest.approx(0.223143551314210, rel=1e-14)
    v0 = np.sqrt(2 * 9.81 * 0.4)
    for delta, time, force in (
        (0.8, 3.21887582487, 2438.11828321),
        (0.2, 0.446287102628, 17585.092542),
    ):
        motion = g.NormalMotion(v0, 0.5, 1e-3, delta)
        assert motion.compression_time * v0 / 1e-3 == pytest.approx(time, rel=1e-11)
        assert motion.acceleration == pytest.approx(force, rel=1e-11)
        assert motion.restitution_time == pytest.approx(2 * motion.compression_time)


def test_closed_forms_satisfy_the_equation_of_the_layer():
    # (g_11 v)' - L^1_11 g_11 v v = f_1, g_11 = m (b/x)^2, f_1 = m a b/x; here by differences of v.
    motion, b = g.NormalMotion(2.0, 0.5, 1e-3, 0.8), 1e-3
    t_c, t_r, h = motion.compression_time, motion.restitution_time, 1e-9
    for t, a in ((0.3 * t_c, motion.acceleration), (t_c + 0.4 * t_r, 0.25 * motion.acceleration)):
        x, v = motion.x(t), motion.x_rate(t)
        np.testing.assert_allclose(v, (motion.x(t + h) - motion.x(t - h)) / (2 * h), rtol=1e-6)
        rate = (
            motion.x_rate(t + h) * (b / motion.x(t + h)) ** 2
            - motion.x_rate(t - h) * (b / motion.x(t - h)) ** 2
        ) / (2 * h)
        left = rate - affinity(x) * (b / x) ** 2 * v * v
        assert left == pytest.approx(
            a * b / x, rel=1e-5
        )  # central differences: h^2 and round-off/h


def test_affinity_is_that_of_the_metric():
    # Levi-Civita: L^1_11 = (d g_11/dx) / (2 g_11) = -1/x.
    mass, b, x, h = np.linalg.inv(W_SPACE), 1e-3, 4e-4, 1e-9
    slope = (metric(mass, x + h, b)[0, 0] - metric(mass, x - h, b)[0, 0]) / (2 * h)
    assert slope / (2 * metric(mass, x, b)[0, 0]) == pytest.approx(affinity(x), rel=1e-8)
    # In the flat coordinate the energy is that of the constant metric: u_n = b xdot/x.
    v = U_SPACE * [x / b, 1, 1]
    assert v @ metric(mass, x, b) @ v == pytest.approx(U_SPACE @ mass @ U_SPACE, rel=1e-13)
    assert g.normal_coordinate(b * np.log(x / b), b) == pytest.approx(x, rel=1e-14)


@verifies("impact.diagonal_form", r"the same energy and power as $\dot u = W (N, T)$", "invariant")
def test_diagonal_form_is_the_coupled_one():
    # g_ii d(vtil)/dt = f_i against du/dt = W (N, T), and the same kinetic energy.
    force = np.array([3.0, -0.4, 0.7])
    masses, vtil, f = g.diagonal_form(W_SPACE, U_SPACE, force)
    energy = U_SPACE @ np.linalg.solve(W_SPACE, U_SPACE)
    agree(np.sum(masses * vtil**2), energy, rtol=1e-13)
    _, rate, _ = g.diagonal_form(W_SPACE, W_SPACE @ force, force)  # vtil is linear in u
    agree(masses * rate, f, rtol=1e-12)
    # Power: f.vtil = force.u
    agree(f @ vtil, force @ U_SPACE, rtol=1e-13)
