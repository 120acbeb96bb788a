"""`GeneralizedSolution`: the results of a run of a `GeneralizedSystem`."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import checks
from carom.generalized.thresholds import TIME_ERROR
from carom.geometry.spline import cubic
from carom.results.drawn import Drawn
from carom.results.endings import message
from carom.results.event_tables import EventTable
from carom.results.ledger import Ledger
from carom.scene.table import RecordTable
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.run import GeneralizedRun
    from carom.generalized.system import GeneralizedSystem


class CoordinateImpact(NamedTuple):
    """One impact of a `GeneralizedSystem`. Vectors (3,) are in contact axes (normal, tangents 1, 2)."""

    time: float  #: time of the impact [s]
    contact: int  #: index of the contact in `GeneralizedSystem.contacts`
    position: np.ndarray  #: (n,) coordinates at the impact
    relative_velocity_before: np.ndarray  #: (3,) velocity before; approach is negative
    relative_velocity_after: np.ndarray  #: (3,) velocity after
    impulse: np.ndarray  #: (3,) impulse
    energy_change: float  #: change of energy [J]; in a multiple impact the share of the contact
    law: str  #: law of restitution
    inverse_mass: np.ndarray  #: (3, 3) Delassus operator W of the contact
    restitution: float  #: e of the contact
    friction: float  #: mu of the contact, of a law that which bounds stick
    compression_work: float  #: work of the normal force in compression [J]
    restitution_work: float  #: work of the normal force in restitution [J]
    friction_loss: float  #: energy that friction dissipates [J]
    together: int  #: number of contacts in this multiple impact, each with a record; 1 for a single impact
    wedged: int  #: 1 if friction wedges the pair, so that the law of restitution cannot hold; otherwise 0


class CoordinateImpactTable(RecordTable[CoordinateImpact]):
    """All K impacts of a run in the order of time; columns (K, ...) are the fields of `CoordinateImpact`."""

    _record, _a_row = CoordinateImpact, "impact"

    def __repr__(self) -> str:
        return f"<CoordinateImpactTable: {len(self)} impacts>"


def impact_table(records: list[CoordinateImpact], n: int) -> CoordinateImpactTable:
    """Return the table of impacts of a system of n coordinates."""
    v = np.zeros(3)
    like = CoordinateImpact(
        0.0, 0, np.zeros(n), v, v, v, 0.0, "", np.zeros((3, 3)), 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0
    )
    columns = {name: np.array(column) for name, column in zip(like._fields, zip(like, *records))}
    return CoordinateImpactTable(**{name: column[1:] for name, column in columns.items()})


@dataclass(frozen=True, eq=False)
class GeneralizedSolution(Drawn):
    """The motion of a system in n coordinates at T saved times, with K impacts.

    Attributes
    ----------
    t : (T,)
        Saved times [s].
    q, v : (T, n)
        Coordinates and their rates; at the time of an impact the rates after it.
    kinetic_energy, potential_energy, total_energy : (T,)
        Energies [J].
    impacts : CoordinateImpactTable
        One record for each impact.
    events : EventTable
        Impacts and changes of persistent contacts, in the order of time.
    constraint_errors : tuple of (T,), (T,)
        Greatest entries of phi(q) and of A v, the rates of the constraints.
    ledger : Ledger
        Energy balance of the run.
    status : Status
        How the run ended; see also `success` and `message`.
    warnings : tuple of str
        Sentences about energy errors above `Options.energy_tolerance` at saved times.
    stats : dict
        Counts: steps, located events, impacts, contacts that became persistent.
    system : GeneralizedSystem
        The system of the run.
    settings : dict
        The arguments of the run.
    """

    t: np.ndarray
    q: np.ndarray
    v: np.ndarray
    kinetic_energy: np.ndarray
    potential_energy: np.ndarray
    impacts: CoordinateImpactTable
    events: EventTable
    ledger: Ledger
    status: Status
    stats: dict[str, int]
    system: GeneralizedSystem = field(repr=False)
    settings: dict[str, Any]
    _run: GeneralizedRun = field(repr=False)
    warnings: tuple[str, ...] = ()

    @classmethod
    def _from_run(cls, run: GeneralizedRun, status: Status) -> GeneralizedSolution:
        """Make the solution from the records of a run."""
        from carom._compiled.user_functions import Fault, returned
        from carom.results.accuracy import inaccurate, sentences, watched

        saved, n = int(run.clock[0].saved), run.n
        series: Any = run.series[:saved]
        ledger = Ledger(**{one.name: np.array(series[one.name]) for one in fields(Ledger)})
        t, states, said = np.array(series.now), run.states[:saved].copy(), ()
        energies = np.column_stack([ledger.kinetic, ledger.potential])
        if len(bad := np.argwhere(~np.isfinite(energies))):
            k, which = bad[0]
            name = f"The {run.user._model.kind} {('metric', 'potential')[which]!r}"
            said = (f"{Fault(name, float(t[k]), states[k], returned(energies[k]))}.",)
        watch = watched(t, ledger, series.given, series.exchanged[-1], run.options.energy_tolerance)
        watch["size"] = max(watch.size, run.contacts.light)
        warnings = (*said, *sentences(watch, run.how.finer))
        if status is Status.SUCCESS and inaccurate(watch):
            status = Status.INACCURATE
        events = [np.array(column) for column in zip(*run.contacts.events)] or [np.zeros(0)] * 3
        names = {contact.name: k for k, contact in enumerate(run.user.contacts)}.copy
        return cls(
            t=t, q=states[:, :n].copy(), v=states[:, n:].copy(), kinetic_energy=ledger.kinetic,
            potential_energy=ledger.potential,
            impacts=impact_table(run.contacts.records, n)._by_name(names),
            events=EventTable(*events)._by_name(names), ledger=ledger, status=status, warnings=warnings,
            stats=run.counted(), system=run.user, settings=run.settings,
            _run=run,
        )  # fmt: skip

    @property
    def message(self) -> str:
        """How the run ended, in sentences; if it failed, with the time that it reached."""
        run = self._run
        return message(self.status, run.reason, run.how.finer, self.t[-1], self.warnings)

    @cached_property
    def constraint_errors(self) -> tuple[np.ndarray, np.ndarray]:
        """Greatest errors of the constraints at each saved time: of phi(q) (T,) and of A v (T,)."""
        position, rate = np.zeros(len(self.t)), np.zeros(len(self.t))
        for k in range(len(self.t)):
            seen = self._run.made.look(np.append(self.q[k], self.v[k]), float(self.t[k]))
            position[k] = np.max(np.abs(seen.phi), initial=0.0)
            rate[k] = np.max(np.abs(seen.A @ self.v[k]), initial=0.0)
        return position, rate

    def evaluate(self, t, side: str = "right") -> tuple[np.ndarray, np.ndarray]:
        """Return (q, v) at times between saved ones, with the accuracy of the run.

        The motion is stepped again from the saved state or the event before.

        Parameters
        ----------
        t : float or (m,)
            Times within the run [s].
        side : {"right", "left"}
            Velocity at the time of an event: after it (``"right"``, default) or before it (``"left"``).

        Returns
        -------
        tuple of arrays
            Arrays (m, n), (m, n); for a single time without the first axis.

        Raises
        ------
        ValueError
            If a time is outside the run, or `side` is invalid.
        """
        checks.choice("side", side, ("right", "left"))
        times = checks.times("t", t, self.t[0], self.t[-1])
        states = np.array([self._state(float(time), side == "left") for time in times])
        q, v = np.split(states.reshape(-1, 2 * self.q.shape[1]), 2, axis=1)
        return (q[0], v[0]) if np.ndim(t) == 0 else (q, v)

    def _state(self, time: float, left: bool) -> np.ndarray:
        """Return the state (q, v) at a time, before or after an event at this time."""
        at, nodes = self._nodes
        k = max(int(np.searchsorted(at, time, side="left" if left else "right")) - 1, 0)
        begin, _, start, active = nodes[k]
        last, end, *_ = nodes[min(k + 1, len(at) - 1)]
        if time == begin:
            return start
        if time > last - TIME_ERROR * self.t[-1]:
            return end
        run = self._run.again(float(begin), start, active, time)
        if run.go_on(run.steps) is Status.SUCCESS:
            return run.x
        h = last - begin  # the end of a run that failed
        return np.concatenate(cubic((time - begin) / h, h, *np.split(start, 2), *np.split(end, 2)))

    @cached_property
    def _nodes(self) -> tuple[np.ndarray, list[tuple]]:
        """Times, and times, states before and after, and contacts, of events and saved steps in order."""
        events, nodes = self._run.nodes, list(self._run.nodes)
        at = np.array([time for time, *_ in events])
        since = np.searchsorted(at, self.t, side="right") - 1  # the last event
        for time, x, i in zip(self.t, np.hstack([self.q, self.v]), since):
            if i < 0 or at[i] < time:  # a step that ends with an event is saved after it
                nodes.append((time, x, x, events[i][3] if i >= 0 else self._run.active))
        nodes.sort(key=lambda node: node[0])
        return np.array([time for time, *_ in nodes]), nodes

    def __repr__(self) -> str:
        return (
            f"<GeneralizedSolution: {self.q.shape[1]} coordinates, t = {self.t[0]:g} .. "
            f"{self.t[-1]:g} s in {len(self.t)} saved steps, {len(self.impacts)} impacts; {self.message}>"
        )
