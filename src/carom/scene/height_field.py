"""Terrain: the C2 bicubic spline through an array of heights."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import keep
from carom.scene.surface_definition import SurfaceDefinition

BEYOND = 8  # spacings over which the slope goes on beyond the grid


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class HeightField(SurfaceDefinition):
    """A surface z = h(x, y) through an array of heights, with free space above it.

    h is the bicubic spline with continuous second derivatives. Beyond the grid it goes on with the slope of the
    border, levels out over eight spacings, and is level from there on, so that nothing falls off.

    Parameters
    ----------
    heights : (n, m)
        Heights [m] at n places along x and m places along y, at least 2 each.
    spacing : float or (2,)
        Distance of two places [m], along x and y.
    corner : (2,), optional
        x and y of ``heights[0, 0]`` [m]. Default: the middle of the grid is at 0.

    Attributes
    ----------
    heights, spacing, corner
        As above, as arrays.

    Raises
    ------
    ValueError
        If heights are not finite or a spacing is not above 0.

    Notes
    -----
    The spline overshoots where heights jump, as at stairs; static boxes are better for those. It is "not a
    knot" at the border, so that it is exact for polynomials of degree 3 in x and y.

    A body must be rounded by less than the smallest radius of curvature of valleys (`bend` is a bound of its
    inverse), because it would touch them in two places: others are refused. For a rough terrain take more
    spacing, smooth the heights, or a body with corners.

    Examples
    --------
    >>> x = np.linspace(-1, 1, 21)
    >>> bowl = carom.surfaces.HeightField(0.5 * (x[:, None] ** 2 + x**2), spacing=0.1)
    >>> round(float(bowl.height(0.12, 0.34)), 9)
    0.065
    """

    heights: np.ndarray
    spacing: np.ndarray
    corner: np.ndarray

    def __init__(
        self, heights: ArrayLike, spacing: float | ArrayLike, corner: ArrayLike | None = None
    ):
        heights = checks.finite_array("heights", heights, (None, None), "m")
        if min(heights.shape) < 2:
            raise ValueError(
                f"heights must be at least 2 along x and y, got an array of shape {heights.shape}"
            )
        wide = checks.real_array("spacing", spacing, "() or (2,)")
        if wide.shape not in ((), (2,)):
            raise ValueError(f"spacing must be a length or two [m], got shape {wide.shape}")
        wide = np.array([checks.length("spacing", one) for one in np.broadcast_to(wide, 2)])
        if corner is None:
            corner = -0.5 * wide * (np.array(heights.shape) - 1)
        corner = checks.finite_array("corner", corner, (2,), "m")
        keep(self, heights=heights, spacing=wide, corner=corner)

    def __repr__(self) -> str:
        (n, m), (low, high) = self.heights.shape, (self.heights.min(), self.heights.max())
        return (
            f"HeightField({n} x {m} places, spacing={self.spacing}, heights {low:g} to {high:g} m)"
        )

    kind = "height_field"

    @property
    def lengths(self) -> tuple[float, ...]:
        """The bound of its hollow curvatures [1/m]."""
        return (self.bend,)

    @property
    def size(self) -> float:
        """A length of the surface [m]: half the diagonal of its grid."""
        return 0.5 * float(np.linalg.norm(self.spacing * (np.array(self.heights.shape) - 1)))

    @cached_property
    def coefficients(self) -> np.ndarray:
        """Coefficients of the B-splines on uniform knots, also of those beyond the grid."""
        return _coefficients(_coefficients(self.heights).T).T

    @property
    def numbers(self) -> np.ndarray:
        """The coefficients, row by row."""
        return self.coefficients.ravel()

    def write(self, row) -> None:
        """Write the grid of all cells, also beyond the heights, to a row of kernels."""
        row.count[:] = np.array(self.coefficients.shape) - 3
        row.corner[:], row.spacing[:] = self.corner - BEYOND * self.spacing, self.spacing

    def height(self, x: ArrayLike, y: ArrayLike) -> np.ndarray:
        """Return the heights h(x, y) (...) [m] at places x, y (...) [m] in axes of the surface."""
        given = np.broadcast_arrays(*(checks.real_array(k, v, "any") for k, v in zip("xy", (x, y))))
        weights = []
        for name, values, at, step, n in zip(
            "xy", given, self.corner, self.spacing, self.coefficients.shape
        ):
            if not np.all(np.isfinite(values)):
                raise ValueError(f"{name} must be finite, got {checks.shown(values)}")
            u = np.clip((values - at) / step + BEYOND, -3.0, n)
            k = np.floor(u).astype(int)
            t = u - k
            w = (1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, 1 + 3 * t * (1 + t - t**2), t**3
            weights.append([(np.clip(k + a, 0, n - 1), w[a] / 6.0) for a in range(4)])
        parts = [w * v * self.coefficients[i, j] for i, w in weights[0] for j, v in weights[1]]
        return np.sum(parts, axis=0)

    @cached_property
    def steepest(self) -> float:
        """Greatest length of the gradient of z - h, from the coefficients."""
        slopes = [np.abs(np.diff(self.coefficients, axis=k)).max() for k in (0, 1)]
        return float(np.linalg.norm([1.0, *(slopes / self.spacing)]))

    @cached_property
    def bend(self) -> float:
        """Greatest curvature of valleys [1/m], or a bound of it.

        Second derivatives are splines too, so that they lie between their coefficients in each cell.
        """
        c, (dx, dy) = self.coefficients, self.spacing
        a = sliding_window_view(np.diff(c, 2, axis=0) / dx**2, (2, 4)).max(axis=(2, 3))
        b = sliding_window_view(np.diff(np.diff(c, axis=0), axis=1) / (dx * dy), (3, 3))
        d = sliding_window_view(np.diff(c, 2, axis=1) / dy**2, (4, 2)).max(axis=(2, 3))
        # the larger eigenvalue of [[a, b], [b, d]]
        valley = 0.5 * (a + d) + np.hypot(0.5 * (a - d), np.abs(b).max(axis=(2, 3)))
        return max(float(valley.max()), 0.0)


def _coefficients(values: np.ndarray) -> np.ndarray:
    """Return the coefficients along the first axis: cubic splines that are "not a knot" at both ends."""
    from scipy.interpolate import CubicSpline, make_interp_spline

    n = len(values)
    slope = CubicSpline(np.arange(n), values)(np.array([0.0, n - 1.0]), 1)
    knots = np.arange(-3.0, n + 3.0)
    c = make_interp_spline(np.arange(n), values, 3, knots, ([(1, slope[0])], [(1, slope[1])])).c
    # the steps from one coefficient to the next become evenly smaller, down to 0
    fall = np.cumsum(1.0 - np.arange(1, BEYOND + 1) / BEYOND)[:, None]
    before, after = c[0] + fall * (c[0] - c[1]), c[-1] + fall * (c[-1] - c[-2])
    return np.concatenate([before[::-1], c, after])
