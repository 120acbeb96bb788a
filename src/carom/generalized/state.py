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

    def __init__(self, state: SystemState, scale: np.ndarray):
        self._state, self.t = state, state.t
        self.q, self.v = scale * state.position[:, 0], scale * state.velocity[:, 0]
        self.q.flags.writeable = self.v.flags.writeable = False
        self.kinetic_energy, self.potential_energy = state.kinetic_energy, state.potential_energy

    def __repr__(self) -> str:
        return f"<CoordinateState: {len(self.q)} coordinates at t = {self.t:g} s>"
