"""Surfaces of shapes as triangles, for drawing."""

from __future__ import annotations

import math

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.scene.pieces import SIGNS, Piece
from carom.scene.shapes import SHAPES, Box
from carom.scene.shapes.compound import Compound
from carom.scene.shapes.mesh import Mesh
from carom.scene.shapes.profile import Profile
from carom.scene.shapes.revolved import Disc

#: kinds of pieces without edges or corners that turn with them
ROUND = ("point", "segment", "cylinder", "ellipsoid")
HOOP = (
    0.94  # inner radius by outer radius with which a hoop is drawn, which has no width of its own
)


def surface(shape, fineness: int = 32) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface of a shape as triangles, in body axes.

    The surface is closed: each edge belongs to two triangles, once in each direction. Sharp shapes (`Box` and
    `Convex` without a radius, `Mesh`) are exact. The curve of a `Profile` is a polygon. The vertices of round
    shapes lie on the shape (of a rounded `Convex`, on it or a little inside), so the enclosed volume of a
    convex shape is too small, relatively by at most ``24 / fineness**2``. The surface of a `Compound` is that
    of all its parts, also where they overlap.
    A `Disc` has both sides in one plane; a hoop (`inner_radius` equal to `radius`) is drawn with a width of 6 %
    of its radius.

    Parameters
    ----------
    shape : Shape
        Any shape of `carom`.
    fineness : int
        Number of sides of the polygon that represents a circle, at least 4, rounded up to a multiple of 4.
        Default 32.

    Returns
    -------
    vertices : (V, 3) float64
        Vertices relative to the mass centre [m].
    triangles : (F, 3) int64
        Indices of vertices, counter-clockwise from outside.
    """
    checks.instance("shape", shape, SHAPES, "; a shape is needed")
    # sides of a quarter of a circle
    n = math.ceil(checks.integer("fineness", fineness, least=4) / 4)
    if isinstance(shape, Disc):
        return _disc(shape.radius, shape.inner_radius, 4 * n)
    if isinstance(shape, Mesh):
        used, faces = np.unique(shape.faces, return_inverse=True)
        return shape.points[used] - shape.centroid, faces.reshape(-1, 3).astype(np.int64)
    if isinstance(shape, Profile):
        return _prism(shape.points(16 * n), 0.5 * shape.thickness)
    if isinstance(shape, Compound):
        return _union(
            (*surface(part, 4 * n), position - shape.centroid, orientation)
            for part, position, orientation, *_ in shape.parts
        )
    if len(shape.pieces) == 1:
        return _of_piece(shape.pieces[0], n)
    return _union((*_of_piece(p, n), p.position, p.orientation) for p in shape.pieces)


def is_round(shape) -> bool:
    """Return whether the rotation of a body with this shape is visible only by a pattern on it."""
    return shape.pieces[0].kind in ROUND and not isinstance(shape, (Box, Compound))


def _prism(points: np.ndarray, half: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface of a prism over a polygon (n, 2), counter-clockwise, convex or not."""
    side, n = np.arange(len(points)), len(points)
    after = np.roll(side, -1)
    top = np.array(_ears(points))
    walls = [
        np.stack([side, after, after + n], axis=1),
        np.stack([side, after + n, side + n], axis=1),
    ]
    levels = [np.column_stack([points, np.full(n, z)]) for z in (-half, half)]
    return np.concatenate(levels), np.concatenate([top[:, ::-1], top + n, *walls])


def _ears(points: np.ndarray) -> list[tuple[int, int, int]]:
    """Return the triangles of a polygon (n, 2), counter-clockwise, by cutting off ears."""

    def turn(a, b, c):
        u, v = b - a, c - a
        return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]

    left, found, k = list(range(len(points))), [], 0
    misses = 0
    while len(left) > 3:
        i, j, m = (left[(k + d) % len(left)] for d in (-1, 0, 1))
        a, b, c = points[i], points[j], points[m]
        others = points[[p for p in left if p not in (i, j, m)]]
        inside = (turn(a, b, others) >= 0) & (turn(b, c, others) >= 0) & (turn(c, a, others) >= 0)
        # of a polygon that round-off has spoiled any corner is cut off after a round
        if (turn(a, b, c) > 0.0 and not inside.any()) or misses > len(left):
            found.append((i, j, m))
            left.remove(j)
            k, misses = k + 1, 0  # not the same corner again: the triangles would be slivers
        else:
            k, misses = k + 1, misses + 1
    return [*found, (left[0], left[1], left[2])]


