"""The sequence of contact of a run, for the comparison of two runs."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom._compiled.record_arrays import Columns
from carom.impact.api import phase_names
from carom.model import records as r
from carom.results.solution import Solution


class ImpactKind(NamedTuple):
    """One event of a contact, without its time and its numerical values."""

    event: str  #: "impact", "held", "slips", "sticks", "opens" or "jams"
    contact: int  #: index of the contact
    feature: int  #: number of the contact point; on a half-space the vertex of the shape
    phases: tuple[str, ...]  #: as in `Impact`, without "slip": points that do not stick slip
    together: int  #: number of points in the multiple impact; 0 for other events


class Step(NamedTuple):
    """An event of a run and its records."""

    event: Any
    kind: str
    shots: np.recarray  # states of its bodies
    impact: int  # row in `Solution.impacts`, -1 if there is none
    row: Any  # record of that impact


def steps_of(solution: Solution) -> list[Step]:
    """Return the events of a run in the order of time."""
    rec = r.trimmed(solution._run.records, solution._run.clock)
    order = np.argsort(rec.impact.time, kind="stable")
    impacts = rec.impact[order]
    used = np.zeros(len(impacts), dtype=bool)
    steps = []
    for number in np.argsort(rec.event.time, kind="stable"):
        event: Any = rec.event[number]
        kind, k = r.EVENTS[event.kind], -1
        if kind in ("impact", "jams"):
            k = _impact_of(event, impacts, used)
        shots = rec.snapshot[rec.snapshot.event == number].view(Columns)
        steps.append(Step(event, kind, shots, k, impacts[k] if k >= 0 else None))
    return steps


def _impact_of(event, impacts, used) -> int:
    """Return the first unused impact of an event; mark it, and those of its other points, as used."""
    own = np.flatnonzero(~used & (impacts["time"] == event.time))
    of_contact = own[impacts["contact"][own] == event.contact]
    if len(of_contact) == 0:
        return -1
    k = int(of_contact[0])
    if impacts["together"][k] > 1:
        used[own[impacts["together"][own] == impacts["together"][k]]] = True
    used[k] = True
    return k


def contact_sequence(solution: Solution) -> tuple[ImpactKind, ...]:
    """Return the sequence of contact of a run: its events in the order of time, each an `ImpactKind`.

    A derivative predicts another run only if the sequence of contact is the same on the whole path to it. After
    a step along a derivative compare ``contact_sequence(new) == contact_sequence(old)``.

    Parameters
    ----------
    solution : Solution
        The run.
    """
    checks.instance("solution", solution, (Solution,))
    found = []
    for step in steps_of(solution):
        row, event = step.row, step.event
        phases = () if row is None else phase_names(int(row.phases))
        # slip may vanish, before stick or without friction, without a change of the sequence
        phases = tuple(name for name in phases if name != "slip")
        together = 0 if row is None else int(row.together)
        found.append(
            ImpactKind(step.kind, int(event.contact), int(event.feature), phases, together)
        )
    return tuple(found)
