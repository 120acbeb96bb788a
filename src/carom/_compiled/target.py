"""Carom's own target of Numba: code for a fixed processor, without changes for other users of Numba.

By Numba's target extension, kernels have their own typing context and their own target context. The subclasses
here make compiling faster and code smaller: operators on numbers are resolved once, flags are compared by the
options that were set, names are short, and named tuples of carom are typed as references. Plain `numba.njit` in
the same process works as usual.

The processor is a baseline (`processor`), so that results are the same, and files of compiled code are valid,
on every machine of an architecture.
"""

from __future__ import annotations

import functools
import gc
import hashlib
import os
from typing import Any

import llvmlite.binding as llvm
import numba.core.typing.context
from numba.core import codegen, compiler, config, cpu, dispatcher, itanium_mangler, types
from numba.core.descriptors import TargetDescriptor
from numba.core.imputils import Registry
from numba.core.target_extension import (
    CPU,
    dispatcher_registry,
    jit_registry,
    target_override,
    target_registry,
)

from carom._compiled.by_reference import type_of
from carom._compiled.cache import StampedCache, files_of

NAME = "carom"
NATIVE = "CAROM_NATIVE"  # environment variable: "1" compiles for the present processor
_BASELINES = {
    # x86-64-v3 is Haswell and Excavator and all later processors
    "x86_64": ("x86-64-v3", "", ("avx2", "bmi2", "fma", "lzcnt", "movbe", "f16c")),
    "aarch64": ("generic", "+v8a", ()),
}
_LONG = 120  # greatest length of the types of arguments in a name


@functools.cache
def processor() -> tuple[str, str]:
    """Return name and features of the processor for which code is compiled.

    It is the baseline of the architecture if the machine has all its features, otherwise, or with
    ``CAROM_NATIVE=1``, the present processor. ``NUMBA_CPU_NAME`` and ``NUMBA_CPU_FEATURES`` have priority.
    """
    name: Any = getattr(config, "CPU_NAME", None)
    if name is not None:
        return name, getattr(config, "CPU_FEATURES", None) or ""
    baseline = _BASELINES.get(llvm.get_process_triple().split("-")[0])
    if baseline is not None and os.environ.get(NATIVE) != "1":
        has = llvm.get_host_cpu_features()
        if all(has.get(feature, False) for feature in baseline[2]):
            return baseline[:2]
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


#: rules to lower code that Numba does not know
_own = Registry("carom")


class CaromCPU(CPU):
    """The name of the target."""


class Library(codegen.JITCodeLibrary):
    """Machine code in files, whose LLVM code is read only if it is linked into other code.

    That is rare: units and entries are called. Numba reads it whenever it loads machine code, which took a
    quarter of the first run of a process.
    """

    _unread: bytes | None = None  # LLVM code from a file

    def serialize_using_object_code(self):
        """Return name, kind, machine code with the names of what it defines, and LLVM code."""
        code: Any = self._get_compiled_object()
        module = self._get_module_for_linking()
        parts = (*module.functions, *module.global_variables)
        names = [part.name for part in parts if not part.is_declaration]
        return self.name, "object", (code, names, module.as_bitcode())

    def symbols_needed(self) -> list[str]:
        """Return the symbols that the code needs and that this process finds."""
        module: Any = self._final_module
        parts = [
            one.name for one in (*module.functions, *module.global_variables) if one.is_declaration
        ]
        return [name for name in parts if name[:5] != "llvm." and llvm.address_of_symbol(name)]

    @classmethod
    def _unserialize(cls, codegen, state):
        name, _, (code, names, unread) = state
        made = codegen.create_library(name)
        made._unread = unread
        made.enable_object_caching()
        made._set_compiled_object(code)
        made._finalize_final_module()
        codegen._engine._defined_symbols.update(names)
        return made

    def _get_module_for_linking(self):
        if self._shared_module is None and self._unread is not None:
            self._shared_module = llvm.parse_bitcode(self._unread)
        return super()._get_module_for_linking()


