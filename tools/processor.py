"""Print what the last places of results may depend on: processor, NumPy's dispatch, BLAS kernels.

python tools/processor.py
"""

from __future__ import annotations

import ctypes
import platform
from importlib.metadata import version
from pathlib import Path

import llvmlite.binding
import numpy
import scipy

NAMES = (
    "scipy_openblas_get_corename64_",
    "scipy_openblas_get_corename",
    "openblas_get_corename64_",
    "openblas_get_corename",
)


def blas_of(package) -> str:
    """Return which kernels the BLAS of a package has chosen, of the library in its wheel."""
    beside = Path(package.__file__).parents[1] / f"{package.__name__}.libs"
    for file in beside.glob("*openblas*"):
        library = ctypes.CDLL(str(file))
        for name in NAMES:
            if hasattr(library, name):
                ask = getattr(library, name)
                ask.restype = ctypes.c_char_p
                return ask().decode()
    return package.show_config(mode="dicts")["Build Dependencies"]["blas"]["name"]


def main() -> None:
    """Print one line for each."""
    simd = numpy.show_config(mode="dicts")["SIMD Extensions"]
    cpu = llvmlite.binding.get_host_cpu_name()
    versions = [f"{name} {version(name)}" for name in ("numpy", "scipy", "numba", "llvmlite")]
    print(f"processor: {platform.machine()}, {cpu}; C library {' '.join(platform.libc_ver())}")
    print(f"versions: Python {platform.python_version()}, {', '.join(versions)}")
    print(f"NumPy's dispatch: {', '.join(simd.get('baseline', []) + simd.get('found', []))}")
    print(f"BLAS kernels: NumPy {blas_of(numpy)}, SciPy {blas_of(scipy)}")


if __name__ == "__main__":
    main()
