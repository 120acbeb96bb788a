"""`Ensemble`: the outcomes of all runs, with one row for each run."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.hints import ending
from carom.scene.shown import Shown
from carom.studies.ensembles.outcome import PENDING
from carom.studies.ensembles.table import WORDS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from carom.generalized.state import CoordinateState
    from carom.results.state import SystemState
    from carom.studies.ensembles.plan import Plan


@dataclass(frozen=True, eq=False)
class Ensemble(Shown):
    """The results of R runs of a scene with N bodies, or of a system in n coordinates.

    Each outcome is an attribute with one row for each run.

    Attributes
    ----------
    inputs : dict of (R, ...)
        The varied values.
    outcomes : (R,) structured array
        A column for each outcome below.
    observed : dict of (R, ...)
        The results of `observe`.
    failures : dict of int to str
        The messages of runs that stopped before their end, could not start, or could not be observed, by the
        number of the run.
    about : dict
        Version and settings of the runs.

    Notes
    -----
    The outcomes are: `status`, a `Status`, or -1 for a run that was not made and -2 for a run that could not
    start; `t`, the time reached [s]; `rest_time`, the end of the first step after which nothing moves [s], or
    NaN; `impacts`, the number of impacts; `first_impact`, the time of the first impact [s]; `kinetic_energy` at
    the end, `impact_loss`, `friction_loss`, `bounce_loss`, `load_work` [J]; `energy_error`, the largest energy
    error as a fraction of the largest energy exchanged until then (see `Options.energy_tolerance`); and the
    state at the end: `position` (R, N, 3), `orientation` (R, N, 4), `velocity`, `angular_velocity` (R, N, 3),
    or `q`, `v` (R, n) of a system in coordinates.
    """

    inputs: dict[str, np.ndarray]
    outcomes: np.ndarray
    observed: dict[str, np.ndarray]
    failures: dict[int, str]
    about: dict[str, Any]
    _plan: Plan | None = field(default=None, repr=False)

    @classmethod
    def load(cls, path) -> Ensemble:
        """Return a saved ensemble, complete or not: a folder of ``save=``, or a file of `save`.

        Raises
        ------
        FileNotFoundError, ValueError
            If the path does not exist, or is not a saved ensemble.
        """
        from carom.studies.ensembles import files
        from carom.studies.ensembles.store import Store

        where = checks.path("path", path)
        if where.suffix.lower() in files.FILES and not where.is_dir():
            return cls(**files.load(where))
        try:
            store = Store.open(where)
            whole, inputs = store.read(), store.inputs()
        except ValueError as error:
            raise ValueError(f"path: {error}") from None
        return cls(inputs, whole.outcomes, whole.observed, whole.failures, store.about)

    def __getattr__(self, name: str) -> np.ndarray:
        """Return an outcome of all runs."""
        outcomes = self.__dict__.get("outcomes")
        if outcomes is None or name not in (outcomes.dtype.names or ()):
            has = [*dir(type(self)), *(() if outcomes is None else outcomes.dtype.names)]
            raise AttributeError(f"an Ensemble has no {name!r}{ending('Ensemble', name, has)}")
        return outcomes[name]

    def __dir__(self) -> list[str]:
        return [*object.__dir__(self), *(self.outcomes.dtype.names or ())]

    def __len__(self) -> int:
        return len(self.outcomes)

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {word}" for word, n in self.counts().items())
        return f"<Ensemble of {len(self)} runs: {counts}>"

    @property
    def grid(self) -> dict[str, np.ndarray]:
        """Axes of the grid by name, the last one fastest; empty if no `Grid` was varied."""
        axes = json.loads(self.about.get("grid", "{}"))
        return {name: np.array(values) for name, values in axes.items()}

    @property
    def done(self) -> np.ndarray:
        """Whether each run was made (R,)."""
        return self.outcomes["status"] != PENDING

    @property
    def complete(self) -> bool:
        """Whether all runs were made."""
        return bool(np.all(self.done))

    def counts(self) -> dict[str, int]:
        """Return the number of runs with each status."""
        found, numbers = np.unique(self.outcomes["status"], return_counts=True)
        return {WORDS[int(s)]: int(n) for s, n in zip(found, numbers)}

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, in the order of the outcomes; empty for systems in coordinates."""
        return list(json.loads(self.about.get("body_names", "[]")))

    @property
    def coordinates(self) -> list[str]:
        """Names of the coordinates of a system, in the order of the outcomes; empty for scenes."""
        return list(json.loads(self.about.get("coordinate_names", "[]")))

    def __getitem__(self, name: Any) -> Any:
        """Return what all runs have of one thing, with one row for each run.

        The name of a body, or the body: its state at the end, ``runs["die"].position`` (R, 3). The name of
        a joint, or of a coordinate of a system: its coordinate and rate at the end,
        ``runs["hinge"].coordinate`` (R,), of a joint with angles from -pi to pi. Otherwise the name of an
        input, of what was observed, or of an outcome: an array (R, ...).

        Raises
        ------
        KeyError
            If there is nothing of this name.
        """
        from carom.studies.ensembles.views import view

        return view(self, name)

    def state(self, run: int) -> SystemState | CoordinateState:
        """Return the state at the end of a run, such as for ``model.qpos(runs.state(3))``.

        Raises
        ------
        ValueError
            As of `solution`.
        """
        from carom.studies.ensembles.views import state_of

        return state_of(self, checks.integer("run", run, least=0, most=len(self) - 1))

    def solution(self, run: int):
        """Return the complete `Solution` of a run; the run is made again.

        Raises
        ------
        ValueError
            If the ensemble was loaded from disk and so has no scene, or there is no run with this number.
        """
        from carom.studies.ensembles.views import solution_of

        return solution_of(self, checks.integer("run", run, least=0, most=len(self) - 1))

    def save(self, path: str | os.PathLike) -> None:
        """Write the ensemble to a file, as the ending says; `load` reads all but the last.

        ``.zarr``: a folder as that of ``save=``. ``.nc``, ``.h5``: one netCDF-4 (HDF5) file with the arrays of
        `to_xarray`. ``.parquet``: the table of `to_pandas`. ``.csv``: the same table as text. An old file is
        replaced as a whole, a folder only if it is an ensemble.

        Parameters
        ----------
        path : str or path
            Path with one of these endings (or ``.hdf5``), in a folder that exists.

        Raises
        ------
        ImportError
            If a package is missing: zarr (``.zarr``), h5netcdf (``.nc``), pandas (tables), pyarrow
            (``.parquet``).
        OSError
            If the file cannot be written, for example on a full disk; an old file then stays unchanged.
        ValueError
            If the folder does not exist, the ending is not one of these, or a folder is no ensemble.
        """
        from carom.studies.ensembles.files import save

        where = checks.path("path", path)
        if not where.is_dir() or where.suffix.lower() != ".zarr":
            where = checks.file_to_write("path", where)
        save(where, self)

    def to_pandas(self) -> pd.DataFrame:
        """Return a `pandas.DataFrame` with one row for each run.

        Columns are the inputs by their names (components as ``"die.velocity.x"``), what was observed, the
        outcomes, `status` as a word, `message`, and the state of each body at the end: ``"die.x"``, ``y``,
        ``z``, the quaternion ``qw``, ``qx``, ``qy``, ``qz``, and the velocities ``vx``, ``vy``, ``vz`` and
        ``wx``, ``wy``, ``wz``. An input or observed value with the name of an outcome has ``"inputs:"`` or
        ``"observed:"`` before it.

        Raises
        ------
        ImportError
            If pandas is missing.
        """
        from carom.studies.ensembles.files import to_pandas

        return to_pandas(self)

    def to_xarray(self) -> xr.Dataset:
        """Return the ensemble as an `xarray.Dataset`.

        Its dimensions are `run`, or, if a `Grid` was varied, the axes of the grid with their values, and `run`
        is a coordinate with the numbers of the runs; then body, axis and quaternion. Inputs are
        ``"input:NAME"``, what was observed ``"observed:NAME"``.

        Raises
        ------
        ImportError
            If xarray is missing.
        """
        from carom.studies.ensembles.files import to_xarray

        return to_xarray(self)

    def plot(self, value: str | ArrayLike, over: str | Sequence[str] | None = None, **options):
        """Draw one value of all runs over what was varied, by `carom.plots.ensemble`, and return its axes.

        Parameters
        ----------
        value : str or (R,)
            A column of `to_pandas`, such as ``"die.z"``, ``"impacts"``, or a name of what was observed; or one
            number for each run.
        over : str or two of them, optional
            The columns on the axes. Default: the axes of the grid, or the numbers that were varied. Two axes of
            a grid are a heat map, with the mean over all other axes; one is a line. Without a grid each run is
            a point.
        **options
            Other arguments of that function, for example ``ax`` to draw into existing axes.

        Raises
        ------
        ImportError
            If matplotlib is missing.
        ValueError
            If there is no such column, or `over` is needed.
        """
        from carom.visual import plots

        return plots.ensemble(self, value, over, **options)
