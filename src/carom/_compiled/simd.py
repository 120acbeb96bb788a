"""Operations of a processor on four numbers at once: load them from arrays, store, add, multiply.

LLVM does not make such code by itself: Numba turns its search for it off, and loops over four lanes are
unrolled before outer loops are examined. Each lane has the same operation and rounding as plain numbers. An
index counts numbers from the start of a contiguous array of any shape; it is unchecked, and never negative.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, models, register_model

from carom._compiled.decorators import COMPILES

LANES = 4  # numbers in one operation


class Four(types.Type):
    """The type of four numbers, for the compiler."""

    def __init__(self):
        super().__init__(name="Four")


_FOUR = Four()
_VECTOR = ir.VectorType(ir.DoubleType(), LANES)


@register_model(Four)
class _FourModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, _VECTOR)


def _pointer(context, builder, kind, array, index):
    """Return the address of four numbers in an array."""
    data = cgutils.create_struct_proxy(kind)(context, builder, value=array).data
    return builder.bitcast(builder.gep(data, [index]), _VECTOR.as_pointer())


def _lanes(builder, number):
    """Return a vector with `number` in all lanes."""
    vector = ir.Constant(_VECTOR, ir.Undefined)
    for lane in range(LANES):
        vector = builder.insert_element(vector, number, ir.Constant(ir.IntType(32), lane))
    return vector


def _load(typing, x, i):
    def generate(context, builder, signature, values):
        return builder.load(_pointer(context, builder, signature.args[0], *values), align=8)

    return _FOUR(x, types.intp), generate


def _store(typing, x, i, v):
    def generate(context, builder, signature, values):
        x, i, v = values
        builder.store(v, _pointer(context, builder, signature.args[0], x, i), align=8)
        return context.get_dummy_value()

    return types.void(x, types.intp, _FOUR), generate


def _same(typing, f):
    def generate(context, builder, signature, values):
        return _lanes(builder, values[0])

    return _FOUR(types.float64), generate


def _add(typing, v, w):
    def generate(context, builder, signature, values):
        return builder.fadd(*values)

    return _FOUR(_FOUR, _FOUR), generate


def _subtract(typing, v, w):
    def generate(context, builder, signature, values):
        return builder.fsub(*values)

    return _FOUR(_FOUR, _FOUR), generate


def _multiply(typing, v, w):
    def generate(context, builder, signature, values):
        return builder.fmul(*values)

    return _FOUR(_FOUR, _FOUR), generate


def _larger(typing, v, w):
    def generate(context, builder, signature, values):
        v, w = values
        return builder.select(builder.fcmp_ordered("<", v, w), w, v)

    return _FOUR(_FOUR, _FOUR), generate


def _greatest(typing, v):
    def generate(context, builder, signature, values):
        most = builder.extract_element(values[0], ir.Constant(ir.IntType(32), 0))
        for lane in range(1, LANES):
            new = builder.extract_element(values[0], ir.Constant(ir.IntType(32), lane))
            most = builder.select(builder.fcmp_ordered("<", most, new), new, most)
        return most

    return types.float64(_FOUR), generate


def _either(plain, definition) -> Any:
    """Return the operation for compiled code, or the plain one if code runs uncompiled."""
    if not COMPILES:
        return plain
    made: Any = intrinsic(definition)
    made.parts = (definition, _pointer, _lanes)  # a change of these changes compiled code
    return made


def _plain_store(x, i, v):
    x.reshape(-1)[i : i + LANES] = v


#: load(x, i): four numbers of the array x, from index i
load = _either(lambda x, i: x.reshape(-1)[i : i + LANES].copy(), _load)
#: store(x, i, v): write four numbers v to them
store = _either(_plain_store, _store)
#: same(f): f in all lanes
same = _either(lambda f: np.full(LANES, f), _same)
add = _either(np.add, _add)
subtract = _either(np.subtract, _subtract)
multiply = _either(np.multiply, _multiply)
#: larger(v, w): the larger one in each lane
larger = _either(lambda v, w: np.where(v < w, w, v), _larger)
#: greatest(v): the greatest of the four
greatest = _either(lambda v: float(np.max(v)), _greatest)
