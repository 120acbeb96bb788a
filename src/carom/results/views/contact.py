"""Results of one contact, or stop of a joint."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import arguments
from carom.results.views.common import View
from carom.scene.belts import BeltStretch
from carom.scene.bodies import Body, HalfSpace, StaticBody
from carom.scene.contacts import gap_between
from carom.scene.coordinates import Length, Strand, Wrap, terms_of
from carom.scene.stops import RailContact, Stop

if TYPE_CHECKING:
    from carom.results.event_tables import ContactTable, EventTable, ImpactTable
    from carom.results.named import Source


MODES = np.array(["open", "slipping", "sticking"])


@arguments.attributes()
class ContactView(View):
    """Results of one contact, or stop of a joint: ``solution["die-ground"]``, or of a state (without T)."""

    def __init__(self, source: Source, number: int):
        super().__init__(source, None)
        scene, pairs = source._scene, source._numbers.pairs
        self._number, self._stop = number, number - len(pairs.body)
        if self._stop >= 0:
            self._part = scene.stops[self._stop]
        elif number < len(scene.contacts):
            self._part = scene.contacts[number]
        else:
            plane = pairs.plane[number]
            other = scene.fixed[plane] if plane >= 0 else scene.bodies[pairs.other[number]]
            self._part = _Pair(scene.bodies[pairs.body[number]], other)

    @property
    def _turns(self) -> bool:
        """Whether it is the stop of an angle, whose force is a torque."""
        stop = self._part
        return isinstance(stop, Stop) and stop.turns

    @cached_property
    def _sums(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The greatest mode, and the forces in contact axes and in the world."""
        touch = self._source._touch
        own, times = touch[touch["contact"] == self._number], np.size(self._source.t)
        mode, force, vector = np.zeros(times, dtype=np.int64), *np.zeros((2, times, 3))
        np.maximum.at(mode, own["saved"], own["mode"])
        np.add.at(force, own["saved"], own["force"])
        np.add.at(vector, own["saved"], own["push"])
        if np.ndim(self._source.t) == 0:
            return mode[0], force[0], vector[0]
        return mode, force, vector

    @property
    def mode(self):
        """Mode "open", "slipping" or "sticking" (or rolling, or at rest), (T,)."""
        return MODES[self._sums[0]]

    @property
    def force(self) -> np.ndarray:
        """Force on the body (T, 3), contact axes (normal, tangent 1, tangent 2) [N]; 0 while it is open.

        Of the stop of an angle: the torque about its axis [N m], in the first column.
        """
        return self._sums[1]

    @property
    def tension(self):
        """Tension of a tether, a rope, or a strand of a belt [N], (T,): 0 while it is slack.

        Of a rope that rubs on a guide: (T, 2), before the guide and behind it.
        """
        if not _is_cord(self._part):
            raise AttributeError(f"{self.name!r} has no tension: it is no tether, rope or belt")
        if isinstance(getattr(self._part, "joint", None), Wrap):
            half = 0.5 * self.force[..., 1]
            return self.force[..., 0, None] + np.stack([half, -half], axis=-1)
        return self.force[..., 0]

    @property
    def vector(self) -> np.ndarray:
        """Force on the body (T, 3), world axes [N]."""
        return self._sums[2]

    @cached_property
    def gap(self):
        """Distance of the two [m], (T,), negative inside; of a stop that of the coordinate [rad or m].

        It is computed from the states when it is asked for, some 20 microseconds for each time.
        """
        source, part = self._source, self._part
        if isinstance(part, RailContact):
            gaps = source._reports.motion(part.joint, source._saved).gap
            return np.reshape(gaps, np.shape(source.t))[()]
        if isinstance(part, Stop):
            q = source._reports.motion(part.joint, source._saved, part.coordinate).value
            return part.side * (np.reshape(q, np.shape(source.t))[()] - part.end)
        x, Q = (np.reshape(a, (-1, *a.shape[-2:])) for a in (source.position, source.orientation))
        gaps = [
            gap_between(*(_pose(one, x[k], Q[k]) for one in (part.body, part.other)))[0]
            for k in range(len(x))
        ]
        return np.reshape(np.array(gaps), np.shape(source.t))[()]

    @property
    def impacts(self) -> ImpactTable:
        """Its impacts: rows of `Solution.impacts`."""
        return self._table("impacts")

    @property
    def events(self) -> EventTable:
        """Its events: rows of `Solution.events`."""
        return self._table("events")

    @property
    def intervals(self) -> ContactTable:
        """Its intervals of persistent contact: rows of `Solution.contacts`."""
        return self._table("contacts")


def _is_cord(part) -> bool:
    """Return whether a part is the upper limit of a length, which pulls."""
    if not isinstance(part, Stop) or part.upper is None:
        return False
    own = terms_of(part.joint, part.coordinate)
    return isinstance(part.joint, BeltStretch) or any(
        type(one) in (Length, Strand) for one, _, _ in own
    )


class _Pair(NamedTuple):
    """A pair that touches by the default of the scene."""

    body: Body
    other: Body | HalfSpace | StaticBody

    @property
    def name(self) -> str:
        return f"{self.body.name}-{self.other.name}"


class _Posed(NamedTuple):
    """A body elsewhere."""

    shape: Any
    position: np.ndarray
    orientation: np.ndarray


def _pose(part, x: np.ndarray, Q: np.ndarray):
    return _Posed(part.shape, x[part.index], Q[part.index]) if isinstance(part, Body) else part
