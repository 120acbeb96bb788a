"""Units: kernels that are compiled separately, and loaded when compiled code first calls them.

A kernel is compiled again into each of its callers, and into their callers; a solve with twenty callers cost a
minute. A unit is called through its address instead. The caller has a slot for the address, which is empty at
first. If it is empty, the caller requests the address from Python (`_find`), which loads the unit from disk or
compiles it. So a scene waits only for the units that it needs: joints, several points or groups.

If a call stands where every scene passes, the unit states which scenes need it, and the result for others:

    @unit(where=has_relations, otherwise=0.0)
    def rotor_energy(system, state) -> float: ...

Its callers get a guard, which is inlined and calls the unit if `has_relations(system)`.

Without compiling a unit is a plain function.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import importlib
import inspect
import pickle
import zlib
from collections.abc import Callable, Iterable
from typing import Any

import llvmlite.binding as llvm
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.compiler_lock import global_compiler_lock
from numba.core.errors import TypingError
from numba.core.typing.templates import make_intrinsic_template

from carom._compiled import ahead
from carom._compiled.decorators import COMPILES, INSIDE, RULES, inlined
from carom._compiled.record_arrays import ARRAY_FLAGS

if COMPILES:
    from carom._compiled.by_reference import refer_to
    from carom._compiled.cache import StampedCache, digest_of, files_of
    from carom._compiled.target import Dispatcher, Entry, compiled, plain_type, with_files

_RETURNS = {"float": types.float64, "int": types.int64, "bool": types.boolean}
_FINDER = "carom_find_unit"  # symbol of `_find` in compiled code


class NotCompiled(RuntimeError):
    """A unit called by compiled code could not be compiled; `__cause__` is the reason."""

    stopped_by: BaseException | None = (
        None  # error of the last compile, because errors cannot pass through compiled code
    )

    def __init__(self, name: str):
        super().__init__(f"{name} could not be compiled")
        self.__cause__ = NotCompiled.stopped_by


def unit(function: Any = None, *, where: Any = None, otherwise: Any = None) -> Any:
    """Compile `function` separately; kernels call it like any other kernel.

    It returns nothing, or the type in its annotation: `float`, `int`, `bool`, or a tuple of these. With
    `where`, it is called only if this kernel is true for its first argument; if not, the result is `otherwise`.
    """
    if function is None:
        return functools.partial(unit, where=where, otherwise=otherwise)
    made = _separate(function) if COMPILES else function
    return made if where is None else _guarded(function, made, where, otherwise)


def _guarded(function, made, where, otherwise):
    """Return the kernel that calls `made`, the unit of a function, where its condition holds."""

    def guard(first, *others):
        if where(first):
            return made(first, *others)
        return otherwise

    guard.__name__, guard.__qualname__ = function.__name__, function.__qualname__
    guard.__module__, guard.__doc__ = function.__module__, function.__doc__
    return inlined(guard)


class Unit:
    """A function that is compiled separately, as Numba and the code that calls it see it.

    What Numba needs of it is made while a caller is compiled, or when it is compiled itself: a process that
    finds all code on disk makes none of it.
    """

    is_unit = True  # for stamps

    def __init__(self, function: Callable):
        self._function = function
        self.returned = _returned(function.__annotations__.get("return"))
        self.__name__, self.__qualname__ = function.__name__, function.__qualname__
        self.__module__, self.__doc__ = function.__module__, function.__doc__
        #: its code in this process: address and library, by the hash of its types
        self.loaded: dict[str, tuple[int, Any]] = {}

    @functools.cached_property
    def files(self) -> StampedCache | None:
        """The files of its compiled code."""
        return files_of(self._function, linked=False)

    @functools.cached_property
    def compiled(self) -> Any:
        """The function as Numba compiles it."""
        return with_files(compiled(self._function, **RULES, **INSIDE), self.files)

    @functools.cached_property
    def _numba_type_(self) -> types.Function:
        """The type of what calls it: an intrinsic of Numba."""

        def call(typing, *arguments):
            kinds = tuple(map(plain_type, arguments))

            def generate(context, builder, signature, values):
                pairs = [refer_to(builder, kind, value) for kind, value in zip(kinds, values)]
                taken, values = zip(*pairs)
                return _call(context, builder, name, self, taken, values)

            return self.returned(*kinds), generate

        name = f"{self.__module__}:{self.__qualname__}"
        given = inspect.signature(self._function).parameters.values()
        own = [one.replace(annotation=inspect.Parameter.empty) for one in given]
        first = inspect.Parameter("typing", inspect.Parameter.POSITIONAL_OR_KEYWORD)
        call.__signature__ = inspect.Signature([first, *own])  # pyright: ignore[reportFunctionMemberAccess]
        call.__name__, call.__qualname__ = self.__name__, self.__qualname__
        call.__module__, call.__doc__ = self.__module__, self.__doc__
        return types.Function(make_intrinsic_template(self, call, self.__name__))

    def address(self, digest: str, packed: bytes) -> int:
        """Return the address of its code for packed types with this hash; load or compile it if need be."""
        if digest not in self.loaded:
            with global_compiler_lock:
                if digest not in self.loaded:  # by another thread
                    self.loaded[digest] = self._from_disk(digest) or self._made(unpack(packed))
        return self.loaded[digest][0]

    def _from_disk(self, digest: str) -> tuple[int, Any] | None:
        codegen = Dispatcher.targetdescr.target_context.codegen()
        found = None if self.files is None else self.files.machine(digest, codegen)
        if found is None:
            return None
        library = codegen.unserialize_library(found.library)
        return library.get_pointer_to_function(found.name), library

    def _made(self, kinds: tuple) -> tuple[int, Any]:
        made = self.compiled.get_compile_result(self.returned(*kinds))
        return made.library.get_pointer_to_function(made.fndesc.llvm_func_name), made.library


def _separate(function) -> Unit:
    """Return what calls a function that is compiled separately."""
    made = Unit(function)
    UNITS[f"{function.__module__}:{function.__qualname__}"] = made
    return made


def _returned(annotation) -> types.Type:
    """Return the type of the result of a unit, from the text of its annotation."""
    if annotation is None:
        return types.none
    if annotation.startswith("tuple["):
        return types.Tuple([_RETURNS[part.strip()] for part in annotation[6:-1].split(",")])
    return _RETURNS[annotation]


def _call(context, builder, name, unit, kinds, values):
    """Generate the call of a unit: read the slot, fill it if it is empty, and call."""
    pointer, number = ir.IntType(8).as_pointer(), ir.IntType(64)
    ASKED[name, kinds] = None
    packed, result = pack(kinds), unit.returned
    if unit.files is not None:
        unit.files.note_asked(packed)
    ahead.tell(name, packed)
    digest = digest_of(result(*kinds))
    slot = _global(builder.module, f"slot.{name}.{digest}", ir.Constant(pointer, None), False)
    found = builder.load(slot)
    place = cgutils.alloca_once_value(builder, found)
    with cgutils.if_unlikely(builder, cgutils.is_null(builder, found)):
        form = ir.FunctionType(pointer, [pointer, pointer, number])
        finder = cgutils.get_or_insert_function(builder.module, form, _FINDER)
        texts = [
            _global(builder.module, f"{kind}.{name}.{digest}", cgutils.make_bytearray(text), True)
            for kind, text in (("name", f"{name} {digest}\0".encode()), ("types", packed))
        ]
        texts = [builder.bitcast(text, pointer) for text in texts]
        asked = builder.call(finder, [*texts, ir.Constant(number, len(packed))])
        with cgutils.if_unlikely(builder, cgutils.is_null(builder, asked)):
            context.call_conv.return_user_exc(builder, NotCompiled, (name,))
        builder.store(asked, slot)
        builder.store(asked, place)
    function = context.call_conv.get_function_type(result, kinds)
    callee = builder.bitcast(builder.load(place), function.as_pointer())
    status, answer = context.call_conv.call_function(builder, callee, result, kinds, values)
    with cgutils.if_unlikely(builder, status.is_error):
        context.call_conv.return_status_propagate(builder, status)
    return context.get_dummy_value() if result is types.none else answer


def _global(module, name, value, constant):
    """Return a variable of a module, made once."""
    if name not in module.globals:
        made = ir.GlobalVariable(module, value.type, name)
        made.initializer, made.linkage, made.global_constant = value, "internal", constant
    return module.globals[name]


#: all units, by module and name
UNITS: dict[str, Unit] = {}
#: units that code compiled in this process may call: name and types of arguments
ASKED: dict[tuple[str, tuple], None] = {}


def pack(kinds: tuple) -> bytes:
    """Return types of arguments as bytes."""
    return zlib.compress(pickle.dumps(kinds))


def unpack(packed: bytes) -> tuple:
    """Return the types of arguments that were packed."""
    return pickle.loads(zlib.decompress(packed))


def asked_before() -> set[tuple[str, tuple]]:
    """Return units of loaded modules, with the types with which compiled code on disk calls them."""
    out = set()
    for name, made in UNITS.items():
        packed = None if made.files is None else made.files.asked()
        if packed is not None:
            with contextlib.suppress(Exception):  # a file of another version of Numba
                out.add((name, unpack(packed)))
    return out


def compile_asked(wanted: Iterable[tuple[str, tuple]]) -> None:
    """Compile units for types of arguments; those of an earlier version, which no code calls now, are left."""
    for name, kinds in wanted:
        with contextlib.suppress(TypingError, KeyError):  # KeyError: of a column that has gone
            address(name, kinds)


def find(name: str) -> Any:
    """Return a unit, by module and name."""
    if name not in UNITS:
        importlib.import_module(name.partition(":")[0])
    return UNITS[name]


def address(name: str, kinds: tuple) -> int:
    """Return the address of a unit for arguments of these types, loaded or compiled."""
    made = find(name)
    return made.address(digest_of(made.returned(*kinds)), pack(kinds))


@ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int64)
def _find(called, packed, size):
    """Return the address of a unit to compiled code, or 0 if it could not be compiled."""
    try:
        name, digest = called.decode().split(" ")
        return find(name).address(digest, ctypes.string_at(packed, size))
    except BaseException as error:  # Ctrl-C too: errors cannot pass through compiled code
        NotCompiled.stopped_by = error
        return 0


llvm.add_symbol(_FINDER, ctypes.cast(_find, ctypes.c_void_p).value)

_KINDS: dict[tuple, object] = {}  # one object for each key, which is faster to compare
_ENTRIES: dict[tuple, Callable] = {}


def kind(value):
    """Return a key that is equal for values of the same Numba type."""
    if isinstance(value, tuple):
        return (type(value), *map(kind, value))
    if isinstance(value, np.ndarray):
        return value.dtype, value.ndim, value.flags.num & ARRAY_FLAGS
    return type(value)


class Entries:
    """Entries for arguments that consist of these parts, numbers, workspace and records, found without Numba.

    Numba examines the types of all arguments, some 600 arrays and numbers, at each call of an entry: 25
    microseconds, of which 2 are the call. Workspace and records are named tuples of arrays of the same types in
    every run.
    """

    def __init__(self, *parts):
        self.__setstate__(kind(parts))

    def __getstate__(self) -> tuple:
        return self._kinds

    def __setstate__(self, kinds: tuple) -> None:
        self._kinds = kinds
        self._kind = _KINDS.setdefault(kinds, object())

    def __call__(self, function, *arguments) -> Any:
        """Call an entry without an examination of all types.

        If a unit that it needs could not be compiled, the error of its compile is raised.
        """
        key = (function, self._kind, *map(type, arguments))
        if key not in _ENTRIES:
            _ENTRIES[key] = _for_types_of(function, arguments) if COMPILES else function
        try:
            return _ENTRIES[key](*arguments)
        except NotCompiled as error:
            raise (error.__cause__ or error) from None


def _for_types_of(function: Entry, arguments: tuple) -> Callable:
    """Return the compiled code of an entry for arguments like these."""
    made = function.dispatcher
    return made.compile(tuple(map(made.typeof_pyval, arguments)))
