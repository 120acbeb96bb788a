"""Methods by name, and what a run with steps of varying length takes from its tolerances."""

from __future__ import annotations

import numpy as np

from carom.dynamics.explicit import EXPLICIT, Explicit, tableau, with_error
from carom.dynamics.implicit import Implicit
from carom.dynamics.rattle import SYMPLECTIC, Rattle, composition
from carom.dynamics.three_field import ThreeField
from carom.options import Options

ORDERS = {"rk5": 5, "rk8": 8}  # of the error of a step, for the length of the next
FIRST = 1e-3  # of the longest step: the first


def make_method(
    name: str, options: Options, adapts: bool = False
) -> Explicit | Rattle | ThreeField | Implicit:
    """Return the settings of a method by its name."""
    if adapts:
        return with_error(name)
    if name in EXPLICIT:
        return tableau(name)
    if name in SYMPLECTIC:
        return Rattle(composition(name), *tableau("rk8" if name == "rattle6" else "rk4"))
    if name == "implicit":
        return Implicit(*tableau("rk4"))
    return ThreeField(
        int(name == "paper-ode"),
        options.natural_frequency,
        options.damping_ratio,
        options.augmentation,
        options.residual_tolerance,
        options.max_iterations,
        *tableau("rk4"),
    )


def time_of_bounces(system, tolerances: tuple[float, float], longest: float) -> float:
    """Return the time of a bounce as high as the tolerance, sqrt(8 tol/g): shorter ones are not resolved.

    It takes the place of the step wherever that is a measure of time: for what is held, and what rests.
    """
    g = float(np.linalg.norm(system.gravity))
    if not system.contacts.size or g == 0.0:
        return longest
    rtol, atol = tolerances
    size = float(np.min(system.bodies.extent[system.contacts.body]))
    return min(longest, float(np.sqrt(8.0 * (atol + rtol * size) / g)))
