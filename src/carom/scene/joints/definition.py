"""`JointDefinition`: the base class of all joints, which gives their constraint rows and coordinates."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.geometry.frames import triad

#: number of rows that constrain the anchor of the child, and number of rows that constrain its rotation
ACTIVE_POINT = {"point": 3, "line": 2, "plane": 1, "curve": 2}
TURNS = {"ball": 0, "cross": 1, "axis": 2, "rigid": 3}


@dataclass(frozen=True, init=False, eq=False)
class JointDefinition:
    """Base class of all joints.

    The direction of a joint is its `axis`, `normal` or `direction`, fixed in the parent.

    Attributes
    ----------
    guide : {"point", "line", "plane", "curve", "own"}
        Allowed positions of the anchor of the child in the parent: the anchor of the parent ("point"), the line
        through it along the direction of the joint ("line"), the plane through it perpendicular to the
        direction ("plane"), a curve (`carom.scene.joints.on_curve`, "curve"), or positions given by special
        equations of the joint ("own").
    turn : {"ball", "axis", "rigid", "cross", "own"}
        Allowed rotations of the child relative to the parent: all ("ball"), about the direction of the joint
        ("axis"), none ("rigid"), about two perpendicular axes (`Universal`, "cross"), or rotations given by
        special equations of the joint ("own").
    coordinates : tuple of {"turn", "slide"}
        Coordinates of the joint: angles [rad] about ("turn") and displacements [m] along ("slide") the axes of
        `coordinate_frame`.
    measured : tuple of {"turn", "slide"}
        Kinds of the numbers that results have: those of `coordinates`, but for joints along whose coordinates
        nothing acts.
    limits : dict of str to {"turn", "slide"}
        Angles [rad] and lengths [m] beside the coordinates that stops can limit (`Spherical`).
    rows : int
        Number of constraint rows; by default those of `guide` and `turn`.
    nonholonomic : int
        Number of rows that restrict only velocities.
    in_trees : bool
        Whether the joint can be a branch of a kinematic tree; if not, it is solved like a closed loop.
    """

    guide: ClassVar[str]
    turn: ClassVar[str]
    coordinates: ClassVar[tuple[str, ...]] = ()
    measured: ClassVar[tuple[str, ...]] = ()
    limits: ClassVar[dict[str, str]] = {}
    rows: ClassVar[int]
    nonholonomic: ClassVar[int] = 0
    in_trees: ClassVar[bool] = True

    def __init_subclass__(cls):
        if "rows" not in vars(cls):
            cls.rows = ACTIVE_POINT[cls.guide] + TURNS[cls.turn]
        if "measured" not in vars(cls):
            cls.measured = cls.coordinates

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return the axes (3, 3) of the joint as columns, in the world at the start, its direction first.

        `flipped` means that the kinematic tree goes from the child to the parent.
        """
        for name in ("axis", "normal", "direction"):
            if hasattr(self, name):
                return triad(getattr(self, name))
        return np.eye(3)

    def frames_of_limits(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the axes (3, 3) of `limits` in the parent and in the child, as columns."""
        return self.frame(), self.frame()

    def anchors(self, anchor: np.ndarray, child: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the anchors (3,) of parent and child in the world; `child` is the child's mass centre (3,)."""
        return anchor, anchor

    def scale(self) -> float:
        """Return the length [m] of the joint, `length` in the kernels."""
        return 0.0

    def period(self, coordinate: int) -> float:
        """Return the change of a coordinate after which all is as before: a turn [rad]; 0 for none."""
        return 2.0 * math.pi if self.coordinates[coordinate] == "turn" else 0.0

    def coordinate_frame(self, coordinate: int) -> np.ndarray:
        """Return the axes (3, 3) of a coordinate as columns; the coordinate is along or about the first."""
        frame = self.frame()
        if self.guide == "plane" and self.coordinates[coordinate] == "slide":
            return triad(frame[:, 1 + coordinate])
        return frame
