"""The outcome of each run of an ensemble: a row of numbers, and the observed values."""

from __future__ import annotations

import numpy as np

from carom.results.accuracy import energy_error
from carom.results.assemble import to_scene_axes
from carom.run import Run
from carom.status import Status

#: status of runs that have not been made, and of runs that could not start
PENDING, REFUSED = -1, -2


def outcome_type(bodies: int) -> np.dtype:
    """Return the data type of a row, for scenes with this number of bodies."""
    return np.dtype(
        [
            ("status", "i8"),  # a `Status`, or PENDING, or REFUSED
            ("t", "f8"),  # reached
            ("rest_time", "f8"),  # end of the first step after which nothing moves, else NaN
            ("impacts", "i8"),
            ("first_impact", "f8"),  # time, else NaN
            ("kinetic_energy", "f8"),  # at the end
            ("impact_loss", "f8"),  # energy that impacts, friction and bounces have taken
            ("friction_loss", "f8"),
            ("bounce_loss", "f8"),
            ("load_work", "f8"),
            ("energy_error", "f8"),  # worst without a name, as a part of what was exchanged
            ("position", "f8", (bodies, 3)),
            ("orientation", "f8", (bodies, 4)),
            ("velocity", "f8", (bodies, 3)),
            ("angular_velocity", "f8", (bodies, 3)),
        ]
    )


def no_outcomes(runs: int, bodies: int) -> np.ndarray:
    """Return rows for runs that have not been made."""
    rows = np.zeros(runs, dtype=outcome_type(bodies))
    rows["status"] = PENDING
    for name in rows.dtype.names or ():
        if rows.dtype[name].base.kind == "f":
            rows[name] = np.nan
    return rows


def write_outcome(run: Run, status: Status, row: np.void) -> None:
    """Write the outcome of a run."""
    now = run.now
    clock = dict(
        zip(run.clock.dtype.names or (), run.clock[0].item())
    )  # fields one by one are slow
    struck = clock["struck"]
    row["status"], row["t"], row["impacts"] = int(status), clock["now"], struck
    row["rest_time"] = clock["still"] if np.isfinite(clock["still"]) else np.nan
    row["first_impact"] = np.min(run.records.impact["time"][:struck]) if struck else np.nan
    row["impact_loss"], row["friction_loss"] = -clock["impacts"], -clock["friction"]
    row["bounce_loss"], row["load_work"] = -clock["bounces"], clock["loads"]
    row["energy_error"] = energy_error(run.watch[0])
    row["kinetic_energy"] = clock["kinetic"]
    row["position"], row["velocity"], row["angular_velocity"] = now.x, now.v, now.w
    row["orientation"] = to_scene_axes(now.Q[None], run.compiled.to_principal)[0]
