"""The source of compiled code: a hash of a function and of all code that is linked into it.

Numba's cache checks only the file of the cached function, so it does not see a change of a called function in
another file. This stamp follows the calls. Units (`carom._compiled.units`) are compiled separately and left
out, so that a change recompiles only the units that contain it.
"""

from __future__ import annotations

import hashlib
import types
from collections.abc import Callable
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


Own = tuple[str, list[Callable]]  #: text of a function alone, and the functions that it names


def stamp(function: Callable, known: dict[Callable, Own] | None = None) -> str:
    """Return the hash of all that the compiled `function` depends on, except the types of arguments.

    What is `known` of functions is not read again: the units of a run share most of theirs.
    """
    known = {} if known is None else known
    digest = hashlib.sha256(_rules())
    for one in reached(function, known):
        digest.update(known[one][0].encode())
    return digest.hexdigest()


def reached(function: Callable, known: dict[Callable, Own]) -> list[Callable]:
    """Return a function and all functions that it can reach, each once, in the order of their names."""
    found: dict[Callable, None] = {}
    left = [function]
    while left:
        one = left.pop()
        if one not in found:
            found[one] = None
            if one not in known:
                known[one] = _own(one)
            left.extend(reversed(known[one][1]))
    return list(found)


@cache
def _rules() -> bytes:
    here = Path(__file__).parent
    return b"".join((here / name).read_bytes() for name in _RULES)


def _own(function: Callable) -> Own:
    """Return the text of a function with the constants that it names, and the functions that it names."""
    code: types.CodeType = function.__code__
    texts = [f"{function.__module__}.{function.__qualname__}", _text(code)]
    called: list[Callable] = []
    outer = dict(zip(code.co_freevars, function.__closure__ or ()))
    near = {name: cell.cell_contents for name, cell in outer.items()}
    names = _names(code)
    for name in names:
        value = near.get(name, function.__globals__.get(name))
        if value is None:  # most names are of fields
            continue
        if isinstance(value, types.ModuleType) and value.__name__.startswith("carom"):
            inside = vars(value)
            pairs = [(inner, inside[inner]) for inner in names if inner in inside]
        else:
            pairs = [(name, value)]
        for one in pairs:
            _add_value(*one, texts, called)
    return "\n".join(texts), called


def _add_value(name: str, value: object, texts: list[str], called: list[Callable]) -> None:
    """Add the text of a global: of a constant, a kernel or a unit; and the functions that it brings."""
    if isinstance(value, _CONSTANTS):
        texts.append(f"{name}={value!r}")
        return
    if getattr(value, "is_unit", False) is True:
        # it is not linked in; its callers depend only on the type of its result
        texts.append(f"{name} -> {getattr(value, 'returned', None)}")
    if getattr(value, "targetoptions", {}).get("forceinline"):
        texts.append(f"{name} is inlined")
    called += [getattr(part, "py_func", part) for part in getattr(value, "parts", ())]
    inner = getattr(value, "py_func", None)
    if inner is not None:
        called.append(inner)


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
    return "; ".join((code.co_code.hex(), *consts, *code.co_names, "of", *code.co_varnames))
