"""The outcome of each run of an ensemble: a row of numbers, and the observed values."""

from __future__ import annotations

import math

import numpy as np

from carom.model import records as r
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
            ("t", "f8"),  # time reached
            ("rest_time", "f8"),  # end of the first step after which nothing moves, or NaN
            ("impacts", "i8"),
            ("first_impact", "f8"),  # time of the first impact, or NaN
            ("kinetic_energy", "f8"),  # at the end
            ("impact_loss", "f8"),  # this and the next two: energy dissipated
            ("friction_loss", "f8"),
            ("bounce_loss", "f8"),
            ("load_work", "f8"),
            ("energy_error", "f8"),  # greatest energy error, relative to the energy exchanged
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


def outcome(run: Run, status: Status) -> tuple:
    """Return the row of a run at its end, in the order of `outcome_type`."""
    now, clock, watch = run.now, r.as_numbers(run.clock), run.watch[0]
    struck, still = clock["struck"], clock["still"]
    return (
        int(status),
        clock["now"],
        still if math.isfinite(still) else math.nan,
        struck,
        float(run.records.impact["time"][:struck].min()) if struck else math.nan,
        clock["kinetic"],
        -clock["impacts"],
        -clock["friction"],
        -clock["bounces"],
        clock["loads"],
        energy_error(watch),
        now["x"],
        to_scene_axes(now["Q"][None], run.compiled.to_principal)[0],
        now["v"],
        now["w"],
    )
