"""The state of a system in coordinates at one time, in the form for user-defined functions."""

from __future__ import annotations


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

    def __init__(self, run):
        clock = run.clock[0]
        self.t = float(clock.now)
        scale = run.compiled.system.own.scale
        self.q, self.v = scale * run.now.x[:, 0], scale * run.now.v[:, 0]
        self.q.flags.writeable = self.v.flags.writeable = False
        self.kinetic_energy, self.potential_energy = float(clock.kinetic), float(clock.potential)

    def __repr__(self) -> str:
        return f"<CoordinateState: {len(self.q)} coordinates at t = {self.t:g} s>"
