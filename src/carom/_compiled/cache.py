"""Compiled code on disk: valid for one state of a function and of all code that is linked into it.

Any error of the cache (a full disk, a folder without write access, a truncated file) only causes a new compile.
If several processes need the same function, one compiles it, and the others wait for its file.
"""

from __future__ import annotations

import contextlib
import warnings
from functools import cached_property
from pathlib import Path

from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile

from carom._compiled import ahead, notice
from carom._compiled.cache_key import stamp
from carom._compiled.file_lock import FileLock

#: exists if a wheel contained compiled code (`tools/build_wheel.py`)
SHIPPED = Path(__file__).parent / "shipped"


class _Reduced(CompileResultCacheImpl):
    """What a file keeps of a compiled function: without its annotated text, and environments that hold nothing.

    Each kernel has an environment, for Python objects that its code uses; those of a die are 1900.
    """

    def reduce(self, cres):
        """Return the parts of a compiled function that its file keeps."""
        *kept, _, reload, environments = super().reduce(cres)
        return *kept, "", reload, tuple(one for one in environments if one.consts)


class StampedCache(FunctionCache):
    """A function cache that is valid while the stamp of its function does not change."""

    _impl_class = _Reduced
    warned = False  # whether the warning that the cache cannot be written was given

    def __init__(self, py_func):
        super().__init__(py_func)
        self._kept, self._noted = py_func, False
        self._lock = FileLock(Path(self._cache_path) / f"{self._impl.filename_base}.lock")
        del self._cache_file  # made at first use, because called functions may be defined later

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

    def _load(self, sig, target_context):
        """Load a compiled function; a damaged file counts as missing, and is written again."""
        try:
            found = super().load_overload(sig, target_context)
        except Exception:  # a truncated file may cause any error of unpickling
            with contextlib.suppress(OSError):
                self.flush()
            return None
        return self._load_shipped(sig, target_context) if found is None else found

    def _load_shipped(self, sig, target_context):
        """Load compiled code from a wheel, if its folder is not writable and therefore not the cache."""
        place = Path(self._kept.__code__.co_filename).parent / "__pycache__"
        if not SHIPPED.exists() or place == Path(self._cache_path):
            return None
        written, self._cache_file = self._cache_file, self._file_at(str(place))
        try:
            return super().load_overload(sig, target_context)
        except Exception:
            return None
        finally:
            self._cache_file = written

    def save_overload(self, sig, data):
        """Save a compiled function; if this fails, warn once."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            if not StampedCache.warned:
                StampedCache.warned = True
                warnings.warn(
                    f"compiled code cannot be kept in {self._cache_path!r} and is compiled again in each "
                    f"process: {error}",
                    RuntimeWarning,
                    stacklevel=2,
                )

    def note_asked(self, packed: bytes) -> None:
        """Save the types with which compiled code calls this function, for `carom warmup`; ignore errors."""
        file = self._asked_file(self._cache_path)
        with contextlib.suppress(OSError):
            if not file.exists() or file.read_bytes() != packed:
                file.write_bytes(packed)

    def asked(self) -> bytes | None:
        """Return the types that `note_asked` has saved, in this process or in another one."""
        with contextlib.suppress(OSError):
            return self._asked_file(self._cache_path).read_bytes()
        return None

    def _asked_file(self, place: str) -> Path:
        return Path(place) / f"{self._impl.filename_base}.asked"

    @cached_property
    def _cache_file(self):
        return self._file_at(self._cache_path)

    def _file_at(self, place: str):
        return IndexDataCacheFile(
            cache_path=place, filename_base=self._impl.filename_base, source_stamp=stamp(self._kept)
        )
