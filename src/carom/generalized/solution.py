"""`GeneralizedSolution`: the results of a run of a `GeneralizedSystem`."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from carom import arguments, checks
from carom.results.drawn import Drawn
from carom.results.event_tables import ContactTable, EventTable
from carom.results.ledger import Ledger
from carom.scene.table import RecordTable
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.state import CoordinateState
    from carom.generalized.system import GeneralizedSystem
    from carom.impact.history import LayerHistory
    from carom.results.solution import Solution


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


FILES = ".nc", ".h5", ".hdf5"  # suffixes of files of runs
#: columns that are those of the impacts of a scene; the place is in coordinates
_SAME = tuple(name for name in CoordinateImpact._fields if name not in ("position", "inverse_mass"))


def impact_table(solution: Solution, system: GeneralizedSystem) -> CoordinateImpactTable:
    """Return the impacts of the scene of a system, in coordinates."""
    impacts, n = solution.impacts, len(system.position)
    there = (
        system.scale * solution.evaluate(impacts.time)[0][..., 0]
        if len(impacts)
        else np.zeros((0, n))
    )
    rows = np.any(system.evaluation().look(system.position).G != 0.0, axis=2)[impacts.contact]
    W = (
        impacts.inverse_mass * rows[:, :, None] * rows[:, None, :]
    )  # 0 along tangents that are not there
    same = {name: getattr(impacts, name) for name in _SAME}
    return CoordinateImpactTable(**same, position=there, inverse_mass=W)


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
    contacts : ContactTable
        Intervals of persistent contact.
    contact_mode : (T, C)
        Mode of each contact: 0 open, 1 slipping, 2 sticking.
    contact_force : (T, C, 3)
        Forces of persistent contacts: normal, tangent 1, tangent 2 [N].
    held_residual : (T,)
        Greatest residual of the contact law in persistent contacts [m/s], as of `Solution`.
    t_events, state_events
        Times and states of the `events` of `simulate`, as of `Solution`; None without any.
    status : Status
        How the run ended; see also `success` and `message`.
    warnings : tuple of str
        Sentences as those of `Solution`, about energies, penetrations and contact problems.
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
    status: Status
    stats: dict[str, int]
    system: GeneralizedSystem = field(repr=False)
    settings: dict[str, Any]
    _of_scene: Solution = field(repr=False)
    warnings: tuple[str, ...] = ()

    @classmethod
    def _of(cls, solution: Solution) -> GeneralizedSolution:
        """Return the solution of the scene of a system in coordinates."""
        scene: Any = solution.scene
        scale = scene.system.scale
        q, v = scale * solution.position[..., 0], scale * solution.velocity[..., 0]
        return cls(
            t=solution.t, q=q, v=v, status=solution.status, stats=solution.stats, system=scene.system,
            settings=solution.settings, _of_scene=solution,
            warnings=(*not_finite(solution, scene.system, q, v), *solution.warnings),
        )  # fmt: skip

    @property
    def kinetic_energy(self) -> np.ndarray:
        """Kinetic energy (T,) [J]."""
        return self._of_scene.kinetic_energy

    @property
    def potential_energy(self) -> np.ndarray:
        """Potential energy (T,) [J]."""
        return self._of_scene.potential_energy

    @property
    def ledger(self) -> Ledger:
        """Energy balance of the run."""
        return self._of_scene.ledger

    @property
    def events(self) -> EventTable:
        """Impacts and changes of persistent contacts, in the order of time."""
        return self._of_scene.events

    @property
    def contacts(self) -> ContactTable:
        """Intervals of persistent contact."""
        return self._of_scene.contacts

    @property
    def contact_mode(self) -> np.ndarray:
        """Mode (T, C) of each contact: 0 open, 1 slipping, 2 sticking."""
        return self._of_scene.contact_mode

    @property
    def contact_force(self) -> np.ndarray:
        """Forces (T, C, 3) of persistent contacts: normal, tangent 1, tangent 2 [N]."""
        return self._of_scene.contact_force

    @property
    def held_residual(self) -> np.ndarray:
        """Greatest residual (T,) of the contact law in persistent contacts [m/s], as of `Solution`."""
        return self._of_scene.held_residual

    def impact_history(self, k: int, steps: int | None = None) -> LayerHistory:
        """Return impact k resolved in time inside its boundary layer, as `Solution.impact_history` does."""
        return self._of_scene.impact_history(k, steps)

    @cached_property
    def impacts(self) -> CoordinateImpactTable:
        """One record for each impact."""
        names = {contact.name: contact.index for contact in self.system.contacts}.copy
        return impact_table(self._of_scene, self.system)._by_name(names)

    @property
    def message(self) -> str:
        """How the run ended, in sentences; if it failed, with the time that it reached."""
        return self._of_scene.message

    @cached_property
    def constraint_errors(self) -> tuple[np.ndarray, np.ndarray]:
        """Greatest errors of the constraints at each saved time: of phi(q) (T,) and of A v (T,)."""
        position, rate = np.zeros(len(self.t)), np.zeros(len(self.t))
        for k in range(len(self.t)):
            here = self.system.evaluation().look(np.append(self.q[k], self.v[k]), float(self.t[k]))
            position[k] = np.max(np.abs(here.phi), initial=0.0)
            rate[k] = np.max(np.abs(here.A @ self.v[k]), initial=0.0)
        return position, rate

    def evaluate(self, t, side: str = "right") -> tuple[np.ndarray, np.ndarray]:
        """Return (q, v) at times between saved ones, with the accuracy of the run.

        The motion is computed again from the saved state before.

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
        x, _, v, _ = self._of_scene.evaluate(t, side)
        return self.system.scale * x[..., 0], self.system.scale * v[..., 0]

    @property
    def t_events(self) -> list[np.ndarray] | None:
        """For each of the `events` that `simulate` was given the times [s] at which it happened, or None."""
        return self._of_scene.t_events

    @property
    def state_events(self) -> list[list[CoordinateState]] | None:
        """The states at these times."""
        from carom.generalized.state import CoordinateState

        found, scale = self._of_scene.state_events, self.system.scale
        if found is None:
            return None
        return [[CoordinateState._of(one, scale) for one in some] for some in found]

    @property
    def _run(self):
        return self._of_scene._run

    @arguments.known
    def save(self, path: str | os.PathLike) -> None:
        """Write the run to a file, which `load` reads; needs ``carom[files]``.

        It is that of a scene (see `Solution.save`) with ``q`` and ``v`` (time, coordinate). Functions and
        expressions of the system are not in it.

        Parameters
        ----------
        path : str or path
            Path that ends in ``.nc``, ``.h5`` or ``.hdf5``, in a folder that exists.

        Raises
        ------
        ImportError
            If h5netcdf is missing.
        OSError
            If the file cannot be written; an old file then stays unchanged.
        ValueError
            If the folder does not exist, or the suffix is not one of these.
        """
        where = checks.file_to_write("path", path)
        if where.suffix.lower() not in FILES:
            raise ValueError(f"path must end in {', '.join(FILES)}, got {str(where)!r}")
        self._of_scene.save(where)

    @classmethod
    @arguments.known
    def load(cls, path: str | os.PathLike, system: GeneralizedSystem) -> GeneralizedSolution:
        """Return the solution in a file, bit for bit equal to the one that was saved.

        Parameters
        ----------
        path : str or path
            Path of the file.
        system : GeneralizedSystem
            The system of the run, as it was at its start.

        Raises
        ------
        FileNotFoundError
            If the file does not exist.
        ValueError
            If it is not a file of such a run, is damaged or changed, or the start, the metric there, the scale
            or the contacts of the system are others.
        """
        from carom.results.solution import Solution

        return cls._of(Solution._load(checks.path("path", path), system=system))

    @arguments.known
    def simulate(
        self, duration: float, *, progress: bool | Callable[[float, float], None] | None = None,
        throw: bool = True,
    ) -> GeneralizedSolution:  # fmt: skip
        """Continue the run from its end, as `Solution.simulate` does.

        Parameters
        ----------
        duration : float
            Additional time to simulate [s].
        progress, throw
            As for `carom.simulate`.

        Returns
        -------
        GeneralizedSolution
            The solution for the whole time, from the start.

        Raises
        ------
        ValueError
            If the run has not reached its end, or was continued since.
        SimulationError
            If the run fails and `throw` is True.
        """
        return cast("Any", self._of_scene.simulate(duration, progress=progress, throw=throw))

    def __repr__(self) -> str:
        return (
            f"<GeneralizedSolution: {self.q.shape[1]} coordinates, t = {self.t[0]:g} .. "
            f"{self.t[-1]:g} s in {len(self.t)} saved steps, {len(self.impacts)} impacts; {self.message}>"
        )


def not_finite(solution: Solution, system: GeneralizedSystem, q, v) -> tuple[str, ...]:
    """Return a sentence about the first energy that is not finite, if one is."""
    from carom._compiled.user_functions import Fault, returned

    energies = np.column_stack([solution.kinetic_energy, solution.potential_energy])
    bad = np.argwhere(~np.isfinite(energies))
    if not len(bad):
        return ()
    k, which = bad[0]
    name = f"The {system._model.kind} {('metric', 'potential')[which]!r}"
    state = np.append(q[k], v[k])
    return (f"{Fault(name, float(solution.t[k]), state, returned(energies[k]))}.",)
