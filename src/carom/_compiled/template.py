"""Arrays of nested tuples, and copies of such tuples with arrays of their own, in one block of memory."""

from __future__ import annotations

import os
from collections.abc import Callable
from mmap import ACCESS_COPY, ACCESS_WRITE, mmap
from typing import Any

import numpy as np

SMALL = 512  # bytes up to which it takes longer to look for zeros than to copy them
#: bytes from which on memory comes from the system, which clears only pages that are used; forks have their own
LARGE, PRIVATE = 1 << 20, ACCESS_WRITE if os.name == "nt" else ACCESS_COPY


def arrays_of(value) -> list[np.ndarray]:
    """Return the arrays in nested tuples that can be written to."""
    found, left = [], [value]
    while left:
        part = left.pop()
        if isinstance(part, tuple):
            left += part[::-1]
        elif isinstance(part, np.ndarray) and part.size and part.flags.writeable:
            found.append(part)
    return found


class Template:
    """Contents of the arrays in nested named tuples, from which tuples with arrays of their own are made.

    The new arrays are parts of one array of bytes, in which those of zeros come last and are not copied. Arrays
    that are `shared` are no parts of it.
    """

    def __init__(self, parts: tuple, shared: tuple = ()):
        known = {id(one) for one in arrays_of(shared)}
        arrays = [one for one in arrays_of(parts) if id(one) not in known]
        zero = [a.nbytes > SMALL and not a.reshape(-1).view(np.uint8).any() for a in arrays]
        content = [b"" if empty else one.tobytes("A") for one, empty in zip(arrays, zero)]
        order = sorted(range(len(zero)), key=zero.__getitem__)
        self.recipe = parts, [arrays[k] for k in order], [content[k] for k in order]

    def make(self) -> Any:
        """Return the tuples with new arrays."""
        recipe = self.recipe
        if len(recipe) == 3:  # worked out when it is needed first
            recipe = self.recipe = _recipe(*recipe)
        plan, places, content, size = recipe
        block = mmap(-1, size, access=PRIVATE) if size > LARGE else bytearray(size)
        memory = np.frombuffer(block, np.uint8)
        memory[: len(content)] = content
        arrays = [np.ndarray.__new__(k, n, t, memory, at, by) for k, n, t, at, by in places]
        return _made(arrays, *plan)


def _recipe(parts: tuple, arrays: list[np.ndarray], contents: list[bytes]) -> tuple:
    """Return the plan of nested tuples, types and places of their arrays, the first bytes, and their number."""
    size, places, content = 0, [], bytearray()
    for k, one in enumerate(arrays):
        places.append((type(one), one.shape, one.dtype, size, one.strides))
        size += one.nbytes + -one.nbytes % 16
        if contents[k]:
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


def _made(made: list[np.ndarray], make: Callable, parts: list, arrays: list, plans: list):
    found = parts.copy()
    for i, k in arrays:
        found[i] = made[k]
    for i, plan in plans:
        found[i] = _made(made, *plan)
    return make(found)
