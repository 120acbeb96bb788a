"""Machine code of the user's functions on disk, found by its content: a hash of all that it depends on.

A file has the name of the hash (`carom._compiled.snapshot`, with the versions of what compiles and the
processor), so there is nothing that could be out of date, wherever the function was written: in a file, a
notebook or a shell. A file that is damaged, or cannot be written, costs a compile. Two processes that compile
one function write the same file, each as a whole.

Only the wrapper can be called from outside: names of Numba's own functions are numbered in each process, so the
code of another process must not meet them.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
import tempfile
import weakref
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numba
import numpy as np
from numba import cfunc  # pyright: ignore[reportPrivateImportUsage]
from numba.core import config, typed_passes
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import register_pass
from numba.core.target_extension import target_override

from carom._compiled import snapshot as snapshots
from carom._compiled.link_only import PartCompiler
from carom._compiled.snapshot import NotKept, Snapshot
from carom._compiled.target import NAME, Dispatcher

_MOST_FILES = 500  # of 20 to 60 kB; those that were not used for the longest time are removed
_CHECK = 32  # bytes of a hash before the code
#: settings that do not change code
_OF_MACHINE = "NUM_THREADS", "CACHE", "DEBUG", "DUMP", "THREADING"


class Code:
    """Machine code with an address; it stays while this object does."""

    def __init__(self, library: JITCodeLibrary, name: str, function: Any = None):
        self.address: int = library.get_pointer_to_function(name)
        self._kept = library, function


_made: weakref.WeakValueDictionary[str, Code] = weakref.WeakValueDictionary()


@global_compiler_lock
def code_of(function: Any, signature: Any) -> Any:
    """Return an object with the address of the C function of a function: loaded, or compiled and saved."""
    try:
        copy = Snapshot(function)
    except NotKept:
        return cfunc(signature)(function)
    key = hashlib.sha256(f"{_surroundings()} {signature} {copy.digest}".encode()).hexdigest()
    found = _made.get(key)
    if found is None:
        with contextlib.suppress(Exception):  # as of a file of a damaged folder
            found = _load(key)
    if found is None:
        try:
            found = _compile(copy, signature, key)
        except (
            Exception
        ):  # `NotKept`, or an error of Numba, which is to name the user's own functions
            return cfunc(signature)(function)
    _made[key] = found
    return found


def _compile(copy: Snapshot, signature: Any, key: str) -> Code:
    copy.named_after(key)
    made: Any = cfunc(signature, pipeline_class=_Compiler)(copy.function)
    library = made._library
    if library.has_dynamic_globals or library._reload_init or _uses_python(library):
        raise NotKept("an object of this process")
    needs = [one.name for one in library._final_module.functions if one.is_declaration]
    needs = [one for one in needs if not one.startswith("llvm.")]
    _save(key, [made.native_name, *needs], library._get_compiled_object())
    return Code(library, made.native_name, made)


def _uses_python(library: Any) -> bool:
    """Return whether code uses objects of Python, which it finds in a variable of its process."""
    module = library._final_module
    names = [one.name for one in module.global_variables if one.name.startswith("_ZN08NumbaEnv")]
    text = str(module)
    return any(text.count(f"@{name}") > 1 for name in names)


class _Library(JITCodeLibrary):
    """Code of which only the wrapper can be called from outside."""

    def _optimize_final_module(self):
        for one in self._final_module.functions:
            if not one.is_declaration and not one.name.startswith("cfunc."):
                one.linkage = llvm.Linkage.internal
        super()._optimize_final_module()


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lowering(typed_passes.NativeLowering):
    """Lowering of a function into a `_Library`."""

    _name = "kept_lowering"

    def run_pass(self, state):
        """Write the code into a library of this file."""
        state.library = _Library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return super().run_pass(state)


class _Compiler(PartCompiler):
    """Numba's own pipeline with the pass of this file."""

    lowering = _Lowering


def _surroundings() -> str:
    """Return what code depends on beside its function: versions, the processor, settings of Numba."""
    settings = [
        (name, repr(getattr(config, name)))
        for name in sorted(dir(config))
        if name.isupper() and not any(one in name for one in _OF_MACHINE)
        and isinstance(getattr(config, name), (int, float, str, type(None)))
    ]  # fmt: skip
    return f"{_versions()} {settings}"


@cache
def _versions() -> str:
    rules = b"".join(Path(one or "").read_bytes() for one in (__file__, snapshots.__file__))
    versions = sys.version, numba.__version__, llvmlite.__version__, np.__version__
    machine = (
        llvm.get_process_triple(),
        llvm.get_host_cpu_name(),
        llvm.get_host_cpu_features().flatten(),
    )
    return f"{versions} {machine} {hashlib.sha256(rules).hexdigest()}"


@cache
def _folder() -> Path | None:
    """Return the folder of the files: that of carom's compiled code, or None if none can be written."""
    try:
        place = FunctionCache(_folder.__wrapped__)._impl.locator.get_cache_path()
        made = Path(place) / "functions"
        made.mkdir(parents=True, exist_ok=True)
    except (RuntimeError, OSError):
        return None
    return made


def _load(key: str) -> Code | None:
    folder = _folder()
    if folder is None:
        return None
    try:
        data = (folder / key).read_bytes()
    except OSError:
        return None
    if hashlib.sha256(data[_CHECK:]).digest() != data[:_CHECK]:
        return None
    with contextlib.suppress(OSError):
        os.utime(folder / key)
    head, _, code = data[_CHECK:].partition(b"\0")
    name, *needs = head.decode().split("\n")
    # carom's own target, because Numba's would first load all that it can compile
    context = Dispatcher.targetdescr.target_context
    with target_override(NAME):
        context.refresh()
    if not all(map(llvm.address_of_symbol, needs)):  # LLVM would end the process
        return None
    state = key, "object", (code, [name], None)  # nothing links it in
    return Code(context.codegen().unserialize_library(state), name)


def _save(key: str, names: list[str], code: bytes) -> None:
    """Save code: a hash of all that follows, the name of the function and those that it needs, and the code."""
    folder, data = _folder(), "\n".join(names).encode() + b"\0" + code
    if folder is None:
        return
    with contextlib.suppress(OSError):
        number, path = tempfile.mkstemp(dir=folder, suffix=".part")
        try:
            with os.fdopen(number, "wb") as file:
                file.write(hashlib.sha256(data).digest() + data)
            os.replace(path, folder / key)
        except OSError:
            os.unlink(path)
            raise
        _remove_oldest(folder)


def _remove_oldest(folder: Path) -> None:
    files = list(folder.iterdir())
    if len(files) > _MOST_FILES:
        files.sort(key=lambda one: one.stat().st_mtime)
        for one in files[:-_MOST_FILES]:
            one.unlink(missing_ok=True)
