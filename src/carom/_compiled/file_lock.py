"""A lock between processes: a file that the one who holds it has made, with its number inside."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

_PAUSE = 0.02  # seconds between two looks
_TOO_LONG = 600.0  # seconds after which whoever holds a lock is taken for dead


class FileLock:
    """A lock by the name of a file. Where no file can be made nothing is locked, and nobody waits."""

    _all: ClassVar[set[FileLock]] = set()  # those that this process holds

    def __init__(self, path: Path):
        self._path = path

    def take(self, meanwhile: Callable[[], bool]) -> bool:
        """Take the lock; return whether another process had to be waited for.

        What is called meanwhile returns whether it had anything to do.
        """
        waited = False
        while not self.try_to_take():
            waited = True
            if not meanwhile():
                time.sleep(_PAUSE)
        return waited

    def try_to_take(self) -> bool:
        """Take the lock, if no other living process has it."""
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
        except OSError:  # a folder that cannot be written, a full disk
            pass
        return True

    def release(self) -> None:
        """Give the lock back, if it is held."""
        if self in self._all:
            with contextlib.suppress(OSError):
                self._path.unlink()
            self._all.discard(self)  # last: `release_all` may end the process at any time

    @classmethod
    def release_all(cls) -> None:
        """Give back all locks of this process."""
        for lock in list(cls._all):
            lock.release()

    def is_taken(self) -> bool:
        """Return whether another process has the lock."""
        return self not in self._all and self._path.exists()

    def _is_left_over(self) -> bool:
        """Return whether who made the file has died."""
        try:
            if time.time() - self._path.stat().st_mtime > _TOO_LONG:
                return True
            number = int(self._path.read_text() or 0)
        except (OSError, ValueError):  # it was given back just now
            return False
        return number > 0 and not _lives(number)


def _lives(number: int) -> bool:
    """Return whether there is a process of this number, as far as the system tells."""
    if os.name != "posix":  # where signal 0 would end it
        return True
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    except OSError:  # one of another user
        pass
    return True
