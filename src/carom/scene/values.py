"""What the records of a scene have in common."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from carom import arguments, checks

if TYPE_CHECKING:
    from carom.scene.registry import Registry

T = TypeVar("T")

#: decorator of a scene and its parts: the end of the message about an attribute that cannot be set
in_scene = arguments.attributes(
    "parts are read-only: scene.replace(name, ...) puts a part with other values in their place, and "
    "carom.ensemble(scene, duration, vary=...) varies them from run to run"
)


class MethodsOfScene:
    """Base class of the methods of `Scene` for one kind of part, which stand beside that kind."""

    if TYPE_CHECKING:
        _parts: Registry


@dataclass(frozen=True, eq=False, repr=False)
class PartOfScene:
    """A part of a scene, which a method of `Scene` makes.

    Attributes
    ----------
    index : int
        Its index among the parts of its kind, as in `Scene.bodies` or `Scene.joints`.
    name : str
    """

    index: int
    name: str


def shown(vector) -> str:
    """Return a vector in a message."""
    return f"({', '.join(f'{x:g}' for x in vector)})"


def apart(record, hint: str = "") -> float:
    """Return the distance [m] of both anchors of a definition; refuse equal ones, between which is no line."""
    distance = math.dist(record.anchor_parent, record.anchor_child)
    if not distance > 0.0:
        same = shown(record.anchor_child)
        raise ValueError(f"anchor_child must differ from anchor_parent, got {same} for both{hint}")
    return checks.number("the distance of anchor_parent and anchor_child", distance)


def subclasses_in(names: dict, base: type[T]) -> tuple[type[T], ...]:
    """Return the subclasses of `base` among the names of a module, in the order of their definition."""
    found = (one for one in names.values() if isinstance(one, type) and issubclass(one, base))
    return tuple(one for one in found if one is not base)
