"""A copy of the contents of arrays, from which they can be restored; and a run that is put back."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from mmap import mmap
from typing import Any

import numpy as np

#: bytes of an array up to which it takes longer to look for zeros than to copy them
SMALL = 512
#: bytes from which on memory comes from the system, which clears only the pages that are used
LARGE = 1 << 20


class Kept:
    """A copy of the contents of all arrays in nested tuples, as bytes: records are slow to copy by fields.

    A run has fifty arrays. The copy of one takes .1 microseconds as a memoryview, and .3 as an array.
    """

    def __init__(self, parts: tuple):
        self.parts = parts
        flat = [array.reshape(-1).view(np.uint8) for array in arrays_of(parts)]
        self.content = [(there.data, there.copy().data) for there in flat]

    def take(self) -> None:
        """Store the present contents of the arrays."""
        for there, kept in self.content:
            kept[:] = there

    def restore(self) -> None:
        """Write the contents back."""
        for there, kept in self.content:
            there[:] = kept

    def is_of(self, parts: tuple) -> bool:
        """Return whether these are the same tuples; when an array is lengthened, its tuple is replaced."""
        return all(a is b for a, b in zip(parts, self.parts))


class Snapshot:
    """The place where a run stood between two steps, and to which it can be put back.

    It has all that the next step depends on. The records of a run are not kept: its clock says how many of
    their rows are valid.
    """

    def __init__(self, run):
        self.run = run
        self.parts, self.kept = self.present(), Kept(run.memory)

    def take(self) -> None:
        """Keep where the run stands."""
        if self.kept.is_of(self.run.memory):
            self.kept.take()
        else:  # it has grown
            self.kept = Kept(self.run.memory)
        self.parts = self.present()

    def put_back(self) -> None:
        """Put the run back to where it stood."""
        run = self.run
        run.compiled, run.now, run.active, run.islands = self.parts
        self.kept.restore()

    def present(self) -> tuple:
        """Return the parts of the run that are replaced when they grow."""
        run = self.run
        return run.compiled, run.now, run.active, run.islands


def arrays_of(value) -> Iterator[np.ndarray]:
    """Yield the arrays in nested tuples that can be written to."""
    if isinstance(value, np.ndarray):
        if value.size and value.flags.writeable:
            yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from arrays_of(part)


class Mould:
    """Contents of the arrays in nested named tuples, from which tuples with arrays of their own are made.

    The new arrays are parts of one array of bytes, in which those of zeros come last and are not copied. Arrays
    that are `shared` are no parts of it.
    """

    def __init__(self, parts: tuple, shared: tuple = ()):
        known = {id(one) for one in arrays_of(shared)}
        arrays = [one for one in arrays_of(parts) if id(one) not in known]
        is_zero = [
            one.nbytes > SMALL and not one.reshape(-1).view(np.uint8).any() for one in arrays
        ]
        contents = [one.tobytes("A") for one, zero in zip(arrays, is_zero) if not zero]
        self.recipe = (
            parts,
            [a for k in (False, True) for a, z in zip(arrays, is_zero) if z == k],
            contents,
        )

    def cast(self) -> Any:
        """Return the tuples with new arrays."""
        recipe = self.recipe
        if len(recipe) == 3:  # worked out when it is needed first
            recipe = self.recipe = _recipe(*recipe)
        plan, places, content, size = recipe
        memory = np.frombuffer(mmap(-1, size) if size > LARGE else bytearray(size), np.uint8)
        memory[: len(content)] = content
        new = np.ndarray.__new__
        return _cast([new(*kind, memory, *place) for kind, place in places], *plan)


def _recipe(parts: tuple, arrays: list[np.ndarray], contents: list[bytes]) -> tuple:
    """Return the plan of nested tuples, types and places of their arrays, the first bytes, and their number."""
    size, places, content = 0, [], bytearray()
    for k, one in enumerate(arrays):
        places.append(((type(one), one.shape, one.dtype), (size, one.strides)))
        size += one.nbytes + -one.nbytes % 16
        if k < len(contents):
            content += contents[k].ljust(size - len(content), b"\0")
    plan = _plan(parts, {id(one): k for k, one in enumerate(arrays)})
    return plan, places, np.frombuffer(content, np.uint8), size


def _plan(part: tuple, number: dict[int, int]) -> tuple:
    """Return how a tuple is made: by what, of which parts, the places of arrays and plans of tuples in it."""
    arrays = [(i, number[id(one)]) for i, one in enumerate(part) if id(one) in number]
    plans = [(i, _plan(one, number)) for i, one in enumerate(part) if isinstance(one, tuple)]
    plans = [(i, plan) for i, plan in plans if plan[2] or plan[3]]
    found = list(part)
    for i, _ in arrays + plans:
        found[i] = None
    return getattr(part, "_make", tuple), found, arrays, plans


def _cast(made: list[np.ndarray], make: Callable, parts: list, arrays: list, plans: list):
    found = parts.copy()
    for i, k in arrays:
        found[i] = made[k]
    for i, plan in plans:
        found[i] = _cast(made, *plan)
    return make(found)
