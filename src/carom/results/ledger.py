"""The energy ledger of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Ledger:
    """Where the energy went, at each saved time; all [J], all (T,), sums since the start.

    ``kinetic + potential = start + loads + impacts + friction + bounces + residual``

    Attributes
    ----------
    kinetic, potential
        What there is. Potential: gravity and springs.
    loads
        Work of forces and torques without potential, of dampers (negative), and of motors.
    impacts
        Change by impacts: not above zero, but where Newton's law with friction gives energy. Friction takes
        less in impacts and bounces together than in the impacts alone where these bounces are not resolved.
    friction
        Work of friction in persistent contacts, not above zero.
    bounces
        Energy of bounces that were not resolved when a contact was held, not above zero.
    residual
        What is left: the error of the time integration.
    """

    kinetic: np.ndarray
    potential: np.ndarray
    loads: np.ndarray
    impacts: np.ndarray
    friction: np.ndarray
    bounces: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """Energy that no entry explains (T,) [J]."""
        total = self.kinetic + self.potential
        return total - total[0] - self.loads - self.impacts - self.friction - self.bounces
