"""The energy ledger of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.arguments import attributes
from carom.scene.shown import Shown


@attributes()
@dataclass(frozen=True, eq=False)
class Ledger(Shown):
    """Energy balance at each saved time, arrays (T,) [J]; all except the first two are sums since the start.

    ``kinetic + potential = start + loads + impacts + friction + bounces + residual``

    Attributes
    ----------
    kinetic, potential
        Present energies. The potential energy is that of gravity, springs and forces with a potential.
    loads
        Work of forces and torques without potential, of dampers (negative), of motors, and of the drives of
        surfaces that move in themselves.
    impacts
        Change of energy by impacts: at most 0, except that Newton's law with friction may add energy. If small
        bounces are dropped, corrections of their friction are included here.
    friction
        Work of friction in persistent contacts, at most 0.
    bounces
        Energy of small bounces that were dropped when a contact became persistent, at most 0.
    residual
        Rest that no entry explains: the error of the time integration.
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
