"""The outcome of each run of an ensemble: a row of numbers, and the observed values."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.generalized.scene import CoordinateScene
from carom.model import records as r
from carom.model.arrays import STATE
from carom.results.accuracy import energy_error, inaccurate, sentences
from carom.results.assemble import to_scene_axes
from carom.results.endings import message
from carom.run import Run
from carom.scene.all_pairs import PairTable
from carom.scene.scene import Scene
from carom.status import Status
from carom.stepping.energy_balance import WATCH

#: status of runs that have not been made, and of runs that could not start
PENDING, REFUSED = -1, -2


#: the state at the end of a run, by what it is of: fields of each, and their components
STATES = {
    "bodies": {"position": (3,), "orientation": (4,), "velocity": (3,), "angular_velocity": (3,)},
    "coordinates": {"q": (), "v": ()},
}


class Layout(NamedTuple):
    """What the state at the end of a run is of."""

    names: tuple[str, ...]
    of: str = "bodies"

    @property
    def fields(self) -> dict[str, tuple[int, ...]]:
        """The fields of the state of one body or coordinate, with their shapes."""
        return STATES[self.of]

    @property
    def fact(self) -> dict[str, str]:
        """The names, as files have them."""
        return {FACTS[self.of]: json.dumps(self.names)}

    @classmethod
    def of_facts(cls, about: Mapping, bodies: int = 0) -> Layout:
        """Return what files have; those without names are of `bodies` with numbers."""
        for of, fact in FACTS.items():
            if fact in about:
                return cls(tuple(json.loads(about[fact])), of)
        return cls(tuple(f"body{k + 1}" for k in range(bodies)))

    def __str__(self) -> str:
        return f"{len(self.names)} {self.of}"


#: names in files of the names of bodies or coordinates
FACTS = {"bodies": "body_names", "coordinates": "coordinate_names"}


def outcome_type(layout: Layout) -> np.dtype:
    """Return the data type of a row."""
    count = len(layout.names)
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
            *((name, "f8", (count, *shape)) for name, shape in layout.fields.items()),
        ]
    )


def no_outcomes(runs: int, layout: Layout) -> np.ndarray:
    """Return rows for runs that have not been made."""
    rows = np.zeros(runs, dtype=outcome_type(layout))
    rows["status"] = PENDING
    for name in rows.dtype.names or ():
        if rows.dtype[name].base.kind == "f":
            rows[name] = np.nan
    return rows


class End(NamedTuple):
    """What a run has left behind when the next one begins. `write` makes rows of many of them together."""

    status: Status
    first_impact: float
    state: bytes  # (N,) STATE
    clock: bytes  # (1,) CLOCK
    watch: bytes  # (1,) WATCH
    to_principal: np.ndarray
    scene: Scene
    pairs: PairTable
    reason: str
    finer: str


def end_of(run: Run, status: Status) -> End:
    """Return what a run that ended with this status leaves behind."""
    struck = run.clock["struck"][0]
    times = run.records.impact["time"][:struck]
    return End(
        run.ending(status), np.minimum.reduce(times) if struck else np.nan,
        run.now.tobytes(), run.clock.tobytes(), run.watch.tobytes(),
        run.to_principal, run.scene, run.pairs, run.compiled.functions.reason, run.how.finer,
    )  # fmt: skip


def write(ends: dict[int, End], rows: np.ndarray) -> dict[int, str]:
    """Write the rows of runs, by number; return a message for each run that is no success."""
    at, found = list(ends), list(ends.values())
    now = _joined(STATE, [end.state for end in found]).reshape(len(at), -1)
    clock = _joined(r.CLOCK, [end.clock for end in found])
    watch = _joined(WATCH, [end.watch for end in found])
    status = np.array([end.status for end in found], dtype=int)
    done = np.flatnonzero(status == Status.SUCCESS)
    status[done[inaccurate(watch[done])]] = Status.INACCURATE
    to_principal = np.array([end.to_principal for end in found]).reshape(*now.shape, 4)
    columns = {
        "status": status,
        "t": clock["now"],
        "rest_time": np.where(np.isfinite(clock["still"]), clock["still"], np.nan),
        "impacts": clock["struck"],
        "first_impact": [end.first_impact for end in found],
        "kinetic_energy": clock["kinetic"],
        "impact_loss": -clock["impacts"],
        "friction_loss": -clock["friction"],
        "bounce_loss": -clock["bounces"],
        "load_work": clock["loads"],
        "energy_error": energy_error(watch),
        **_states(found[0].scene, now, to_principal),
    }
    for name, values in columns.items():
        rows[name][at] = values
    return {
        at[i]: _message(Status(status[i]), found[i], clock["now"][i], watch[i])
        for i in np.flatnonzero(status != Status.SUCCESS)
    }


def _states(scene: Scene, now: np.ndarray, to_principal: np.ndarray) -> dict[str, np.ndarray]:
    """Return the states at the ends of runs by name."""
    if isinstance(scene, CoordinateScene):
        scale = scene.system.scale
        return {"q": scale * now["x"][..., 0], "v": scale * now["v"][..., 0]}
    return {
        "position": now["x"],
        "orientation": to_scene_axes(now["Q"], to_principal),
        "velocity": now["v"],
        "angular_velocity": now["w"],
    }


def _joined(fields: list, rows: list[bytes]) -> np.ndarray:
    """Return rows that were copied as bytes, which takes a tenth of the time of a copy by fields."""
    return np.frombuffer(b"".join(rows), table(fields, 0).dtype)


def _message(status: Status, end: End, reached: float, watch: np.record) -> str:
    said = sentences(watch, end.finer, end.scene, end.pairs)
    return message(status, end.reason, end.finer, reached, said)
