"""The triangles of each body for films, with their colours, normals and edges."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.scene.shapes.convex import Convex
from carom.scene.shapes.revolved import Disc
from carom.scene.surface_definition import SurfaceDefinition
from carom.visual.bodies import ORIGIN, Part, colours_of, parts_of

MOST_TRIANGLES = 20_000  # triangles of a body, from which on large ones are not split any more
SHARP = np.cos(np.radians(35.0))  # of the angle from which an edge is one
FACET = np.cos(np.radians(1.0))  # the same of a polyhedron, whose faces are all flat
SMOOTH = -1.0  # of what has no edge
NARROW = 0.8  # inner radius by outer radius from which a ring has no room for lines at its edges
PALE = 0.55  # of the second colour of round bodies, which shows how they turn


class Model(NamedTuple):
    """Triangles of one body, in its axes."""

    corners: np.ndarray  #: (F, 3, 3)
    normals: np.ndarray  #: (F, 3, 3) at the corners
    colours: np.ndarray  #: (F, 3)
    edges: np.ndarray  #: (F, 3) whether the side opposite a corner is an edge


def joined(models) -> Model:
    """Return several models as one."""
    return Model(*(np.ascontiguousarray(np.concatenate(columns)) for columns in zip(*models)))


def models(scene, length: float, centre: np.ndarray = ORIGIN) -> tuple[Model, np.ndarray]:
    """Return the triangles of all bodies, and which body each belongs to, -1 for static ones.

    `length` is the size of the scene [m], and `centre` (3,) is what the camera looks at.
    """
    fineness = 48 if len(scene.bodies) <= 20 else 24 if len(scene.bodies) <= 150 else 16
    none = np.zeros((0, 3, 3))
    made, owner = [Model(none, none, none[:, 0], np.zeros((0, 3), dtype=np.int8))], []
    for part in parts_of(scene, length, fineness, centre):
        model = split(model_of(part), length)
        pale = model.colours
        for b, name in zip(part.bodies, colours_of(part, scene)):
            colour = rgb(name)
            made.append(model._replace(colours=colour + pale * (1.0 - colour)))
            owner += [b] * len(pale)
    return joined(made), np.array(owner, dtype=int)


def split(model: Model, longest: float) -> Model:
    """Return a model whose triangles have no side longer than `longest`, or as many of them as is sensible.

    A triangle much larger than the picture reaches behind the camera and cannot be drawn, but its parts can.
    """
    while len(model.corners) < MOST_TRIANGLES:
        edges = np.roll(model.corners, -1, axis=1) - np.roll(model.corners, 1, axis=1)
        sides = np.linalg.norm(edges, axis=2)  # opposite each corner
        large = sides.max(axis=1) > longest
        if not np.any(large):
            break
        order = (sides[large].argmax(axis=1)[:, None] + np.arange(3)) % 3
        rows = np.flatnonzero(large)[:, None]
        corners, normals, edges = (
            a[rows, order] for a in (model.corners, model.normals, model.edges)
        )
        halves = []
        for k in (1, 2):  # the corner in whose place the middle of the longest side comes
            half, turned, drawn = corners.copy(), normals.copy(), edges.copy()
            half[:, k] = 0.5 * (corners[:, 1] + corners[:, 2])
            turned[:, k] = 0.5 * (normals[:, 1] + normals[:, 2])
            drawn[:, 3 - k] = 0  # the new side
            halves.append(Model(half, turned, model.colours[large], drawn))
        rest = Model(*(column[~large] for column in model))
        model = joined([rest, *halves])
    return model


def rgb(colour: str) -> np.ndarray:
    """Return red, green and blue from 0 to 1 of "#rrggbb"."""
    return np.array([*bytes.fromhex(colour[1:])]) / 255.0


def model_of(part: Part) -> Model:
    """Return a part with its edges; in the place of colours how pale each triangle is."""
    vertices, triangles, _, look, shape, _ = part
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normals, axis=1)
    alike = FACET if isinstance(shape, Convex) and not shape.radius else SHARP
    if isinstance(shape, SurfaceDefinition) and not getattr(shape, "length", None):
        alike = SMOOTH  # of all curved ground, only a can has edges
    flat = size <= 1e-12 * max(float(size.max()), 1e-300)
    unit = normals / np.where(flat, 1.0, size)[:, None]
    side = {(int(t[k]), int(t[k - 2])): f for f, t in enumerate(triangles) for k in range(3)}
    edges = np.zeros(triangles.shape, dtype=np.int8)
    for (i, j), f in side.items() if look != "pip" else ():
        other = side.get((j, i), f)  # curved ground has a rim
        if other == f or (unit[f] @ unit[other] < alike and not (flat[f] or flat[other])):
            opposite = next(k for k in range(3) if triangles[f, k] not in (i, j))
            edges[f, opposite] = 1
    if look == "joint" or (isinstance(shape, Disc) and shape.inner_radius > NARROW * shape.radius):
        edges[:] = 0
    around: list[list[int]] = [[] for _ in vertices]
    for f, triangle in enumerate(triangles):
        for v in triangle:
            around[v].append(f)
    smooth = np.empty_like(corners)
    for f, triangle in enumerate(triangles):
        for k, v in enumerate(triangle):
            near = np.array(around[v])
            near = near if flat[f] else near[unit[near] @ unit[f] >= alike]
            mean = normals[near].sum(axis=0)
            smooth[f, k] = mean / max(float(np.linalg.norm(mean)), 1e-300)
    pale = np.zeros((len(triangles), 3))
    if look == "round":
        middle = corners.mean(axis=1)
        whole = shape is None or shape.pieces[0].kind in ("point", "ellipsoid")
        kept = slice(0, 3 if whole else 2)
        pale[np.prod(np.sign(middle[:, kept]), axis=1) < 0.0] = PALE
    return Model(corners, smooth, pale, edges)
