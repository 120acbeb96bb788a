"""Results of one force, and of one constraint, of which a motor acts along a coordinate as a force does."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom import arguments
from carom.results.views.common import AlongCoordinate, View, alone
from carom.scene.belts import BeltRelation
from carom.scene.constraints import Driver
from carom.scene.forces import CurveSpring, Spring
from carom.scene.more_forces import AlongJoint, UserForce
from carom.scene.strand_force import BeltStrand


@arguments.attributes()
class ForceView(AlongCoordinate, View):
    """Results of one force: ``solution["motor"]``, or ``state["motor"]`` at one time (without T).

    They are computed from the states and the law of the force when they are asked for; those of `JointFriction`
    with the reactions of joints. Those of `JointInertia`, which need accelerations, are NaN.
    """

    @property
    def _along(self):
        d = self._part.definition
        return d if isinstance(d, AlongJoint) else None

    def plot(self, **options) -> Any:
        """Draw the force over time, as `carom.plots.forces` does."""
        return self._drawn("forces", options)

    @property
    def _rows(self) -> np.ndarray:
        return self._source._exerted_by(self._part)

    @property
    def _value(self):
        return self._rows[..., 0, 6][()]

    def _vector(self, first: int) -> np.ndarray:
        rows = self._rows[..., first : first + 3]
        return rows if isinstance(self._part.definition, UserForce) else rows[..., 0, :]

    @property
    def force(self) -> np.ndarray:
        """Force on the child (T, 3), world axes [N].

        Along a displacement of a joint: the force along it (T,). Of a `UserForce`: (T, n, 3) on its n bodies.
        """
        return self._vector(0) if self._along is None else self._acts("slide")

    @property
    def torque(self) -> np.ndarray:
        """Torque on the child (T, 3), world axes [N m].

        Along an angle of a joint: the torque about its axis (T,). Of a `UserForce`: (T, n, 3) on its n bodies.
        """
        return self._vector(3) if self._along is None else self._acts("turn")

    @property
    def power(self):
        """Power that it gives to the bodies [W], (T,): negative for a damper."""
        return np.sum(self._rows[..., 7], axis=-1)

    def _line(self) -> np.recarray:
        """Return what it exerts (T,), with its length, or that of one time."""
        if not isinstance(self._part.definition, (Spring, CurveSpring)):
            raise AttributeError(f"{self.name!r} has no length: it is no Spring or CurveSpring")
        found = self._source._report((self._part,))[:, 0]
        return found[0] if np.ndim(self._source.t) == 0 else found

    @property
    def length(self):
        """Distance of the ends of a spring [m], (T,)."""
        return self._line().length

    @property
    def length_rate(self):
        """Rate of this distance [m/s], (T,)."""
        return self._line().stretching

    @property
    def tension(self):
        """Force with which a spring, and its damper, pull the ends together [N], (T,); tension of a strand."""
        if isinstance(self._part.definition, BeltStrand):
            return -self._value
        return self._line().value


@arguments.attributes()
class ConstraintView(AlongCoordinate, View):
    """Results of one constraint: a motor (`Driver`), a gear, rows of one's own."""

    @property
    def _along(self):
        d = self._part.definition
        return d if isinstance(d, Driver) else None

    @property
    def multipliers(self) -> np.ndarray:
        """Multipliers of its rows, (T, n); (T,) if it has one. See `Solution.constraint_forces`."""
        before = self._source._scene.constraints[: self._part.index]
        first = sum(one.rows for one in before)
        return alone(self._source.constraint_forces[..., first : first + self._part.rows])

    @property
    def _value(self):
        return self.multipliers

    @property
    def force(self):
        """Force of a `Driver` along a displacement [N], (T,)."""
        return self._driven("slide")

    @property
    def torque(self):
        """Torque of a `Driver` about an angle [N m], (T,)."""
        return self._driven("turn")

    def _driven(self, kind: str):
        if self._along is None:
            raise AttributeError(f"{self.name!r} is no Driver: it has multipliers, and no force")
        return self._acts(kind)

    @property
    def tension(self):
        """Tensions of both strands of a `carom.joints.Belt` [N], (T, 2): below 0 where one would push."""
        d = self._part.definition
        if not isinstance(d, BeltRelation):
            raise AttributeError(f"{self.name!r} has no tension: it is no Belt")
        half = 0.5 * np.asarray(self.multipliers)
        return d.tension + np.stack([-half, half], axis=-1)

    @property
    def power(self):
        """Power of a `Driver` [W], (T,)."""
        return self.rate * self.multipliers
