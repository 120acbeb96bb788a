"""What a joint says of itself: from it follow its rows, its coordinates and its place among the kinds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.geometry.frames import triad

#: how many rows hold the child's anchor in place, and how many its turn
ACTIVE_POINT = {"point": 3, "line": 2, "plane": 1}
TURNS = {"ball": 0, "cross": 1, "axis": 2, "rigid": 3}


@dataclass(frozen=True, init=False, eq=False)
class JointDefinition:
    """A joint of a scene. Its own direction is its `axis`, `normal` or `direction`, fixed in the parent.

    Attributes
    ----------
    guide : {"point", "line", "plane", "own"}
        Where the anchor of the child may be in the parent: at its anchor, on the line through it along the own
        direction, in the plane through it across that; or what equations of the joint's own say.
    turn : {"ball", "axis", "rigid", "cross", "own"}
        How the child may turn against the parent: freely, about the own direction, not, about two crossed axes
        (`Universal`); or what equations of the joint's own say.
    coordinates : tuple of {"turn", "slide"}
        What is measured: angles [rad] about and ways [m] along axes of `coordinate_frame`.
    rows : int
        Constraint rows; by default those of `guide` and `turn`.
    nonholonomic : int
        How many of them restrict velocities only.
    in_trees : bool
        Whether the joint carries its child in a tree; else it is solved as a closed loop is.
    """

    guide: ClassVar[str]
    turn: ClassVar[str]
    coordinates: ClassVar[tuple[str, ...]] = ()
    rows: ClassVar[int]
    nonholonomic: ClassVar[int] = 0
    in_trees: ClassVar[bool] = True

    def __init_subclass__(cls):
        if "rows" not in vars(cls):
            cls.rows = ACTIVE_POINT[cls.guide] + TURNS[cls.turn]

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return the axes (3, 3) of the joint as columns, in the world at the start: first its own direction.

        Where it is `flipped` a tree is walked from the child to the parent.
        """
        for name in ("axis", "normal", "direction"):
            if hasattr(self, name):
                return triad(getattr(self, name))
        return np.eye(3)

    def anchors(self, anchor: np.ndarray, child: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the points (3,) of parent and child in the world; `child` is the place of its mass centre."""
        return anchor, anchor

    def scale(self) -> float:
        """Return the length [m] that kernels know as `length`."""
        return 0.0

    def coordinate_frame(self, coordinate: int) -> np.ndarray:
        """Return the axes (3, 3) of a coordinate as columns: first that along or about which it is."""
        frame = self.frame()
        if self.guide == "plane" and self.coordinates[coordinate] == "slide":
            return triad(frame[:, 1 + coordinate])
        return frame
