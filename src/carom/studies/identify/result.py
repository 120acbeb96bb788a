"""What a fit hands back."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.geometry import quaternion
from carom.studies.identify.recording import Recording
from carom.studies.identify.rollout import RollOut
from carom.studies.identify.uncertainty import Uncertainty


@dataclass(frozen=True, eq=False)
class Identification:
    """Fitted parameters, how sure they are, and how well each of K recordings is met.

    Attributes
    ----------
    parameters : dict of float
        The best evaluated ones.
    error : dict of float
        Standard deviation of each over recordings drawn anew, NaN without resampling.
    interval : dict of (float, float)
        Where 95 % of these lie.
    objective, objective_at_start : float
        Mean over the recordings.
    objectives : (K,)
        Of each recording.
    runs : list of RollOut
        Simulated motion of each recording, with the best parameters.
    recordings : list of Recording
    evaluations : int
        How often all recordings were simulated.
    points, values : (M, p), (M, K)
        All evaluations: parameters, and the objective of each recording.
    failed : (M,)
        How many runs stopped early in each evaluation.
    converged : bool
        Whether the search ended by itself.
    message : str
        How it ended.
    uncertainty : Uncertainty or None
        Samples behind `error` and `interval`.
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
        """How often all recordings were simulated."""
        return len(self.points)

    @property
    def error(self) -> dict[str, float]:
        """Standard deviation of each parameter over recordings drawn anew."""
        if self.uncertainty is None:
            return dict.fromkeys(self.parameters, float("nan"))
        return dict(zip(self.parameters, np.std(self.uncertainty.samples, axis=0).tolist()))

    @property
    def smooth(self) -> dict[str, float]:
        """Minimum of the quadratic surface through evaluations around the best, NaN without resampling.

        Where the objective is rough the best evaluated point is lucky in part; what lies between this and
        `parameters` is that.
        """
        if self.uncertainty is None:
            return dict.fromkeys(self.parameters, float("nan"))
        return dict(zip(self.parameters, self.uncertainty.centre.tolist()))

    @property
    def interval(self) -> dict[str, tuple[float, float]]:
        """Where 95 % of each parameter lie over recordings drawn anew."""
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
