"""Surfaces of shapes as triangles, for drawing."""

from __future__ import annotations

import math

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.scene.pieces import Piece
from carom.scene.shapes import SHAPES, Box
from carom.scene.shapes.compound import Compound
from carom.scene.shapes.mesh import Mesh
from carom.scene.shapes.revolved import Disc

#: kinds of pieces without edges or corners that turn with them
ROUND = ("point", "segment", "cylinder", "ellipsoid")
HOOP = (
    0.94  # inner radius by outer radius with which a hoop is drawn, which has no width of its own
)


def surface(shape, fineness: int = 32) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface of a shape as triangles, in body axes.

    The surface is closed: each edge belongs to two triangles, once in each direction. Sharp shapes (`Box` and
    `Convex` without a radius, `Mesh`) are exact. The vertices of round shapes lie on the shape, so the enclosed
    volume of a convex shape is too small, relatively by at most ``24 / fineness**2``. The surface of a
    `Compound` is that of all its parts, also where they overlap. A `Disc` has both sides in one plane; a hoop
    (`inner_radius` equal to `radius`) is drawn with a width of 6 % of its radius.

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
    if isinstance(shape, Compound):
        return _union(
            (*surface(part, 4 * n), position - shape.centroid, orientation)
            for part, position, orientation in shape.parts
        )
    if len(shape.pieces) == 1:
        return _of_piece(shape.pieces[0], n)
    return _union((*_of_piece(p, n), p.position, p.orientation) for p in shape.pieces)


def is_round(shape) -> bool:
    """Return whether the rotation of a body with this shape is visible only by a pattern on it."""
    return shape.pieces[0].kind in ROUND and not isinstance(shape, (Box, Compound))


