"""User-defined functions, called from compiled code through an address.

All have one form: ``f(t, x, out)`` reads a time and an array of numbers and writes an array of numbers. A
function compiled by Numba is called directly (50 ns, with a new array for the result); a plain Python
function is called through `ctypes` with the interpreter's lock (1 to 2 microseconds). The address is a number
in the data of a run, so a new function does not cause a new compile of the loop.

An error in a plain function cannot pass through compiled code: it is stored, the result is NaN, the run stops,
and then the error is raised (`Functions.failed`).
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import carray, cfunc  # pyright: ignore[reportPrivateImportUsage]
from numba.core import types
from numba.extending import intrinsic, overload

from carom._compiled.composed import is_compiled, once
from carom._compiled.decorators import COMPILES, OPTIONS

_FORM = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p)
MOST_PLACES = 100  # arrays that are kept
_SIGNATURE = types.void(types.float64, types.CPointer(types.float64), types.CPointer(types.float64))


class Functions:
    """The functions of one run: references to them, and the first error that one of them raised."""

    def __init__(self):
        self._kept: list[Any] = []
        self.failed: BaseException | None = None

    def address(self, function: Callable, inside: tuple[int, ...], outside: tuple[int, ...]):
        """Return the address of ``function(t, x) -> y``, x and y arrays of the given shapes."""
        if is_compiled(function):
            made = _compiled(function, inside, outside)
            self._kept.append(made)
            return made.address
        made = _FORM(self._plain(function, inside, outside))
        self._kept.append(made)
        return ctypes.cast(made, ctypes.c_void_p).value

    def written(self, function: Callable, inside: tuple[int, ...], outside: tuple[int, ...]):
        """Return the address of ``function(t, x, out)``, which only reads and writes numbers of its arguments.

        It is compiled without a wrapper for arrays, for code that the library itself has written.
        """
        if not COMPILES:

            def answer(t, x):
                out = np.empty(outside)
                function(t, x, out)
                return out

            return self.address(answer, inside, outside)
        made: Any = cfunc(_SIGNATURE)(function)
        self._kept.append(made)
        return made.address

    def _plain(self, function, inside, outside):
        inputs, outputs = Arrays(inside), Arrays(outside)

        def call(t, read, write):
            out = outputs[write]
            out[...] = np.nan
            if self.failed is not None:
                return
            try:
                out[...] = function(t, inputs[read])
            except BaseException as error:  # errors cannot pass through the compiled loop
                self.failed = error

        return call


class Arrays(dict):
    """Arrays of one shape by the address of their numbers, made once: a run has few places for them."""

    def __init__(self, shape: tuple[int, ...]):
        super().__init__()
        self.shape = shape

    def __missing__(self, address: int) -> np.ndarray:
        """Make the array."""
        if len(self) >= MOST_PLACES:
            self.clear()
        numbers = (ctypes.c_double * math.prod(self.shape)).from_address(address)
        self[address] = np.ctypeslib.as_array(numbers).reshape(self.shape)
        return self[address]


@once
def _compiled(function, inside, outside):
    """Compile the wrapper of a function that Numba has compiled."""

    def call(t, read, write):
        out = carray(write, outside)
        out[...] = function(t, carray(read, inside))

    return cfunc(_SIGNATURE)(call)


def call_function(address, t, x, out):
    """Call the function at `address` from a kernel: out = f(t, x), both arrays contiguous."""
    _FORM(int(address))(t, x.ctypes.data, out.ctypes.data)


_options: Any = OPTIONS


@overload(call_function, **_options)
def _call_function(address, t, x, out):
    call: Any = _call
    return lambda address, t, x, out: call(address, t, x, out)


@intrinsic
def _call(typing, address, t, x, out):
    """Call a C function with the data of two arrays."""
    signature = types.none(types.intp, types.float64, x, out)

    def generate(context, builder, signature, values):
        from llvmlite import ir

        number, numbers = ir.DoubleType(), ir.DoubleType().as_pointer()
        form = ir.FunctionType(ir.VoidType(), [number, numbers, numbers])
        data = []
        for kind, value in zip(signature.args[2:], values[2:]):
            array = context.make_array(kind)(context, builder, value)
            data.append(builder.bitcast(array.data, numbers))
        builder.call(builder.inttoptr(values[0], form.as_pointer()), [values[1], *data])
        return context.get_dummy_value()

    return signature, generate
