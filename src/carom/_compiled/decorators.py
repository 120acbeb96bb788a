"""The decorators for compiled code: `kernel`, and `entry` for calls from Python.

Kernels are plain functions on scalars and arrays. They call only other kernels, and also run uncompiled
(with ``NUMBA_DISABLE_JIT=1``, or with an unknown version of Numba). They are compiled without Numba's memory
manager: a kernel that allocates does not compile, and references to arrays are not counted (counting cost 8
microseconds a step). Kernels become parts of their callers (`carom._compiled.link_only`); units
(`carom._compiled.units`) and entries are compiled as a whole, and are stored on disk until some part of them
changes (`carom._compiled.cache`).
"""

from __future__ import annotations

import warnings
from typing import Any

import numba
from numba.core import config

#: whether kernels are compiled, or stay plain functions
COMPILES = not getattr(config, "DISABLE_JIT", 0)
if COMPILES:
    try:  # inner parts of Numba that exist in the tested versions (pyproject.toml)
        from carom._compiled.by_reference import refer
        from carom._compiled.link_only import PartCompiler
        from carom._compiled.target import Entry, Kernel
    except (ImportError, AttributeError) as error:
        COMPILES = False
        warnings.warn(
            f"carom does not know Numba {numba.__version__} ({error}): it runs uncompiled, hundreds of times "
            "slower; install numba>=0.61,<0.69",
            RuntimeWarning,
            stacklevel=2,
        )

RULES: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
INSIDE: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_OUTSIDE: dict[str, Any] = {"no_cfunc_wrapper": True}
_PART: dict[str, Any] = {
    **RULES,
    **INSIDE,
    **({"pipeline_class": PartCompiler} if COMPILES else {}),
}

#: the same rules for functions of `numba.extending.overload`
OPTIONS: dict[str, Any] = {"jit_options": {**_PART, "forceinline": True}}


def kernel(function):
    """Compile `function` for calls from other kernels only, as a part of them.

    Division follows IEEE (``error_model="numpy"``), and there is no fast-math: every run has the same results.
    """
    return _part(function, _PART)


def inlined(function):
    """Compile `function` as `kernel` does, and always inline it: for functions called in every step."""
    return _part(function, {**_PART, "forceinline": True})


def _part(function, options):
    return Kernel(function, options) if COMPILES else function


def entry(function):
    """Compile `function` for calls from Python as well, and store it on disk with all that it calls.

    If no directory is writable (a read-only install without a user cache), it is compiled in each process.
    """
    return Entry(function, {**RULES, **_OUTSIDE}) if COMPILES else function


def _same(record):
    """Return a record as it is, uncompiled."""
    return record


#: converts a named tuple that was made in compiled code to a reference
by_reference: Any = refer if COMPILES else _same
