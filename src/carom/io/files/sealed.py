"""The end of a file: the part that carom reads, and the digest that shows damage.

For other programs a file is netCDF-4 (HDF5) from its first byte on. After the HDF5 data, where HDF5 does not
read, are the arrays of carom, an index of all arrays (JSON), and a line with the SHA-256 of all bytes before.
(In the user block of HDF5, at the beginning, the digest would hide the signature by which xarray recognises a
file.)

`Solution.load` reads the numbers at the positions in the index. It does not use the HDF5 library, which follows
links to other files and crashes on some damaged files.
"""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any, NamedTuple

from carom.io.files.layout import FORMAT

BEFORE = "\ncarom run, format %3d, index of %15d bytes, sha256 "
TAIL = re.compile(rb"\ncarom run, format +(\d+), index of +(\d+) bytes, sha256 ([0-9a-f]{64})\n")
LENGTH = len(BEFORE % (0, 0)) + 64 + 1
SIGNATURE = b"\x89HDF\r\n\x1a\n"
ALLOWED = "give a file that Solution.save or simulate(save=...) has written"


class Sealed(NamedTuple):
    """A complete file: all its bytes, and its index."""

    data: memoryview
    index: dict[str, Any]


def seal(parts: list, index: dict[str, Any]) -> list:
    """Return the bytes of a file, in parts: those given, their index, and the line with the digest."""
    text = json.dumps(index, allow_nan=False).encode()
    return with_digest([*parts, text, (BEFORE % (FORMAT, len(text))).encode()])


def with_digest(parts: list) -> list:
    """Return the bytes of a file, in parts, and their SHA-256 with the end of a line."""
    digest = hashlib.sha256()
    for one in parts:
        digest.update(one)
    return [*parts, f"{digest.hexdigest()}\n".encode()]


def agrees(data: memoryview) -> bool:
    """Return whether the bytes of a file agree with the digest at its end."""
    return bytes(data[-65:]) == f"{hashlib.sha256(data[:-65]).hexdigest()}\n".encode()


def unsealed(path: Path) -> Sealed:
    """Return the contents of a file, if no bit of it has changed since it was written.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If it is of another kind, damaged, or newer than this version of carom.
    """
    data = memoryview(_bytes(path))
    tail = TAIL.fullmatch(data[-LENGTH:])
    if tail is None:
        raise ValueError(refusal(path, _what_it_is(bytes(data[: len(SIGNATURE)]))))
    version, length = int(tail[1]), int(tail[2])
    if not agrees(data):
        raise ValueError(refusal(path, "it is damaged: its digest does not agree with its bytes"))
    if version != FORMAT:
        raise ValueError(
            f"path must be a file in format {FORMAT}, got {str(path)!r} in format {version}: update carom to "
            "read it"
        )
    start = len(data) - LENGTH - length
    try:
        index = json.loads(bytes(data[max(0, start) : -LENGTH]), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ValueError(refusal(path, f"its index is broken ({error})")) from error
    if start < 0 or not isinstance(index, dict):
        raise ValueError(refusal(path, "its index is broken (it is no object)"))
    return Sealed(data, index)


def refusal(path: Path, why: str) -> str:
    """Return the message about a file that is refused."""
    return f"path must be a file of a run, got {str(path)!r}: {why}; {ALLOWED}"


def _bytes(path: Path) -> bytes:
    if not path.exists():
        raise FileNotFoundError(
            f"path must be a file of a run, got {str(path)!r}: it does not exist"
        )
    if not path.is_file():
        what = "a folder" if path.is_dir() else "not a regular file"
        raise ValueError(refusal(path, f"it is {what}"))
    try:
        return path.read_bytes()
    except MemoryError:
        raise ValueError(refusal(path, "it is larger than the memory")) from None


def _what_it_is(beginning: bytes) -> str:
    if beginning != SIGNATURE:
        return "it is not HDF5, or its beginning is missing"
    return (
        "it is HDF5 without the end that carom writes: a file of another program, or cut short, or changed, or "
        "written by carom 0.1 or earlier, which can read it"
    )


def _no_constant(name: str):
    raise ValueError(f"{name} is no number of JSON")
