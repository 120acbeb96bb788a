"""What `sensitivities` hands back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from carom import checks
from carom.studies.gradient.tangents import Tangents

NEAR = 0.05  # margins below this part of their scale are shown as near


class Derivative(NamedTuple):
    """Derivatives of the state of N bodies by P parameters, world axes; of several times with one axis more."""

    position: np.ndarray  #: (N, 3, P)
    rotation: np.ndarray  #: (N, 3, P) rotation vector: the attitude R goes to exp(d) R
    velocity: np.ndarray  #: (N, 3, P)
    angular_velocity: np.ndarray  #: (N, 3, P)


@dataclass(frozen=True, eq=False)
class Margin:
    """How far the run is from another sequence of contact at one place.

    Attributes
    ----------
    time : float
        [s]
    impact : int
        Number of the impact that it belongs to, -1 for none.
    what : str
        What is near, in words.
    value : float
        Distance from the change, which is at 0.
    unit : str
    relative : float
        The same as a part of what is usual: of the size of the body, the speed of impact, ...
    gradient : (P,)
        Derivative of `value`.
    """

    time: float
    impact: int
    what: str
    value: float
    unit: str
    relative: float
    gradient: np.ndarray

    @property
    def reach(self) -> np.ndarray:
        """How far (P,) each parameter alone may go until the sequence changes here, to first order."""
        with np.errstate(divide="ignore"):
            return np.abs(self.value) / np.abs(self.gradient)

    def __str__(self) -> str:
        return f"t = {self.time:.6f} s: {self.what} ({self.value:.3g} {self.unit})"


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivities:
    """Derivatives of a run by P parameters. Where there is none, NaN, and `notes` say why.

    Attributes
    ----------
    labels : tuple of str
        One a column: ``"die.velocity.x"``, ``"die-ground.friction"``, ...
    columns : dict of str to slice or int
        Columns of each name as it was asked for.
    final : Derivative
        Of the final state.
    impact_time : (K, P)
        Of the times of the impacts of the run [s].
    impact_point : (K, 3, P)
        Of the points where they are, each at its own time, in the world.
    velocity_before, velocity_after : (K, 3, P)
        Of the relative velocities, contact axes.
    impulse : (K, 3, P)
        Contact axes.
    impact_error : (K,)
        Estimate of the relative error of the derivative of each impact's impulse.
    notes : tuple of str
        What has no derivative, and why.
    margins : tuple of Margin
        How far the sequence of contact is from a change, the nearest (in `relative`) first. Between impacts
        vertices over half-spaces are looked at, not two bodies that pass each other, nor curved ones.
    defect : float
        Greatest distance between the stepped motion and the exact free flight that is differentiated, as a
        part of the size of a body: the error of the time integration. By differences: the greatest estimate of
        their own error, relative.
    by : str
        ``"saltation"``, the exact derivative of free flight and impacts; or ``"differences"`` of pieces.
    """

    labels: tuple[str, ...]
    columns: dict[str, slice | int]
    impact_time: np.ndarray
    impact_point: np.ndarray
    velocity_before: np.ndarray
    velocity_after: np.ndarray
    impulse: np.ndarray
    impact_error: np.ndarray
    notes: tuple[str, ...]
    margins: tuple[Margin, ...]
    defect: float
    final: Derivative = field(init=False)
    by: str
    _motion: Tangents

    def __post_init__(self):
        object.__setattr__(self, "final", self.evaluate(self._motion.end))

    @property
    def reach(self) -> np.ndarray:
        """How far (P,) each parameter alone may go until the sequence of contact changes, to first order.

        The least of all margins; of a parameter that has no derivative, NaN. By differences no margins are
        known: NaN.
        """
        if self.by == "differences":
            return np.full(len(self.labels), np.nan)
        if not self.margins:
            return np.full(len(self.labels), np.inf)
        return np.min([m.reach for m in self.margins], axis=0)

    def evaluate(self, t) -> Derivative:
        """Return the derivatives of the state at times of the run; at that of an impact, after it.

        Near an impact the motion is differentiable at each fixed time, but not evenly: between the time of
        the impact and that of the changed motion the velocity is off by the whole jump.

        Parameters
        ----------
        t : float or (n,)
            Times within the run [s]; by differences, ends of its steps.

        Returns
        -------
        Derivative
            Arrays (n, N, 3, P), without the first axis for a single time.

        Raises
        ------
        ValueError
            If a time is outside the run.
        """
        X = self._motion.at(checks.times("t", t, self._motion.begin, self._motion.end))
        X = X[0] if np.ndim(t) == 0 else X
        return Derivative(*(X[..., 3 * k : 3 * k + 3, :] for k in range(4)))

    def __repr__(self) -> str:
        head = f"<Sensitivities of {len(self.impact_time)} impacts by {len(self.labels)} parameters"
        near = [m for m in self.margins if m.relative < NEAR]
        lines = [f"  no derivative: {note}" for note in self.notes]
        lines += [f"  near a change of sequence: {m}" for m in near]
        if not near and self.by == "saltation":
            lines.append("  no change of the sequence of contact is near")
        return "\n".join([head, *lines]) + ">"
