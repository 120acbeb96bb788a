"""The triangles of each body for films, with their colours, normals and edges."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.scene.bodies import GROUND
from carom.scene.shapes import Sphere
from carom.scene.shapes.convex import Convex
from carom.scene.shapes.revolved import Capsule, Disc
from carom.visual.details import colour_of, is_die, pins, pip_colour, pips
from carom.visual.plots import style
from carom.visual.surfaces import is_round, surface

COLOURS = (style.BLUE, style.ORANGE, style.GREEN, style.RED, style.PURPLE, style.SKY)
JOINT = "#5b6873"
MOST = 20_000  # triangles of a body, from which on large ones are not split any more
SHARP = np.cos(np.radians(35.0))  # of the angle from which an edge is one
FACET = np.cos(np.radians(1.0))  # the same of a polyhedron, whose faces are all flat
NARROW = 0.8  # inner radius by outer radius from which a ring has no room for lines at its edges
PALE = 0.55  # of the second colour of round bodies, which shows how they turn
STATIC = "#c3ccd4"  # colour of what never moves
ROD = 0.012  # thickness of a rod that stands for a body without a shape, by the size of the scene


class Model(NamedTuple):
    """Triangles of one body, in its axes."""

    corners: np.ndarray  #: (F, 3, 3)
    normals: np.ndarray  #: (F, 3, 3) at the corners
    colours: np.ndarray  #: (F, 3)
    edges: np.ndarray  #: (F, 3) whether the side opposite a corner is an edge


def models(scene, length: float) -> list[Model]:
    """Return the models of all bodies; `length` is the size of the scene [m]."""
    fineness = 48 if len(scene.bodies) <= 20 else 24 if len(scene.bodies) <= 150 else 16
    made: dict = {}
    out = []
    for body in scene.bodies:
        shape = body.shape
        if shape is not None:
            if shape not in made:
                made[shape] = model_of(*surface(shape, fineness), shape)
            model = made[shape]
        else:
            model = _rods(scene, body, ROD * length)
        name = colour_of(body, COLOURS)
        colour, pale = rgb(name), model.colours[:, :1]
        made_of = [model._replace(colours=colour + pale * (1.0 - colour))]
        if shape is not None:
            made_of += [_painted(pin, JOINT) for pin in pins(scene, body, ROD * length)]
            made_of += [_painted(pips(shape), pip_colour(name))] if is_die(body) else []
        out.append(Model(*(np.concatenate(columns) for columns in zip(*made_of))))
    return out


def split(model: Model, longest: float) -> Model:
    """Return a model whose triangles have no side longer than `longest`, or as many of them as is sensible.

    A triangle much larger than the picture reaches behind the camera and cannot be drawn, but its parts can.
    """
    while len(model.corners) < MOST:
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
        model = Model(*(np.concatenate(columns) for columns in zip(rest, *halves)))
    return model


def _painted(surface, colour: str) -> Model:
    """Return a surface of one colour, without lines at its edges and with flat triangles."""
    vertices, triangles = surface
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    normals = np.repeat(normals[:, None], 3, axis=1)
    edges = np.zeros(triangles.shape, dtype=np.int8)
    return Model(corners, normals, np.tile(rgb(colour), (len(triangles), 1)), edges)


def placed_model(solid) -> Model:
    """Return the model of a static body, in the world."""
    model = model_of(*surface(solid.shape, 48), solid.shape)
    turn = quaternion.matrix(solid.orientation)
    return model._replace(
        corners=model.corners @ turn.T + solid.position,
        normals=model.normals @ turn.T,
        colours=np.zeros((len(model.colours), 3)) + rgb(STATIC),
    )


def rgb(colour: str) -> np.ndarray:
    """Return red, green and blue from 0 to 1 of "#rrggbb"."""
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0


def model_of(vertices, triangles, shape) -> Model:
    """Return a surface with its edges; in the place of colours how pale each triangle is."""
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normals, axis=1)
    alike = FACET if isinstance(shape, Convex) and not shape.radius else SHARP
    flat = size <= 1e-12 * max(float(size.max()), 1e-300)
    unit = normals / np.where(flat, 1.0, size)[:, None]
    side = {(int(t[k]), int(t[k - 2])): f for f, t in enumerate(triangles) for k in range(3)}
    edges = np.zeros(triangles.shape, dtype=np.int8)
    for (i, j), f in side.items():
        other = side[j, i]
        if unit[f] @ unit[other] < alike and not (flat[f] or flat[other]):
            opposite = next(k for k in range(3) if triangles[f, k] not in (i, j))
            edges[f, opposite] = 1
    if isinstance(shape, Disc) and shape.inner_radius > NARROW * shape.radius:
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
    if shape is not None and is_round(shape):
        middle = corners.mean(axis=1)
        kept = slice(0, 3 if shape.pieces[0].kind in ("point", "ellipsoid") else 2)
        pale[np.prod(np.sign(middle[:, kept]), axis=1) < 0.0] = PALE
    return Model(corners, smooth, pale, edges)


def _rods(scene, body, radius: float) -> Model:
    """Return a ball at the mass centre, and rods from it to the joints and springs."""
    parts = [model_of(*surface(Sphere(1.8 * radius), 24), None)]
    for end in _ends(scene, body):
        length = float(np.linalg.norm(end))
        if length > 2.0 * radius:
            rod = model_of(*surface(Capsule(radius, length), 16), None)
            turn = turned_to(end / length)
            parts.append(
                rod._replace(corners=rod.corners @ turn.T + 0.5 * end, normals=rod.normals @ turn.T)
            )
    return Model(*(np.concatenate(columns) for columns in zip(*parts)))


def _ends(scene, body) -> list[np.ndarray]:
    """Return the anchors of joints at a body, in its axes."""
    return [at for part, at in anchors(scene.joints) if part is body and at is not None]


def anchors(parts) -> list[tuple]:
    """Return (body, point in its axes) of both ends of each joint or spring; None without a point."""
    found = []
    for one in parts:
        frames = getattr(one, "frames", None)
        for k, (part, name) in enumerate(
            ((one.parent, "anchor_parent"), (one.child, "anchor_child"))
        ):
            place = getattr(one.definition, name, getattr(one.definition, "anchor", None))
            if frames is not None:
                place = frames[k][0]
            elif place is not None and part is not GROUND:
                place = quaternion.rotate_back(part.orientation, place - part.position)
            found.append((part, place))
    return found


def turned_to(direction) -> np.ndarray:
    """Return a rotation (3, 3) from z to a unit direction."""
    across = np.cross(direction, np.eye(3)[0 if abs(direction[0]) < 0.8 else 1])
    across /= np.linalg.norm(across)
    return np.stack([across, np.cross(direction, across), direction], axis=1)
