"""The tangents of all bodies at times of a run: along free flight, or at the ends of its steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.studies.gradient.body import Moving, fly


@dataclass(frozen=True, eq=False)
class Flights:
    """Bodies in free flight from their last knot; if a body is not in flight, it keeps the tangents there."""

    begin: float  # of the run [s]
    end: float
    knots: list[list[Moving]]
    free: list[list[bool]]

    def at(self, times: np.ndarray) -> np.ndarray:
        """Return the tangents (n, N, 12, P) at n times."""
        P = self.knots[0][0].X.shape[1]
        X = np.empty((len(times), len(self.knots), 12, P))
        for b, (knots, free) in enumerate(zip(self.knots, self.free)):
            last = np.searchsorted([k.t for k in knots], times, side="right") - 1
            for i in np.argsort(times, kind="stable"):
                k = last[i]
                X[i, b] = fly(knots[k], float(times[i])).X if free[k] else knots[k].X
        return X


@dataclass(frozen=True, eq=False)
class Steps:
    """Tangents (T, N, 12, P) at the ends of the steps of a run."""

    begin: float  # of the run [s]
    end: float
    t: np.ndarray
    X: np.ndarray

    def at(self, times: np.ndarray) -> np.ndarray:
        """Return the tangents at n times, each of which ends a step.

        Raises
        ------
        ValueError
            If a time is not the end of a step.
        """
        k = np.clip(np.searchsorted(self.t, times), 1, len(self.t) - 1)
        k -= np.abs(self.t[k - 1] - times) < np.abs(self.t[k] - times)
        off = np.abs(self.t[k] - times)
        if not np.all(off <= 1e-6 * np.max(np.diff(self.t))):
            worst = int(np.argmax(off))
            raise ValueError(
                "t must be the end of a step if derivatives are found by differences, got "
                f"{times[worst]:.9g}; the nearest is {self.t[k[worst]]:.9g} s"
            )
        return self.X[k]
