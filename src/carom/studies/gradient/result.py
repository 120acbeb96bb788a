"""Results of `sensitivities`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from carom import checks
from carom.studies.gradient.tangents import Flights, Steps

NEAR = 0.05  # margins below this part of their scale are shown as near


class Derivative(NamedTuple):
    """Derivatives of the state of N bodies by P parameters, world axes; for several times with a first axis."""

    position: np.ndarray  #: (N, 3, P) mass centres
    rotation: np.ndarray  #: (N, 3, P) rotation vector d: the attitude R becomes exp(d) R
    velocity: np.ndarray  #: (N, 3, P) velocities of the mass centres
    angular_velocity: np.ndarray  #: (N, 3, P)


@dataclass(frozen=True, eq=False)
class Margin:
    """Distance of the run from one change of the sequence of contact.

    Attributes
    ----------
    time : float
        Time [s].
    impact : int
        Index of the impact to which the margin belongs, -1 for none.
    what : str
        Description of the distance.
    value : float
        The distance; the sequence changes at 0.
    unit : str
        Unit of `value`.
    relative : float
        `value` relative to a typical value: the size of the body, the speed of impact, ...
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
        """Change (P,) of each parameter alone that changes the sequence here, to first order."""
        with np.errstate(divide="ignore"):
            return np.abs(self.value) / np.abs(self.gradient)

    def __str__(self) -> str:
        return f"t = {self.time:.6f} s: {self.what} ({self.value:.3g} {self.unit})"


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivities:
    """Derivatives of a run by P parameters. Missing derivatives are NaN, and `notes` has the reasons.

    Attributes
    ----------
    labels : tuple of str
        Labels of the columns: ``"die.velocity.x"``, ``"die-ground.friction"``, ...
    columns : dict of str to slice or int
        Columns of each name in `with_respect_to`.
    final : Derivative
        Derivatives of the final state.
    impact_time : (K, P)
        Derivatives of the times of the impacts.
    impact_point : (K, 3, P)
        Derivatives of the points of the impacts, each at the time of its impact, in the world.
    velocity_before, velocity_after : (K, 3, P)
        Derivatives of the relative velocities before and after each impact, contact axes.
    impulse : (K, 3, P)
        Derivatives of the impulses, contact axes.
    impact_error : (K,)
        Estimated relative error of the derivative of each impulse.
    notes : tuple of str
        Reasons of missing derivatives.
    margins : tuple of Margin
        Distances from changes of the sequence of contact, the nearest (in `relative`) first. Between impacts
        only vertices above half-spaces are examined, not pairs of bodies and not curved bodies.
    defect : float
        By saltation: the largest distance between the simulated motion and the exact free flight that is
        differentiated, as a fraction of the size of a body (the error of the time integration). By differences:
        the largest estimate of their relative error.
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
    _motion: Flights | Steps

    def __post_init__(self):
        object.__setattr__(self, "final", self.evaluate(self._motion.end))

    @property
    def reach(self) -> np.ndarray:
        """Change (P,) of each parameter alone that changes the sequence of contact, to first order.

        It is the least over all margins. It is NaN for a parameter without a derivative, and for all parameters
        by differences, which have no margins.
        """
        if self.by == "differences":
            return np.full(len(self.labels), np.nan)
        if not self.margins:
            return np.full(len(self.labels), np.inf)
        return np.min([m.reach for m in self.margins], axis=0)

    def evaluate(self, t) -> Derivative:
        """Return the derivatives of the state at times of the run; at the time of an impact, those after it.

        Near an impact the motion is differentiable at each fixed time, but not uniformly: between the time of
        the impact and that of the impact in the changed motion, the velocity differs by the whole jump.

        Parameters
        ----------
        t : float or (n,)
            Times within the run [s]; by differences they must be ends of steps.

        Returns
        -------
        Derivative
            Arrays (n, N, 3, P); for a single time without the first axis.

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
