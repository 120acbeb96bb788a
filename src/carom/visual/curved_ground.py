"""Curved ground as triangles that face free space.

Triangles are drawn from their front only, so that a wall between the eye and the motion is not seen.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np

from carom.collision.implicit import values_at
from carom.collision.layout import implicit_surface
from carom.io.files.scene_data import MissingFunction
from carom.scene.height_field import HeightField
from carom.scene.surface_definition import SurfaceDefinition
from carom.scene.user_surface import Surface, evaluator
from carom.visual.surfaces import turned

GRID_CELLS = 64  # along each side of a height field
GRID_CUBES = 20  # along the longest side of a box
UNEVEN = 0.0417  # of a side of the box
DRAWN = 2.0  # of the region of the motion, to which endless surfaces are drawn
WIDER = 4.0  # a surface so many times larger than the region is drawn there only
NO_TRIANGLES = np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
#: tetrahedra of a cube whose corners have the bits of their numbers for coordinates
TETRAHEDRA = [(0, a, a + b, 7) for a, b, _ in permutations((1, 2, 4))]


def ground(surface: SurfaceDefinition, centre: np.ndarray, radius: float, n: int):
    """Return vertices and triangles of a surface, in its axes; circles have n sides.

    The motion is in a ball about `centre` (3,), in axes of the surface, of this `radius`. There are none of a
    surface that is elsewhere, or whose function a file does not have.
    """
    if isinstance(surface, HeightField):
        return _field(surface, centre, radius)
    low, high = centre - DRAWN * radius, centre + DRAWN * radius
    if isinstance(surface, Surface):
        if isinstance(surface.function, MissingFunction):
            return NO_TRIANGLES
        own = surface.bounds
        if surface.size > WIDER * radius:
            own = np.stack([np.maximum(low, own[0]), np.minimum(high, own[1])])
        evaluate = evaluator(surface)
        return _level(lambda x: np.array([evaluate(one)[0] for one in x]), own)
    profile = surface.profile(float(np.linalg.norm(centre)) + DRAWN * radius, n)
    if profile is None or WIDER * radius * surface.bend < 1.0:
        return _level(lambda x: _values(surface, x), np.stack([low, high]))
    vertices, faces = turned(*profile)
    return vertices, faces[:, ::-1]


def _values(surface: SurfaceDefinition, points: np.ndarray) -> np.ndarray:
    """Return phi at points (K, 3)."""
    tables, out = implicit_surface(surface, 0), np.zeros(len(points))
    values_at(tables.surfaces[0], tables, points, out)
    return out


def _field(surface: HeightField, centre: np.ndarray, radius: float):
    """Return a grid on a height field, as fine as the region of the motion needs."""
    near, sides = WIDER * radius, []
    for k in range(2):
        end = surface.corner[k] + surface.spacing[k] * (surface.heights.shape[k] - 1)
        low = max(surface.corner[k], min(centre[k], end) - near)
        high = min(end, max(centre[k], surface.corner[k]) + near)
        sides.append(np.linspace(low, high, GRID_CELLS + 1))
    x, y = np.meshgrid(*sides, indexing="ij")
    i, j = (k.ravel() for k in np.meshgrid(*2 * [np.arange(GRID_CELLS)], indexing="ij"))
    a, b = i * (GRID_CELLS + 1) + j, (i + 1) * (GRID_CELLS + 1) + j
    faces = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
    return np.stack([x, y, surface.height(x, y)], axis=-1).reshape(-1, 3), faces


def _level(phi, box: np.ndarray):
    """Return the surface phi = 0 in a box, with phi above 0 on its outside: marching tetrahedra."""
    side = np.max(box[1] - box[0]) / GRID_CUBES
    count = np.maximum(np.ceil((box[1] - box[0]) / side).astype(int), 1)
    # not quite even, because many surfaces have the points of an even grid
    parts = [s + UNEVEN * s * (1.0 - s) for s in (np.arange(k + 1) / k for k in count)]
    grid = np.stack(np.meshgrid(*parts, indexing="ij"), axis=-1).reshape(-1, 3)
    points = box[0] + (box[1] - box[0]) * grid
    value = phi(points)
    value[value == 0.0] = np.finfo(float).tiny  # no vertex is on the surface
    number = np.arange(len(points)).reshape(count + 1)
    corner = [
        number[tuple(slice(k >> d & 1, count[d] + (k >> d & 1)) for d in range(3))].ravel()
        for k in range(8)
    ]
    cuts = []  # edges (F, 3, 2) on which the corners of triangles are
    for tetrahedron in TETRAHEDRA:
        own = np.stack([corner[k] for k in tetrahedron], axis=1)
        above = value[own] > 0.0
        order = np.argsort(~above, axis=1, kind="stable")  # those above come first
        own, many = np.take_along_axis(own, order, axis=1), above.sum(axis=1)
        for k, triangles in (
            (1, [(0, 1, 0, 2, 0, 3)]),
            (2, [(0, 2, 0, 3, 1, 2), (1, 2, 0, 3, 1, 3)]),
            (3, [(0, 3, 1, 3, 2, 3)]),
        ):
            cuts += [own[many == k][:, ends].reshape(-1, 3, 2) for ends in map(list, triangles)]
    edges = np.concatenate(cuts)
    if not len(edges):
        return NO_TRIANGLES
    edges, faces = np.unique(np.sort(edges.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    low, high = points[edges[:, 0]], points[edges[:, 1]]
    vertices, faces = _zeros(phi, low, high, value[edges]), faces.reshape(-1, 3)
    corners = vertices[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1)
    faces, normal = faces[size > 0.0], normal[size > 0.0] / size[size > 0.0, None]
    middle, step = corners[size > 0.0].mean(axis=1), 0.1 * side * normal
    inwards = phi(middle + step) < phi(middle - step)
    faces[inwards] = faces[inwards, ::-1]
    return vertices, faces


def _zeros(phi, a: np.ndarray, b: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Return the points between a and b (K, 3), with these values (K, 2) of phi, at which it is 0."""
    u, v = value.T
    for _ in range(4):  # regula falsi: edges are short
        x = a + (u / (u - v))[:, None] * (b - a)
        w = phi(x)
        first = np.sign(w) == np.sign(u)
        u, v = np.where(first, w, u), np.where(first, v, w)
        a, b = np.where(first[:, None], x, a), np.where(first[:, None], b, x)
    return x
