"""Records of arrays (system, workspace, active points, ...) are passed from kernel to kernel by one address.

Numba passes a named tuple by value: some 300 numbers for a step of a scene are written and read at every call,
which costs time in compiling and in the run. Here a named tuple of carom becomes a pointer when compiled code
is entered, and each field is loaded where it is used. Fields of a named tuple never change, so the loads are
marked invariant, and cost no more than local variables.
"""

from __future__ import annotations

import hashlib
from functools import cache
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.errors import NumbaNotImplementedError
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.core.typing.typeof import Purpose, typeof
from numba.extending import (
    NativeValue,
    intrinsic,
    lower_getattr_generic,
    models,
    register_model,
    unbox,
)
from numba.np.numpy_support import from_dtype, map_layout

from carom._compiled.record_arrays import ARRAY_FLAGS, Columns


class Reference(types.Type):
    """The address of a named tuple."""

    def __init__(self, record: Any):  # a types.BaseNamedTuple
        self.record = record
        digest = hashlib.sha256(str(record).encode()).hexdigest()[:16]
        super().__init__(f"{record.instance_class.__name__}_{digest}")

    @property
    def instance_class(self) -> type:
        """The class of the named tuple."""
        return self.record.instance_class

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of its fields."""
        return self.record.fields

    @property
    def types(self) -> tuple[types.Type, ...]:
        """The types of its fields."""
        return self.record.types


_ARRAYS = np.ndarray, Columns
_KINDS: dict[tuple, types.Array] = {}  # types of arrays; those of a scene are 100, on 800 arrays


@cache
def _reference(record: Any) -> Reference:
    return Reference(record)


def type_of(value: Any) -> types.Type:
    """Return the type of an argument from Python: a reference if it is a named tuple of carom."""
    kind = _type_of(value)
    return _reference(kind) if is_ours(kind) else kind


def _type_of(value):
    if isinstance(value, tuple):
        kinds = [type_of(v) for v in value]
        return types.BaseTuple.from_types(kinds, type(value))
    try:
        kind = _type_of_array(value) if type(value) in _ARRAYS else typeof(value, Purpose.argument)
    except (ValueError, NumbaNotImplementedError):
        kind = None
    return types.pyobject if kind is None else kind


def _type_of_array(array) -> types.Array:
    """Return the type that Numba has for an array; it would import masked arrays to see that it is none."""
    dtype = array.dtype
    key = dtype, dtype.isalignedstruct, array.ndim, array.flags.num & ARRAY_FLAGS
    if key not in _KINDS:
        layout, readonly = map_layout(array), not array.flags.writeable
        _KINDS[key] = types.Array(from_dtype(dtype), array.ndim, layout, readonly=readonly)
    return _KINDS[key]


def is_ours(kind: Any) -> bool:
    """Return whether a type is that of a named tuple of this library."""
    named = isinstance(kind, types.NamedTuple | types.NamedUniTuple)
    return named and kind.instance_class.__module__.startswith("carom.")


def refer_to(builder, kind, value):
    """Return type and value of a reference to a named tuple; other values are returned unchanged."""
    return (_reference(kind), _keep(builder, value)) if is_ours(kind) else (kind, value)


@register_model(Reference)
class _ReferenceModel(models.PointerModel):
    def __init__(self, dmm, fe_type):
        self._pointee_model = dmm.lookup(fe_type.record)
        self._pointee_be_type = self._pointee_model.get_value_type()
        models.PrimitiveModel.__init__(self, dmm, fe_type, self._pointee_be_type.as_pointer())


@infer_getattr
class _ReferenceAttribute(AttributeTemplate):
    key = Reference

    def generic_resolve(self, reference, attr):
        if attr in reference.fields:
            return reference.types[reference.fields.index(attr)]
        return None


@lower_getattr_generic(Reference)
def _load_field(context, builder, reference, pointer, attr):
    """Load a field; every load gives the same value."""
    place = cgutils.gep_inbounds(builder, pointer, 0, reference.fields.index(attr))
    loaded = builder.load(place)
    loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
    return loaded


def _keep(builder, value):
    """Store a value in the stack frame of the present function; return its address.

    The address passes an empty instruction that hides the store from the compiler, because the loads after a
    visible store would not be invariant.
    """
    place = cgutils.alloca_once(builder, value.type)
    builder.store(value, place)
    same = ir.FunctionType(place.type, [place.type])
    return builder.asm(same, "", "=r,0,~{memory}", [place], True, name="kept")


@unbox(Reference)
def _unbox(reference, value, c):
    native = c.unbox(reference.record, value)
    return NativeValue(
        _keep(c.builder, native.value), is_error=native.is_error, cleanup=native.cleanup
    )


@intrinsic
def refer(typing, record):
    """Return a reference to a named tuple; it is valid until the calling function returns."""

    def generate(context, builder, signature, values):
        return refer_to(builder, record, values[0])[1]

    return (_reference(record) if is_ours(record) else record)(record), generate
