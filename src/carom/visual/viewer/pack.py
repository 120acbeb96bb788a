"""Arrays for a browser: numbers in one packed block, and a header that says where each array is."""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import numpy as np


class Packer:
    """Collects arrays; each gets an entry in the header: its start, its type and its shape."""

    def __init__(self):
        self._bytes, self._length = [], 0

    def add(self, array, kind: str = "f4") -> dict[str, Any]:
        """Store an array as `kind` ("f4", "f8" or "i4"); return its entry of the header."""
        array = np.ascontiguousarray(array)
        data = array.astype(f"<{kind}").tobytes()
        # each array starts at a multiple of 8 bytes, as typed arrays need
        data += bytes(-len(data) % 8)
        note = {"at": self._length, "kind": kind, "shape": list(array.shape)}
        self._bytes.append(data)
        self._length += len(data)
        return note

    def block(self) -> str:
        """Return all arrays, deflated, in base64."""
        return base64.b64encode(zlib.compress(b"".join(self._bytes), 6)).decode("ascii")


def header_text(header: dict) -> str:
    """Return JSON that is safe inside a script element, with any names in it."""
    text = json.dumps(header, ensure_ascii=True, allow_nan=False)
    return text.replace("<", "\\u003c")
