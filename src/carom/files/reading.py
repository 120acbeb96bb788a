"""Reading a run from its file."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from carom.files import checkpoint as state
from carom.files import raw
from carom.files.checkpoint import Checkpoint
from carom.files.kept import KeptRun
from carom.files.layout import EVENT, FORMAT, IMPACT, INTERVAL, LEDGER
from carom.files.needs import need
from carom.files.scene_parts import scene_from_text
from carom.ledger import Ledger
from carom.options import Options
from carom.status import Status
from carom.system import records as r
from carom.tables import LAWS, ContactTable, EventTable, ImpactTable

ALLOWED = "allowed is a file that Solution.save or simulate(save=...) has written"
#: what HDF5, h5netcdf and JSON raise where a file has been damaged
BROKEN = (
    KeyError, TypeError, IndexError, AttributeError, OSError, RuntimeError, MemoryError,
    UnicodeDecodeError, json.JSONDecodeError,
)  # fmt: skip
#: types of columns of words
MOTION = ("position", "velocity", "angular_velocity", "held_residual")
DERIVED = ("orientation", "kinetic_energy", "potential_energy")
MODES = ("open", "slipping", "sticking")
WORDS = {"impact_law": LAWS, "event_kind": r.EVENTS, "interval_mode": MODES}


def read(path: Path, functions: Mapping[str, Callable] | None = None) -> dict[str, Any]:
    """Return the fields of a solution, and in ``cached`` its properties that were worked out already."""
    with opened(path) as file, _told(path):
        scene, missing = scene_from_text(_text(file.variables["scene"]), functions)
        options = Options(**json.loads(file.attrs["options"]))
        settings = json.loads(file.attrs["settings"])
        records = _records(file)
        run = KeptRun(scene, settings, options, records, _checkpoint(file), missing)
        fields: dict[str, Any] = {
            "t": _array(file, "time"),
            **{name: _array(file, name) for name in MOTION},
            "status": Status[file.attrs["status"]],
            "warnings": tuple(json.loads(file.attrs.get("warnings", "[]"))),
            "stats": json.loads(file.attrs["stats"]),
            "scene": scene, "settings": settings, "_run": run, "_touch": records.touch,
        }  # fmt: skip
        derived = {name: _array(file, name) for name in DERIVED}
        entries = [_array(file, f"ledger_{name}") for name in LEDGER if name != "residual"]
        energies = derived["kinetic_energy"], derived["potential_energy"]
        fields["cached"] = {
            **derived,
            "impacts": ImpactTable(**{k: _array(file, f"impact_{k}") for k in IMPACT}),
            "events": EventTable(**{k: _array(file, f"event_{k}") for k in EVENT}),
            "contacts": ContactTable(**{k: _array(file, f"interval_{k}") for k in INTERVAL}),
            "ledger": Ledger(*energies, *entries),
            **_cached(file),
        }
    return fields


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Open a file for reading, or say what it is instead of a run.

    Raises
    ------
    FileNotFoundError
        If there is none.
    ValueError
        If it is of another kind, broken, or newer than this version of carom.
    """
    h5netcdf = need("h5netcdf", "loading a run")
    import h5py

    if not path.exists():
        raise FileNotFoundError(f"path must be a file of a run, got {str(path)!r}: there is none")
    if path.is_dir() or not h5py.is_hdf5(path):
        what = "a folder" if path.is_dir() else "not HDF5, or its beginning is lost"
        raise ValueError(_refusal(path, f"it is {what}"))
    try:
        file = h5netcdf.File(path, "r")
        version, made = (file.attrs.get(name) for name in ("carom_format", "source"))
    except (*BROKEN, ValueError) as error:
        raise ValueError(_refusal(path, f"it is broken ({error})")) from error
    with file:
        if not isinstance(version, (int, np.integer)):
            raise ValueError(_refusal(path, "it is HDF5, but not from carom (no carom_format)"))
        if not 1 <= version <= FORMAT:
            raise ValueError(
                f"path must be a file in format {FORMAT} or older, got {str(path)!r} in format {version}, "
                f"written by {made or 'another program'}; update carom to read it"
            )
        yield file


def _refusal(path: Path, why: str) -> str:
    return f"path must be a file of a run, got {str(path)!r}: {why}; {ALLOWED}"


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Say of a file whose inside is not as it should be that it is broken."""
    try:
        yield
    except (
        KeyError,
        TypeError,
        IndexError,
        AttributeError,
        OSError,
        json.JSONDecodeError,
    ) as error:
        what = f"{type(error).__name__}: {error}"
        raise ValueError(_refusal(path, f"a part of it is missing or broken ({what})")) from error


def _text(variable) -> str:
    value = variable[()]
    value = value.item() if isinstance(value, np.ndarray) else value
    return value.decode() if isinstance(value, bytes) else value


def _array(file, name: str) -> np.ndarray:
    """Return a variable as the array that it was."""
    data = np.asarray(file.variables[name][...])
    if data.dtype.kind not in "OS":
        return data
    words = [one.decode() if isinstance(one, bytes) else str(one) for one in data.ravel()]
    kind = np.array(WORDS[name]).dtype if name in WORDS else None
    return np.array(words, dtype=kind or str).reshape(data.shape)


def _records(file) -> r.Records:
    group = file.groups[raw.GROUP]
    sizes = {
        name: file.dimensions[name].size for name in ("time", "body", "held", "impact", "event")
    }
    sizes["snapshot"] = group.dimensions["snapshot"].size

    def column(name: str, same: str) -> np.ndarray:
        return _array(
            group if name in group.variables else file, name if name in group.variables else same
        )

    return raw.from_columns(column, sizes)


def _checkpoint(file) -> Checkpoint | None:
    if state.GROUP not in file.groups:
        return None
    group = file.groups[state.GROUP]
    note = json.loads(_text(group.variables["note"]))
    arrays = {}
    for name, of in note["arrays"].items():
        kind = of["dtype"]
        kind = (
            [(f[0], f[1], *(tuple(n) for n in f[2:])) for f in kind]
            if isinstance(kind, list)
            else kind
        )
        made = np.zeros(tuple(of["shape"]), dtype=np.dtype(kind))
        if not of["zero"]:
            made.reshape(-1).view("u8")[:] = group.variables[name][...]
        arrays[name] = made
    return Checkpoint(note["found"], arrays)


def _cached(file) -> dict[str, Any]:
    """Return what the file of a finished run holds of reactions, empty where there are none of a kind."""
    if "position_error" not in file.variables:
        return {}
    saved = file.dimensions["time"].size
    out: dict[str, Any] = {
        "joint_reactions": np.zeros((saved, 0, 6)),
        "constraint_forces": np.zeros((saved, 0)),
        "constraint_errors": (_array(file, "position_error"), _array(file, "velocity_error")),
    }
    if "joint_force" in file.variables:
        pair = [_array(file, name) for name in ("joint_force", "joint_torque")]
        out["joint_reactions"] = np.concatenate(pair, axis=2)
    if "constraint_force" in file.variables:
        out["constraint_forces"] = _array(file, "constraint_force")
    return out
