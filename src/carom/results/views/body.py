"""The motion of one body."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom import arguments
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