class Codegen(codegen.JITCPUCodegen):
    """Machine code for a fixed processor."""

    _library_class = Library

    def _get_host_cpu_name(self):
        return processor()[0]

    def _get_host_cpu_features(self):
        return processor()[1]


class TypingContext(numba.core.typing.context.Context):
    """Types of expressions; the signature of a function of plain numbers is resolved only once."""

    _plain = (types.Integer, types.Float, types.Boolean)

    def __init__(self):
        super().__init__()
        self._found: dict[tuple, Any] = {}

    def resolve_function_type(self, func, args, kws):
        """Return the signature of a call.

        Functions that Numba defines by an overload or an intrinsic (``max``, ``int``) are resolved each time,
        because Numba stores one implementation for all targets, that of the last request.
        """
        plain = not kws and isinstance(func, types.Function)
        if not (plain and all(isinstance(a, self._plain) for a in args)):
            return super().resolve_function_type(func, args, kws)
        key = func, args
        if key in self._found:
            return self._found[key]
        found = super().resolve_function_type(func, args, kws)
        shared = "_compiled_overloads", "_overload_cache"  # of overloads, of intrinsics
        if not any(hasattr(template, name) for template in func.templates for name in shared):
            self._found[key] = found
        return found


class TargetContext(cpu.CPUContext):
    """Code of expressions, with short names of functions.

    Numba writes the types of all arguments in the name of a function: 29 000 letters for the loop of a run.
    """

    def init(self):
        """Begin with carom's own code generation."""
        super().init()
        self._internal_codegen: Any = Codegen("carom.exec")

    def load_additional_registries(self):
        """Load the rules that kernels need: numbers, tuples, records, arrays and their elements, mathematics.

        Numba's own list also has strings, dictionaries and linear algebra, for which it imports SciPy; this
        took a third of the first run of a process.
        """
        from numba.core import optional  # noqa: F401
        from numba.core.runtime.nrt import rtsys
        from numba.cpython import (  # noqa: F401
            builtins,
            iterators,
            mathimpl,
            numbers,
            rangeobj,
            slicing,
            tupleobj,
        )
        from numba.np import arrayobj, npyimpl  # noqa: F401

        rtsys.initialize(self)
        self.install_registry(mathimpl.registry)
        self.install_registry(npyimpl.registry)
        self.install_registry(_own)

    def mangler(self, name, types, *, abi_tags=(), uid=None):
        """Return the symbol of a function."""
        return _symbol(name, tuple(types), tuple(abi_tags), uid)


def _symbol(name, kinds, tags, uid) -> str:
    spelled = _spelled(kinds)
    head = itanium_mangler.mangle(name, (), abi_tags=tags, uid=uid)
    return head[:-1] + spelled if head.endswith("v") and spelled else head + spelled


@functools.cache
def _spelled(kinds: tuple) -> str:
    name = itanium_mangler.mangle_args(kinds)
    if len(name) > _LONG:
        digest = hashlib.sha256(name.encode()).hexdigest()[:24]
        name = itanium_mangler.mangle_identifier(f"of_{digest}")
    return name


class Flags(compiler.Flags):
    """Options of a compile, compared by the options that were set: Numba compares them 15 million times."""

    def __eq__(self, other):
        if self is other or (type(self) is type(other) and self._values == other._values):
            return True
        return super().__eq__(other)

    def __hash__(self):
        return 20261123  # there are few different options


class Target(TargetDescriptor):
    """The typing and target contexts, made at first use."""

    options: Any = cpu.CPUTargetOptions

    @functools.cached_property
    def typing_context(self):
        """The context of types."""
        return TypingContext()

    @functools.cached_property
    def target_context(self):
        """The context of code."""
        return TargetContext(self.typing_context, target=NAME)


class _Compiler(dispatcher._FunctionCompiler):  # pyright: ignore[reportAttributeAccessIssue]
    """Compiler of one function, with `Flags` of this file."""

    def _customize_flags(self, flags):
        own = Flags()
        own._values.update(flags._values)
        return own


