"""What switches have done in a run: which parts it is without, and how joints stand that were put in."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from carom.model.forces import FRICTIONS
from carom.scene.switches import off_at_start, view_of

#: a part that was switched: rows that were saved before, with that of this time; time [s]; number of the
#: switch, -1 for `carom.Run.switch`; number of the part among all of the scene; 1 if it was put in; change of
#: the energies by this; where a joint was put in, or the constant of a relation
SWITCHED = np.dtype(
    [
        ("row", "<i8"), ("time", "<f8"), ("switch", "<i8"), ("part", "<i8"), ("on", "<i8"),
        ("energy", "<f8"), ("placed", "<f8", 7),
    ]
)  # fmt: skip
NOTHING_SWITCHED = np.zeros(0, SWITCHED)


class Stands(NamedTuple):
    """Which parts a run is without, by name, and how joints stand that were put in."""

    off: frozenset[str] = frozenset()
    placed: Mapping[str, np.ndarray] = {}

    def after(self, name: str, on: bool, placed: np.ndarray) -> Stands:
        """Return this after a part was switched."""
        off = self.off - {name} if on else self.off | {name}
        rest = {other: where for other, where in self.placed.items() if other != name}
        return Stands(off, {**rest, name: placed} if on else rest)

    def view(self, scene):
        """Return the scene as a run sees it; itself, if all of it is there as it states it."""
        if not self.off and not self.placed:
            return scene
        if self.placed:
            return view_of(scene, self.off, self.placed)
        return scene._derived.once(("view", self.off), lambda: view_of(scene, self.off))


def first_stand(scene) -> Stands:
    """Return which parts a run of a scene begins without; a view of one stays as it is."""
    return Stands() if scene._off is not None else Stands(off_at_start(scene))


def stands_of(scene, switched: np.ndarray) -> list[tuple[int, Stands]]:
    """Return the ranges of saved rows with the same parts: the first row from which on, and what stands there.

    Forces and reactions at the row of a switch are those just before it.
    """
    names, stand = [part.name for part in scene], first_stand(scene)
    found = [(0, stand)]
    for one in switched:
        stand = stand.after(names[one["part"]], bool(one["on"]), np.array(one["placed"]))
        if found[-1][0] == one["row"]:
            found.pop()
        found.append((int(one["row"]), stand))
    return found


def rows_with(run, part, count: int) -> np.ndarray:
    """Return at which of the saved rows (count,) of a run a part was there."""
    there = np.ones(count, dtype=bool)
    for first, stand in stands_of(run.scene, run.switched) if run.scene.switches else ():
        there[first:] = part.name not in (stand.view(run.scene)._off or ())
    return there


def go_on_from(old, active, new, entered) -> None:
    """Take over the turns of joints, friction in them, and active points, of what is still there.

    Parameters
    ----------
    old, new : the compiled scenes before and after
    active, entered : their active sets; the second is written
    """
    a, b = (one.system.relations.memory for one in (old, new))
    for key, k in new.numbers.items():
        if key in old.numbers:
            b.coordinates[k] = a.coordinates[old.numbers[key]]
    for index, place in new.places.items():
        if place.kind == FRICTIONS and index in old.places:
            b.frictions[place.first] = a.frictions[old.places[index].first]
    known, numbers = old.system.contacts["number"], new.system.contacts["number"]
    # rows of one contact stay together, in their order
    rows = np.flatnonzero(np.isin(known, numbers))
    place = np.full(len(known), -1)
    place[rows] = np.flatnonzero(np.isin(numbers, known))
    entered.contact_states[place[rows]] = active.contact_states[rows]
    entered.contact_states["near"] = 1
    points = active.points[: active.count[0]]
    points = points[place[points["contact"]] >= 0]
    here = entered.points[: len(points)]
    here[:] = points
    here["contact"], here["rest"], here["comes_to_rest"] = place[points["contact"]], 0, 0
    entered.count[0] = len(points)
    entered.carries[here["feature"][here["fixed"] == 1]] = 1
