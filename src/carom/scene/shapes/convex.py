"""`Convex`: the solid convex hull of points; volume, centroid and inertia by tetrahedra."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import keep
from carom.scene.moments import about_centroid, of_swollen
from carom.scene.pieces import Piece, Shape

FLAT = 1e-10  # thickness relative to the largest extent below which points count as coplanar
SAME_FACE = 1e-8  # sine of the angle between triangles that are one face: rounding, not shape


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Convex(Shape):
    """The solid convex hull of points, rounded by a ball if a radius is given.

    The shape is moved so that its centroid becomes the origin of the body, because the `position` of a body is
    its mass centre: a point with the coordinates ``p`` here is at ``p - centroid`` in body axes.

    Parameters
    ----------
    points : (n, 3)
        At least four points that are not in one plane [m], in any order. Points inside the hull are dropped.
    radius
        Radius of the ball [m], at least 0. Default 0: a hull with sharp edges. The solid extends beyond the
        hull of the points by this radius on all sides.

    Attributes
    ----------
    points : (m, 3)
        The vertices of the hull, as given [m].
    centroid : (3,)
        Centroid of the solid, in the axes of `points` [m].
    vertices : (m, 3)
        The vertices in body axes, ``points - centroid`` [m].
    faces : tuple of (normal, ring)
        Outward unit normals (3,) and the indices of their vertices, counter-clockwise from outside.
    radius
        Radius of the ball [m].
    volume
        Volume [m^3].
    size
        Largest distance of a point of the solid from the centroid [m].

    Raises
    ------
    ValueError
        If there are fewer than four points, all lie in one plane, or the radius is negative.
    """

    points: np.ndarray
    radius: float
    centroid: np.ndarray
    faces: tuple
    volume: float
    size: float
    _vertices: np.ndarray
    _spread: np.ndarray  # integral of x x^T over the solid, by volume [m^2]

    def __init__(self, points: ArrayLike, radius: float = 0.0):
        given = checks.finite_array("points", points, (None, 3), unit="m")
        radius = checks.length("radius", radius, zero=True)
        corners, simplices = hull_of(given)

        def integrals(origin):
            return of_swollen(corners - origin, simplices, radius)

        volume, centroid, second = about_centroid(integrals, corners)
        vertices = corners - centroid
        size = float(np.max(np.linalg.norm(vertices, axis=1))) + radius
        keep(self, points=corners, radius=radius, centroid=centroid, _vertices=vertices)
        keep(self, volume=volume, size=size, _spread=second / volume)
        keep(self, faces=_faces(vertices, simplices))

    def __repr__(self) -> str:
        radius = f", radius={self.radius!r}" if self.radius else ""
        return f"Convex(<{len(self.points)} vertices>{radius})"

    @property
    def vertices(self) -> np.ndarray:
        """Vertices in body axes (m,3) [m]."""
        return self._vertices

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: a hull, rounded by the ball."""
        half = np.max(np.abs(self.vertices), axis=0)
        touching = {"vertices": self.vertices, "faces": self.faces}
        return (Piece("hull", half, self.radius, extent=self.size, **touching),)

    def _inertia(self, mass: float) -> np.ndarray:
        return mass * (np.trace(self._spread) * np.eye(3) - self._spread)


def hull_of(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (m,3) of the hull and its outward triangles (k,3), as numbers of vertices."""
    if len(points) < 4:
        raise ValueError(f"points must be at least 4 to enclose a volume, got {len(points)}")
    checks.length("the greatest coordinate of points", np.max(np.abs(points)), zero=True)
    middle = points.mean(axis=0)
    extents = np.linalg.svd(points - middle, compute_uv=False)
    if not extents[2] > FLAT * extents[0]:
        raise ValueError(
            f"points must not all lie in one plane, got {len(points)} points with a thickness of "
            f"{extents[2]:.3g} m and a length of {extents[0]:.3g} m"
        )
    from scipy.spatial import ConvexHull

    hull = ConvexHull((points - middle) / extents[0])
    number = np.full(len(points), -1)
    number[hull.vertices] = np.arange(len(hull.vertices))
    simplices = hull.simplices.copy()
    triangles = points[simplices]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    inward = np.sum(normals * hull.equations[:, :3], axis=1) < 0
    simplices[inward] = simplices[inward][:, ::-1]
    return points[hull.vertices], number[simplices]


def _faces(vertices: np.ndarray, simplices: np.ndarray) -> tuple:
    """Return the faces: triangles with a common edge and plane form one face, its corners in a ring."""
    triangles = vertices[simplices]
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    group = _planes(simplices, cross)
    order = np.argsort(group, kind="stable")
    first = np.flatnonzero(np.diff(group[order], prepend=-1))
    # the ring of a triangle has its least corner in the middle
    turn = np.argmin(simplices, axis=1)[:, None]
    rings = np.take_along_axis(simplices, (turn + np.array([2, 0, 1])) % 3, axis=1).tolist()
    faces = []
    for start, stop in zip(first.tolist(), [*first[1:].tolist(), len(order)]):
        t = order[start]
        if stop == start + 1:
            normal, ring = cross[t] / math.sqrt(cross[t].dot(cross[t])), tuple(rings[t])
        else:
            normal, ring = _ring(vertices, simplices, cross, order[start:stop])
        normal.setflags(write=False)
        faces.append((normal, ring))
    return tuple(faces)


def _planes(simplices: np.ndarray, cross: np.ndarray) -> np.ndarray:
    """Return a number (k,) for each triangle, equal for those of one face: neighbours in one plane."""
    edges = np.stack([simplices, np.roll(simplices, -1, axis=1)], axis=-1).reshape(-1, 2)
    i, j = edges.T
    n = simplices.max() + 1
    here, there = np.lexsort((j, i)), np.lexsort((i, j))  # the same edges, seen from both triangles
    assert np.array_equal(i[here] * n + j[here], j[there] * n + i[there])
    other = np.empty(len(edges), dtype=np.int64)
    other[here] = there // 3
    own = np.arange(len(edges)) // 3
    double = np.linalg.norm(cross, axis=1)
    a, b = cross[own], cross[other]
    sine = np.linalg.norm(np.cross(a, b), axis=1)
    bent = sine > SAME_FACE * double[own] * double[other]
    level = (i < j) & ~bent & (np.sum(a * b, axis=1) >= 0.0)
    group = np.arange(len(simplices))
    for f, g in zip(own[level], other[level]):
        group[group == group[g]] = group[f]
    return group


def _ring(vertices, simplices, cross, chosen) -> tuple[np.ndarray, tuple[int, ...]]:
    """Return the normal of a face of several triangles, and its corners, counter-clockwise from outside."""
    normal = cross[chosen].sum(axis=0)
    normal /= np.linalg.norm(normal)
    corners = np.unique(simplices[chosen])
    offsets = vertices[corners] - vertices[corners].mean(axis=0)
    across = offsets[0] - (offsets[0] @ normal) * normal
    angle = np.arctan2(offsets @ np.cross(normal, across), offsets @ across)
    return normal, tuple(int(i) for i in corners[np.argsort(angle)])
