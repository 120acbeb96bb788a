"""Values of frozen records, with read-only arrays."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np

from carom import arguments, checks

T = TypeVar("T")

#: decorator of a scene and its parts: the end of the message about an attribute that cannot be set
in_scene = arguments.attributes(
    "values of a scene and of its parts cannot be changed; make a new scene, or vary them from run to run by "
    "carom.ensemble(scene, duration, vary=...)"
)


def keep(record, **fields) -> None:
    """Set `fields` of a frozen `record` while it is made; arrays become read-only."""
    for name, value in fields.items():
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        object.__setattr__(record, name, value)


def point(name: str, value) -> np.ndarray:
    """Return `value` as a point or vector (3,)."""
    return checks.finite_array(name, value, (3,))


def apart(anchor_parent, anchor_child) -> tuple[np.ndarray, np.ndarray, float]:
    """Return two points (3,) and their distance [m], 0 if they are equal."""
    start, end = point("anchor_parent", anchor_parent), point("anchor_child", anchor_child)
    distance = math.dist(start, end)
    return start, end, checks.number("the distance of anchor_parent and anchor_child", distance)


def optional_point(name: str, value) -> np.ndarray | None:
    """Return `value` as a point (3,), or None."""
    return None if value is None else point(name, value)


def subclasses_in(names: dict, base: type[T]) -> tuple[type[T], ...]:
    """Return the subclasses of `base` among the names of a module, in the order of their definition."""
    found = (one for one in names.values() if isinstance(one, type) and issubclass(one, base))
    return tuple(one for one in found if one is not base)
