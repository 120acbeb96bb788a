"""A lock between processes: a file made by the process with the lock, which contains the process number."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

_PAUSE = 0.02  # seconds between two tries
_TOO_LONG = 600.0  # seconds after which the process with a lock counts as dead


class FileLock:
    """A lock with the name of a file. If no file can be made, nothing is locked, and no process waits."""

    _all: ClassVar[set[FileLock]] = set()  # locks of this process

    def __init__(self, path: Path):
        self._path = path

    def take(self, meanwhile: Callable[[], bool]) -> bool:
        """Take the lock; return whether this process had to wait for another one.

        During the wait `meanwhile` is called; it returns whether it had work to do.
        """
        waited = False
        while not self.try_to_take():
            waited = True
            if not meanwhile():
                time.sleep(_PAUSE)
        return waited

    def try_to_take(self) -> bool:
        """Take the lock if no other living process has it; return whether it was taken."""
        try:
            with open(self._path, "x") as file:
                self._all.add(self)
                file.write(str(os.getpid()))
        except FileExistsError:
            if not self._is_left_over():
                return False
            with contextlib.suppress(OSError):
                self._path.unlink()
            return self.try_to_take()
        except OSError:  # a folder without write access, or a full disk
            pass
        return True

    def release(self) -> None:
        """Release the lock if this process has it."""
        if self in self._all:
            with contextlib.suppress(OSError):
                self._path.unlink()
            self._all.discard(self)  # last, because the process may end at any time

    @classmethod
    def release_all(cls) -> None:
        """Release all locks of this process."""
        for lock in list(cls._all):
            lock.release()

    def is_taken(self) -> bool:
        """Return whether another process has the lock."""
        return self not in self._all and self._path.exists()

    def _is_left_over(self) -> bool:
        """Return whether the process that made the file has ended."""
        try:
            if time.time() - self._path.stat().st_mtime > _TOO_LONG:
                return True
            number = int(self._path.read_text() or 0)
        except (OSError, ValueError):  # it was released at this moment
            return False
        return number > 0 and not _lives(number)


def _lives(number: int) -> bool:
    """Return whether a process with this number exists, or may exist."""
    if os.name != "posix":  # signal 0 would end the process there
        return True
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    except OSError:  # a process of another user
        pass
    return True
