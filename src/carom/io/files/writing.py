"""Writing a run to its file: completely, or not at all.

The HDF5 library makes its part in memory; the bytes are written without it. (It does not survive a full disk:
version 2.0 ends the process.)
"""

from __future__ import annotations

import io
import os
from pathlib import Path

import numpy as np

from carom import checks
from carom.io.files import raw
from carom.io.files.checkpoint import Checkpoint, packed, state_at_end
from carom.io.files.convert import is_table, write_tables
from carom.io.files.disk import put
from carom.io.files.layout import Variable
from carom.io.files.sealed import seal
from carom.io.files.settings_in_time import as_rows
from carom.io.files.user_events import index_of
from carom.io.files.variables import attributes, labelled
from carom.model import records as r


def save(path: str | os.PathLike, solution) -> None:
    """Write a solution to a file, whose suffix says how; see `Solution.save`."""
    where = checks.file_to_write("path", path)
    if is_table(where):
        write_tables(where, solution)
        return
    checks.need("h5netcdf", "saving a run", "files")
    write(where, solution, state_at_end(solution))


def write(path: Path, solution, checkpoint: Checkpoint | None = None, whole: bool = True) -> None:
    """Write a solution to `path`, and replace an old file in one operation.

    Without `whole` the reactions of joints are left out.

    Raises
    ------
    OSError
        If it could not be written, with the path and the reason; an old file is unchanged.
    """
    solution = getattr(solution, "_of_scene", solution)  # of a system in coordinates
    try:
        parts = file_of(solution, checkpoint, whole)
    except (OSError, MemoryError) as error:
        why = str(error) or "no memory is left"
        raise OSError(f"{str(path)!r} could not be written and is unchanged: {why}") from error
    put(path, parts)


def file_of(solution, checkpoint: Checkpoint | None = None, whole: bool = True) -> list:
    """Return the bytes of a file, in parts: HDF5, carom's own arrays, the index of both, the digest."""
    variables = labelled(solution, reactions=whole)
    known = {one.name: one.data for one in variables}
    image, arrays = hdf5(variables, attributes(solution))
    parts: list[bytes | memoryview] = [image]
    end = len(image)

    def add(data: bytes) -> int:
        nonlocal end
        parts.append(data)
        end += len(data)
        return end - len(data)

    run = solution._run
    records, history = r.trimmed(run.records, run.clock), as_rows(getattr(run, "history", None))
    for name, _, data in raw.columns(records, known):
        arrays[f"{raw.GROUP}/{name}"] = data.dtype.str, add(data.tobytes())
    index = {
        "attributes": attributes(solution),
        "scene": known["scene"].item(),
        "sizes": {
            dim: n for one in variables for dim, n in zip(one.dims, one.data.shape)
        } | {"snapshot": len(records.snapshot), "turn": records.turn.shape[1]},
        "arrays": arrays,
        "words": {name: _coded(known[name], words) for name, words in raw.WORDS.items()},
        "user_events": index_of(solution),
        "found": None if run.found is None else len(run.found),
        "history": None if history is None else [len(history), add(history.tobytes())],
        "switched": [len(run.switched), add(run.switched.tobytes())] if len(run.switched) else None,
        "checkpoint": None if checkpoint is None else packed(checkpoint, add),
    }  # fmt: skip
    return seal(parts, index)


def hdf5(variables: list[Variable], attrs: dict) -> tuple[memoryview, dict[str, tuple[str, int]]]:
    """Return a netCDF-4 file as it would lie on the disk, and where in it the numbers of each variable are.

    Raises
    ------
    OSError
        If the HDF5 library fails, or has written wrong data.
    """
    h5netcdf = checks.need("h5netcdf", "saving a run", "files")
    import h5py

    made, arrays = io.BytesIO(), {}
    try:
        with h5netcdf.File(made, "w") as file:
            file.attrs.update(attrs)
            for one in variables:
                _create(file, one).attrs.update(one.attrs)
        image = made.getbuffer()
        with h5py.File(made, "r") as file:
            for one in variables:
                if one.data.dtype.kind in "fi":
                    start = file[one.name].id.get_offset() or 0  # None where there are no elements
                    arrays[one.name] = one.data.dtype.str, start
    except Exception as error:  # of its own kinds: RuntimeError, KeyError, ...
        raise OSError(f"HDF5 could not make the file: {type(error).__name__}: {error}") from error
    for one in variables:
        if one.name in arrays:
            start = arrays[one.name][1]
            if image[start : start + one.data.nbytes] != one.data.tobytes():
                raise OSError(f"HDF5 has not written {one.name!r} as it was given")
    return image, arrays


def _create(file, one: Variable):
    """Create a variable, and the dimensions that are new."""
    for dim, size in zip(one.dims, one.data.shape):
        if dim not in file.dimensions:
            file.dimensions[dim] = size
    data = one.data
    if data.dtype.kind in "UO":
        import h5py

        data, kind = data.astype(object), h5py.string_dtype()
    else:
        kind = data.dtype
    if data.size == 0:  # a length of 0 stands for one that may grow, and such arrays have chunks
        chunks = tuple(max(1, n) for n in data.shape)
        return file.create_variable(one.name, one.dims, dtype=kind, chunks=chunks)
    return file.create_variable(one.name, one.dims, dtype=kind, data=data)


def _coded(data: np.ndarray, words: tuple[str, ...]) -> str:
    """Return a column of words as one digit a row."""
    return "".join(str(words.index(word)) for word in data.tolist())
