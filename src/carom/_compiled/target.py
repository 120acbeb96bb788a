"""A target of Numba of our own: code for a fixed processor, and nothing changed for other users of Numba.

Kernels are typed in a typing context of their own and become code in a target context of their own, by Numba's
target extension. What makes that quick or small is said in subclasses here: operators on numbers are resolved
once, flags compare by what was set, names have a length that can be handled, named tuples of ours are typed as
references. Plain `numba.njit` in the same process goes on as it was.

The processor is a baseline (`processor`), so that results are the same, and files of compiled code are good, on
every machine of an architecture.
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
from carom._compiled.cache import StampedCache

NAME = "carom"
NATIVE = "CAROM_NATIVE"  # environment: "1" compiles for the processor at hand
_BASELINES = {
    # x86-64-v3 is Haswell and Excavator, and all that came after
    "x86_64": ("x86-64-v3", "", ("avx2", "bmi2", "fma", "lzcnt", "movbe", "f16c")),
    "aarch64": ("generic", "+v8a", ()),
}
_LONG = 120  # letters of what a name says of the types of arguments


@functools.cache
def processor() -> tuple[str, str]:
    """Return name and features of the processor that is compiled for.

    That is the baseline of the architecture, where the machine has all of it; with ``CAROM_NATIVE=1``, or on
    other machines, the one at hand; ``NUMBA_CPU_NAME`` and ``NUMBA_CPU_FEATURES`` come before both.
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


#: how to lower what Numba does not know
_own = Registry("carom")


class CaromCPU(CPU):
    """The name of the target."""


class Codegen(codegen.JITCPUCodegen):
    """Machine code for a fixed processor."""

    def _get_host_cpu_name(self):
        return processor()[0]

    def _get_host_cpu_features(self):
        return processor()[1]


class TypingContext(numba.core.typing.context.Context):
    """Types of expressions; what a function makes of plain numbers is found once, not in each place."""

    _plain = (types.Integer, types.Float, types.Boolean)

    def __init__(self):
        super().__init__()
        self._found: dict[tuple, Any] = {}

    def resolve_function_type(self, func, args, kws):
        """Return the signature of a call.

        What Numba writes as an overload or an intrinsic (``max``, ``int``) is resolved each time: it keeps one
        implementation for all targets, that of the last one that asked.
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
    """Code of expressions; names of functions are kept short.

    Numba spells the types of all arguments in the name of a function: 29 000 letters for the loop of a run.
    """

    def init(self):
        """Begin with code generation of our own."""
        super().init()
        self._internal_codegen: Any = Codegen("carom.exec")

    def load_additional_registries(self):
        """Know how to lower what kernels use: numbers, tuples, records, arrays and their elements, mathematics.

        Numba's own list goes on to strings, dictionaries and linear algebra, for which it imports SciPy: a
        third of the first run of a process.
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
    """Options of a compile, compared by what was set: Numba asks 15 million times whether two are the same."""

    def __eq__(self, other):
        if self is other or (type(self) is type(other) and self._values == other._values):
            return True
        return super().__eq__(other)

    def __hash__(self):
        return 20261123  # there are few


class Target(TargetDescriptor):
    """Both contexts, made at first use."""

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
    """Compiles one function, with `Flags` of ours."""

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
        """Compile for a signature, or load; the garbage collector, which would go through all of it, waits."""
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
        """Return the type of an argument from Python: a reference where it is a named tuple of ours."""
        kind = type_of(val)
        self._types_active_call.add(kind)  # pyright: ignore[reportAttributeAccessIssue]
        return kind

    def get_call_template(self, args, kws: Any):
        """Return how a call is typed, for plain types only.

        A variable that begins as a constant (``n = 0``) has a type of its own until all that is assigned to it
        is known. Numba compiles what is called meanwhile for that type, with all that this calls, and uses none
        of it: a quarter of all functions that a thrown die needs. An array that is a field of a record has a
        type of its own, too, that of its shape.
        """
        plain = {name: plain_type(kind) for name, kind in kws.items()}
        return super().get_call_template(tuple(map(plain_type, args)), plain)


def plain_type(kind) -> types.Type:
    """Return the type that a function is compiled for: one for constants and variables, fields and arrays."""
    if isinstance(kind, types.NestedArray):  # in memory they are alike
        return types.Array(kind.dtype, kind.ndim, "C")
    return types.unliteral(kind)


@_own.lower_cast(types.NestedArray, types.Array)
def _field_as_array(context, builder, fromty, toty, val):
    """Hand a field of a record on as the array that it is."""
    return val


def compiled(function=None, **options):
    """Compile for the target: `numba.njit` for our own code, and what its overloads are compiled with."""
    if function is None:
        return functools.partial(compiled, **options)
    options.pop("nopython", None)
    pipeline = options.pop("pipeline_class", compiler.Compiler)
    chosen = {"nopython": True, "boundscheck": None, **options}
    return Dispatcher(function, {}, chosen, pipeline)


target_registry[NAME] = CaromCPU
dispatcher_registry[CaromCPU] = Dispatcher
jit_registry[CaromCPU] = compiled
