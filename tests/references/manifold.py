"""The configuration manifold (R^3 x SO(3))^N with its autoparallels and its kinetic metric."""

from typing import NamedTuple

import numpy as np

from carom.geometry import differential, quaternion


class Point(NamedTuple):
    """A configuration q: mass centres `x` (N, 3) [m] and unit quaternions `Q` (N, 4)."""

    x: np.ndarray
    Q: np.ndarray


class Manifold(NamedTuple):
    """N rigid bodies as one point of (R^3 x SO(3))^N: masses (N,), inertias (N, 3, 3) in body axes.

    Tangent vectors (N, 6) have components in the left-invariant frame: three along world axes [m],
    three along body axes [rad]; velocities likewise per second, covectors (momenta, forces) are
    dual to them. (Mathematics page, §1.1 and §1.2.)
    """

    mass: np.ndarray
    inertia: np.ndarray

    def exp(self, q, xi) -> Point:
        """The end (x + xi_x, R exp(hat xi_theta)) of the autoparallel that starts at q along xi."""
        turned = quaternion.multiply(q.Q, quaternion.exp(xi[:, 3:]))
        return Point(q.x + xi[:, :3], quaternion.normalize(turned))

    def log(self, q0, q1):
        """The arc xi (N, 6) from q0 to q1 that turns each body by an angle in [0, pi]."""
        return np.hstack([q1.x - q0.x, quaternion.between(q0.Q, q1.Q)])

    def transport(self, xi, a):
        """A vector or covector (N, 6) after parallel transport along the arc: exp(-hat xi_theta).

        This rotation is its own inverse transpose, so <p, w> is preserved.
        """
        turn = quaternion.exp(xi[:, 3:])
        return np.hstack([a[:, :3], quaternion.rotate_back(turn, a[:, 3:])])

    def differential(self, xi, rate):
        """The velocity (N, 6) of the end of the arc when xi changes at `rate`: T(xi) rate."""
        return np.hstack([rate[:, :3], differential.apply(xi[:, 3:], rate[:, 3:])])

    def inner(self, a, b) -> float:
        """a . M b; half of v . M v is the kinetic energy [J] of a velocity v (N, 6)."""
        turning = np.einsum("ni,nij,nj", a[:, 3:], self.inertia, b[:, 3:])
        return float(self.mass @ np.sum(a[:, :3] * b[:, :3], axis=1) + turning)

    def length(self, xi) -> float:
        """The length sqrt(xi . M xi) [sqrt(kg) m] of the arc: the speed along it is constant."""
        return float(np.sqrt(self.inner(xi, xi)))


def kinetic_metric(mass, inertia):
    """The metric ``M = blockdiag(m 1, J)`` (6N, 6N) of masses (N,) and tensors (N, 3, 3)."""
    result = np.zeros((6 * len(mass), 6 * len(mass)))
    for k, (m, J) in enumerate(zip(mass, inertia)):
        i = 6 * k
        result[i : i + 3, i : i + 3], result[i + 3 : i + 6, i + 3 : i + 6] = m * np.eye(3), J
    return result
