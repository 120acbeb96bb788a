"""The objective of a fit as a function of its parameters, with a record of all evaluations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom import checks
from carom.scene.scene import Scene
from carom.studies.identify.parameters import Space
from carom.studies.identify.recording import Recording
from carom.studies.identify.rollout import RollOut, roll_outs
from carom.studies.identify.varied import KNOWN, varied
from carom.studies.values import changed, find_targets, whole


class Evaluator:
    """The objective as a function of the parameters; each set of parameters is simulated once."""

    def __init__(
        self, scene, recordings: Sequence[Recording], space: Space, objective, progress, **settings
    ):
        self.scene, self.recordings, self.space = scene, recordings, space
        self.objective, self.progress, self.settings = objective, progress, settings
        self.points: list[np.ndarray] = []
        self.values: list[np.ndarray] = []
        self.failed: list[int] = []
        self._known: dict[bytes, int] = {}

    def scene_of(self, point: np.ndarray, recording: Recording) -> Scene:
        """Return the scene of one recording."""
        named = self.space.named(point)
        if isinstance(self.scene, Scene):
            short = {name: value for name, value in named.items() if name in KNOWN}
            made = varied(self.scene, **short, start=recording.start)
            rest = {n: np.array([value]) for n, value in named.items() if n not in KNOWN}
            rows = whole(made, rest)
            return changed(made, find_targets(made, rows), {n: row[0] for n, row in rows.items()})
        scene = checks.call("scene", self.scene, named, recording)
        checks.instance("the result of the function scene", scene, (Scene,))
        return scene

    def runs(self, point: np.ndarray) -> list[RollOut]:
        """Return the simulated motion of each recording."""

        def make(recording):
            return self.scene_of(point, recording)

        return roll_outs(make, self.recordings, **self.settings)

    def number(self, point: np.ndarray) -> int:
        """Return the number of the evaluation at a point, moved into the bounds; evaluate it if it is new."""
        point = self.space.clip(np.asarray(point, dtype=np.float64)) + 0.0  # no -0.0
        key = point.tobytes()
        if key not in self._known:
            runs = self.runs(point)
            values = [
                checks.call("objective", self.objective, *pair)
                for pair in zip(runs, self.recordings)
            ]
            self.values.append(checked(values, self.recordings))
            self.points.append(point)
            self.failed.append(sum(bool(run.message) for run in runs))
            self._known[key] = len(self.points) - 1
            if self.progress is not None:
                named = self.space.named(point)
                checks.call("progress", self.progress, len(self.points), named, self.mean(-1))
        return self._known[key]

    def mean(self, number: int) -> float:
        """Return the objective of evaluation `number`, the mean over recordings."""
        return float(np.mean(self.values[number]))

    def __call__(self, point: np.ndarray) -> float:
        """Return the objective, the mean over recordings."""
        return self.mean(self.number(point))

    @property
    def best(self) -> int:
        """Number of the best evaluation so far."""
        return int(np.argmin([np.mean(v) for v in self.values]))


def checked(values: list, recordings: Sequence[Recording]) -> np.ndarray:
    """Return the objective of each recording (K,); refuse values that are not finite numbers."""
    array = np.array([_number(v) for v in values])
    if not np.all(np.isfinite(array)):
        k = int(np.argmax(~np.isfinite(array)))
        raise ValueError(
            f"objective must return one finite number, got {checks.shown(values[k])} for recording {k} "
            f"{checks.shown(recordings[k].name)}"
        )
    return array


def _number(value) -> float:
    """Return the result of a function as a number, or NaN if it is not a number."""
    try:
        return checks.number("objective", value)
    except ValueError:
        return np.nan
