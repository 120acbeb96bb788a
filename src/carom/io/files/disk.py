"""Writing files: completely, or not at all. All that carom writes, apart from compiled code, goes this way."""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Iterable, Iterator
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
    part = _beside(path, "part")
    try:
        with part.open("wb") as file:
            for one in parts:
                file.write(one)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    except OSError as error:
        raise _unchanged(path, error) from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink()
    _sync(path.parent)


@contextlib.contextmanager
def staged(path: Path) -> Iterator[Path]:
    """Yield an empty folder beside `path`, for programs that write files themselves; then put these in place.

    The file with the name of `path` replaces `path`, last and in one operation. The others replace those in the
    folder `path` without its suffix. If anything fails before, nothing is replaced.

    Raises
    ------
    OSError
        If the files cannot be written; with the path and the reason.
    """
    part, folder = _beside(path, "part"), path.with_suffix("")
    try:
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir()
        yield part
        sync(part)
        for one in sorted(part.iterdir()):
            if one.name != path.name:
                folder.mkdir(exist_ok=True)
                os.replace(one, folder / one.name)
        os.replace(part / path.name, path)
    except OSError as error:
        raise _unchanged(path, error) from error
    finally:
        shutil.rmtree(part, ignore_errors=True)
    _sync(path.parent)


def replace_folder(new: Path, path: Path) -> None:
    """Let the folder `new`, beside `path`, take its place; an old one is removed when that is done.

    If the process is killed in between, the old folder is there, perhaps as ``.NAME.old``.
    """
    old = _beside(path, "old")
    shutil.rmtree(old, ignore_errors=True)
    sync(new)
    there = path.exists()
    if there:
        path.rename(old)
    try:
        new.rename(path)
    except OSError:
        if there:
            old.rename(path)
        raise
    _sync(path.parent)
    shutil.rmtree(old, ignore_errors=True)


def _beside(path: Path, what: str) -> Path:
    """Return the hidden path beside `path` that is used while it is written."""
    return path.with_name(f".{path.name}.{what}")


def _unchanged(path: Path, error: OSError) -> OSError:
    """Return the error of a file that could not be written."""
    why = f"{error.strerror or error}; nothing was written, an old file is unchanged"
    return OSError(error.errno, why, str(path))


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
