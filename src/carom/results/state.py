"""The state of a scene at one time, in the form for user-defined functions."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from carom import arguments, checks
from carom.geometry import quaternion
from carom.model.arrays import STATE
from carom.results.event_tables import ForceTable, force_table
from carom.results.exerted import COLUMNS_EACH, rubs
from carom.results.instant import Instant
from carom.results.joint_coordinates import in_degrees, of_scene
from carom.results.named import Source
from carom.results.names import Numbers

_NONE = np.array([1.0, 0.0, 0.0, 0.0])
_NONE_SET: dict = {}


@arguments.attributes()
class SystemState(Source):
    """The N bodies of a scene at one time. Read only; it stays as it is when the run goes on.

    ``state["die"]`` is one of them, a `BodyState`; ``state["hinge"]``, ``state["motor"]`` and
    ``state["die-ground"]`` are a joint, a force and a contact, as of `Solution`. Forces of joints and motors
    are computed when they are asked for, which takes some tenths of a millisecond.

    Attributes
    ----------
    t : float
        Time [s].
    kinetic_energy, potential_energy : float
        Energies of the whole system [J].
    """

    _whose = "state"

    def __init__(self, run, known: dict | None = None, given: dict | None = None):
        self._known = {} if known is None else known  # joints prepared so far, names of contacts
        clock, rows = run.clock, run.now.view(np.ndarray).copy()
        rows.flags.writeable = False
        self._rows, self._to_principal = rows, run.to_principal
        self._scene = run.stands.view(run.scene)
        self.t = float(clock["now"][0])
        self.kinetic_energy = float(clock["kinetic"][0])
        self.potential_energy = float(clock["potential"][0])
        given = _NONE_SET if given is None else given
        self._instant = Instant(run, rows, self.t, given, self._known)

    @classmethod
    def _of_file(cls, scene, t: float, kinetic: float, potential: float, motion) -> SystemState:
        """Return a state; `motion`: position, orientation, velocity and angular velocity (N, ...)."""
        state = cls.__new__(cls)
        rows = np.zeros(len(scene.bodies), STATE)
        rows["x"], rows["Q"], rows["v"], rows["w"] = motion
        rows.flags.writeable = False
        state._known, state._rows, state._scene, state._to_principal = {}, rows, scene, _NONE
        state._instant = None
        state.t, state.kinetic_energy, state.potential_energy = t, kinetic, potential
        return state

    @property
    def position(self) -> np.ndarray:
        """Positions of the mass centres (N, 3), world [m]."""
        return self._rows["x"]

    @property
    def velocity(self) -> np.ndarray:
        """Velocities of the mass centres (N, 3), world axes [m/s]; at the time of an impact, after it."""
        return self._rows["v"]

    @property
    def angular_velocity(self) -> np.ndarray:
        """Angular velocities (N, 3), world axes [rad/s]; at the time of an impact, after it."""
        return self._rows["w"]

    @cached_property
    def orientation(self) -> np.ndarray:
        """Unit quaternions (N, 4), body to world."""
        if (self._to_principal == _NONE).all():
            return self._rows["Q"]
        turned = quaternion.conjugate(self._to_principal)
        out = quaternion.multiply(np.array(self._rows["Q"]), turned)
        out.flags.writeable = False
        return out

    @property
    def turns(self) -> np.ndarray | None:
        """Coordinates (C,) whose whole turns a run counts [rad or m]; None of a state from a file."""
        return None if self._instant is None else self._instant.turns

    @property
    def _given(self) -> dict:
        """Values of forces and controls that were set in a run, by the index of the force."""
        return {} if self._instant is None else self._instant.given

    @property
    def total_energy(self) -> float:
        """Kinetic plus potential energy [J]."""
        return self.kinetic_energy + self.potential_energy

    @property
    def _at(self) -> Instant:
        if self._instant is None:
            raise ValueError(
                "forces of a state of a file are not known; read them from the solution"
            )
        return self._instant

    @property
    def _numbers(self) -> Numbers:
        if self._instant is None:
            from carom.model.contact_rows import touching_pairs

            return Numbers(self._scene, touching_pairs(self._scene))
        pairs = self._instant.pairs
        kept = self._known.get(Numbers)
        if kept is None or kept.pairs is not pairs:
            kept = self._known[Numbers] = Numbers(self._scene, pairs)
        return kept

    @property
    def _touch(self) -> np.recarray:
        return self._at.touch

    @property
    def _reports(self):
        from carom.results.reports import Reports

        if Reports not in self._known:
            self._known[Reports] = Reports(self._scene)
        return self._known[Reports]

    @cached_property
    def _saved(self):
        """The state as the records of a run of one saved time."""
        from carom.results.reports import at_once

        if self._instant is not None:
            return at_once(self._rows, self.t, self._instant.turns[: self._instant.counted])
        rows = self._rows.copy()
        rows["Q"] = quaternion.multiply(self.orientation, self._reports.compiled.to_principal)
        return at_once(rows, self.t)

    def _report(self, forces) -> np.recarray:
        """Return what some forces exert (1, R), as `Reports.exerted` does."""
        self._reports.set(self._at.given)
        frictions = self._solved[1] if any(map(rubs, forces)) else {}
        return self._reports.exerted(forces, self._saved, ((0, 1),), frictions)

    def _exerted_by(self, force) -> np.ndarray:
        from carom.results.reports import numbers

        return numbers(self._report((force,)))[0, :, :COLUMNS_EACH]

    @cached_property
    def _solved(self):
        return self._at.solved(self)

    @cached_property
    def _accelerations(self) -> np.ndarray:
        return self._at.accelerations(self)

    @property
    def _reactions(self) -> np.ndarray:
        return self._solved[0]

    @property
    def forces(self) -> ForceTable:
        """Forces at all points of persistent contact, as of `Solution.forces`."""
        return force_table(self._touch)._by_name(self._numbers)

    @property
    def joint_reactions(self) -> np.ndarray:
        """Force and torque (J, 6) of each joint on its child, as of `Solution.joint_reactions`."""
        return self._reactions[0][: len(self._scene.joints)]

    @property
    def constraint_forces(self) -> np.ndarray:
        """Multipliers (K,) of the rows of constraints, as of `Solution.constraint_forces`."""
        from carom.results.assemble import multipliers

        return multipliers(self._scene, self._reactions)[0]

    def joint_coordinates(self, joint, *, degrees: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Return coordinates and rates (n,) of a joint, as `Solution.joint_coordinates` does.

        Angles include whole turns, and places on closed curves laps, which the run counts.

        Parameters
        ----------
        joint : Joint or str
            A joint of the scene, or its name.
        degrees : bool
            Whether angles are in degrees. Default False: radians.
        """
        joint = of_scene(self._scene, joint)
        motion = self._reports.motion(joint, self._saved)
        read = motion.value[0], motion.rate[0]
        return in_degrees(joint, *read) if checks.flag("degrees", degrees) else read

    def __repr__(self) -> str:
        return f"<SystemState: {len(self._rows)} bodies at t = {self.t:.9g} s>"
