"""Kinds of ground that is not convex: a file each, composed by number.

The file of a kind has `field_at`, and of the other operations of `collision.implicit` those that are not the
common ones. A new kind is a file here, its name in `SURFACE_KINDS` (`collision.layout`), and its definition in
`scene`.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

from carom._compiled.by_number import by_number
from carom.collision.layout import SURFACE_KINDS

_FILES = [import_module(f"{__name__}.{kind}") for kind in SURFACE_KINDS]


def by_ground(common: Callable) -> Any:
    """Decorate the common form of an operation; the result calls the own form of a kind where it has one."""
    own = [getattr(file, common.__name__, None) for file in _FILES]
    return by_number("surface.kind", common, own)
