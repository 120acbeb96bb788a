"""The two decorators for compiled code: `kernel`, and `entry` where Python calls it.

Kernels are plain functions on scalars and arrays. They call only other kernels, and also run
uncompiled (``NUMBA_DISABLE_JIT=1``). They are compiled without Numba's memory manager: a kernel that
would allocate does not compile, and no array is counted when it is passed on (which cost 8 microseconds a
step).

Numba caches compiled code beside the source, but it looks only at the file of the function that is
called: a change in a *callee* in another file would go unseen. Here the cache is stamped with a
hash of every source file of the package, so any change of carom, or an upgrade, recompiles.
"""

from __future__ import annotations

import contextlib
import hashlib
from functools import cache
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba.core.caching import FunctionCache, IndexDataCacheFile

_RULES: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
_INSIDE: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_OUTSIDE: dict[str, Any] = {"no_cfunc_wrapper": True}

#: for `numba.extending.overload`, whose functions are compiled by these rules
OPTIONS: dict[str, Any] = {"jit_options": {**_RULES, **_INSIDE, "forceinline": True}}


_WITHOUT_KERNELS = ("paper", "cli", "identify")  # folders that no compiled function calls


@cache
def _package_stamp() -> str:
    """Hash of all sources of the package that can be part of a compiled function."""
    digest = hashlib.sha256()
    root = Path(__file__).parent
    for path in sorted(root.rglob("*.py")):
        if path.relative_to(root).parts[0] in _WITHOUT_KERNELS:
            continue
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


class _StampedCache(FunctionCache):
    """A function cache that is valid for one state of the whole package, not of one file."""

    def __init__(self, py_func):
        super().__init__(py_func)
        self._cache_file = IndexDataCacheFile(
            cache_path=self._cache_path,
            filename_base=self._impl.filename_base,
            source_stamp=_package_stamp(),
        )


def kernel(function):
    """Compile `function` for calls from other kernels only.

    Division follows IEEE (``error_model="numpy"``), no fast-math: results are the same on every run.
    """
    return numba.njit(**_RULES, **_INSIDE)(function)


def inlined(function):
    """Compile `function` as `kernel` does, always inlined: for what every step passes.

    A call that hands on a system costs more than a free step (some 150 values go on the stack).
    """
    return numba.njit(**_RULES, **_INSIDE, forceinline=True)(function)


def unit(function):
    """Compile `function` on its own, to be called through its address (`carom.dispatch.by_address`).

    What is called directly is compiled again into each of its callers, and theirs; a solve that is
    reached from twenty places cost a minute that way.
    """
    compiled = numba.njit(**_RULES, **_INSIDE)(function)
    return _keep_on_disk(compiled, function)


def address(function, *arguments) -> int:
    """Return the address of a unit for arguments of these types, compiled if need be; 0 without the JIT."""
    if not hasattr(function, "get_compile_result"):  # NUMBA_DISABLE_JIT=1
        return 0
    key = (function, *map(_alike, arguments))
    if key not in _ADDRESSES:
        given = numba.types.void(*(numba.typeof(a) for a in arguments))
        compiled = function.get_compile_result(given)
        name = compiled.fndesc.llvm_func_name
        _ADDRESSES[key] = compiled.library.get_pointer_to_function(name)
    return _ADDRESSES[key]


_ADDRESSES: dict[tuple, int] = {}


def _alike(value):
    """Return what is the same for values of one Numba type.

    `numba.typeof` spells out each structured array: 60 ms a run, twice what the tosses of a cube take in all.
    """
    if isinstance(value, tuple):
        return (type(value), *map(_alike, value))
    if isinstance(value, np.ndarray):
        flags = value.flags
        layout = flags.c_contiguous, flags.f_contiguous, flags.writeable, flags.aligned
        return value.dtype, value.ndim, layout
    return value.dtype if isinstance(value, np.void) else type(value)


def entry(function):
    """Compile `function` for calls from Python as well, and keep it on disk with all that it calls.

    Where no directory can be written (a read-only install without a user cache) it is compiled in each
    process.
    """
    compiled = numba.njit(**_RULES, **_OUTSIDE)(function)
    return _keep_on_disk(compiled, function)


def _keep_on_disk(compiled, function):
    if compiled is not function:  # it is with NUMBA_DISABLE_JIT=1
        with contextlib.suppress(RuntimeError):  # no writable place for a cache
            compiled._cache = _StampedCache(function)
    return compiled
