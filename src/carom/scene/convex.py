"""The solid convex hull of points: volume, centroid and inertia by tetrahedra."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from carom import check
from carom.scene.values import keep

FLAT = 1e-10  # thickness relative to the largest extent below which points count as coplanar


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Convex:
    """The solid convex hull of points.

    The shape is moved so that its centroid becomes the origin of the body: the `position` of a body
    is its mass centre. A point given here as ``p`` is at ``p - centroid`` in body axes.

    Parameters
    ----------
    points : (n, 3)
        At least four points that are not in one plane [m], in any order; the ones inside the hull
        are dropped.

    Attributes
    ----------
    points : (m, 3)
        The vertices of the hull, as they were given [m].
    centroid : (3,)
        Of the solid hull, in the axes in which the points were given [m].
    vertices : (m, 3)
        ``points - centroid``: in body axes [m].
    volume
        [m^3].
    size
        Largest distance of a vertex from the centroid [m].

    Raises
    ------
    ValueError
        If there are fewer than four points, or all lie in one plane.
    """

    points: np.ndarray
    centroid: np.ndarray
    vertices: np.ndarray
    volume: float
    size: float
    _spread: np.ndarray  # integral of x x^T over the hull, by volume [m^2]
    radius: ClassVar[float] = 0.0

    def __init__(self, points: ArrayLike):
        given = check.finite_array("points", points, (None, 3), unit="m")
        corners, triangles = _hull(given)
        volume, centroid, second = _moments(corners, triangles)
        vertices = corners - centroid
        size = float(np.max(np.linalg.norm(vertices, axis=1)))
        keep(self, points=corners, centroid=centroid, vertices=vertices, volume=volume, size=size)
        keep(self, _spread=0.5 * (second + second.T) / volume)

    def __repr__(self) -> str:
        return f"Convex(<{len(self.points)} vertices>)"

    def inertia(self, mass: float) -> np.ndarray:
        """Return the inertia (3,3) [kg m^2] about the centroid, for a `mass` [kg]."""
        return mass * (np.trace(self._spread) * np.eye(3) - self._spread)


def _hull(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (m,3) of the hull and its triangles (k,3,3), oriented outwards."""
    if len(points) < 4:
        raise ValueError(f"points must be at least 4 to enclose a volume, got {len(points)}")
    middle = points.mean(axis=0)
    extents = np.linalg.svd(points - middle, compute_uv=False)
    if not extents[2] > FLAT * extents[0]:
        raise ValueError(
            f"points must not all lie in one plane, got {len(points)} points that have a spread of "
            f"{extents[2]:.3g} across one, {extents[0]:.3g} along it [m]"
        )
    from scipy.spatial import ConvexHull

    hull = ConvexHull((points - middle) / extents[0])
    triangles = points[hull.simplices]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    inward = np.sum(normals * hull.equations[:, :3], axis=1) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return points[hull.vertices], triangles


def _moments(corners: np.ndarray, triangles: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Return volume, centroid (3,), and integral of x x^T (3,3) about it, of the solid."""
    apex = corners.mean(axis=0)
    volume, first, second = _tetrahedra(triangles - apex)
    centroid = apex + first / volume
    # Once more about the centroid: no cancellation of a parallel-axis term.
    volume, _, second = _tetrahedra(triangles - centroid)
    return volume, centroid, second


def _tetrahedra(triangles: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Return the integrals of 1, x, x x^T over the tetrahedra between 0 and `triangles`.

    For one of volume V with corners 0, a, b, c and sum s = a + b + c: V, V s / 4 and
    V (a a^T + b b^T + c c^T + s s^T) / 20.
    """
    volumes = np.linalg.det(triangles) / 6
    sums = triangles.sum(axis=1)
    four = np.concatenate([triangles, sums[:, None]], axis=1)
    second = np.einsum("t,tki,tkj->ij", volumes, four, four) / 20
    return float(volumes.sum()), volumes @ sums / 4, second
