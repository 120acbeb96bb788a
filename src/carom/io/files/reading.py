"""Reading a run from its file.

The file has not changed since it was written (`carom.io.files.sealed`), but anybody may have written it.
Therefore all data from it are checked: sizes before arrays are made, and row numbers before they are used.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from carom import checks
from carom.generalized.scene import CoordinateScene
from carom.generalized.system import GeneralizedSystem
from carom.io.files import raw
from carom.io.files.checkpoint import from_index
from carom.io.files.kept import KeptRun
from carom.io.files.layout import (
    ENERGIES,
    EVENT,
    IMPACT,
    INTERVAL,
    JOINT_IMPULSE,
    LEDGER,
    MOTION,
)
from carom.io.files.scene_parts import OF_SYSTEM, scene_from_text, scene_to_text
from carom.io.files.sealed import Sealed, refusal, unsealed
from carom.io.files.settings_in_time import from_rows, switched_from
from carom.io.files.user_events import from_file
from carom.model import records as r
from carom.options import Options
from carom.results.assemble import named
from carom.results.event_tables import ContactTable, EventTable, ImpactTable
from carom.results.exerted import rows_of
from carom.results.joint_impulses import of_joints
from carom.results.ledger import Ledger
from carom.results.names import Numbers
from carom.scene.coordinates import counted
from carom.scene.scene import Scene
from carom.status import Status
from carom.stepping.settings import checked_settings

#: results of the motion that a solution computes when it is asked for them
DERIVED = ("orientation", *ENERGIES)
LENGTHS = {"axis": 3, "quaternion": 4, "contact_axis": 3, "contact_axis_2": 3}
TYPES = ("<f8", "<i8", ">f8", ">i8")
#: columns of the table of impacts that files of earlier versions do not have
LATER_IMPACT = ("peak_force", "layer_duration")
#: columns of tables that count something
WHOLE = ("contact", "together", "wedged", "located", "feature", "impact", "joint")


def read(
    path: Path, functions: Mapping[str, Callable] | None = None, system: Any = None
) -> dict[str, Any]:
    """Return the fields of a solution, and in ``cached`` its properties that were worked out already.

    `system` is given for the file of a system in coordinates, which does not contain it.

    Raises
    ------
    FileNotFoundError
        If there is no file.
    ValueError
        If it is not a file of a run, damaged, or newer than this version of carom; if the scene does not have a
        function.
    """
    file = unsealed(path)
    text = file.index.get("scene", "")
    if system is not None or _is_of_system(text):
        scene, missing = _scene_of(system, text, path), []
    else:
        scene, missing = _stated_scene(text, functions, path)
    try:
        return _fields(file, scene, missing)
    except Exception as error:  # whatever a made-up index leads to
        what = f"{type(error).__name__}: {error}"
        raise ValueError(refusal(path, f"a part of it is missing or broken ({what})")) from error


def _stated_scene(text, functions, path: Path) -> tuple[Scene, list[str]]:
    """Return the scene of a text, and the functions that are missing in it."""
    try:
        made, missing = scene_from_text(text, functions)
        return made._as_it_is(), missing
    except ValueError as error:
        if str(error).startswith("functions must"):
            raise
        raise ValueError(refusal(path, f"its scene is broken: {error}")) from error


def _is_of_system(text) -> bool:
    """Return whether the text of a scene is that of a system in coordinates."""
    return isinstance(text, str) and text.startswith(OF_SYSTEM)


def _scene_of(system, text, path: Path) -> CoordinateScene:
    """Return the scene of a system in coordinates, if it is that of the file."""
    if system is None:
        raise ValueError(
            refusal(
                path, "it is of a system in coordinates: GeneralizedSolution.load(path, system)"
            )
        )
    checks.instance("system", system, (GeneralizedSystem,))
    if not _is_of_system(text):
        raise ValueError(refusal(path, "it is of a scene: Solution.load(path)"))
    scene = CoordinateScene(system)
    if scene_to_text(scene) != text:
        raise ValueError(
            "system must be that of the file as it was at its start, got one with another start, metric there, "
            "scale or contacts"
        )
    return scene


def _fields(file: Sealed, scene, missing: list[str]) -> dict[str, Any]:
    index = file.index
    attributes = index["attributes"]
    options = Options(**json.loads(attributes["options"]))
    settings = _settings(json.loads(attributes["settings"]), options)
    arrays = _Arrays(file, len(scene.bodies))
    records = raw.from_columns(arrays.column, arrays.sizes)
    note = index["checkpoint"]
    checkpoint = None if note is None else from_index(note, file.data)
    found = _found(arrays, index["found"], len(scene.stops))
    history = from_rows(file.data, index.get("history"), scene)
    switched = switched_from(file.data, index.get("switched"), scene)
    known = records, checkpoint, missing, attributes, found, history, switched
    run = KeptRun(scene, settings, options, *known)
    check_numbers(records, len(run.pairs.body) + len(scene.stops))
    if records.turn.shape[1] not in (0, turning := len(counted(scene.joints))):
        raise ValueError(
            f"it has {records.turn.shape[1]} angles of joints, and the scene {turning}"
        )
    names = Numbers(scene, run.pairs)
    motion = {name: arrays.array(name, ("time", *dims)) for name, (dims, _, _) in MOTION.items()}
    derived = {name: motion.pop(name) for name in DERIVED}
    entries = [arrays.array(f"ledger_{name}", ("time",)) for name in LEDGER if name != "residual"]
    return {
        "t": arrays.array("time", ("time",)),
        **motion,
        "status": Status[attributes["status"]],
        "_reason": str(attributes.get("reason", "")),
        "warnings": tuple(str(one) for one in json.loads(attributes["warnings"])),
        "stats": {
            str(name): _count(name, n)
            for name, n in json.loads(attributes["stats"]).items()
        },
        "scene": scene, "settings": settings, "pairs": run.pairs, "_run": run, "_touch": records.touch,
        **from_file(arrays, index.get("user_events"), scene),
        "cached": {
            **derived,
            "impacts": _impacts(arrays, scene, run.pairs)._by_name(names),
            "events": EventTable(**arrays.table("event", EVENT))._by_name(names),
            "contacts": ContactTable(**arrays.table("interval", INTERVAL))._by_name(names),
            "ledger": Ledger(derived["kinetic_energy"], derived["potential_energy"], *entries),
            **_cached(arrays, scene),
        },
    }  # fmt: skip


def _count(name: str, n):
    if name == "busiest_contact" and isinstance(n, str):
        return n
    return checks.integer(name, n) if isinstance(n, int) else checks.number(name, n)


def _impacts(arrays: _Arrays, scene, pairs) -> ImpactTable:
    """Return the table of impacts, with the names of the bodies that strike each other."""
    known = {name: kind for name, kind in IMPACT.items() if name not in LATER_IMPACT}
    known |= {name: IMPACT[name] for name in LATER_IMPACT if f"impact_{name}" in arrays}
    columns = arrays.table("impact", known)
    if "layer_duration" not in columns:  # of an earlier version, where that was the duration
        columns["layer_duration"] = columns["duration"]
        columns["duration"] = columns["peak_force"] = np.full(len(columns["time"]), np.nan)
    return ImpactTable(**columns, **named(columns["contact"], scene, pairs))


def _found(arrays: _Arrays, count: int | None, stops: int) -> np.ndarray | None:
    """Return the bodies (K, 2) of contacts found during the run; None if all existed at its start."""
    if count is None:
        return None
    if count == 0:
        return np.zeros((0, 2), dtype=np.int64)
    last = arrays.sizes["contact"] - stops
    first = last - checks.integer("found", count, least=0, most=last)
    ends = (arrays.array(f"contact_{side}", ("contact",), "i8") for side in ("body", "other"))
    return np.stack([end[first:last] for end in ends], axis=1)


def _settings(given: dict, options: Options) -> dict:
    """Return the settings of a run, checked as those of `simulate` are."""
    save_at = given.get("save_at")
    longest = max([given["duration"], *given.get("earlier", ())])  # an event may have stopped it
    checked_settings(
        longest, given["step"], given["method"], given["impact_location"],
        save_every=given["save_every"], save_at=save_at, rtol=given.get("rtol"), atol=given.get("atol"),
        options=options,
    )  # fmt: skip
    known = {**given, "save_at": tuple(save_at) if isinstance(save_at, list) else save_at}
    if "earlier" in given:
        known["earlier"] = tuple(
            checks.number("earlier", one, above=0.0) for one in given["earlier"]
        )
        if not np.all(np.diff((*known["earlier"], given["duration"])) != 0.0):
            raise ValueError(f"durations must differ, got {known['earlier']}, {given['duration']}")
    return known


class _Arrays:
    """The arrays of a file by name: those that its index places in it, of the shape that they should have."""

    def __init__(self, file: Sealed, bodies: int):
        self.data, self.index = file.data, file.index
        known = {
            str(dim): checks.integer(f"size of {dim}", n, least=0)
            for dim, n in file.index["sizes"].items()
        }
        self.sizes = {"turn": 0, **known, **LENGTHS}  # files of earlier versions have no turns
        if self.sizes["time"] < 1 or self.sizes["body"] != bodies:
            raise ValueError(f"it has {bodies} bodies, and {self.sizes['body']} rows for them")
        for dims in raw.DIMS.values():
            if 8 * math.prod(self.sizes[dim] for dim in dims) > len(self.data):
                raise ValueError(f"it is too short for its sizes {self.sizes}")

    def __contains__(self, name: str) -> bool:
        return name in self.index["arrays"]

    def array(self, name: str, dims: tuple[str, ...], kind: str | None = "f8") -> np.ndarray:
        """Return a variable with these dimensions, of a kind or (None) of any."""
        return self._placed(name, tuple(self.sizes[dim] for dim in dims), kind)

    def column(self, name: str, same: str, shape: tuple[int, ...], kind) -> np.ndarray:
        """Return a column of the records, or the variable that has the same bits."""
        own = f"{raw.GROUP}/{name}"
        if name in raw.LATER and own not in self:
            return np.zeros(shape, kind)
        return self._placed(own if own in self else same, shape, kind)

    def table(self, prefix: str, columns: dict) -> dict[str, np.ndarray]:
        """Return the columns of a table."""
        out = {}
        for column, (dims, _, _) in columns.items():
            name = f"{prefix}_{column}"
            kind = "i8" if column in WHOLE else None
            out[column] = (
                self._words(name, self.sizes[prefix])
                if name in raw.WORDS
                else self.array(name, (prefix, *dims), kind)
            )
        return out

    def _words(self, name: str, rows: int) -> np.ndarray:
        codes = np.frombuffer(self.index["words"][name].encode(), "u1") - ord("0")
        if len(codes) != rows:
            raise ValueError(f"{name} has {len(codes)} rows where {rows} should be")
        return np.array(raw.WORDS[name])[codes]

    def _placed(self, name: str, shape: tuple[int, ...], kind) -> np.ndarray:
        stored, start = self.index["arrays"][name]
        found = np.dtype(checks.choice(f"type of {name}", stored, TYPES))
        own = found.newbyteorder("=")
        if kind is not None and own != kind:
            raise ValueError(f"{name} is of type {stored!r} where {np.dtype(kind).str!r} should be")
        size = math.prod(shape)
        most = len(self.data) - found.itemsize * size
        checks.integer(f"place of {name}", start, least=0, most=most)
        flat = np.frombuffer(self.data, found, size, start) if size else np.zeros(0)
        return flat.reshape(shape).astype(own)


def check_numbers(records: r.Records, contacts: int) -> None:
    """Raise for row numbers out of range: of contacts, bodies, saved times, events, snapshots.

    Raises
    ------
    ValueError
        With the column.
    """
    saved, bodies = records.state.shape
    events, shots = len(records.event), len(records.snapshot)
    ranges = {
        "touch": {
            "saved": (0, saved), "contact": (0, contacts), "body": (0, bodies),
            "other": (-1, bodies), "mode": (0, 3),
        },
        "impact": {"contact": (0, contacts)},
        "event": {
            "kind": (0, len(r.EVENTS)), "contact": (0, contacts), "saved": (0, saved + 1),
            "first": (0, shots + 1), "mode": (0, 3),
        },
        "snapshot": {"event": (0, events), "body": (0, bodies)},
    }  # fmt: skip
    for table, columns in ranges.items():
        for name, (least, end) in columns.items():
            column = getattr(records, table)[name]
            if column.size and not (column.min() >= least and column.max() < end):
                raise ValueError(
                    f"{table}_{name} has numbers outside {least} to {end - 1}, which do not exist"
                )


def _cached(arrays: _Arrays, scene) -> dict[str, Any]:
    """Return the reactions in the file of a finished run; a kind that the run does not have is empty."""
    out: dict[str, Any] = {}
    if "joint_impulse_time" in arrays:
        out["joint_impulses"] = of_joints(scene, arrays.table("joint_impulse", JOINT_IMPULSE))
    if "applied_force" in arrays:
        if arrays.sizes["applied"] != len(rows_of(scene)):
            raise ValueError(f"it has {arrays.sizes['applied']} rows of forces, for other forces")
        of, vector = ("time", "applied"), ("time", "applied", "axis")
        parts = [arrays.array(f"applied_{name}", vector) for name in ("force", "torque")]
        alone = [arrays.array(f"applied_{name}", of)[..., None] for name in ("value", "power")]
        out["_exerted"] = np.concatenate([*parts, *alone], axis=2)
    if "position_error" not in arrays:
        return out
    saved = arrays.sizes["time"]
    names, of = ("position_error", "velocity_error"), ("time", "constraint_row")
    errors = (arrays.array(name, of) for name in names)
    out |= {
        "joint_reactions": np.zeros((saved, 0, 6)),
        "constraint_forces": np.zeros((saved, 0)),
        "constraint_errors": tuple(errors),
    }
    if "joint_force" in arrays:
        pair = [
            arrays.array(name, ("time", "joint", "axis"))
            for name in ("joint_force", "joint_torque")
        ]
        out["joint_reactions"] = np.concatenate(pair, axis=2)
    if "constraint_force" in arrays:
        out["constraint_forces"] = arrays.array("constraint_force", ("time", "row"))
    return out
