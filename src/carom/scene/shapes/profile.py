"""`Profile`: a prism over a plane closed curve, convex or not: cams, ratchets, Geneva wheels."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import keep
from carom.scene.outline import Outline, around, through
from carom.scene.pieces import Piece, Shape

SAMPLED = 1.05  # the greatest curvature by that of the samples of a piece


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Profile(Shape):
    """A solid of constant thickness over a plane closed curve, convex or not: a cam, a ratchet, a Geneva wheel.

    The curve lies in the plane of x and y; the solid extends by half the thickness to both sides of it. The
    shape is moved so that its centroid becomes the origin of the body: a point with the coordinates ``p`` here
    is at ``p - centroid`` in body axes.

    It touches half-spaces, boxes and convex prisms with faces across its plane, and cylinders, discs, capsules
    and other profiles with parallel axes, along its thickness; and spheres anywhere. The flat sides of the
    prism touch spheres only. Other pairs are refused.

    Parameters
    ----------
    outline : (n, 2) or callable
        Points [m] through which a closed cubic spline goes, at least 3, the first of which is not repeated at
        the end. Or a function of the angle from 0 to 2 pi [rad], periodic with continuous curvature, that
        returns the distance from the axis [m] at this angle, or a point (2,) [m].
    thickness
        Thickness along z [m], above 0.
    corners : sequence of int or "all"
        Which of the points are corners, by number; "all": the curve is a polygon. Between two corners is a
        spline, or a straight line if there is no other point. Default: none.

    Attributes
    ----------
    thickness
        Thickness [m].
    length
        Length of the curve [m].
    centroid : (3,)
        Centroid of the solid, in the axes of `outline` [m].
    volume
        Volume [m^3].
    size
        Largest distance of a point of the shape from the centroid [m].

    Raises
    ------
    ValueError
        If the curve crosses itself or is not smooth between its corners.

    Notes
    -----
    A table of the curve by arc length is within 1e-12 of its size; area, centroid and inertia are exact
    integrals along the boundary of the table.

    Examples
    --------
    An eccentric disc as a function of the angle, and a ratchet of eight teeth:

    >>> import math
    >>> disc = carom.Profile(lambda a: (0.02 + 0.05 * math.cos(a), 0.05 * math.sin(a)), thickness=0.01)
    >>> round(float(disc.centroid[0]), 9), round(disc.length / math.pi, 9)
    (0.02, 0.1)
    >>> turn = [0.25 * math.pi * k for k in range(8)]
    >>> teeth = [(r * math.cos(a), r * math.sin(a)) for a in turn for r in (0.04, 0.05)]
    >>> carom.Profile(teeth, thickness=0.01, corners="all")
    Profile(<16 corners>, thickness=0.01)
    """

    thickness: float
    centroid: np.ndarray
    volume: float
    size: float
    rows: np.ndarray  # of `carom.scene.outline`, in body axes
    _spread: np.ndarray  # integral of x x^T over the solid, by volume [m^2]

    def __init__(
        self,
        outline: ArrayLike | Callable,
        thickness: float,
        corners: Sequence[int] | str = (),
    ):
        thickness = checks.length("thickness", thickness)
        if callable(outline):
            if not isinstance(corners, tuple) or corners:
                raise ValueError(
                    "corners must be left out where outline is a function, got "
                    f"{checks.shown(corners)}; give points for a curve with corners"
                )
            curve = around(outline)
        else:
            curve = through(outline, corners)
        self._keep(curve, thickness)

    def _keep(self, curve: Outline, thickness: float) -> None:
        """Keep a curve, moved to its centroid, and its moments."""
        area, middle, second = curve.moments()
        rows, half = curve.rows, 0.5 * thickness
        rows[:, 1:3] -= middle
        far = np.max(np.linalg.norm(curve.peaks(np.zeros(2), 1.0), axis=1), initial=0.0)
        far = max(far, np.max(np.linalg.norm(rows[:, 1:3], axis=1)))
        spread = np.diag([0.0, 0.0, half**2 / 3.0])
        spread[:2, :2] = second
        keep(self, thickness=thickness, rows=rows, centroid=np.array([*middle, 0.0]))
        keep(self, volume=area * thickness, size=math.hypot(far, half), _spread=spread)

    @classmethod
    def involute(
        cls,
        teeth: int,
        module: float,
        thickness: float,
        *,
        pressure_angle: float = math.radians(20.0),
        backlash: float = 0.0,
        shift: float = 0.0,
        addendum: float = 1.0,
        dedendum: float = 1.25,
    ) -> Profile:
        """Return a spur gear with involute teeth, the middle of one of them on the axis x.

        Two gears of one module and pressure angle mesh at the distance ``module (teeth_1 + teeth_2)/2``, and
        have the ratio of their teeth exactly, also at a distance that is somewhat larger. Below the base circle
        flanks are radial, and there is no undercut, so gears of few teeth (below 17 for 20 degrees) may touch
        the feet of each other.

        Parameters
        ----------
        teeth : int
            Number of teeth, 4 to 500.
        module : float
            Diameter of the pitch circle divided by the number of teeth [m].
        thickness : float
            Thickness along z [m].
        pressure_angle : float
            Angle between the line of action and the common tangent of the pitch circles [rad], below pi/4.
            Default 20 degrees.
        backlash : float
            Play of two such gears on the pitch circle [m], half of which is taken from the teeth of each.
            Default 0: both flanks of a tooth touch.
        shift : float
            Profile shift by the module. Default 0.
        addendum, dedendum : float
            Heights of a tooth above, and depth of a gap below the pitch circle by the module. Default 1 and
            1.25.

        Raises
        ------
        ValueError
            If a value is invalid, or teeth are pointed or leave no gaps.

        Examples
        --------
        >>> wheel = carom.Profile.involute(20, module=0.002, thickness=0.01, backlash=1e-4)
        >>> round(wheel.size, 4), len(wheel.rows) > 400
        (0.0226, True)
        """
        from carom.scene.involute import gear, outline_of

        teeth = checks.integer("teeth", teeth, least=4, most=500)
        module = checks.length("module", module)
        thickness = checks.length("thickness", thickness)
        angle = checks.number(
            "pressure_angle", pressure_angle, above=0.0, below=0.25 * math.pi, unit="rad"
        )
        backlash = checks.number("backlash", backlash, least=0.0, below=module, unit="m")
        shift = checks.number("shift", shift, least=-1.0, most=1.0)
        heights = tuple(
            checks.number(name, value, above=0.0, most=2.0)
            for name, value in (("addendum", addendum), ("dedendum", dedendum))
        )
        made = object.__new__(cls)
        made._keep(outline_of(gear(teeth, module, angle, backlash, shift, heights)), thickness)
        return made

    def __repr__(self) -> str:
        count = int(np.sum(np.diff(self.rows[:, 0]) == 0.0))
        of = f"<{count} corners>" if count else f"<length {self.length:g} m>"
        return f"Profile({of}, thickness={self.thickness!r})"

    @cached_property
    def _curve(self) -> Outline:
        return Outline(self.rows)

    @property
    def length(self) -> float:
        """Length of the curve [m]."""
        return self._curve.length

    def points(self, count: int = 128) -> np.ndarray:
        """Return points (K, 2) of the curve in body axes [m], counter-clockwise: about `count`, and corners."""
        return self._curve.polygon(checks.integer("count", count, least=3))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: the prism, which is not convex."""
        half = np.array([np.max(np.abs(self.rows[:, k])) for k in (1, 2)] + [0.5 * self.thickness])
        of_curve: dict[str, Any] = {"outline": self.rows, "hollows": self._curve.hollows()}
        bend = self._curve.bends()[1]
        most = SAMPLED * max(0.0, -float(np.min(bend[np.isfinite(bend)], initial=0.0)))
        return (Piece("profile", half, extent=self.size, bend=most, **of_curve),)

    def _inertia(self, mass: float) -> np.ndarray:
        return mass * (np.trace(self._spread) * np.eye(3) - self._spread)
