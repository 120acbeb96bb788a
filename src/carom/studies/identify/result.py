"""`Identification`: the result of a fit."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.geometry import quaternion
from carom.studies.identify.curvature import Curvature
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
        Standard error of each parameter: that of the curvature of the sum of squares, or, if it is greater, the
        standard deviation over bootstrap samples of six or more recordings; with fewer recordings also the
        difference from `smooth`. Infinite for a parameter that the recordings do not determine; NaN with
        ``resamples=0``.
    interval : dict of (float, float)
        Interval in which each parameter is with a probability of 95 %. Of a parameter that is not determined:
        the values that are not excluded, such as all friction above that with which an impact sticks.
    undetermined : tuple of str
        The parameters that the recordings do not determine. Their value in `parameters` is that of a best run,
        of many runs that are as good.
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
        Bootstrap samples of six or more recordings.
    curvature : Curvature or None
        Curvature of the sum of squares; None with ``resamples=0``.
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
    curvature: Curvature | None = field(repr=False)

    @property
    def evaluations(self) -> int:
        """Number of evaluations; each simulated all recordings."""
        return len(self.points)

    @property
    def error(self) -> dict[str, float]:
        """Standard error of each parameter; infinite if the recordings do not determine it."""
        if self.curvature is None:
            return dict.fromkeys(self.parameters, float("nan"))
        if self.uncertainty is None:
            # an objective with other weights than the noise is minimal elsewhere than the sum of squares
            off = np.array(list(self.parameters.values())) - self.curvature.centre
            errors = np.hypot(self.curvature.error, off)
        else:
            errors = np.maximum(self.curvature.error, np.std(self.uncertainty.samples, axis=0))
        return dict(zip(self.parameters, errors.tolist()))

    @property
    def undetermined(self) -> tuple[str, ...]:
        """The parameters that the recordings do not determine."""
        return tuple(name for name, error in self.error.items() if np.isinf(error))

    @property
    def smooth(self) -> dict[str, float]:
        """Minimum of the quadratic surface around the best point; NaN with ``resamples=0``.

        If the objective is rough, the best evaluation is partly a matter of chance; the difference between
        `smooth` and `parameters` shows how much.
        """
        surface = self.uncertainty or self.curvature
        if surface is None:
            return dict.fromkeys(self.parameters, float("nan"))
        return dict(zip(self.parameters, surface.centre.tolist()))

    @property
    def interval(self) -> dict[str, tuple[float, float]]:
        """Interval in which each parameter is with a probability of 95 %."""
        if self.curvature is None:
            return dict.fromkeys(self.parameters, (float("nan"), float("nan")))
        allowed = self.curvature.allowed
        if self.uncertainty is not None:
            samples = self.uncertainty.samples
            greater = np.std(samples, axis=0) > self.curvature.error
            inner = np.percentile(samples, [2.5, 97.5], axis=0).T
            allowed = np.where(greater[:, None], inner, allowed)
        return dict(zip(self.parameters, map(tuple, allowed.tolist())))

    @property
    def final_turn(self) -> np.ndarray:
        """Largest angle (K,) between the last simulated and recorded attitudes of a recording [rad].

        NaN of recordings without orientations.
        """
        pairs = zip(self.runs, self.recordings)
        turns = [
            np.full((1, 3), np.nan)
            if b.orientation is None
            else quaternion.between(b.orientation[-1], a.orientation[-1])
            for a, b in pairs
        ]
        return np.array([np.max(np.linalg.norm(turn, axis=-1)) for turn in turns])

    def __str__(self) -> str:
        lines = [
            f"objective {self.objective:.6g} (at the start {self.objective_at_start:.6g}), mean of "
            f"{len(self.recordings)} recordings; {self.evaluations} evaluations, {self.message}"
        ]
        for name, value in self.parameters.items():
            low, high = self.interval[name]
            if name in self.undetermined:
                text = f"not determined by these data: from {low:.3g} to {high:.3g}"
            else:
                text = f"{value:.6g} +- {self.error[name]:.2g}, smoothed {self.smooth[name]:.6g}, "
                text += f"95 % in [{low:.6g}, {high:.6g}]"
            lines.append(f"{name:16} {text}")
        for change in [] if self.curvature is None else self.curvature.combinations:
            change = change / change[np.argmax(np.abs(change))]
            parts = {name: part for name, part in zip(self.parameters, change) if part}
            lines.append(
                f"{' and '.join(parts)} only in combination: the data do not show changes in the ratio "
                + " : ".join(f"{part:.2g}" for part in parts.values())
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
