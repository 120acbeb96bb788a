"""A copy of the contents of arrays, from which they can be restored."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np


class Kept:
    """A copy of the contents of all arrays in nested tuples, as bytes: records are slow to copy by fields."""

    def __init__(self, parts: tuple):
        self.parts = parts
        flat = [array.reshape(-1).view(np.uint8) for array in arrays_of(parts)]
        self.content = [(there, there.copy()) for there in flat]

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


def arrays_of(value) -> Iterator[np.ndarray]:
    """Yield the arrays in nested tuples that can be written to."""
    if isinstance(value, np.ndarray):
        if value.size and value.flags.writeable:
            yield np.asarray(value)
    elif isinstance(value, tuple):
        for part in value:
            yield from arrays_of(part)
