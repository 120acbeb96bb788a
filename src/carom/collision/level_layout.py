"""Records of level surfaces (`carom.collision.level_surface`)."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table

SURFACE = [
    ("normal", "f8", 3),
    ("offset", "f8"),  # n . q of its points
    ("tolerance", "f8"),  # two heights, and two edges, that differ by less are equal [m]
    ("first", "i8"),  # range of the faces
    ("last", "i8"),
    ("first_rim", "i8"),  # range of the segments of the rim
    ("last_rim", "i8"),
]

LEVEL_FACE = [
    ("centre", "f8", 3),  # of a ball around it
    ("reach", "f8"),
    ("thickness", "f8"),  # of its solid below it
    ("solid", "i8"),  # whose face it is
    ("first_own", "i8"),  # range of the surfaces of this solid in `Levels.own`
    ("last_own", "i8"),
    ("first", "i8"),  # range of the sides
    ("last", "i8"),
]

LEVEL_SIDE = [
    ("inward", "f8", 3),  # m
    ("level", "f8"),  # d
    ("corner", "f8", 3),  # at which it begins
]

RIM_SEGMENT = [("begin", "f8", 3), ("end", "f8", 3)]


class Levels(NamedTuple):
    """All level surfaces of a scene, of static solids in the world, of others in the axes of their body."""

    surfaces: np.recarray  # (S,) SURFACE
    faces: np.recarray  # (F,) LEVEL_FACE
    sides: np.recarray  # (K,) LEVEL_SIDE
    rims: np.recarray  # (E,) RIM_SEGMENT
    own: np.ndarray  # (O,) surfaces of which a solid has faces, solid by solid
    solid_of_own: np.ndarray  # (O,) these solids


@cache
def no_levels() -> Levels:
    """Return the level surfaces of a scene that has none."""
    kinds = SURFACE, LEVEL_FACE, LEVEL_SIDE, RIM_SEGMENT
    none = np.zeros(0, dtype=np.int64)
    return Levels._make([*(table(kind, 0) for kind in kinds), none, none.copy()])
