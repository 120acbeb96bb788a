"""What differs between the kinds of coordinates of joints: a file each, composed by number.

The file of a kind has a function of the name of each operation in `carom.kinematics.coordinate` that is not
that of an angle about an axis. A new kind is a file here, its word in `LIMITED` (`model.arrays`), and the joint
that states it.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

from carom._compiled.by_number import by_number
from carom._compiled.decorators import inlined
from carom.kinematics.coordinates import on_curve, slide
from carom.model.arrays import LIMITED, OF_LIMIT, ON_CURVE, PRISMATIC

_FILES = {PRISMATIC: slide} | dict.fromkeys(ON_CURVE, on_curve)
_FILES |= {OF_LIMIT[word]: import_module(f"{__name__}.{file}") for word, file in LIMITED.items()}


def by_coordinate(angle: Callable) -> Any:
    """Decorate the form of an operation for angles; the result calls that of the kind of a coordinate c."""
    own = [getattr(_FILES.get(k), angle.__name__, None) for k in range(1 + max(_FILES))]
    return by_number("c.kind", angle, own, inlined)
