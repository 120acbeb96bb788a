"""An ensemble on disk: a Zarr group that grows by whole parts, and that a later call can continue.

A part is complete when it has a mark: a small file that is written last, in one operation, with the digest of
all numbers of the part. After an interruption, parts whose numbers do not agree with their mark are computed
again. While a store is being created a file says so; a store whose creation was interrupted is created again.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from carom import checks
from carom.io.files.disk import put, sync
from carom.studies.ensembles.outcome import PENDING, Layout, outcome_type
from carom.studies.ensembles.plan import Part, join

FORMAT = "carom ensemble 2"
MAKING = ".making"  # file that exists while a store is created
NEW = ".new"  # array that is being created
MARKS = "parts"
OWN = (NEW, "zarr.json", "inputs", "outcomes", "observed", MARKS)


def _zarr() -> Any:
    return checks.need("zarr", "save", "ensemble")


def is_begun(path: Path) -> bool:
    """Return whether a path has a store, except one whose creation was interrupted."""
    if not path.is_dir():
        return path.exists()
    return any(path.iterdir()) and not (path / MAKING).exists()


class Store:
    """The arrays of an ensemble in a folder."""

    def __init__(self, path, group: Any):
        self.path, self.group = Path(path), group

    @classmethod
    def make(cls, path, inputs: dict[str, np.ndarray], layout: Layout, chunk: int, about: dict):
        """Return a new store without any runs."""
        zarr = _zarr()
        path = Path(path)
        path.mkdir(parents=True, exist_ok=True)
        (path / MAKING).touch()
        for name in OWN:
            _remove(path / name)
        runs = len(next(iter(inputs.values())))
        group = zarr.create_group(str(path), attributes={**about, **layout.fact, "chunk": chunk})
        for name in ("inputs", "outcomes", "observed", MARKS):
            group.create_group(name)
        words = {
            name: sorted(set(rows.tolist()))
            for name, rows in inputs.items()
            if rows.dtype.kind == "U"
        }
        for name, values in inputs.items():
            if (
                name in words
            ):  # as their places in a list: Zarr has no type of words that all readers know
                values = np.searchsorted(words[name], values)
            _array(group, f"inputs/{in_file(name)}", values.shape, values.dtype, chunk)[:] = values
        group.attrs["words"], group.attrs["names"] = words, list(inputs)
        kind = outcome_type(layout)
        for name in kind.names or ():
            base, shape = kind[name].base, kind[name].shape
            fill = PENDING if name == "status" else (0 if base.kind == "i" else np.nan)
            _array(group, f"outcomes/{name}", (runs, *shape), base, chunk, fill)
        group.attrs["inputs"] = _digest(inputs)
        group.attrs["format"] = FORMAT
        sync(path)
        (path / MAKING).unlink()
        return cls(path, group)

    @classmethod
    def open(cls, path):
        """Return an existing store; refuse a path that is not a store."""
        zarr = _zarr()
        if not is_begun(Path(path)):
            raise FileNotFoundError(
                f"{path} does not exist; carom.ensemble(..., save=...) saves an ensemble"
            )
        try:
            group = zarr.open_group(str(path), mode="r+")
            known = group.attrs.get("format")
        except Exception as error:
            raise ValueError(
                f"{path} must be an ensemble of carom, but cannot be read: {error}"
            ) from None
        if known != FORMAT:
            raise ValueError(
                f"{path} must be of format {FORMAT!r}, got {known!r}; give another path, or remove it"
            )
        return cls(path, group)

    @property
    def chunk(self) -> int:
        """Number of runs in a part."""
        return int(self.group.attrs["chunk"])

    @property
    def about(self) -> dict:
        """The facts that were stored when the store was created."""
        return dict(self.group.attrs)

    @property
    def layout(self) -> Layout:
        """What the states at the ends of the runs are of."""
        bodies = (
            self.group["outcomes/position"].shape[1] if "outcomes/position" in self.group else 0
        )
        return Layout.of_facts(self.about, bodies)

    @property
    def runs(self) -> int:
        """Number of runs."""
        return self.group["outcomes/status"].shape[0]

    def write(self, part: Part) -> None:
        """Write a part, and its mark last.

        Raises
        ------
        OSError
            If the part cannot be written, for example on a full disk. Parts that were written before stay
            unchanged.
        """
        rows = slice(part.first, part.first + len(part.outcomes))
        failures = {str(k): message for k, message in part.failures.items()}
        mark = {"digest": _digest(_columns(part.outcomes), part.observed), "failures": failures}
        text = json.dumps({**mark, "observed": sorted(part.observed)})
        try:
            for name, values in part.observed.items():
                self._observed(name, values)[rows] = values
            names = part.outcomes.dtype.names or ()
            for name in sorted(names, key="status".__eq__):  # status last, for other readers
                self.group[f"outcomes/{name}"][rows] = part.outcomes[name]
            put(self.path / MARKS / f"{part.first}.json", [text.encode()])
        except OSError as error:
            raise OSError(
                error.errno,
                f"{error.strerror or error}; the parts written so far are valid: call again to continue",
                str(self.path),
            ) from error

    def _observed(self, name: str, values: np.ndarray):
        """Return the array of the observed values; a new array replaces it as a whole."""
        key = f"observed/{in_file(name)}"
        if key not in self.group:
            _remove(self.path / NEW)
            shape = (self.runs, *values.shape[1:])
            fill = np.nan if values.dtype.kind == "f" else 0
            _array(self.group, NEW, shape, values.dtype, self.chunk, fill)
            sync(self.path / NEW)
            place = self.path / key
            place.parent.mkdir(parents=True, exist_ok=True)
            (self.path / NEW).rename(place)
        return self.group[key]

    def inputs(self) -> dict[str, np.ndarray]:
        """Return the varied values.

        Raises
        ------
        ValueError
            If they differ from those that were written.
        """
        try:
            arrays = sorted(self.group["inputs"].arrays())
            values = {from_file(name): np.asarray(array[:]) for name, array in arrays}
            for name, words in self.group.attrs.get("words", {}).items():
                values[name] = np.array(words)[values[name]]
            values = {name: values[name] for name in self.group.attrs.get("names", values)}
            whole = _digest(values) == self.group.attrs["inputs"]
        except Exception as error:  # a damaged file may cause any error of a decoder
            raise ValueError(
                f"{self.path} is damaged: its inputs cannot be read ({error})"
            ) from error
        if not whole:
            raise ValueError(
                f"{self.path} is damaged: its inputs have changed since they were written"
            )
        return values

    def read(self) -> Part:
        """Return all completed runs as one part; rows of other runs are pending.

        Raises
        ------
        ValueError
            If columns have different numbers of rows: one may be said to be larger than the memory.
        """
        runs = self.runs
        for folder in ("outcomes", "observed"):
            for name, array in self.group[folder].arrays():
                if array.shape[0] != runs:
                    raise ValueError(
                        f"{self.path} is damaged: {folder}/{name} has {array.shape[0]} rows, "
                        f"and outcomes/status {runs}"
                    )
        whole = join(self._parts(), runs, self.layout)
        return whole._replace(failures=dict(sorted(whole.failures.items())))

    def _parts(self) -> Iterator[Part]:
        """Yield the parts that have a mark and agree with it."""
        columns = {name: self._column(f"outcomes/{name}") for name in self.group["outcomes"]}
        names = self.group["observed"]
        observed = {from_file(name): self._column(f"observed/{name}") for name in names}
        kind = outcome_type(self.layout)
        for first in range(0, self.runs, self.chunk):
            file = self.path / MARKS / f"{first}.json"
            if not file.exists():
                continue
            mark, rows = json.loads(file.read_bytes()), slice(first, first + self.chunk)
            made = np.zeros(len(columns["status"][rows]), dtype=kind)
            for name in kind.names or ():
                made[name] = columns[name][rows]
            seen = {name: observed[name][rows] for name in mark["observed"] if name in observed}
            if _digest(_columns(made), seen) == mark["digest"]:
                failures = {int(k): message for k, message in mark["failures"].items()}
                yield Part(first, made, failures, seen)

    def _column(self, key: str) -> np.ndarray:
        """Return an array, with zeros for chunks that cannot be read: an incomplete part has no mark."""
        array = self.group[key]
        try:
            return np.asarray(array[:])
        except Exception:  # an incomplete file may cause any error of a decoder
            out = np.zeros(array.shape, array.dtype)
        for first in range(0, self.runs, self.chunk):
            try:
                out[first : first + self.chunk] = array[first : first + self.chunk]
            except Exception:
                continue
        return out


def in_file(name: str) -> str:
    """Return a name as files have it, where a slash leads into a folder."""
    return name.replace("/", "%2F")


def from_file(name: str) -> str:
    """Return a name that files have as `in_file` says."""
    return name.replace("%2F", "/")


def _columns(outcomes: np.ndarray) -> dict[str, np.ndarray]:
    return {name: outcomes[name] for name in outcomes.dtype.names or ()}


def _digest(*tables: dict[str, np.ndarray]) -> str:
    """Return the SHA-256 of columns of numbers."""
    found = hashlib.sha256()
    for name, values in (column for table in tables for column in sorted(table.items())):
        found.update(f"{name} {values.dtype.str} {values.shape}".encode())
        found.update(np.ascontiguousarray(values).tobytes())
    return found.hexdigest()


def _array(group, key: str, shape, kind, chunk: int, fill: float = 0):
    return group.create_array(
        key, shape=shape, dtype=kind, chunks=(min(chunk, shape[0]), *shape[1:]), fill_value=fill
    )


def _remove(place: Path) -> None:
    if place.is_dir():
        shutil.rmtree(place)
    else:
        place.unlink(missing_ok=True)
