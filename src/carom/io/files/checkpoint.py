"""The checkpoint of a run between two steps: all arrays on which the next step depends.

Arrays that a step writes before it reads them (the workspace of impacts, groups and crowds) are not stored,
only their sizes.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from carom import checks
from carom.model import records as r
from carom.stepping.islands.layout import with_clusters

#: what is the same in every run of a scene, holds addresses, or is written anew when a step begins; files that
#: have it are read without it
FIXED = {
    *("clock." + name for name in (
        "spent", "begin", "length", "before", "owed", "first_touch", "concerns", "in_step", "tries",
        "scale", "pull", "longest", "able", "counts", "grow", "since", "paused", "whole_at",
    )),
    "work.first", "work.point", "work.step", "work.search", "work.known", "work.stage", "work.trial",
    "work.part", "work.middle", "work.iterate", "work.mean", "work.beside", "work.origin", "work.struck",
    "work.placed", "work.pair.poses", "work.pair.known", "islands.clock", "islands.single.clock",
    "islands.joined", "islands.others", "islands.cluster", "islands.plan.joined", "islands.partner",
    "islands.partner_first", "islands.plane", "islands.plane_first",
}  # fmt: skip


class Packed(NamedTuple):
    """A packed array in a file; it is unpacked after the check that it belongs to the run."""

    dtype: np.dtype
    shape: tuple[int, ...]
    data: bytes  # none: all zeros; shorter than the array: deflated

    def unpacked(self) -> np.ndarray:
        """Return the array."""
        size = self.dtype.itemsize * math.prod(self.shape)
        if not self.data:
            return np.zeros(self.shape, self.dtype)
        whole = self.data
        if len(whole) < size:
            whole = zlib.decompressobj().decompress(whole, size)
        if len(whole) != size:
            raise ValueError("an array of the checkpoint has another size than it should")
        return np.frombuffer(whole, self.dtype).reshape(self.shape)


class Checkpoint(NamedTuple):
    """A run between two steps, or pieces of one."""

    found: dict[str, int]  # the sizes of what grows
    arrays: Mapping[str, np.ndarray | Packed]  # by name, copies


def capture(run) -> Checkpoint | None:
    """Return the checkpoint of a run; None in the middle of a step, or of a piece of one."""
    step, search, islands = run.work.step[0], run.work.search[0], run.islands
    inside = step.spent != 0.0 or step.paused != 0 or search.pending != 0
    if inside or (islands.plan[0].planned != 0):
        return None
    pairs = 0 if run.found is None else len(run.found)
    multiple, spots = len(run.multiple.contact), len(run.crowd.closed)
    found = {"multiple": multiple, "spots": spots, "room": len(islands.which), "pairs": pairs}
    return Checkpoint(found, {name: array.copy() for name, array in arrays_of(run)})


def state_at_end(solution) -> Checkpoint | None:
    """Return the checkpoint of the run of a finished solution; None if the run has continued since."""
    run = solution._run
    if hasattr(run, "checkpoint"):  # from a file
        return run.checkpoint
    stands = solution.status.ended and run.reached == solution.t[-1]
    return capture(run) if stands else None


def restore(run, checkpoint: Checkpoint, records: r.Records) -> None:
    """Set a new run of the same scene to the checkpoint of another one; `records` are those of that run.

    It has the contacts that the other one had (`Run.add_pairs`).

    Raises
    ------
    ValueError
        If the arrays are not those of this version of carom.
    """
    found = checkpoint.found
    while len(run.multiple.contact) < found["multiple"]:
        run.grow(r.FULL_MULTIPLE)
    while len(run.crowd.closed) < found["spots"]:
        run.grow(r.FULL_SPOTS)
    while len(run.islands.which) < found["room"]:
        run.grow(r.FULL_PAIRS)
    here = dict(arrays_of(run))
    kept = {name: array for name, array in checkpoint.arrays.items() if name not in FIXED}
    if layout_of(here) != layout_of(kept):
        raise ValueError("the checkpoint was written by another version of carom")
    for name, array in here.items():
        one = kept[name]
        one = one.unpacked() if isinstance(one, Packed) else one
        for field in array.dtype.names or (...,):
            array[field] = one[field]
    run.islands = with_clusters(run.islands, run.compiled.system)
    _put_records(run, records)


def packed(checkpoint: Checkpoint, add: Callable[[bytes], int]) -> dict:
    """Return the index entry of a checkpoint; `add` stores bytes in a file and returns their position."""
    arrays = {}
    for name, array in checkpoint.arrays.items():
        data = array.data if isinstance(array, Packed) else _deflated(array)
        kind = array.dtype.descr if array.dtype.names else array.dtype.str
        arrays[name] = kind, array.shape, add(data), len(data)
    return {"found": checkpoint.found, "arrays": arrays}


def from_index(note: dict, data: memoryview) -> Checkpoint:
    """Return the checkpoint that `packed` has written."""
    arrays = {}
    for name, (kind, shape, start, length) in note["arrays"].items():
        kind = [(f[0], f[1], *map(tuple, f[2:])) for f in kind] if isinstance(kind, list) else kind
        dtype = np.dtype(kind)
        sizes = [*shape, start, length]
        if dtype.hasobject or not all(type(n) is int and n >= 0 for n in sizes):
            raise ValueError(f"checkpoint: {name!r} is not an array")
        arrays[name] = Packed(dtype, tuple(shape), bytes(data[start : start + length]))
    found = {str(name): checks.integer(name, n, least=0) for name, n in note["found"].items()}
    return Checkpoint(found, arrays)


def _deflated(array: np.ndarray) -> bytes:
    """Return the bytes of an array, deflated where that is shorter; none if they are zeros."""
    whole = np.ascontiguousarray(array).tobytes()
    if not np.frombuffer(whole, "u1").any():
        return b""
    short = zlib.compress(whole, 1)
    return short if len(short) < len(whole) else whole


def layout_of(arrays: Mapping[str, np.ndarray | Packed]) -> dict[str, tuple]:
    """Return type and shape of arrays by name."""
    return {name: (_type_of(name, a), tuple(a.shape)) for name, a in sorted(arrays.items())}


def _type_of(name: str, array: np.ndarray | Packed) -> str:
    fields = [field for field in array.dtype.descr if f"{name}.{field[0]}" not in FIXED]
    return str(fields if array.dtype.names else array.dtype.str)


def arrays_of(run) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the arrays that are the state of a run, with their names."""
    system = run.compiled.system
    roots = {
        "now": run.now, "clock": run.clock, "active": run.active, "work": run.work,
        "islands": run.islands, "solver": system.solver, "memory": system.relations.memory,
        "watch": run.watch,
    }  # fmt: skip
    for name, root in roots.items():
        yield from _walk(name, root)


def _walk(name: str, value) -> Iterator[tuple[str, np.ndarray]]:
    if name in FIXED:
        return
    if isinstance(value, np.ndarray):
        if value.size:
            yield name, value
    elif isinstance(value, tuple):
        for field, one in zip(value._fields, value):  # pyright: ignore[reportAttributeAccessIssue]
            yield from _walk(f"{name}.{field}", one)


def _put_records(run, records: r.Records) -> None:
    """Copy the records before the checkpoint into the records of a run, which are lengthened as in a run."""
    ends = r.ends_of(run.clock)
    grows = ("touch", "impact", "event", "snapshot")
    while any(len(getattr(run.records, name)) < ends[name] for name in grows):
        run.records = r.longer(run.records, run.clock)
    for name, end in ends.items():
        getattr(run.records, name)[:end] = getattr(records, name)[:end]
