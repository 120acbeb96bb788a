"""Putting bytes on the disk: all of them in the place of what was there, or nothing."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable
from pathlib import Path


def put(path: Path, parts: Iterable[bytes | memoryview]) -> None:
    """Write `parts`, one after the other, to `path`, replacing what is there in one go.

    They go to a file beside it, on the disk, and that takes the place of the old one. Whoever kills the
    process, or cuts the power, finds the old file or the new one; what a killed process leaves beside it the
    next one writes over.

    Raises
    ------
    OSError
        With the path and the reason, if they cannot be written: on a full disk above all.
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
            f"{error.strerror or error}; nothing was written, what was there is as it was",
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
