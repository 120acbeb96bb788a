"""`Identification`: the result of a fit."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.geometry import quaternion
from carom.studies.identify.recording import Recording
from carom.studies.identify.rollout import RollOut
from carom.studies.identify.uncertainty import Uncertainty


@dataclass(frozen=True, eq=False)
class Identification:
    """Fitted parameters, their uncertainty, and the fit to each of K recordings.

    Attributes
    ----------
    parameters : dict of float
        Parameters with the smallest objective of all evaluations.
    error : dict of float
        Standard deviation of each parameter over bootstrap samples of the recordings; NaN without them.
    interval : dict of (float, float)
        Interval with 95 % of the values of each parameter over the bootstrap samples.
    objective, objective_at_start : float
        Mean objective over the recordings, for the best parameters and for the initial ones.
    objectives : (K,)
        Objective of each recording.
    runs : list of RollOut
        Simulated motion of each recording, with the best parameters.
    recordings : list of Recording
        The recorded motions.
    evaluations : int
        Number of evaluations; each simulated all recordings.
    points, values : (M, p), (M, K)
        All evaluations: parameters, and the objective of each recording.
    failed : (M,)
        Number of runs that failed in each evaluation.
    converged : bool
        Whether the search converged.
    message : str
        How the search ended.
    uncertainty : Uncertainty or None
        Bootstrap samples for `error` and `interval`.
    """

    parameters: dict[str, float]
    objective: float
    objective_at_start: float
    objectives: np.ndarray
    runs: list[RollOut] = field(repr=False)
    recordings: list[Recording] = field(repr=False)
    points: np.ndarray = field(repr=False)
    values: np.ndarray = field(repr=False)
    failed: np.ndarray = field(repr=False)
    converged: bool
    message: str
    uncertainty: Uncertainty | None = field(repr=False)

    @property
    def evaluations(self) -> int:
        """Number of evaluations; each simulated all recordings."""
        return len(self.points)

    @property
    def error(self) -> dict[str, float]:
        """Standard deviation of each parameter over bootstrap samples of the recordings."""
        if self.uncertainty is None:
            return dict.fromkeys(self.parameters, float("nan"))
        return dict(zip(self.parameters, np.std(self.uncertainty.samples, axis=0).tolist()))

    @property
    def smooth(self) -> dict[str, float]:
        """Minimum of the quadratic surface through evaluations around the best point; NaN without bootstrap.

        If the objective is rough, the best evaluation is partly a matter of chance; the difference between
        `smooth` and `parameters` shows how much.
        """
        if self.uncertainty is None:
            return dict.fromkeys(self.parameters, float("nan"))
        return dict(zip(self.parameters, self.uncertainty.centre.tolist()))

    @property
    def interval(self) -> dict[str, tuple[float, float]]:
        """Interval with 95 % of the values of each parameter over the bootstrap samples."""
        if self.uncertainty is None:
            return dict.fromkeys(self.parameters, (float("nan"), float("nan")))
        low, high = np.percentile(self.uncertainty.samples, [2.5, 97.5], axis=0).tolist()
        return dict(zip(self.parameters, zip(low, high)))

    @property
    def final_turn(self) -> np.ndarray:
        """Largest angle (K,) between the last simulated and recorded attitudes of a recording [rad]."""
        pairs = zip(self.runs, self.recordings)
        turns = [quaternion.between(b.orientation[-1], a.orientation[-1]) for a, b in pairs]
        return np.array([np.max(np.linalg.norm(turn, axis=-1)) for turn in turns])

    def __str__(self) -> str:
        lines = [
            f"objective {self.objective:.6g} (at the start {self.objective_at_start:.6g}), mean of "
            f"{len(self.recordings)} recordings; {self.evaluations} evaluations, {self.message}"
        ]
        for name, value in self.parameters.items():
            low, high = self.interval[name]
            lines.append(
                f"{name:16} {value:.6g} +- {self.error[name]:.2g}, smoothed {self.smooth[name]:.6g}, "
                f"95 % in [{low:.6g}, {high:.6g}]"
            )
        stopped = [run.message for run in self.runs if run.message]
        if stopped:
            lines.append(f"{len(stopped)} runs stopped early, the first: {stopped[0]}")
        worst = np.argsort(self.objectives)[::-1][:3]
        lines.append(
            "worst: " + ", ".join(f"{self._name(k)} ({self.objectives[k]:.4g})" for k in worst)
        )
        return "\n".join(lines)

    def _name(self, k: int) -> str:
        return self.recordings[k].name or f"recording {k}"
