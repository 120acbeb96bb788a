"""The source of compiled code: a hash of a function and of all code that is linked into it.

Numba's cache checks only the file of the cached function, so it does not see a change of a called function in
another file. This stamp follows the calls. Units (`carom._compiled.units`) are compiled separately and left
out, so that a change recompiles only the units that contain it.
"""

from __future__ import annotations

import hashlib
import types
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

_RULES = (
    "decorators.py",
    "target.py",
    "units.py",
    "link_only.py",
    "cache_key.py",
    "call_address.py",
    "by_reference.py",
    "simd.py",
)  # files with the rules of compiling
_CONSTANTS = (int, float, str, bool, tuple, frozenset)


def stamp(function: Callable) -> str:
    """Return the hash of all that the compiled `function` depends on, except the types of arguments."""
    digest = hashlib.sha256(_rules())
    for part in _reached(function, set()):
        digest.update(part.encode())
    return digest.hexdigest()


@cache
def _rules() -> bytes:
    here = Path(__file__).parent
    return b"".join((here / name).read_bytes() for name in _RULES)


def _reached(function: Callable, seen: set[int]) -> Iterator[str]:
    """Yield the text of a function and of all functions that it can reach, each once."""
    if id(function) in seen:
        return
    seen.add(id(function))
    yield f"{function.__module__}.{function.__qualname__}"
    yield _text(function.__code__)
    outer = dict(zip(function.__code__.co_freevars, function.__closure__ or ()))
    near = {name: cell.cell_contents for name, cell in outer.items()}
    names = _names(function.__code__)
    for name in names:
        value = near.get(name, function.__globals__.get(name))
        if isinstance(value, types.ModuleType) and value.__name__.startswith("carom"):
            for inner in names:
                if inner in vars(value):
                    yield from _value(inner, vars(value)[inner], seen)
        else:
            yield from _value(name, value, seen)


def _value(name: str, value: object, seen: set[int]) -> Iterator[str]:
    """Yield the text of a global: a constant, a kernel or a unit."""
    if isinstance(value, _CONSTANTS):
        yield f"{name}={value!r}"
    if hasattr(
        value, "compiled"
    ):  # a unit is not linked in; its callers depend only on the type of its result
        yield f"{name} -> {getattr(value, 'returned', None)}"
    if getattr(value, "targetoptions", {}).get("forceinline"):
        yield f"{name} is inlined"
    for part in getattr(value, "parts", ()):
        yield from _reached(getattr(part, "py_func", part), seen)
    inner = getattr(value, "py_func", None)
    if inner is not None:
        yield from _reached(inner, seen)


def _names(code: types.CodeType) -> list[str]:
    """Return the names used in a function and in the functions defined in it."""
    names = [*code.co_names, *code.co_freevars]
    for part in code.co_consts:
        if isinstance(part, types.CodeType):
            names += _names(part)
    return names


def _text(code: types.CodeType) -> str:
    """Return the instructions of a function, without line numbers and docstring."""
    consts = [
        _text(part) if isinstance(part, types.CodeType) else repr(part)
        for k, part in enumerate(code.co_consts)
        if not (k == 0 and isinstance(part, str))
    ]
    return f"{code.co_code!r}{consts}{code.co_names}{code.co_varnames}"
