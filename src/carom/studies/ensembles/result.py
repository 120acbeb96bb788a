"""What an ensemble hands back: a column for each outcome, a row a run."""

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
    """Many runs of a scene, R in all, of N bodies. Each outcome is an attribute, a row a run.

    Attributes
    ----------
    inputs : dict of (R, ...)
        The values that differed.
    outcomes : (R,) structured array
        A column for each name below.
    observed : dict of (R, ...)
        What `observe` returned.
    failures : dict of int to str
        Why a run stopped before its end, or could not begin, by its number.
    about : dict
        Version and settings of the runs.

    Notes
    -----
    Outcomes: `status`, a `Status`, or -1 of runs that were not made and -2 of those that could not begin; `t`,
    time reached [s]; `rest_time`, end of the first step after which nothing moves, else NaN; `impacts`, their
    number; `first_impact` [s]; `kinetic_energy` at the end, `impact_loss`, `friction_loss`, `bounce_loss`,
    `load_work` [J]; `energy_error`, the worst energy without a name as a part of the largest exchanged until
    then (`Options.energy_tolerance`); and at the end `position` (R, N, 3), `orientation` (R, N, 4), `velocity`,
    `angular_velocity` (R, N, 3).
    """

    inputs: dict[str, np.ndarray]
    outcomes: np.ndarray
    observed: dict[str, np.ndarray]
    failures: dict[int, str]
    about: dict[str, Any]
    _plan: Plan | None = field(default=None, repr=False)

    @classmethod
    def load(cls, path) -> Ensemble:
        """Return an ensemble that was saved, finished or not.

        Raises
        ------
        FileNotFoundError, ValueError
            If there is nothing, or something else, at the path.
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
        """Return a column of the outcomes."""
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
        """Which runs were made (R,)."""
        return self.outcomes["status"] != PENDING

    @property
    def complete(self) -> bool:
        """Whether all were."""
        return bool(np.all(self.done))

    def counts(self) -> dict[str, int]:
        """Return how many runs ended in which way."""
        words = {PENDING: "pending", REFUSED: "refused", **{int(s): s.name.lower() for s in Status}}
        found, numbers = np.unique(self.outcomes["status"], return_counts=True)
        return {words[int(s)]: int(n) for s, n in zip(found, numbers)}

    def solution(self, run: int):
        """Return the whole `Solution` of a run, by making it again.

        Raises
        ------
        ValueError
            If the ensemble was loaded from disk, and so has no scene, or there is no such run.
        """
        from carom.scene.scene import Scene
        from carom.simulate import simulate
        from carom.studies.ensembles.targets import changed

        run = checks.integer("run", run, least=0, most=len(self) - 1)
        plan = self._plan
        if plan is None:
            raise ValueError(
                "solution needs the scene, which an ensemble from disk does not have; call carom.ensemble "
                "with the same arguments and the same save"
            )
        values = {name: array[run] for name, array in self.inputs.items()}
        if isinstance(plan.scene, Scene):
            scene = changed(plan.scene, plan.targets, values)
        else:
            scene = plan.scene(**{k: float(v) if np.ndim(v) == 0 else v for k, v in values.items()})
        how = plan.settings._replace(save_every=1)
        return simulate(scene, **how.as_dict(), options=how.options, throw=False)

    def to_xarray(self):
        """Return the ensemble as an `xarray.Dataset` with the dimension `run`."""
        try:
            import xarray
        except ImportError as error:
            raise checks.missing_package("to_xarray", "xarray", "ensemble") from error
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
