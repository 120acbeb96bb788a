"""The one decorator for compiled kernels.

Kernels are plain functions on scalars and arrays. They call only other kernels, and also run
uncompiled (``NUMBA_DISABLE_JIT=1``). They are compiled without Numba's memory manager: a kernel that
would allocate does not compile, and no array is counted when it is passed on (which cost 8 microseconds a
step).

Numba caches compiled code beside the source, but it looks only at the file of the function that is
called: a change in a *callee* in another file would go unseen. Here the cache is stamped with a
hash of every source file of the package, so any change of carom, or an upgrade, recompiles.
"""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile

#: for `numba.extending.overload`, whose functions are compiled by their callers' rules
OPTIONS = {"jit_options": {"nogil": True, "error_model": "numpy", "_nrt": False}}


@cache
def _package_stamp() -> str:
    """Hash of all sources of the package that can be part of a compiled function."""
    digest = hashlib.sha256()
    root = Path(__file__).parent
    for path in sorted(root.rglob("*.py")):
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
    """Compile `function` at its first call; release the GIL; keep the result on disk.

    Division follows IEEE (``error_model="numpy"``), no fast-math: results are the same on every
    run. Where no directory can be written (a read-only install without a user cache) the function
    is compiled in each process.
    """
    compiled = numba.njit(**OPTIONS["jit_options"])(function)
    if compiled is function:  # NUMBA_DISABLE_JIT=1
        return function
    try:
        compiled._cache = _StampedCache(function)
    except RuntimeError:  # no writable place for a cache
        pass
    return compiled
