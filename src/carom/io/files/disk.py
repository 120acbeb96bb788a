"""Writing bytes to a file: completely, or not at all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable
from pathlib import Path


def put(path: Path, parts: Iterable[bytes | memoryview]) -> None:
    """Write `parts`, one after another, to `path`, and replace an old file in one operation.

    They are written to a temporary file in the same folder, which then replaces the old file. If the process is
    killed or the power fails, `path` is either the old or the new file. The next call overwrites a temporary
    file that was left.

    Raises
    ------
    OSError
        If they cannot be written, for example on a full disk; with the path and the reason.
    """
    part = path.with_name(f".{path.name}.part")
    try:
        with part.open("wb") as file:
            for one in parts:
                file.write(one)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    except OSError as error:
        raise OSError(
            error.errno,
            f"{error.strerror or error}; nothing was written, an old file is unchanged",
            str(path),
        ) from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink()
    _sync(path.parent)


def sync(folder: Path) -> None:
    """Flush a folder and all that is in it to the disk, where the system can do that."""
    for one in folder.rglob("*"):
        _sync(one)
    _sync(folder)


def _sync(place: Path) -> None:
    """Flush a file, or the names in a folder, to the disk."""
    with contextlib.suppress(OSError):
        number = os.open(place, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
