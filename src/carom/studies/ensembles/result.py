"""`Ensemble`: the outcomes of all runs, with one row for each run."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import checks
from carom.status import Status
from carom.studies.ensembles.outcome import PENDING, REFUSED

if TYPE_CHECKING:
    from carom.studies.ensembles.plan import Plan


@dataclass(frozen=True, eq=False)
class Ensemble:
    """The results of R runs of a scene with N bodies. Each outcome is an attribute with one row for each run.

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
    state at the end: `position` (R, N, 3), `orientation` (R, N, 4), `velocity`, `angular_velocity` (R, N, 3).
    """

    inputs: dict[str, np.ndarray]
    outcomes: np.ndarray
    observed: dict[str, np.ndarray]
    failures: dict[int, str]
    about: dict[str, Any]
    _plan: Plan | None = field(default=None, repr=False)

    @classmethod
    def load(cls, path) -> Ensemble:
        """Return a saved ensemble, complete or not.

        Raises
        ------
        FileNotFoundError, ValueError
            If the path does not exist, or is not a saved ensemble.
        """
        from carom.studies.ensembles.store import Store

        where = checks.path("path", path)
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
            raise AttributeError(f"an Ensemble has no {name!r}")
        return outcomes[name]

    def __len__(self) -> int:
        return len(self.outcomes)

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {word}" for word, n in self.counts().items())
        return f"<Ensemble of {len(self)} runs: {counts}>"

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
        words = {PENDING: "pending", REFUSED: "refused", **{int(s): s.name.lower() for s in Status}}
        found, numbers = np.unique(self.outcomes["status"], return_counts=True)
        return {words[int(s)]: int(n) for s, n in zip(found, numbers)}

    def solution(self, run: int):
        """Return the complete `Solution` of a run; the run is made again.

        Raises
        ------
        ValueError
            If the ensemble was loaded from disk and so has no scene, or there is no run with this number.
        """
        from carom.scene.scene import Scene
        from carom.simulate import simulate
        from carom.studies.ensembles.plan import plain
        from carom.studies.ensembles.targets import changed

        run = checks.integer("run", run, least=0, most=len(self) - 1)
        plan = self._plan
        if plan is None:
            raise ValueError(
                "solution needs the scene, but an ensemble from disk has none; call carom.ensemble with the "
                "same arguments and the same save"
            )
        if isinstance(plan.scene, Scene):
            values = {name: array[run] for name, array in self.inputs.items()}
            scene = changed(plan.scene, plan.targets, values)
        else:
            scene = plan.scene(**plain(self.inputs, run))
        how = plan.settings._replace(save_every=1)
        return simulate(scene, **how.as_dict(), options=how.options, throw=False)

    def to_xarray(self):
        """Return the ensemble as an `xarray.Dataset` with the dimension `run`."""
        xarray = checks.need("xarray", "to_xarray", "ensemble")
        units = {
            "t": "s", "rest_time": "s", "first_impact": "s", "position": "m", "velocity": "m/s",
            "angular_velocity": "rad/s", "kinetic_energy": "J", "impact_loss": "J",
            "friction_loss": "J", "bounce_loss": "J", "load_work": "J",
        }  # fmt: skip
        variables = {}
        for name in self.outcomes.dtype.names or ():
            values = self.outcomes[name]
            last = {3: "axis", 4: "quaternion"}.get(values.shape[-1]) if values.ndim == 3 else None
            dims = ("run", "body", last) if last else ("run",)
            variables[name] = (dims, values, {"units": units[name]} if name in units else {})
        for folder, arrays in (("input", self.inputs), ("observed", self.observed)):
            for name, values in arrays.items():
                more = [f"{name}_{k}" for k in range(1, values.ndim)]
                key = f"{folder}:{name}"
                variables[key] = (("run", *more), values, {})
        attributes = {k: v for k, v in self.about.items() if isinstance(v, (str, int, float))}
        return xarray.Dataset(variables, attrs=attributes)
