"""The decorators for compiled code: `kernel`, and `entry` where Python calls it.

Kernels are plain functions on scalars and arrays. They call only other kernels, and also run
uncompiled (``NUMBA_DISABLE_JIT=1``). They are compiled without Numba's memory manager: a kernel that
would allocate does not compile, and no array is counted when it is passed on (which cost 8 microseconds a
step). Kernels are parts of what calls them (`carom._compiled.link_only`); units (`carom._compiled.units`)
and entries are compiled as a whole, and kept on disk until something in them changes (`carom._compiled.cache`).
"""

from __future__ import annotations

import contextlib
from typing import Any

import numba
from numba.core import config

try:  # inner parts of Numba that the versions we have tried hold (pyproject.toml)
    from carom._compiled.cache import StampedCache
    from carom._compiled.link_only import PartCompiler
    from carom._compiled.target import compiled as _compiled
except (ImportError, AttributeError) as error:
    raise ImportError(
        f"carom does not know Numba {numba.__version__} ({error}); install numba>=0.61,<0.69"
    ) from error

RULES: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
INSIDE: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_OUTSIDE: dict[str, Any] = {"no_cfunc_wrapper": True}
_PART: dict[str, Any] = {**RULES, **INSIDE, "pipeline_class": PartCompiler}

#: for `numba.extending.overload`, whose functions are compiled by these rules
OPTIONS: dict[str, Any] = {"jit_options": {**_PART, "forceinline": True}}


def kernel(function):
    """Compile `function` for calls from other kernels only, as a part of them.

    Division follows IEEE (``error_model="numpy"``), no fast-math: results are the same on every run.
    """
    return jit(**_PART)(function)


def inlined(function):
    """Compile `function` as `kernel` does, always inlined: for what every step passes."""
    return jit(**_PART, forceinline=True)(function)


def jit(**options):
    """Return the decorator of the target, or that of functions left as they are (``NUMBA_DISABLE_JIT=1``)."""
    return (
        (lambda function: function) if getattr(config, "DISABLE_JIT", 0) else _compiled(**options)
    )


def entry(function):
    """Compile `function` for calls from Python as well, and keep it on disk with all that it calls.

    Where no directory can be written (a read-only install without a user cache) it is compiled in each
    process.
    """
    compiled = jit(**RULES, **_OUTSIDE)(function)
    return keep_on_disk(compiled, function)


def keep_on_disk(compiled, function):
    """Keep what is compiled in files beside the source, or in the cache of the user."""
    if compiled is not function:  # it is with NUMBA_DISABLE_JIT=1
        with contextlib.suppress(RuntimeError):  # no writable place for a cache
            compiled._cache = StampedCache(function)
    return compiled
