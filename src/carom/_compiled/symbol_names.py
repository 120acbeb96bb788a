"""Names of compiled functions, of a length that can be handled.

Numba spells the types of all arguments in the name of a function: 29 000 letters for the loop of a run, in each
place where it is mentioned.
"""

from __future__ import annotations

import hashlib

from numba.core import itanium_mangler

_spelled = itanium_mangler.mangle_args
_NAMES: dict[tuple, str] = {}
_LONG = 120


def _short(kinds) -> str:
    """Return what names say of the types of arguments: themselves, or a digest of what is long."""
    kinds = tuple(kinds)
    if kinds not in _NAMES:
        name = _spelled(kinds)
        if len(name) > _LONG:
            digest = hashlib.sha256(name.encode()).hexdigest()[:24]
            name = itanium_mangler.mangle_identifier(f"of_{digest}")
        _NAMES[kinds] = name
    return _NAMES[kinds]


def install() -> None:
    """Shorten names in this process."""
    itanium_mangler.mangle_args = _short
