"""Modes of flexible bodies: of beams, plates and solids, or from matrices and files of other programs.

`carom.Modes` is what all of them make, and what `Scene.add_body` takes as ``modes=``.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from carom.hints import ending

if TYPE_CHECKING:
    from carom.flexible.beams import beam
    from carom.flexible.modes import Modes
    from carom.flexible.plates import plate
    from carom.flexible.sections import Circle, Rectangle, Tube
    from carom.flexible.solids import solid

__all__ = ["Circle", "Modes", "Rectangle", "Tube", "beam", "plate", "solid"]

_LAZY = {
    "Circle": "carom.flexible.sections",
    "Modes": "carom.flexible.modes",
    "Rectangle": "carom.flexible.sections",
    "Tube": "carom.flexible.sections",
    "beam": "carom.flexible.beams",
    "plate": "carom.flexible.plates",
    "solid": "carom.flexible.solids",
}


def __getattr__(name: str):
    if name in _LAZY:
        return getattr(importlib.import_module(_LAZY[name]), name)
    hint = ending("carom.flexible", name, __all__) if name[:1] != "_" else ""
    raise AttributeError(f"module 'carom.flexible' has no attribute {name!r}{hint}")


def __dir__() -> list[str]:
    return __all__
