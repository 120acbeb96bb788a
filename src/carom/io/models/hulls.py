"""Meshes: their hulls, and their triangles for pictures; with fewer corners or triangles if they have many."""

from __future__ import annotations

import math

import numpy as np

from carom.io.models.build import Build
from carom.io.models.links import called
from carom.scene.shapes.convex import Convex, hull_of

MOST_SEEN = 5000  # triangles of a mesh in pictures
FINEST_GRID = 512.0  # cells along a mesh, in which vertices are joined to have fewer triangles
OUTSIDE = 1e-12  # relative to the size: corners less far from the hull of others are on it


def hull_of_mesh(build: Build, mesh: int) -> Convex | None:
    """Return the convex hull of a mesh, the same for all geoms that have it; None if it has no volume."""
    if mesh not in build.hulls:
        build.hulls[mesh] = _hull(build, mesh)
    return build.hulls[mesh]


def _hull(build: Build, mesh: int) -> Convex | None:
    model = build.model
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    points = np.array(model.mesh_vert[first : first + count], dtype=float)
    element = called(model, "mesh", mesh)
    try:
        corners, _ = hull_of(points)
    except ValueError as error:
        build.report.add(element, f"it has no volume ({error})", "left out")
        return None
    most = build.most_corners
    if most is None or len(corners) <= most:
        return Convex(points)
    fewer, out = with_fewer_corners(corners, most)
    left = f"the hull of {most} of them leaves out up to {out:.3g} m"
    build.report.add(element, f"its hull has {len(corners)} corners", left)
    return Convex(fewer)


def triangles_of(build: Build, mesh: int) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and triangles of a mesh as it is seen, the same for all geoms that have it."""
    if mesh not in build.triangles:
        m = build.model
        first, begin = int(m.mesh_vertadr[mesh]), int(m.mesh_faceadr[mesh])
        points = np.array(m.mesh_vert[first : first + int(m.mesh_vertnum[mesh])], dtype=float)
        faces = np.array(m.mesh_face[begin : begin + int(m.mesh_facenum[mesh])], dtype=np.int64)
        build.triangles[mesh] = with_fewer_triangles(points, faces, MOST_SEEN)
    return build.triangles[mesh]


def with_fewer_triangles(
    points: np.ndarray, faces: np.ndarray, most: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return a surface with vertices at one place joined, and, where it has many triangles, at most `most`.

    Vertices in one cell of a grid become their mean; triangles that lose a side go. The grid is the finest of
    those with sides of 2^(k/2) that leaves few enough (Rossignac and Borrel, Multi-resolution 3D
    approximations for rendering complex scenes, 1993).
    """
    joined = np.unique(points, axis=0, return_inverse=True)
    vertices, found = joined[0], joined[1].ravel()[faces]
    low, size = vertices.min(axis=0), float(np.ptp(vertices, axis=0).max())
    cells = FINEST_GRID
    kept = _whole(found)
    while len(kept) > most and cells > 2.0:
        place = np.floor((vertices - low) * (cells / size)).astype(np.int64)
        _, group = np.unique(place, axis=0, return_inverse=True)
        kept = _whole(group.ravel()[found])
        if len(kept) <= most:
            count = np.bincount(group.ravel())[:, None]
            sums = [np.bincount(group.ravel(), weights=column) for column in vertices.T]
            return np.array(sums).T / count, kept
        cells /= math.sqrt(2.0)
    return vertices, kept


def _whole(faces: np.ndarray) -> np.ndarray:
    """Return the triangles with three different vertices, each once."""
    a, b, c = faces.T
    whole = faces[(a != b) & (b != c) & (c != a)]
    _, first = np.unique(np.sort(whole, axis=1), axis=0, return_index=True)
    return whole[np.sort(first)]


def with_fewer_corners(corners: np.ndarray, most: int) -> tuple[np.ndarray, float]:
    """Return the corners (most,3) of a hull inside that of `corners` (n,3), and its greatest distance from it.

    They begin with four that enclose a volume; then, again and again, the corner is added that is farthest
    beyond a face of those so far. No point of the full hull is farther from the smaller one than the farthest
    of its corners, as the distance from a convex body is a convex function.
    """
    from scipy.spatial import ConvexHull

    middle, size = corners.mean(axis=0), np.ptp(corners, axis=0).max()
    points = (corners - middle) / size
    chosen, known = _four(points), {}
    while True:
        hull = ConvexHull(points[chosen])
        faces = [tuple(sorted(face)) for face in np.array(chosen)[hull.simplices].tolist()]
        new = [k for k, face in enumerate(faces) if face not in known]
        beyond = points @ hull.equations[new, :3].T + hull.equations[new, 3]
        for k, column in zip(new, beyond.T):
            farthest = int(np.argmax(column))
            known[faces[k]] = float(column[farthest]), farthest
        height, farthest = max(known[face] for face in faces)
        if len(chosen) == most or not height > OUTSIDE:
            break
        chosen.append(farthest)
    return corners[np.sort(chosen)], size * _greatest_distance(points, hull)


def _four(points: np.ndarray) -> list[int]:
    """Return four corners that enclose a volume: each is the farthest from the others' point, line, plane."""
    first = int(np.argmax(np.sum(points**2, axis=1)))
    away = points - points[first]
    second = int(np.argmax(np.sum(away**2, axis=1)))
    area = np.cross(away, away[second])
    third = int(np.argmax(np.sum(area**2, axis=1)))
    return [first, second, third, int(np.argmax(np.abs(away @ area[third])))]


def _greatest_distance(points: np.ndarray, hull) -> float:
    """Return the greatest distance of points from a hull; the nearest point is on a face that is seen."""
    height = points @ hull.equations[:, :3].T + hull.equations[:, 3]
    one, face = np.nonzero(height > OUTSIDE)
    p, corners, normal = points[one], hull.points[hull.simplices[face]], hull.equations[face, :3]
    over, square = np.ones(len(one), dtype=bool), np.full(len(one), np.inf)
    for k in range(3):
        start = corners[:, k]
        away, edge = p - start, corners[:, (k + 1) % 3] - start
        across = np.cross(normal, edge)
        inward = np.sum((corners[:, (k + 2) % 3] - start) * across, axis=1)
        over &= np.sum(away * across, axis=1) * inward >= 0.0
        part = np.sum(away * edge, axis=1) / np.sum(edge**2, axis=1)
        away -= np.clip(part, 0.0, 1.0)[:, None] * edge
        square = np.minimum(square, np.sum(away**2, axis=1))
    least = np.full(len(points), np.inf)
    np.minimum.at(least, one, np.where(over, height[one, face], np.sqrt(square)))
    return float(np.max(least, where=np.isfinite(least), initial=0.0))