def _of_piece(piece: Piece, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface of a piece in its own axes."""
    if piece.kind == "cylinder":
        r, z = piece.half[0], piece.half[2]
        return turned([(0.0, -z), (r, -z), (r, z), (0.0, z)], 4 * n)
    ball = _directions(n)
    if piece.kind == "ellipsoid":
        vertices, triangles = _hull(ball)
        return vertices * piece.half, triangles
    core = piece.vertices if piece.kind == "hull" else piece.half * SIGNS
    # balls of this radius around all vertices of the core, and its faces moved out
    if piece.radius:
        ball = np.array([*ball, *(normal for normal, _ in piece.faces)])
        core = (core[:, None] + piece.radius * ball).reshape(-1, 3)
    elif piece.faces:
        fans = [(r[0], r[k], r[k + 1]) for _, r in piece.faces for k in range(1, len(r) - 1)]
        return np.array(core), np.array(fans, dtype=np.int64)
    return _hull(core)


def _directions(n: int) -> np.ndarray:
    """Return unit vectors in all directions: the corners of an octahedron with n^2 triangles on each side."""
    steps = np.array([(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)])
    octant = np.sin(0.5 * math.pi / n * steps)
    octant /= np.linalg.norm(octant, axis=1)[:, None]
    return np.unique((octant * SIGNS[:, None]).reshape(-1, 3) + 0.0, axis=0)


def _hull(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface of the convex hull of points."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(np.unique(points, axis=0))
    used, faces = np.unique(hull.simplices, return_inverse=True)
    points, faces = hull.points[used], faces.reshape(-1, 3).astype(np.int64)
    sides = np.linalg.det(points[faces] - points.mean(axis=0))
    faces[sides < 0.0] = faces[sides < 0.0, ::-1]
    return points, faces


def turned(profile, n: int, closed: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Return a profile of (r, z), from below to above outside, turned about z in n steps.

    Its ends lie on the axis, or it is `closed`.
    """
    angle = 2.0 * math.pi / n * np.arange(n)
    circle = np.stack([np.cos(angle), np.sin(angle), np.ones(n)], axis=1)
    rings, points = [], []
    for r, z in profile:
        count = n if r > 0.0 else 1
        rings.append(len(points) + np.arange(n) % count)
        points.extend(circle[:count] * (r, r, z))
    faces = []
    for low, high in zip(rings, rings[1:] + rings[:1] if closed else rings[1:]):
        after_low, after_high = np.roll(low, -1), np.roll(high, -1)
        if low[0] != low[-1]:
            faces.append(np.stack([low, after_low, after_high], axis=1))
        if high[0] != high[-1]:
            faces.append(np.stack([low, after_high, high], axis=1))
    return np.array(points), np.concatenate(faces).astype(np.int64)


def _disc(radius: float, hole: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return both sides of a disc or a ring, in one plane."""
    if not hole:
        return turned([(0.0, 0.0), (radius, 0.0), (0.0, 0.0)], n)
    hole = min(hole, HOOP * radius)
    middle = 0.5 * (radius + hole)  # apart above and below: an edge has two triangles, not four
    return turned([(middle, 0.0), (radius, 0.0), (middle, 0.0), (hole, 0.0)], n, closed=True)


def _union(parts) -> tuple[np.ndarray, np.ndarray]:
    """Return the surfaces of all parts: vertices, triangles, position and orientation of each."""
    points, faces, count = [], [], 0
    for vertices, triangles, position, orientation in parts:
        points.append(position + quaternion.rotate(orientation, vertices))
        faces.append(triangles + count)
        count += len(vertices)
    return np.concatenate(points), np.concatenate(faces)
