"""The parts of a solution between switches, each a solution of the scene as it was then."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom._compiled.record_arrays import Columns, copied
from carom.status import Status

if TYPE_CHECKING:
    from carom.results.solution import Solution


class InSpans:
    """Base class of a solution: what is read from its parts between switches."""

    if TYPE_CHECKING:
        t: np.ndarray
        scene: Any

    @cached_property
    def _spans(self) -> list[Any]:
        """The parts between switches; none if all of the scene was there throughout."""
        return spans(self)  # pyright: ignore[reportArgumentType]

    def _by_span(self, read: Callable[[Any], np.ndarray]) -> np.ndarray:
        """Read an array from each part between switches, and join them over time (T, ...)."""
        first, *others = self._spans
        return np.concatenate([read(first), *(read(part)[1:] for part in others)])

    def _span_at(self, t: float) -> Any:
        """Return the part between switches that moves on from a time; itself if nothing was switched."""
        return [self, *(part for part in self._spans if part.t[0] <= t)][-1]

    def _by_time(self, t, side: Any, read: Callable[[Any, np.ndarray], tuple]) -> tuple:
        """Return states at times, each read from the part between switches that it is in."""
        times, begins = np.atleast_1d(np.asarray(t, dtype=float)), [one.t[0] for one in self._spans]
        which = np.maximum(np.searchsorted(begins, times, side=side) - 1, 0)
        count = len(self.scene.bodies)
        out = tuple(np.zeros((len(times), count, n)) for n in (3, 4, 3, 3))
        for k in np.unique(which).tolist():
            for there, found in zip(out, read(self._spans[k], times[which == k])):
                there[which == k] = found
        return tuple(one[0] for one in out) if np.ndim(t) == 0 else out


def spans(solution: Solution) -> list[Solution]:
    """Return the parts between switches in the order of time; none if all of the scene was there throughout.

    Each begins with the row of the switch before, whose forces are those of the part before: the state at this
    time is that after the switch.
    """
    from carom.model.switched import stands_of

    stands = stands_of(solution.scene, solution._run.switched)
    if len(stands) == 1 and not stands[0][1].off:
        return []
    ends = [*(row for row, _ in stands[1:]), len(solution.t)]
    rows = [(max(first - 1, 0), end) for (first, _), end in zip(stands, ends)]
    made = [
        _part(solution, stand.view(solution.scene), *own) for (_, stand), own in zip(stands, rows)
    ]
    return [part for part in made if len(part.t)]


def _part(solution: Solution, view, first: int, end: int) -> Solution:
    from carom.io.files.kept import KeptRun
    from carom.model import records as r
    from carom.results.assemble import Written
    from carom.results.solution import Solution

    run, rows = solution._run, slice(first, end)
    whole = r.written(run.records, run.clock)
    touch, event = copied(whole.touch), copied(whole.event)
    touch = touch[(touch["saved"] >= first) & (touch["saved"] < end)]
    touch["saved"] -= first
    event["saved"] -= first
    records = whole._replace(
        series=whole.series[rows].view(Columns), state=whole.state[rows].view(Columns),
        turn=whole.turn[rows].view(Columns), touch=touch.view(Columns), event=event.view(Columns),
    )  # fmt: skip
    history = getattr(run, "history", None)
    if history is not None:
        history = [(max(0, row - first), index, value) for row, index, value in history]
    kept = KeptRun(
        view, solution.settings, run.options, records, None, getattr(run, "missing", []),
        {"status": Status.SUCCESS.name}, run.found, history,
    )  # fmt: skip
    part = Solution(
        t=solution.t[rows], position=solution.position[rows], velocity=solution.velocity[rows],
        angular_velocity=solution.angular_velocity[rows], held_residual=solution.held_residual[rows],
        status=Status.SUCCESS, stats=solution.stats, scene=view, pairs=solution.pairs,
        settings=solution.settings, _run=cast(Any, kept), _touch=records.touch,
        _written=Written(
            np.array(records.state["Q"]), records.series, whole.impact, event, {}, view.forces
        ),
    )  # fmt: skip
    for name in ("impacts", "events", "contacts"):  # those of the whole run
        vars(part)[name] = getattr(solution, name)
    return part
