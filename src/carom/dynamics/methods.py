"""Methods by name, and what a run with steps of varying length takes from its tolerances."""

from __future__ import annotations

import numpy as np

from carom.dynamics.explicit import EXPLICIT, tableau, with_error
from carom.dynamics.rattle import SYMPLECTIC, composition
from carom.model.method import IMPLICIT, RATTLE, THREE_FIELD, Method
from carom.options import Options

ORDERS = {"rk5": 5, "rk8": 8}  # of the error of a step, for the length of the next
FIRST = 1e-3  # of the longest step: the first


def make_method(name: str, options: Options, adapts: bool = False) -> Method:
    """Return the settings of a method by its name."""
    if adapts:
        return with_error(name)
    if name in EXPLICIT:
        return tableau(name)
    if name in SYMPLECTIC:
        on = tableau("rk8" if name == "rattle6" else "rk4")
        return on._replace(kind=RATTLE, parts=composition(name))
    if name == "implicit":
        return tableau("rk4")._replace(kind=IMPLICIT)
    return tableau("rk4")._replace(
        kind=THREE_FIELD,
        ode=int(name == "paper-ode"),
        beta=options.natural_frequency,
        zeta=options.damping_ratio,
        augment=options.augmentation,
        tolerance=options.residual_tolerance,
        most=options.max_iterations,
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
