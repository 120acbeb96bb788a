"""Shorten compile time without changing the generated code.

Measured on a die thrown to rest, of its compile time:
- options of a compile are compared by what was set (a tenth: 15 million times, two dozen look-ups each),
- what an operator makes of numbers is found once (it was resolved anew in each place), and the garbage
  collector waits for the end of a compile (it went through all that was there): a tenth together.
"""

from __future__ import annotations

import gc
from typing import Any

from numba.core import event, types
from numba.core.targetconfig import TargetConfig

from carom._compiled import late_blas

_equal, _hash = TargetConfig.__eq__, TargetConfig.__hash__
_HASHES: dict[type, int] = {}


def _quickly_equal(self, other):
    if self is other or (type(self) is type(other) and self._values == other._values):
        return True
    return _equal(self, other)


def _same_hash(self):
    """Return Numba's hash, which depends on the names of the options alone: one number for all."""
    kind = type(self)
    if kind not in _HASHES:
        _HASHES[kind] = _hash(self)
    return _HASHES[kind]


_resolve = types.Function.get_call_type
_FOUND: dict[tuple, Any] = {}
_PLAIN = (types.Integer, types.Float, types.Boolean)


def _resolve_once(self, context, args, kws):
    """Return the signature of a function for these arguments, as found before if they are plain numbers."""
    if kws or not all(isinstance(a, _PLAIN) for a in args):
        return _resolve(self, context, args, kws)
    key = id(context), self, args
    if key not in _FOUND:
        _FOUND[key] = _resolve(self, context, args, kws)
    return _FOUND[key]


class _Pause(event.Listener):
    """Stops the garbage collector while something is compiled."""

    depth, was_on = 0, False

    def on_start(self, event):
        """Begin, perhaps within another compile."""
        if self.depth == 0:
            self.was_on = gc.isenabled()
            gc.disable()
        self.depth += 1

    def on_end(self, event):
        """End."""
        self.depth -= 1
        if self.depth == 0 and self.was_on:
            gc.enable()


def install() -> None:
    """Let Numba do so in this process, and SciPy be loaded where it is needed."""
    late_blas.defer()
    TargetConfig.__eq__ = _quickly_equal
    TargetConfig.__hash__ = _same_hash
    types.Function.get_call_type = _resolve_once
    event.register("numba:compile", _Pause())
