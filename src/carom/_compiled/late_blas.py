"""SciPy is loaded when a compiled function needs linear algebra, not before the first one of any kind.

Numba asks at its first compile whether there is a BLAS, and imports `scipy.linalg` for it: a tenth of a second,
a seventh of the first run of a process, for kernels that use none. It asks once more where one is used, as in
a function of the user's with ``a @ b``. SciPy is there: carom depends on it.
"""

from __future__ import annotations

import sys

from numba import config


def defer() -> None:
    """Let Numba take for granted, in this process, that there is a BLAS."""
    compiles = not config.DISABLE_JIT  # pyright: ignore[reportAttributeAccessIssue]
    if not compiles or "scipy.linalg" in sys.modules or "numba.np.arraymath" in sys.modules:
        return
    from numba.np import linalg

    asked = linalg.ensure_blas
    linalg.ensure_blas = _take_for_granted
    try:
        from numba.np import arraymath  # asks as it is imported
    finally:
        linalg.ensure_blas = asked
    arraymath.ensure_blas = asked  # pyright: ignore[reportPrivateImportUsage]


def _take_for_granted() -> None:
    """Do nothing: who uses it will ask."""
