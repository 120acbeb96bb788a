"""The state of a system in coordinates at one time, in the form for user-defined functions."""

from __future__ import annotations

import numpy as np

from carom.results.state import SystemState


class CoordinateState:
    """The coordinates of a system at one time. Read only; it stays as it is when the run goes on.

    Attributes
    ----------
    t : float
        Time [s].
    q, v : (n,)
        Coordinates and their rates; at the time of an impact the rates after it.
    kinetic_energy, potential_energy : float
        Energies [J].
    """

    _state: SystemState  # of the bodies of the run

    def __init__(self, t: float, q: np.ndarray, v: np.ndarray, kinetic: float, potential: float):
        self.t, self.q, self.v = t, q.copy(), v.copy()
        self.q.flags.writeable = self.v.flags.writeable = False
        self.kinetic_energy, self.potential_energy = kinetic, potential

    @classmethod
    def _of(cls, state: SystemState, scale: np.ndarray) -> CoordinateState:
        """Return the coordinates of the bodies that stand for them."""
        q, v = scale * state.position[:, 0], scale * state.velocity[:, 0]
        made = cls(state.t, q, v, state.kinetic_energy, state.potential_energy)
        made._state = state
        return made

    def __repr__(self) -> str:
        return f"<CoordinateState: {len(self.q)} coordinates at t = {self.t:g} s>"
