"""Compiled code on disk: valid for one state of a function and of all code that is linked into it.

A file holds one function for one list of types, on one processor: its name has a hash of these. It has two
parts, of which a process that finds everything on disk reads the first: machine code, and the name of what is
called in it. So it makes no types, no descriptions of functions, and needs nothing of Numba's compiler.

Any error of the cache (a full disk, a folder without write access, a damaged file) only causes a new compile.
If several processes need the same function, one compiles it, and the others wait for its file.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import pickle
import struct
import uuid
import warnings
import zlib
from collections.abc import Callable
from functools import cache, cached_property
from pathlib import Path
from typing import IO, Any, ClassVar, NamedTuple

import llvmlite
import llvmlite.binding as llvm
import numba
import numpy as np
from numba.core.caching import CompileResultCacheImpl, _Cache
from numba.core.serialize import dumps

from carom._compiled import ahead, notice
from carom._compiled.cache_key import Own, stamp
from carom._compiled.file_lock import FileLock

#: exists if a wheel contained compiled code (`tools/build_wheel.py`)
SHIPPED = Path(__file__).parent / "shipped"


class Machine(NamedTuple):
    """The first part of a file: machine code, and what tells whether it can be used."""

    stamp: str  # of the function and the versions for which it is valid
    library: tuple[str, str, tuple]  # state of a library of the target, without LLVM code
    name: str  # of the function
    needs: list[str]  # symbols; LLVM ends the process where one is missing
    alone: bool  # whether nothing of the second part is needed to call it

    def is_valid(self, wanted: str) -> bool:
        """Return whether the code is that of a stamp, and can be loaded into this process."""
        return self.stamp == wanted and all(map(llvm.address_of_symbol, self.needs))


def digest_of(signature: Any) -> str:
    """Return a hash of a signature, or of types of arguments: of names, which are equal where the types are."""
    kinds = getattr(signature, "args", signature)
    text = f"{'; '.join(map(str, kinds))} -> {getattr(signature, 'return_type', None)}"
    return hashlib.sha256(text.encode()).hexdigest()[:16]


class StampedCache(_Cache):
    """The files of a function.

    Parameters
    ----------
    py_func : callable
        The function.
    linked : bool
        Whether other code may link it in, which needs its LLVM code: two thirds of a file.
    """

    warned = False  # whether the warning that the cache cannot be written was given
    _known: ClassVar[dict[Callable, Own]] = {}  # texts of functions, for their stamps

    def __init__(self, py_func, linked: bool = True):
        self._function, self._linked, self._noted = py_func, linked, False
        self._impl = CompileResultCacheImpl(py_func)
        self._place = Path(self._impl.locator.get_cache_path())
        self._lock = FileLock(self._place / f"{self._impl.filename_base}.lock")

    @property
    def cache_path(self) -> str:
        """The folder of the files."""
        return str(self._place)

    def enable(self):
        """Do nothing: the cache is always used."""

    def disable(self):
        """Do nothing."""

    def flush(self):
        """Remove the files."""
        for file in self._place.glob(f"{self._impl.filename_base}.*.nbc"):
            with contextlib.suppress(OSError):
                file.unlink()

    @cached_property
    def _stamp(self) -> str:  # made at first use, because called functions may be defined later
        cells = tuple(cell.cell_contents for cell in self._function.__closure__ or ())
        inside = zlib.crc32(dumps(cells)) if cells else ""
        return f"{stamp(self._function, self._known)} {inside} {_versions()}"

    def load_overload(self, sig, target_context):
        """Load a compiled function; if the result is None, no other process compiles it until `release`."""
        found = self._load(sig, target_context)
        if found is None:
            ahead.start()
            self._begin()
            if self._lock.take(ahead.compile_one):  # another process has compiled it
                found = self._load(sig, target_context)
            if found is not None:
                self._end()
        return found

    def machine(self, digest: str, codegen) -> Machine | None:
        """Return the machine code for types with this hash, if it is on disk and can be called alone."""
        return self._read(digest, codegen, lambda first, _: first if first.alone else None)

    def _load(self, sig, target_context):
        """Load a compiled function with all that Numba knows of it."""
        codegen = target_context.codegen()

        def rebuild(machine: Machine, file):
            unread, *rest = _read_part(file)
            name, kind, (code, names, _) = machine.library
            state = name, kind, (code, names, unread)
            return self._impl.rebuild(target_context, (state, *rest))

        return self._read(digest_of(sig), codegen, rebuild)

    def _read(self, digest: str, codegen, use: Callable) -> Any:
        """Return what `use` makes of a file, or None if there is none that is valid."""
        for place in self._places():
            with (
                contextlib.suppress(Exception),  # a damaged file may cause any error of unpickling
                open(place / self._file_name(digest, codegen), "rb") as file,
            ):
                machine = _read_part(file)
                if machine.is_valid(self._stamp):
                    return use(machine, file)
        return None

    def _places(self) -> list[Path]:
        """Return the folders with files: also that of a wheel, if it is not writable and thus not the cache."""
        shipped = Path(self._function.__code__.co_filename).parent / "__pycache__"
        return (
            [self._place, shipped] if SHIPPED.exists() and shipped != self._place else [self._place]
        )

    def _file_name(self, digest: str, codegen) -> str:
        processor = hashlib.sha256(repr(codegen.magic_tuple()).encode()).hexdigest()[:8]
        return f"{self._impl.filename_base}.{digest}.{processor}.nbc"

    def save_overload(self, sig, data):
        """Save a compiled function; if this fails, warn once."""
        try:
            if self._impl.check_cachable(data):
                self._save(self._file_name(digest_of(sig), data.codegen), data)
        except OSError as error:
            busy = os.name == "nt" and error.errno == errno.EACCES  # another process reads the file
            if not busy and not StampedCache.warned:
                StampedCache.warned = True
                warnings.warn(
                    f"compiled code cannot be kept in {self.cache_path!r} and is compiled again in each "
                    f"process: {error}",
                    RuntimeWarning,
                    stacklevel=2,
                )

    def _save(self, name: str, compiled) -> None:
        """Write a file as a whole, under a name of its own first."""
        state, *rest, _, reload, environments = self._impl.reduce(compiled)
        of, kind, (code, names, unread) = state
        # each kernel has an environment, for Python objects that its code uses; those of a die are 1900
        environments = tuple(one for one in environments if one.consts)
        machine = Machine(
            self._stamp, (of, kind, (code, names, None)), compiled.fndesc.llvm_func_name,
            compiled.library.symbols_needed(), not reload and not environments,
        )  # fmt: skip
        second = (
            unread if self._linked else None,
            *rest,
            "",
            reload,
            environments,
        )  # without its text
        self._impl.locator.ensure_cache_path()
        unfinished = self._place / f"{name}.tmp.{uuid.uuid4().hex[:16]}"
        try:
            unfinished.write_bytes(_part(machine) + _part(second))
            os.replace(unfinished, self._place / name)
        except OSError:
            unfinished.unlink(missing_ok=True)
            raise

    def _begin(self):
        if not self._noted:
            self._noted = True
            notice.begin()

    def _end(self):
        if self._noted:
            self._noted = False
            notice.end()

    def is_taken(self) -> bool:
        """Return whether another process compiles this function."""
        return self._lock.is_taken()

    def release(self):
        """Let other processes load the compiled function, or compile it if this process could not."""
        self._lock.release()
        self._end()

    def note_asked(self, packed: bytes) -> None:
        """Save the types with which compiled code calls this function, for `carom warmup`; ignore errors."""
        file = self._asked_file
        with contextlib.suppress(OSError):
            if not file.exists() or file.read_bytes() != packed:
                file.write_bytes(packed)

    def asked(self) -> bytes | None:
        """Return the types that `note_asked` has saved, in this process or in another one."""
        with contextlib.suppress(OSError):
            return self._asked_file.read_bytes()
        return None

    @property
    def _asked_file(self) -> Path:
        return self._place / f"{self._impl.filename_base}.asked"


_HEAD = struct.Struct("<QI")  # of a part of a file: its length and a checksum


def _part(content: tuple) -> bytes:
    data = dumps(content)
    return _HEAD.pack(len(data), zlib.crc32(data)) + data


def _read_part(file: IO[bytes]) -> Any:
    """Return the content of the next part; any error means that the file is damaged."""
    length, check = _HEAD.unpack(file.read(_HEAD.size))
    data = file.read(length)
    if zlib.crc32(data) != check:
        raise ValueError("a damaged file")
    return pickle.loads(data)


def files_of(function: Callable, linked: bool = True) -> StampedCache | None:
    """Return the files of a function, beside its source or in the cache of the user; None without a place."""
    try:
        return StampedCache(function, linked)
    except (RuntimeError, OSError):  # no writable place for a cache
        return None


@cache
def _versions() -> str:
    return f"{numba.__version__} {llvmlite.__version__} {np.__version__}"
