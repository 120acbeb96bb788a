"""Compiled code on disk: valid for one state of a function and of all that is linked into it.

What goes wrong with it (a full disk, a folder that is no longer writable, a file cut short) costs a recompile
and nothing else. Of several processes that want the same function one compiles it, and the others wait for its
file.
"""

from __future__ import annotations

import contextlib
import warnings
from functools import cached_property
from pathlib import Path

from numba.core.caching import FunctionCache, IndexDataCacheFile

from carom._compiled import ahead, notice
from carom._compiled.cache_key import stamp
from carom._compiled.file_lock import FileLock

#: is there where a wheel has brought compiled code (`tools/build_wheel.py`)
SHIPPED = Path(__file__).parent / "shipped"


class StampedCache(FunctionCache):
    """A function cache that is valid as long as the stamp of its function."""

    told = False  # that nothing can be kept

    def __init__(self, py_func):
        super().__init__(py_func)
        self._kept, self._noted = py_func, False
        self._lock = FileLock(Path(self._cache_path) / f"{self._impl.filename_base}.lock")
        del self._cache_file  # made when it is first asked for: what is called may be defined later

    def load_overload(self, sig, target_context):
        """Load a compiled function, or return None: then no other process compiles it until `release`."""
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
        """Let other processes have what was compiled, or compile it if it could not be."""
        self._lock.release()
        self._end()

    def _load(self, sig, target_context):
        """Load a compiled function; a file that is broken is as good as none, and is written anew."""
        try:
            found = super().load_overload(sig, target_context)
        except Exception:  # cut short by a crash or a full disk: whatever unpickling makes of it
            with contextlib.suppress(OSError):
                self.flush()
            return None
        return self._load_shipped(sig, target_context) if found is None else found

    def _load_shipped(self, sig, target_context):
        """Load what a wheel has brought, where its folder cannot be written and so is not that of the cache."""
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
        """Keep a compiled function; where that fails say so, once."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            if not StampedCache.told:
                StampedCache.told = True
                warnings.warn(
                    f"compiled code cannot be kept in {self._cache_path!r} and is compiled again in each "
                    f"process: {error}",
                    RuntimeWarning,
                    stacklevel=2,
                )

    def note_asked(self, packed: bytes) -> None:
        """Keep by which types compiled code calls this function, for `carom warmup`; where it fails, do not."""
        file = self._asked_file(self._cache_path)
        with contextlib.suppress(OSError):
            if not file.exists() or file.read_bytes() != packed:
                file.write_bytes(packed)

    def asked(self) -> bytes | None:
        """Return what `note_asked` has kept, in this process or another one."""
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
            cache_path=place,
            filename_base=self._impl.filename_base,
            source_stamp=stamp(self._kept),
        )
