"""The controls of the actuators of a run, as an array with names."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.control.applied import Applied


@arguments.attributes("a control is set by run.ctrl[name] = value")
class Controls:
    """The controls (nu,) of the actuators of a run: by name, by number, or all at once.

    A value outside the range of its actuator is kept as it is, and acts as the nearest value inside.

    Attributes
    ----------
    names : tuple of str
        Names of the actuators, in their order.
    """

    __slots__ = ("_of_run", "names")

    def __init__(self, applied: Callable[[], Applied]):
        self._of_run = applied  # a run that is reset has others
        self.names = tuple(one.name for one in applied().commands)

    @property
    def _applied(self) -> Applied:
        return self._of_run()

    def __len__(self) -> int:
        return len(self.names)

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        return np.array(self._applied.ctrl, dtype=dtype)

    def __getitem__(self, which):
        """Return the control of an actuator by its name, or what an array has at this place."""
        return self._applied.ctrl[self._place(which)].copy()

    def __setitem__(self, which, value: ArrayLike) -> None:
        """Set the control of an actuator by its name, or a part of the array."""
        wanted = self._applied.ctrl.copy()
        if isinstance(which, str):
            k = self._number(which)
            if not self._applied.commands[k].parts:
                raise ValueError(
                    f"the actuator {which!r} is not represented in the scene; the report of the model says why"
                )
            wanted[k] = checks.number(f"ctrl[{which!r}]", value)
        else:
            place, given = (
                self._place(which),
                checks.real_array("ctrl", value, f"of {len(wanted)} controls"),
            )
            try:
                wanted[place] = given
            except ValueError:
                raise ValueError(
                    f"ctrl[{checks.shown(which)}] must be {wanted[place].size} controls, got "
                    f"{checks.shown(value)}"
                ) from None
            checks.finite_array("ctrl", wanted, (len(wanted),))
        for k in np.flatnonzero(wanted != self._applied.ctrl):
            for part in self._applied.commands[k].parts:
                self._applied.note(part.index, float(wanted[k]))
        self._applied.ctrl[:] = wanted

    def _place(self, which):
        """Return what an array takes as the place of one control or of several."""
        if isinstance(which, str):
            return self._number(which)
        count = len(self.names)
        if isinstance(which, (int, np.integer)) and not isinstance(which, bool):
            if not -count <= which < count:  # the end of a loop over the controls too
                raise IndexError(f"the run has {count} actuators, got the number {which}")
            return int(which)
        try:
            if np.ndim(self._applied.ctrl[which]) == 1:
                return which
        except (IndexError, TypeError, ValueError):
            pass
        raise ValueError(
            f"the key of ctrl must be the name or the number of one of {count} actuators, or a slice or an "
            f"array of numbers, got {checks.shown(which)}"
        )

    def _number(self, name: str) -> int:
        if name in self.names:
            return self.names.index(name)
        known = ", ".join(map(repr, self.names)) or "none"
        near = checks.nearest(name, self.names)
        raise KeyError(f"the run has no actuator {name!r}; it has {known}{near}")

    def __repr__(self) -> str:
        return f"<Controls: {dict(zip(self.names, self._applied.ctrl.tolist()))}>"
