"""Numba's options of a compile, compared by what was set.

Numba keeps compiled operators by their types and options, and asks for them hundreds of thousands of times
while a scene is compiled. Each time it looks up all two dozen options of both sides, and its hash of them is
one number for all: a tenth of all compile time. What is equal stays equal here; where what was set differs,
Numba decides.
"""

from __future__ import annotations

from numba.core.targetconfig import TargetConfig

_equal, _hash = TargetConfig.__eq__, TargetConfig.__hash__
_HASHES: dict[type, int] = {}


def _quickly_equal(self, other):
    if self is other or (type(self) is type(other) and self._values == other._values):
        return True
    return _equal(self, other)


def _same_hash(self):
    """Return Numba's hash, which depends on the names of the options alone."""
    kind = type(self)
    if kind not in _HASHES:
        _HASHES[kind] = _hash(self)
    return _HASHES[kind]


def install() -> None:
    """Let options be compared quickly in this process."""
    TargetConfig.__eq__ = _quickly_equal
    TargetConfig.__hash__ = _same_hash
