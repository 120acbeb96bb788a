"""Writing a run to a netCDF-4 file: all of it, or nothing."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path

import numpy as np

from carom.files import checkpoint as state
from carom.files import raw
from carom.files.checkpoint import Checkpoint
from carom.files.needs import need
from carom.files.variables import attributes, labelled
from carom.system import records as r

SMALL = (
    4096  # bytes up to which an array is stored as it is: without a checksum, and not compressed
)


def write(path: Path, solution, checkpoint: Checkpoint | None = None, whole: bool = True) -> None:
    """Write a solution to `path`, replacing what is there in one go.

    A file that is being written stands beside it under another name; who kills the process, or fills the disk,
    leaves what was there before. Without `whole` the reactions of joints are left out.
    """
    h5netcdf = need("h5netcdf", "saving a run")
    part = path.with_name(
        f".{path.name}.part"
    )  # what a killed process leaves, the next saving writes over
    try:
        with h5netcdf.File(part, "w") as file:
            _write_all(file, solution, checkpoint, whole)
        with part.open("r+b") as file:
            os.fsync(file.fileno())  # on the disk before it takes the place of the old one
        os.replace(part, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            part.unlink()


def _write_all(file, solution, checkpoint, whole) -> None:
    file.attrs.update(attributes(solution))
    variables = labelled(solution, reactions=whole)
    for one in variables:
        made = _create(file, one.name, one.dims, one.data)
        made.attrs.update(one.attrs)
    run = solution._run
    records = r.trimmed(run.records, run.clock)
    group = file.create_group(raw.GROUP)
    for column in raw.columns(records, {one.name: one.data for one in variables}):
        _create(group, *column)
    if checkpoint is not None:
        _write_checkpoint(file.create_group(state.GROUP), checkpoint)


def _create(group, name: str, dims: tuple[str, ...], data: np.ndarray):
    """Create a variable, and the dimensions that are new; many numbers with a checksum (Fletcher's)."""
    for dim, size in zip(dims, data.shape):
        if dim not in group.dimensions and dim not in getattr(group.parent, "dimensions", {}):
            group.dimensions[dim] = size
    if data.dtype.kind in "UO":
        import h5py

        data, kind = data.astype(object), h5py.string_dtype()
    else:
        kind = data.dtype
    if data.size == 0:  # a length of 0 stands for one that may grow, and such arrays have chunks
        return group.create_variable(
            name, dims, dtype=kind, chunks=tuple(max(1, n) for n in data.shape)
        )
    checked = {"fletcher32": True} if data.nbytes > SMALL and data.dtype.kind != "O" else {}
    return group.create_variable(name, dims, dtype=kind, data=data, **checked)


def _write_checkpoint(group, checkpoint: Checkpoint) -> None:
    """Write arrays as words of 8 bytes, those of zeros by name alone."""
    layout = {}
    for name, array in checkpoint.arrays.items():
        words = np.ascontiguousarray(array).reshape(-1).view("u8")
        kind = array.dtype.descr if array.dtype.names else array.dtype.str
        empty = not np.any(words)
        layout[name] = {"dtype": kind, "shape": list(array.shape), "zero": empty}
        if empty:
            continue
        dim = f"words_{words.size}"
        if dim not in group.dimensions:
            group.dimensions[dim] = words.size
        packed = {"compression": "gzip", "compression_opts": 1, "fletcher32": True}
        group.create_variable(
            name, (dim,), dtype=words.dtype, data=words, **(packed if words.nbytes > SMALL else {})
        )
    note = {"found": checkpoint.found, "arrays": layout}
    _create(group, "note", (), np.array(json.dumps(note), dtype=object))
