"""Forces of a scene whose values are set as a run goes."""

from __future__ import annotations

from typing import Any

from carom import checks
from carom.results.robot import columns, commands, first_controls
from carom.results.set_forces import History, places, put
from carom.scene.forces import AppliedForce, Force, Torque

HINT = "; state one by Scene.add_force, and give it or its name"
UNITS = {Force: "N", Torque: "N m"}


class Applied:
    """The forces of a run that may be set, and what they have been set to."""

    def __init__(self, run, history: History | None = None):
        self.run, self.places = run, places(run.scene, run.compiled)
        self.history: History = list(history or ())
        self.commands = commands(run.scene)
        self.ctrl = first_controls(self.commands)
        self._column = columns(self.commands)
        self.given: dict[int, Any] = {}  # present values, by index; replaced with each
        for index, value in {index: value for _, index, value in self.history}.items():
            self._put(index, value)

    def set(self, force, value) -> None:
        """Set a force, given itself or by its name."""
        scene = self.run.scene
        force = scene._parts.member("force", force, (AppliedForce,), HINT)
        place = self.places.get(force.index)
        if place is None or place.actuator is not None:
            hint = "" if place is None else f", whose control is run.ctrl[{force.name!r}]"
            raise ValueError(
                "force must be a Force, a Torque or a JointForce with a number, got "
                f"{force.name!r}, a {force.kind}{hint}"
            )
        if not isinstance(force.definition, (Force, Torque)):
            value = checks.number("value", value)
        else:
            value = checks.finite_array("value", value, (3,), unit=UNITS[type(force.definition)])
        self.note(force.index, value)

    def note(self, index: int, value) -> None:
        """Set the force with this index to a value, which was checked, or the control of an actuator."""
        self.history.append((int(self.run.clock["saved"][0]), index, value))
        self._put(index, value)

    def _put(self, index: int, value) -> None:
        compiled, place = self.run.compiled, self.places[index]
        self.given = {**self.given, index: value}
        if index in self._column:
            self.ctrl[self._column[index]] = value
        put(compiled.system, place, value)
        joined = self.run.islands.joined
        if joined.body.size:  # a second time, for the islands of loaded bodies
            rows = tuple(int(joined.placed[place.kind][row]) for row in place.rows)
            put(joined, place._replace(rows=rows), value)
            self.run.wake()
