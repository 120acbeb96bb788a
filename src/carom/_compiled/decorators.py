"""The decorators for compiled code: `kernel`, `unit`, and `entry` where Python calls it.

Kernels are plain functions on scalars and arrays. They call only other kernels, and also run
uncompiled (``NUMBA_DISABLE_JIT=1``). They are compiled without Numba's memory manager: a kernel that
would allocate does not compile, and no array is counted when it is passed on (which cost 8 microseconds a
step). Kernels are parts of what calls them (`carom._compiled.link_only`); units and entries are compiled as a
whole, and kept on disk until something in them changes (`carom._compiled.cache`).
"""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
from numba.core import config, types

from carom._compiled.by_reference import type_of
from carom._compiled.cache import StampedCache
from carom._compiled.link_only import PartCompiler
from carom._compiled.target import compiled as _compiled

_RULES: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
_INSIDE: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_OUTSIDE: dict[str, Any] = {"no_cfunc_wrapper": True}
_PART: dict[str, Any] = {**_RULES, **_INSIDE, "pipeline_class": PartCompiler}

#: for `numba.extending.overload`, whose functions are compiled by these rules
OPTIONS: dict[str, Any] = {"jit_options": {**_PART, "forceinline": True}}


def kernel(function):
    """Compile `function` for calls from other kernels only, as a part of them.

    Division follows IEEE (``error_model="numpy"``), no fast-math: results are the same on every run.
    """
    return _jit(**_PART)(function)


def inlined(function):
    """Compile `function` as `kernel` does, always inlined: for what every step passes."""
    return _jit(**_PART, forceinline=True)(function)


def _jit(**options):
    """Return the decorator of the target, or that of functions left as they are (``NUMBA_DISABLE_JIT=1``)."""
    return (lambda function: function) if config.DISABLE_JIT else _compiled(**options)


def unit(function):
    """Compile `function` on its own, to be called through its address (`carom.model.choice.by_address`).

    What is called directly is compiled again into each of its callers, and theirs; a solve that is
    reached from twenty places cost a minute that way.
    """
    compiled = _jit(**_RULES, **_INSIDE)(function)
    return _keep_on_disk(compiled, function)


def address(function, *arguments) -> int:
    """Return the address of a unit for arguments of these types, compiled if need be; 0 without the JIT."""
    if not hasattr(function, "get_compile_result"):  # NUMBA_DISABLE_JIT=1
        return 0
    key = (function, *map(_alike, arguments))
    if key not in _ADDRESSES:
        given = types.void(*(type_of(a) for a in arguments))
        compiled = function.get_compile_result(given)
        name = compiled.fndesc.llvm_func_name
        _ADDRESSES[key] = compiled.library.get_pointer_to_function(name)
    return _ADDRESSES[key]


_ADDRESSES: dict[tuple, int] = {}
_flags, _dtype, _ndim = (getattr(np.ndarray, name).__get__ for name in ("flags", "dtype", "ndim"))


def _alike(value):
    """Return a key that values of one Numba type have in common.

    The type of an argument spells out each structured array: 60 ms a run, twice what the tosses of a cube take in all.
    """
    if isinstance(value, tuple):
        return (type(value), *map(_alike, value))
    if isinstance(value, np.ndarray):
        flags = _flags(value)  # the attributes of record arrays are looked up in Python
        layout = flags.c_contiguous, flags.f_contiguous, flags.writeable, flags.aligned
        return _dtype(value), _ndim(value), layout
    return value.dtype if isinstance(value, np.void) else type(value)


def entry(function):
    """Compile `function` for calls from Python as well, and keep it on disk with all that it calls.

    Where no directory can be written (a read-only install without a user cache) it is compiled in each
    process.
    """
    compiled = _jit(**_RULES, **_OUTSIDE)(function)
    return _keep_on_disk(compiled, function)


def _keep_on_disk(compiled, function):
    if compiled is not function:  # it is with NUMBA_DISABLE_JIT=1
        with contextlib.suppress(RuntimeError):  # no writable place for a cache
            compiled._cache = StampedCache(function)
    return compiled