def _of_piece(piece: Piece, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the surface of a piece in its own axes."""
    if piece.kind == "cylinder":
        r, z = piece.half[0], piece.half[2]
        return _turned([(0.0, -z), (r, -z), (r, z), (0.0, z)], 4 * n)
    if piece.kind == "ellipsoid":
        vertices, triangles = _swollen_box(np.zeros(3), 1.0, n)
        return vertices * piece.half, triangles
    if piece.kind == "hull":
        return _swollen_hull(piece, n) if piece.radius else _fans(piece)
    return _swollen_box(piece.half, piece.radius, n)


def _swollen_box(half: np.ndarray, radius: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a box of half edges `half` rounded by a ball of `radius`; both may be 0.

    A ball as an octahedron with n^2 triangles on each side, whose octants are moved apart; strips join
    them, and vertices that have come to one place become one.
    """
    if not radius:
        n = 1
    steps: list[tuple[int, ...]] = [
        (i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)
    ]
    number: dict[tuple[int, ...], int] = {step: k for k, step in enumerate(steps)}
    corner = np.sin(0.5 * math.pi / n * np.array(steps))
    corner /= np.linalg.norm(corner, axis=1)[:, None]
    signs = np.array([(a, b, c) for a in (1, -1) for b in (1, -1) for c in (1, -1)])
    places: dict[tuple[int, ...], int] = {tuple(s): k * len(steps) for k, s in enumerate(signs)}
    if radius:
        points = np.concatenate([s * (radius * corner + half) for s in signs])
    else:
        points = np.repeat(signs * half, len(steps), axis=0)
    apart = half > 0.0
    keys = [
        (*(s * steps[k]), *(s * apart)) if radius else tuple(s)
        for s in signs
        for k in range(len(steps))
    ]

    faces: list = []

    def add(*ring):  # as seen from outside, or all of it turned
        faces.extend((ring[0], ring[k], ring[k + 1]) for k in range(1, len(ring) - 1))

    for s in signs:
        first, outward = places[tuple(s)], np.prod(s) > 0
        for i, j, k in steps:
            if k > 0:  # x towards y is counter-clockwise where all are positive
                a, b, c = (number[p] for p in ((i, j, k), (i + 1, j, k - 1), (i, j + 1, k - 1)))
                add(first + a, *((first + b, first + c) if outward else (first + c, first + b)))
            if k > 1:
                d = number[i + 1, j + 1, k - 2]
                add(first + b, *((first + d, first + c) if outward else (first + c, first + d)))
    for axis in range(3):
        y, z = (axis + 1) % 3, (axis + 2) % 3
        for sy, sz in ((1, 1), (-1, 1), (-1, -1), (1, -1)):  # strips along the axis
            up, down = np.zeros(3, int), np.zeros(3, int)
            up[[axis, y, z]], down[[axis, y, z]] = (1, sy, sz), (-1, sy, sz)
            for m in range(n):
                here, there = [0, 0, 0], [0, 0, 0]
                here[y], here[z], there[y], there[z] = n - m, m, n - m - 1, m + 1
                a, b = number[tuple(here)], number[tuple(there)]
                p, q = places[tuple(up)], places[tuple(down)]
                ring = (q + a, q + b, p + b, p + a)
                add(*(ring if sy * sz > 0 else ring[::-1]))
        tip = [0, 0, 0]
        tip[axis] = n
        for sign in (1, -1):  # flat sides
            ring = []
            for sy, sz in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
                s = np.zeros(3, int)
                s[[axis, y, z]] = sign, sy, sz
                ring.append(places[tuple(s)] + number[tuple(tip)])
            add(*(ring if sign > 0 else ring[::-1]))
    return _merged(points, np.array(faces), np.array(keys))


def _merged(points, faces, keys) -> tuple[np.ndarray, np.ndarray]:
    """Make vertices of one key one, and leave out the triangles that have lost a side."""
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    faces = number.reshape(-1)[faces]
    kept = [len(set(face)) == 3 for face in faces.tolist()]
    return points[first], faces[kept].astype(np.int64)


def _turned(profile, n: int, closed: bool = False) -> tuple[np.ndarray, np.ndarray]:
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
        return _turned([(0.0, 0.0), (radius, 0.0), (0.0, 0.0)], n)
    hole = min(hole, HOOP * radius)
    middle = 0.5 * (radius + hole)  # apart above and below: an edge has two triangles, not four
    return _turned([(middle, 0.0), (radius, 0.0), (middle, 0.0), (hole, 0.0)], n, closed=True)


def _fans(shape: Piece) -> tuple[np.ndarray, np.ndarray]:
    """Return a sharp hull: each face as a fan of triangles."""
    fans = [
        (ring[0], ring[k], ring[k + 1]) for _, ring in shape.faces for k in range(1, len(ring) - 1)
    ]
    return np.array(shape.vertices), np.array(fans, dtype=np.int64)


def _swollen_hull(shape: Piece, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a hull rounded by a ball: faces moved out, parts of cylinders at edges, of balls at corners.

    The part of a ball at a corner is bounded by arcs from the normal of one face to that of the next; it is
    filled by rings that shrink to its middle.
    """
    points: list[np.ndarray] = []
    faces: list[tuple[int, int, int]] = []
    place: dict[tuple[int, int], int] = {}  # vertex, face
    side: dict[tuple[int, int], int] = {}  # face to the left of an edge
    before: dict[tuple[int, int], int] = {}  # of a vertex and face: the vertex before in the ring

    def put(vertex: int, direction) -> int:
        points.append(shape.vertices[vertex] + shape.radius * np.asarray(direction))
        return len(points) - 1

    for f, (normal, ring) in enumerate(shape.faces):
        for i, j in zip(ring, ring[1:] + ring[:1]):
            place[i, f], side[i, j], before[j, f] = put(i, normal), f, i
        faces += [
            (place[ring[0], f], place[ring[k], f], place[ring[k + 1], f])
            for k in range(1, len(ring) - 1)
        ]
    arcs: dict[tuple[int, int, int], tuple] = {}  # vertex, face, face: numbers and directions
    for (i, j), f in side.items():
        g = side[j, i]
        if i > j:
            continue
        between = _arc(shape.faces[f][0], shape.faces[g][0], n)
        for vertex in (i, j):
            own = [place[vertex, f], *(put(vertex, d) for d in between[1:-1]), place[vertex, g]]
            arcs[vertex, f, g] = own, between
            arcs[vertex, g, f] = own[::-1], between[::-1]
        a, b = arcs[i, f, g][0], arcs[j, f, g][0]
        for k in range(len(a) - 1):
            faces += [(a[k], a[k + 1], b[k + 1]), (a[k], b[k + 1], b[k])]
    for vertex in range(len(shape.vertices)):
        start = f = next(f for v, f in place if v == vertex)
        outer, directions = [], []
        while True:  # faces around the corner, counter-clockwise from outside
            g = side[vertex, before[vertex, f]]  # beyond the edge that comes to the corner
            own, between = arcs[vertex, f, g]
            outer, directions, f = outer + own[:-1], [*directions, *between[:-1]], g
            if f == start:
                break
        faces += _filled(vertex, outer, np.array(directions), n, put)
    return np.array(points), np.array(faces, dtype=np.int64)


def _arc(start, end, n: int) -> list:
    """Return unit vectors from one to another, in steps of at most a quarter of a turn by n."""
    angle = math.atan2(float(np.linalg.norm(np.cross(start, end))), float(start @ end))
    steps = max(1, math.ceil(2.0 * n * angle / math.pi - 1e-9))
    return [_between(start, end, angle, k / steps) for k in range(steps + 1)]


def _between(start, end, angle: float, part: float) -> np.ndarray:
    """Return the unit vector at a part of the arc of an `angle` below pi."""
    if not angle > 1e-6:
        mean = (1.0 - part) * start + part * end
        return mean / np.linalg.norm(mean)
    return (math.sin((1.0 - part) * angle) * start + math.sin(part * angle) * end) / math.sin(angle)


def _filled(vertex: int, outer: list, directions, n: int, put) -> list:
    """Return the triangles inside a ring on the ball at a corner, counter-clockwise."""
    middle = directions.sum(axis=0)
    middle /= np.linalg.norm(middle)
    angles = [
        math.atan2(float(np.linalg.norm(np.cross(d, middle))), float(d @ middle))
        for d in directions
    ]
    steps = max(1, math.ceil(2.0 * n * max(angles) / math.pi - 1e-9))
    faces = []
    for k in range(1, steps):
        pairs = zip(directions, angles)
        inner = [put(vertex, _between(d, middle, a, k / steps)) for d, a in pairs]
        for m in range(len(outer)):
            a, b, c, d = outer[m - 1], outer[m], inner[m], inner[m - 1]
            faces += [(a, b, c), (a, c, d)]
        outer = inner
    top = put(vertex, middle)
    return faces + [(outer[m - 1], outer[m], top) for m in range(len(outer))]


def _union(parts) -> tuple[np.ndarray, np.ndarray]:
    """Return the surfaces of all parts: vertices, triangles, position and orientation of each."""
    points, faces, count = [], [], 0
    for vertices, triangles, position, orientation in parts:
        points.append(position + quaternion.rotate(orientation, vertices))
        faces.append(triangles + count)
        count += len(vertices)
    return np.concatenate(points), np.concatenate(faces)
