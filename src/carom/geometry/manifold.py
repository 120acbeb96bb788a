"""The configuration manifold (R^3 x SO(3))^N with its connection and kinetic metric."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import finite_array
from carom.geometry.inertia import mass_and_inertia

Array = NDArray[np.float64]


class Point(NamedTuple):
    """A configuration q: mass centres `x` (N, 3) [m] and unit quaternions `Q` (N, 4)."""

    x: Array
    Q: Array


@dataclass(frozen=True, eq=False)
class Manifold:
    """N rigid bodies as one point of (R^3 x SO(3))^N.

    Tangent vectors (N, 6) have components in the left-invariant frame: three along world axes [m],
    three along body axes [rad]; velocities likewise per second, covectors (momenta, forces) are
    dual to them.

    Parameters
    ----------
    mass : array_like (N,)
        Masses [kg].
    inertia : array_like (N, 3) or (N, 3, 3)
        Principal moments or full tensors about the mass centres, body axes [kg m^2].

    Raises
    ------
    ValueError
        If a mass is not above zero or an inertia not symmetric positive definite.

    Notes
    -----
    Source: mathematics page, *Configuration and metric*, *Connection and autoparallels*.
    """

    mass: Array
    inertia: Array

    def __post_init__(self):
        m, J = mass_and_inertia(self.mass, self.inertia)
        for name, value in (("mass", m), ("inertia", J)):
            value.flags.writeable = False
            object.__setattr__(self, name, value)

    @property
    def bodies(self) -> int:
        """Number N of bodies."""
        return len(self.mass)

    def point(self, x: ArrayLike, Q: ArrayLike) -> Point:
        """Return the point of mass centres x (N, 3) [m] and quaternions Q (N, 4), normalised."""
        x = finite_array("x", x, (self.bodies, 3), "m")
        Q = finite_array("Q", Q, (self.bodies, 4))
        length = np.linalg.norm(Q, axis=1, keepdims=True)
        if not np.all(np.abs(length - 1.0) <= 1e-6):
            raise ValueError(f"Q must be unit quaternions (w, x, y, z), got lengths {length[:, 0]}")
        return Point(x, Q / length)

    def exp(self, q: Point, xi: ArrayLike) -> Point:
        """Return the end (x + xi_x, R exp(hat xi_theta)) of the autoparallel that starts at q along xi."""
        from carom.geometry import autoparallel

        q, result = self.point(*q), self._empty()
        autoparallel.exp(q.x, q.Q, self._tangent("xi", xi), result.x, result.Q)
        return result

    def log(self, q0: Point, q1: Point) -> Array:
        """Return the arc xi (N, 6) from q0 to q1 that turns each body by an angle in [0, pi].

        At the angle pi two arcs lead to q1, and one of them is returned.
        """
        from carom.geometry import autoparallel

        q0, q1, out = self.point(*q0), self.point(*q1), np.empty((self.bodies, 6))
        autoparallel.log(q0.x, q0.Q, q1.x, q1.Q, out)
        return out

    def transport_vector(self, xi: ArrayLike, vector: ArrayLike) -> Array:
        """Return `vector` (N, 6) after parallel transport to the end of the arc xi: exp(-hat xi_theta)."""
        return self._map("transport_vector", xi, vector)

    def transport_covector(self, xi: ArrayLike, covector: ArrayLike) -> Array:
        """Return `covector` (N, 6) after parallel transport to the end of the arc xi; <p, w> is preserved."""
        return self._map("transport_covector", xi, covector)

    def differential(self, xi: ArrayLike, rate: ArrayLike) -> Array:
        """Return the velocity (N, 6) of the end of the arc when xi changes at `rate`: T(xi) rate."""
        return self._map("differential", xi, rate)

    def differential_inverse(self, xi: ArrayLike, velocity: ArrayLike) -> Array:
        """Return the rate (N, 6) of xi for a `velocity` of the end of the arc; angles must be below 2 pi."""
        return self._map("differential_inverse", xi, velocity)

    def lower(self, vector: ArrayLike) -> Array:
        """Return the covector M v (N, 6) of a vector: the momenta [kg m/s, kg m^2/s] of v."""
        v = self._tangent("vector", vector)
        return np.hstack(
            [self.mass[:, None] * v[:, :3], np.einsum("nij,nj->ni", self.inertia, v[:, 3:])]
        )

    def inner(self, a: ArrayLike, b: ArrayLike) -> float:
        """Return a . M b; half of v . M v is the kinetic energy [J] of a velocity v (N, 6)."""
        return float(np.sum(self._tangent("a", a) * self.lower(b)))

    def length(self, xi: ArrayLike) -> float:
        """Return the length sqrt(xi . M xi) [sqrt(kg) m] of the autoparallel arc xi (N, 6).

        The velocity has constant components along the arc, so this is exact for any inertia.
        """
        xi = self._tangent("xi", xi)
        return float(np.sqrt(self.inner(xi, xi)))

    def _tangent(self, name: str, value: ArrayLike) -> Array:
        return finite_array(name, value, (self.bodies, 6))

    def _empty(self) -> Point:
        return Point(np.empty((self.bodies, 3)), np.empty((self.bodies, 4)))

    def _map(self, kernel: str, xi: ArrayLike, vector: ArrayLike) -> Array:
        from carom.geometry import autoparallel

        out = np.empty((self.bodies, 6))
        getattr(autoparallel, kernel)(self._tangent("xi", xi), self._tangent("vector", vector), out)
        return out