class Dispatcher(dispatcher.Dispatcher):
    """A function compiled for the target."""

    targetdescr = Target(NAME)

    def __init__(self, py_func, locals=None, targetoptions=None, pipeline_class=compiler.Compiler):
        super().__init__(py_func, locals or {}, targetoptions, pipeline_class)
        self._compiler = _Compiler(
            py_func, self.targetdescr, self.targetoptions, self.locals, pipeline_class
        )

    def compile(self, sig):
        """Compile for a signature, or load; meanwhile the garbage collector is off, which saves time."""
        waits = gc.isenabled()
        gc.disable()
        try:
            with target_override(NAME):
                return super().compile(sig)
        finally:
            if waits:
                gc.enable()
            cache: Any = getattr(self, "_cache", None)
            if isinstance(cache, StampedCache):
                cache.release()

    def typeof_pyval(self, val):
        """Return the type of an argument from Python: a reference if it is a named tuple of carom."""
        kind = type_of(val)
        self._types_active_call.add(kind)  # pyright: ignore[reportAttributeAccessIssue]
        return kind

    def get_call_template(self, args, kws: Any):
        """Return the typing of a call, for plain types only.

        A variable that begins as a constant (``n = 0``) has a special type until all its assignments are known.
        Numba would compile called functions for this type, with all that they call, and use none of them: a
        quarter of all functions for a thrown die. An array that is a field of a record has a special type, too,
        which includes its shape.
        """
        plain = {name: plain_type(kind) for name, kind in kws.items()}
        return super().get_call_template(tuple(map(plain_type, args)), plain)


def plain_type(kind) -> types.Type:
    """Return the type for which a function is compiled: that of a variable or of an array."""
    if isinstance(kind, types.NestedArray):  # its memory layout is that of an array
        return types.Array(kind.dtype, kind.ndim, "C")
    return types.unliteral(kind)


@_own.lower_cast(types.NestedArray, types.Array)
def _field_as_array(context, builder, fromty, toty, val):
    """Return a field of a record as an array."""
    return val


def compiled(function=None, **options):
    """Compile for the target, in place of `numba.njit`, for carom's code and for its overloads."""
    if function is None:
        return functools.partial(compiled, **options)
    options.pop("nopython", None)
    pipeline = options.pop("pipeline_class", compiler.Compiler)
    chosen = {"nopython": True, "boundscheck": None, **options}
    return Dispatcher(function, {}, chosen, pipeline)


class Kernel:
    """A function that is compiled as a part of its callers: it has a dispatcher once Numba asks for its type.

    A process that finds all code on disk asks for none: a thousand dispatchers that nobody calls took an eighth
    of its first run.
    """

    def __init__(self, function, options):
        self.py_func, self.targetoptions = function, options
        self.__name__, self.__qualname__ = function.__name__, function.__qualname__
        self.__module__, self.__doc__ = function.__module__, function.__doc__

    @functools.cached_property
    def dispatcher(self) -> Any:
        """The function as Numba knows it."""
        return compiled(self.py_func, **self.targetoptions)

    @property
    def _numba_type_(self):
        return self.dispatcher._numba_type_


class Entry(Kernel):
    """A function that Python calls too: it has a dispatcher, and files, once it is called."""

    def __init__(self, function, options):
        super().__init__(function, options)
        self.__wrapped__ = function  # its signature

    @functools.cached_property
    def dispatcher(self) -> Any:
        """The function as Numba knows it, with its files."""
        return with_files(compiled(self.py_func, **self.targetoptions), files_of(self.py_func))

    def __call__(self, *arguments):
        """Call it from Python."""
        return self.dispatcher(*arguments)


def with_files(made: Any, files: StampedCache | None) -> Any:
    """Return a function that finds its compiled code in files, if it has a place for them."""
    if files is not None:
        made._cache = files
    return made


target_registry[NAME] = CaromCPU
dispatcher_registry[CaromCPU] = Dispatcher
jit_registry[CaromCPU] = compiled
