"""Results of one joint."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom import arguments, checks
from carom.results.views.common import View, alone

if TYPE_CHECKING:
    from carom.results.event_tables import JointImpulseTable


@arguments.attributes()
class JointView(View):
    """Results of one joint: ``solution["hinge"]``, or ``state["hinge"]`` at one time (without T)."""

    @arguments.known
    def coordinates(self, *, degrees: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Return coordinates and rates, (T, n) each, as `Solution.joint_coordinates` does.

        Parameters
        ----------
        degrees : bool
            Whether angles are in degrees. Default False: radians.
        """
        return self._source.joint_coordinates(self._part, degrees=degrees)

    @property
    def coordinate(self):
        """Coordinates [rad or m], (T, n); (T,) if the joint has one. See `Solution.joint_coordinates`."""
        return alone(self.coordinates()[0])

    @property
    def rate(self):
        """Rates of the coordinates [rad/s or m/s], (T, n); (T,) if the joint has one."""
        return alone(self.coordinates()[1])

    @property
    def force(self) -> np.ndarray:
        """Force on the child at its anchor (T, 3), world axes [N]: see `Solution.joint_reactions`."""
        return self._source.joint_reactions[..., self._part.index, :3]

    @property
    def torque(self) -> np.ndarray:
        """Torque on the child about its anchor (T, 3), world axes [N m]."""
        return self._source.joint_reactions[..., self._part.index, 3:]

    @arguments.known
    def to_pandas(self, *, degrees: bool = False) -> Any:
        """Return a `pandas.DataFrame` with one row for each saved time, indexed by the time [s].

        Columns are ``coordinate`` and ``rate`` (with an index if there are several: ``coordinate[0]``), and the
        components of force and torque, ``fx``, ``fy``, ``fz``, ``tx``, ``ty``, ``tz``, as in
        `Solution.to_pandas`.

        Parameters
        ----------
        degrees : bool
            Whether angles are in degrees. Default False: radians.
        """
        pandas = checks.need("pandas", "to_pandas", "files")
        columns = {}
        for name, values in zip(("coordinate", "rate"), self.coordinates(degrees=degrees)):
            rows = np.reshape(values, (-1, np.shape(values)[-1])).T
            columns |= {
                f"{name}[{k}]" if len(rows) > 1 else name: one for k, one in enumerate(rows)
            }
        for name, values in (("f", self.force), ("t", self.torque)):
            columns |= {name + axis: one for axis, one in zip("xyz", np.reshape(values, (-1, 3)).T)}
        return pandas.DataFrame(
            columns, index=pandas.Index(np.atleast_1d(self._source.t), name="time")
        )

    def plot(self, **options) -> Any:
        """Draw coordinates, rates, forces and torques over time, as `carom.plots.joints` does."""
        return self._drawn("joints", options)

    @property
    def impulses(self) -> JointImpulseTable:
        """Impulses of the joint in impacts: rows of `Solution.joint_impulses`."""
        return self._table("joint_impulses")
