"""The motion of one body."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.flexible.modes import Modes
from carom.geometry import quaternion
from carom.scene.bodies import Body

if TYPE_CHECKING:
    from carom.results.named import Source


class _Motion(NamedTuple):
    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray


@arguments.attributes()
class BodyState(_Motion):
    """Position, orientation and velocities of one body, in world axes: at one time, or at T saved times.

    Attributes
    ----------
    position : (3,) or (T, 3)
        Mass centre [m].
    orientation : (4,) or (T, 4)
        Unit quaternion (w, x, y, z), body to world.
    velocity, angular_velocity : (3,) or (T, 3)
        [m/s] and [rad/s].
    """

    _source: Source
    _part: Body

    @classmethod
    def _of(cls, source: Source, part: Body) -> BodyState:
        k = part.index
        made = cls(*(getattr(source, name)[..., k, :] for name in cls._fields))
        made._source, made._part = source, part
        return made

    def __repr__(self) -> str:
        if self.position.ndim == 1:
            return super().__repr__()
        listed = (f"{name} {getattr(self, name).shape}" for name in self._fields)
        return f"<BodyState of {self._part.name!r}: {', '.join(listed)}, energies>"

    @property
    def modal(self) -> np.ndarray:
        """Coordinates of the modes of a flexible body, (n,) or (T, n) [sqrt(kg) m], for unit modal masses.

        Raises
        ------
        ValueError
            If the body has no modes.
        """
        return self._of_modes("position")

    @property
    def modal_rates(self) -> np.ndarray:
        """Rates of the coordinates of its modes, (n,) or (T, n) [sqrt(kg) m/s]."""
        return self._of_modes("velocity")

    def displacement(self, points: ArrayLike) -> np.ndarray:
        """Return the displacements of points of a flexible body by its modes, in body axes [m].

        Parameters
        ----------
        points : (3,) or (k, 3)
            Places on the undeformed body, in body axes [m].

        Returns
        -------
        (3,) or (k, 3), at T saved times (T, 3) or (T, k, 3)
            Phi eta. A point is at position + R (point + displacement).
        """
        modes, eta = self._modes(), self.modal
        given = checks.real_array("points", points, "(3,) or (k, 3)")
        places = checks.finite_array(
            "points", given, (3,) if given.ndim == 1 else (len(given), 3), "m"
        )
        shapes = modes.shapes(np.atleast_2d(places))
        out = np.einsum("kan,...n->...ka", shapes, eta)
        return out[..., 0, :] if given.ndim == 1 else out

    def _modes(self) -> Modes:
        if self._part.modes is None:
            raise ValueError(f"{self._part.name!r} must have modes, got a rigid body")
        return self._part.modes

    def _of_modes(self, field: str) -> np.ndarray:
        modes, k = self._modes(), self._part.index
        n = len(modes.frequencies)
        rows = getattr(self._source, field)[..., k + 1 : k + 1 + -(-n // 3), :]
        return rows.reshape(*rows.shape[:-2], -1)[..., :n] * np.sqrt(self._part.mass)

    @property
    def kinetic_energy(self):
        """Kinetic energy [J], a number or (T,)."""
        w = quaternion.rotate_back(self.orientation, self.angular_velocity)
        turning = np.sum(w * (w @ self._part.inertia), axis=-1)
        return 0.5 * (self._part.mass * np.sum(self.velocity**2, axis=-1) + turning)

    @property
    def potential_energy(self):
        """Potential energy of gravity [J], a number or (T,); 0 where the mass centre is at the origin."""
        return -self._part.mass * (self.position @ self._source._scene.gravity)

    @property
    def energy(self):
        """Kinetic energy plus the potential energy of gravity [J], a number or (T,)."""
        return self.kinetic_energy + self.potential_energy
