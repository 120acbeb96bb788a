"""The call of a C function through its address, from kernels: ``f(t, x, out)`` with two arrays."""

from __future__ import annotations

import ctypes
from typing import Any

from numba.core import types
from numba.extending import intrinsic, overload

from carom._compiled.decorators import OPTIONS

#: the form of the user's functions
FORM = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p)


def call_function(address, t, x, out):
    """Call the function at `address` from a kernel: out = f(t, x), both arrays contiguous."""
    FORM(int(address))(t, x.ctypes.data, out.ctypes.data)


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
