"""What views of parts share: their names and tables, and what acts along a coordinate of a joint."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import arguments
from carom.results.names import UNITS
from carom.scene.coordinates import Length, kind_of, terms_of

if TYPE_CHECKING:
    from carom.results.named import Source


@arguments.attributes()
class View:
    """Base class of the results of a part that is no body."""

    def __init__(self, source: Source, part):
        self._source, self._part = source, part

    @property
    def name(self) -> str:
        """Name of the part."""
        return self._part.name

    def _table(self, name: str):
        """Return the rows of a table of the solution that belong to this part."""
        table = getattr(self._source, name, None)
        if table is None or np.ndim(self._source.t) == 0:
            raise AttributeError(
                f"{name} are those of a whole run: solution[{self.name!r}], not of a state"
            )
        return table[self.name]

    def _drawn(self, kind: str, options: dict) -> Any:
        """Return the axes of a plot of this part over a run."""
        plot = getattr(self._source, "plot", None)
        if plot is None:
            raise AttributeError(
                f"a plot is of a whole run: solution[{self.name!r}], not of a state"
            )
        return plot(kind, self.name, **options)

    def __repr__(self) -> str:
        listed = ", ".join(n for n in dir(type(self)) if not n.startswith("_") and n != "name")
        return f"<{type(self).__name__} of {self.name!r}: {listed}>"


def alone(values: np.ndarray):
    """Return values (..., n) without the last axis if there is only one."""
    return values[..., 0][()] if values.shape[-1] == 1 else values


class AlongCoordinate(ABC):
    """What acts along a coordinate of a joint."""

    _source: Source
    name: str

    @property
    @abstractmethod
    def _along(self) -> Any:
        """The definition with the joint."""

    @property
    @abstractmethod
    def _value(self) -> Any:
        """The force or torque along the coordinate."""

    def _coordinate(self, which: int):
        if self._along is None:
            raise AttributeError(f"{self.name!r} acts along no coordinate of a joint")
        source, read = self._source, self._source.joint_coordinates
        terms = terms_of(self._along.joint, self._along.coordinate)
        if any(isinstance(one, Length) for one, _, _ in terms):
            motion = source._reports.motion(
                self._along.joint, source._saved, self._along.coordinate
            )
            found = motion.value if which == 0 else motion.rate
            return np.reshape(found, np.shape(source.t))[()]
        found = [factor * read(joint)[which][..., k] for joint, k, factor in terms]
        return np.sum(found, axis=0)[()]

    @property
    def coordinate(self):
        """Coordinate of the joint along which it acts [rad or m], (T,)."""
        return self._coordinate(0)

    @property
    def rate(self):
        """Rate of this coordinate [rad/s or m/s], (T,)."""
        return self._coordinate(1)

    def _acts(self, kind: str):
        """Return the force or torque along the coordinate; refuse the other one."""
        own = kind_of(self._along.joint, self._along.coordinate)
        if own != kind:
            asked, has = ("torque", "force") if kind == "turn" else ("force", "torque")
            raise AttributeError(
                f"{self.name!r} acts along a coordinate in {UNITS[own]}: it has a {has}, no {asked}"
            )
        return self._value
