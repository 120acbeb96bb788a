"""Check of the user's functions at the start: their results must be numbers of the right shape."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom._compiled.composed import plainly
from carom.scene.constraints import Driver, Rows
from carom.scene.more_forces import JointForce, UserForce


def check_results(scene) -> None:
    """Raise an error if a function of a force or constraint has a wrong shape, no numbers, or NaN at the start.

    Compiled functions are called as plain Python. The run reports the errors that a function itself raises.
    """
    for part in (*scene.forces, *scene.constraints):
        d = part.definition
        if isinstance(d, UserForce):
            states = _states(d.bodies, with_rates=True)
            _check(f"function of {part.name!r}", d.function, (0.0, states), (len(d.bodies), 6))
            if d.potential is not None:
                name = f"potential of {part.name!r}"
                # no step calls the potential, so its own errors are reported here
                checks.call(name, plainly(d.potential), 0.0, states)
                _check(name, d.potential, (0.0, states), ())
        elif isinstance(d, Rows):
            states = _states(d.bodies, with_rates=False)
            shape = (d.rows, 6 * len(d.bodies) + 1)
            _check(f"function of {part.name!r}", d.function, (0.0, states), shape)
            if d.position is not None:
                _check(f"position of {part.name!r}", d.position, (0.0, states), (d.rows,))
        elif isinstance(d, JointForce) and callable(d.force):
            # the rate at the start is not known here, and NaN at the rate 0 may be correct
            _check(f"force of {part.name!r}", d.force, (0.0, 0.0, 0.0), (), finite=False)
        elif isinstance(d, Driver) and d.motion is not None and not checks.is_polynomial(d.motion):
            _check(f"motion of {part.name!r}", d.motion, (0.0,), (3,))


def _states(bodies, with_rates: bool) -> np.ndarray:
    """Return the argument of a function at the start: states of bodies, (n, 13) or (n, 7)."""
    names = ("position", "orientation", "velocity", "angular_velocity")[: 4 if with_rates else 2]
    return np.array([np.concatenate([getattr(b, name) for name in names]) for b in bodies])


def _check(name: str, function, given: tuple, shape: tuple[int, ...], finite: bool = True) -> None:
    """Raise an error if the result is no number or has not `shape`; axes of length 1 do not count."""
    try:
        result = plainly(function)(*given)
    except Exception:
        return
    wanted = ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "")
    array = checks.real_array(f"the result of {name}", result, f"({wanted})")
    if [n for n in array.shape if n != 1] != [n for n in shape if n != 1]:
        raise ValueError(
            f"the result of {name} must have shape ({wanted}), got shape {array.shape}"
        )
    if finite and not np.all(np.isfinite(array)):
        raise ValueError(
            f"the result of {name} must be finite, got {checks.shown(result)} at the start"
        )
