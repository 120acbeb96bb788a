"""Geometry of the boundary layer, and its closed forms without friction (mathematics page, §1.8).

The layer is 0 < x < b. Its metric g_11 = m (b/x)^2 is singular at the boundary x = 0, so the boundary is
infinitely far away. In the coordinate s = b ln(x/b) the metric is constant (flat).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom import checks
from carom.impact.api import checked_inverse_mass


def normal_coordinate(s, width):
    """Return x = b exp(s/b) of the flat coordinate s = b ln(x/b): 0 at entry, -infinity at the boundary."""
    return width * np.exp(np.asarray(s) / width)


def depth_number(penetration):
    """Return l = -ln(1 - delta): the least s in the layer is -b l."""
    return -np.log1p(-np.asarray(penetration))


@dataclass(frozen=True)
class NormalMotion:
    """Law A without coupling: constant force in s, in each phase (paper, equation (8)).

    Parameters
    ----------
    approach_speed : float
        v_0 > 0 [m/s].
    restitution : float
        e in (0, 1].
    width, penetration : float
        b [m] and delta of the layer.
    """

    approach_speed: float
    restitution: float
    width: float
    penetration: float

    @property
    def compression_time(self) -> float:
        """T_c = 2 b l / v_0 [s]."""
        return float(2.0 * self.width * depth_number(self.penetration) / self.approach_speed)

    @property
    def restitution_time(self) -> float:
        """T_r = T_c / e [s]."""
        return self.compression_time / self.restitution

    @property
    def acceleration(self) -> float:
        """a_c = v_0^2 / (2 b l) of compression [m/s^2]; that of restitution is e^2 a_c."""
        return self.approach_speed / self.compression_time

    def s(self, t):
        """Return s(t): -b l [1 - (1-z)^2], z = t/T_c, then -b l (1 - z^2), z = (t - T_c)/T_r."""
        t = np.asarray(t, dtype=np.float64)
        z = t / self.compression_time
        y = (t - self.compression_time) / self.restitution_time
        part = np.where(z <= 1.0, z * (2.0 - z), (1.0 - y) * (1.0 + y))
        return -self.width * depth_number(self.penetration) * part

    def x(self, t):
        """Return x(t) = b exp(s/b) [m]."""
        return normal_coordinate(self.s(t), self.width)

    def normal_velocity(self, t):
        """Return u_n(t) = ds/dt: -v_0 (1 - z), then e v_0 (t - T_c)/T_r [m/s]."""
        t = np.asarray(t, dtype=np.float64)
        v, t_c = self.approach_speed, self.compression_time
        after = self.restitution * v * (t - t_c) / self.restitution_time
        return np.where(t <= t_c, -v * (1.0 - t / t_c), after)

    def x_rate(self, t):
        """Return dx/dt = u_n x/b [m/s]."""
        return self.normal_velocity(t) * self.x(t) / self.width


def diagonal_form(inverse_mass, velocity, force):
    """Return the paper's uncoupled form of an impact, equations (8) and (9).

    g_ii d(vtil^i)/dt = f_i with vtil^1 = u_n, vtil^a = u_a - (W_an/W_nn) u_n, f_1 = N + W_nt.T/W_nn, f_a = T_a.
    The tangential axes are turned to the principal axes of the reduced W_tt - W_tn W_nt/W_nn.

    Parameters
    ----------
    inverse_mass : array_like, shape (3, 3)
        W, regular [1/kg].
    velocity, force : array_like, shape (3,)
        u and (N, T_1, T_2), in contact axes.

    Returns
    -------
    g, velocity, force : ndarray, shape (3,)
        Diagonal metric [kg], vtil [m/s], f [N].
    """
    W = checked_inverse_mass(inverse_mass)
    if not np.linalg.cond(W) < 1e15:
        raise ValueError(f"inverse_mass must be regular, got {checks.shown(inverse_mass)}")
    u = checks.finite_array("velocity", velocity, (3,), "m/s")
    f = checks.finite_array("force", force, (3,), "N")
    ratio = W[1:, 0] / W[0, 0]
    reduced, axes = np.linalg.eigh(W[1:, 1:] - np.outer(W[1:, 0], ratio))
    g = np.array([1.0 / W[0, 0], *(1.0 / reduced)])
    v = np.array([u[0], *(axes.T @ (u[1:] - ratio * u[0]))])
    return g, v, np.array([f[0] + ratio @ f[1:], *(axes.T @ f[1:])])
