"""Records of the kernels for pairs: solids, hulls, contact points, workspace.

A solid is a convex core in its own axes, enlarged by a ball of `radius`. The poses x, Q of A and B are world
poses of the solids: the pose of the body, combined with the pose of the solid in its body.
"""

from __future__ import annotations

from functools import cache
from itertools import chain
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.geometry import quaternion

#: kinds of cores; a pair is handled with the smaller kind first
POINT, SEGMENT, BOX, HULL, CYLINDER, ELLIPSOID = range(6)
#: kinds that are not convex: a surface given by a function, and a prism over a plane curve
CURVED_GROUND, PROFILE = 6, 7
KINDS = ("point", "segment", "box", "hull", "cylinder", "ellipsoid", "implicit", "profile")
#: kinds of implicit surfaces: files of `carom.collision.grounds`; a new one comes last
SURFACE_KINDS = (
    "inside_sphere", "inside_cylinder", "inside_cone", "inside_torus", "height_field", "function",
)  # fmt: skip

SOLID = [
    ("kind", "i8"),
    # half sizes of the core: segment (0, 0, l/2), box, cylinder (r, r, l/2), ellipsoid semi-axes
    ("half", "f8", 3),
    ("radius", "f8"),  # of the ball that enlarges the core
    ("inner", "f8"),  # an ellipsoid is also a smaller convex core enlarged by this radius
    ("extent", "f8"),  # greatest distance of a point of the solid from its origin
    ("first", "i8"),  # range of the vertices of a hull, or of the pieces of a profile
    ("last", "i8"),
    ("first_face", "i8"),  # range of the faces of a hull, or of the hollows of a profile
    ("last_face", "i8"),
    # of directions, for the vertices of a hull and for the normals of its faces (`carom.geometry.cells`)
    ("across", "i8", 2),  # cells along an edge of the cube
    ("cell", "i8", 2),  # the first cell
    ("surface", "i8"),  # number of an implicit surface
    ("bend", "f8"),  # greatest curvature of hollows of a solid that is not convex [1/m]
    ("body", "i8"),  # number of its shape
    ("x", "f8", 3),  # pose in its body
    ("Q", "f8", 4),
]

#: a face of a hull: outward normal and the range of its corners, counter-clockwise as seen from outside
FACE = [("normal", "f8", 3), ("first", "i8"), ("last", "i8")]

#: one of the points that may be farthest in a cell of directions: a vertex of a hull, or the normal of a face
CANDIDATE = [
    ("point", "f8", 3),
    ("number", "i8"),
]  # counted from the first vertex or face of the hull

#: a surface phi(x) = 0 in its own axes, with free space where phi > 0 (`carom.scene` has its definitions)
IMPLICIT_SURFACE = [
    ("kind", "i8"),
    # radii, lengths and angles of its kind; and the greatest length of the gradient: |phi| over it is at most
    # the distance
    ("size", "f8", 4),
    ("first", "i8"),  # range of its numbers in `Hulls.numbers`
    ("last", "i8"),
    ("count", "i8", 2),  # of cells of a height field along x and y
    ("corner", "f8", 2),  # of its grid
    ("spacing", "f8", 2),
    (
        "address",
        "i8",
    ),  # of a compiled function of the user's: x -> value, gradient, Hessian; 0 for none
]

#: a piece of the plane curve of a profile (`carom.scene.outline`): a polynomial of s - start, s the arc length;
#: after the pieces of a curve come its hollows, each with its curvature as c[0, 0]
PLANE_PIECE = [("start", "f8"), ("c", "f8", (6, 2))]

#: one point of a contact; normal from B to A, points on the two surfaces, all in the world
TOUCH_POINT = [
    ("gap", "f8"),
    ("normal", "f8", 3),
    ("on_a", "f8", 3),
    ("on_b", "f8", 3),
    ("feature", "i8"),
    ("owner", "i8"),  # of the normal: OF_A or OF_B for that of a face, else NOBODY (`features`)
    ("parts", "i8", 2),  # parts of A and of B on which the point lies
    ("surface", "i8"),  # 1 + the number of the level surface that it lies on, 0 for none
    # of bodies with modes: places on both undeformed bodies, in their axes, and the rate of the gap by modes
    ("place_a", "f8", 3),
    ("place_b", "f8", 3),
    ("ringing", "f8"),
]

MOST_POINTS = 8  # of one pair
MOST_CORNERS = 48  # of a face that is clipped; if it has more, some are left out

#: workspace of one pair, all in axes of B
PAIR_STATE = [
    ("R", "f8", (3, 3)),  # axes of A to axes of B
    ("p", "f8", 3),  # origin of A
    ("world", "f8", (3, 3)),  # axes of B to the world
    ("origin", "f8", 3),  # of B in the world
    ("shift", "f8", 3),  # A is moved by this during the search for a normal
    ("corner", "f8", (2, MOST_CORNERS, 3)),  # opposite faces of A and B
    ("number", "i8", (2, MOST_CORNERS)),  # numbers of their corners
    ("count", "i8", 2),
    ("normal", "f8", (2, 3)),  # their outward normals
    ("face", "i8", 2),  # their numbers in the two solids
    ("ring", "f8", (2, 2 * MOST_CORNERS, 3)),  # polygon before and after a cut
    ("side", "i8", (2, 2 * MOST_CORNERS)),  # side after each corner: k incident, -1 - j reference
    ("label", "i8", (2, 2 * MOST_CORNERS)),  # feature of each of its corners
    ("w", "f8", (5, 3)),  # simplex of A - B; the last row is a proposal
    ("on_a", "f8", (5, 3)),  # its points on A and on B
    ("on_b", "f8", (5, 3)),
    ("ids", "i8", (5, 2)),  # their vertices
    ("weight", "f8", 4),  # of the corners in the point nearest to the origin
    ("points", "i8"),  # corners in the simplex
    ("total", "i8"),  # number of points that a unit found
    ("hidden", "i8"),  # 1 + the level surface that hides points of the pair, 0 for none
    ("searches", "i8"),  # number of searches for a distance, for callers that limit the work
    ("start", "f8", (15, 4)),  # directions that may separate the cores, and separations
    ("edge", "f8", (2, 3)),  # directions of the nearest edges
    ("owner", "i8", 2),  # solids of these edges: 0 for A, 1 for B
]


KNOWN_POSES = 8  # of two profiles, of which the places found last are kept
PLACES_OF_POSE = 12  # places of one pose that are kept

#: what was found in one pose of two profiles (`two_profiles`)
KNOWN_POSE = [
    ("R", "f8", (3, 3)),  # as in PAIR_STATE; 0: nothing is known
    ("p", "f8", 3),
    ("first", "i8", 2),  # first rows of both curves
    ("reach", "f8"),  # above the least distance of rows, up to which places were sought
    ("cross", "i8", 2),  # rows that cross, -1 for none
    ("total", "i8"),
    ("next", "i8"),  # of the first pose: which one is replaced next
]


class Hulls(NamedTuple):
    """Vertices and faces of all hulls, in the axes of their solids, and which of them may be farthest."""

    vertices: np.ndarray  # (V, 3)
    faces: np.recarray  # (F,) FACE
    corners: np.ndarray  # (K,) vertices of the faces, counted from the first of the hull
    starts: np.ndarray  # (C + 1,) the first candidate of each cell
    candidates: np.recarray  # (M,) CANDIDATE, cell by cell
    surfaces: np.recarray  # (S,) IMPLICIT_SURFACE
    numbers: np.ndarray  # (L,) of these surfaces
    outlines: np.recarray  # (P,) PLANE_PIECE of profiles


class PairWork(NamedTuple):
    """Workspace for one pair at a time."""

    state: np.recarray  # (1,) PAIR_STATE
    found: np.recarray  # (96,) TOUCH_POINT, in axes of B, points on the cores
    poses: np.recarray  # (KNOWN_POSES,) KNOWN_POSE of two profiles
    known: np.recarray  # (KNOWN_POSES, PLACES_OF_POSE) TOUCH_POINT found there


class Placed(NamedTuple):
    """A solid and its world pose."""

    solid: np.record  # SOLID
    x: np.ndarray  # (3,)
    Q: np.ndarray  # (4,)


class Plane(NamedTuple):
    """The surface of a half-space, in the world."""

    normal: np.ndarray  # (3,) unit, out of the half-space
    offset: float  # normal . point [m]


class Pair(NamedTuple):
    """Two solids, in an order such that the kind of A is not above that of B, and the workspace."""

    a: np.record  # SOLID
    b: np.record
    hulls: Hulls
    state: np.record  # PAIR_STATE
    found: np.recarray  # (96,) TOUCH_POINT, in axes of B, points on the cores
    poses: np.recarray  # (KNOWN_POSES,) KNOWN_POSE of two profiles
    known: np.recarray  # (KNOWN_POSES, PLACES_OF_POSE) TOUCH_POINT found there


@cache
def no_hulls() -> Hulls:
    """Return the hulls of a scene in which no two bodies may touch."""
    none = np.zeros(0, dtype=np.int64)
    curved = table(IMPLICIT_SURFACE, 0), np.zeros(0), table(PLANE_PIECE, 0)
    return Hulls(np.zeros((0, 3)), table(FACE, 0), none, none, table(CANDIDATE, 0), *curved)


def new_pair_work() -> PairWork:
    """Return the workspace of the kernels of pairs."""
    poses, known = table(KNOWN_POSE, KNOWN_POSES), table(TOUCH_POINT, KNOWN_POSES, PLACES_OF_POSE)
    return PairWork(table(PAIR_STATE, 1), table(TOUCH_POINT, 96), poses, known)


def new_points(count: int = MOST_POINTS) -> np.recarray:
    """Return a table for the points of a contact, (count,) TOUCH_POINT."""
    return table(TOUCH_POINT, count)


def solid_table(shapes, turns=None) -> tuple[np.recarray, Hulls]:
    """Return the solids (P,) of `shapes` and the tables of their hulls.

    Parameters
    ----------
    shapes : sequence
        Shapes of `carom.scene`; the solids of one shape follow each other, `body` is its number.
    turns : (n, 4), optional
        For each shape the rotation from the axes that are used (principal axes of inertia) to its
        own body axes. Default: none.
    """
    pieces = [(k, piece) for k, shape in enumerate(shapes) for piece in shape.pieces]
    solid, hulls = table(SOLID, len(pieces)), [no_hulls()]
    end, surfaces, numbers, curves = Count(0, 0, 0, 0, 0), 0, 0, 0
    for row, (k, piece) in zip(solid, pieces):
        row.kind, row.radius, row.body = KINDS.index(piece.kind), piece.radius, k
        row.half[:], row.inner, row.extent = piece.half, piece.inner, piece.extent
        turn = np.array([1.0, 0, 0, 0]) if turns is None else quaternion.conjugate(turns[k])
        row.x[:] = quaternion.rotate(turn, piece.position)
        row.Q[:] = quaternion.multiply(turn, piece.orientation)
        row.first, row.first_face, row.cell[0] = end.vertices, end.faces, end.cells
        if piece.kind == "hull":
            row.across[:] = [cells.across for cells in piece.cells]
            row.cell[1] = row.cell[0] + len(piece.cells[0].starts) - 1
            hulls.append(_hull(piece, end))
            end = Count(*(a + len(part) for a, part in zip(end, hulls[-1])))
        if piece.kind == "implicit":
            row.surface, row.bend = surfaces, piece.surface.bend
            hulls.append(implicit_surface(piece.surface, numbers))
            surfaces, numbers = surfaces + 1, numbers + len(hulls[-1].numbers)
        row.last, row.last_face = end.vertices, end.faces
        if piece.kind == "profile":
            hulls.append(_curve(piece))
            row.first, row.last = curves, curves + len(piece.outline) - 1
            row.first_face, row.last_face = row.last + 1, row.last + 1 + len(piece.hollows)
            row.bend, curves = piece.bend, row.last_face
    made = Hulls._make(
        part[0] if len(part) == 1 else np.concatenate(part).view(type(part[0]))
        for part in zip(*hulls)
    )
    return solid, made._replace(starts=np.append(made.starts, end.candidates))


class Count(NamedTuple):
    """Lengths of the tables of hulls."""

    vertices: int
    faces: int
    corners: int
    cells: int
    candidates: int


def _curve(piece) -> Hulls:
    """Return the tables of a profile: the rows of its curve, then its hollows, with their curvature."""
    rows, n = table(PLANE_PIECE, len(piece.outline) + len(piece.hollows)), len(piece.outline)
    rows.start[:n], rows.c[:n] = piece.outline[:, 0], piece.outline[:, 1:].reshape(-1, 6, 2)
    rows.start[n:], rows.c[n:, 0, 0] = piece.hollows.T
    return no_hulls()._replace(outlines=rows)


def _hull(piece, before: Count) -> Hulls:
    """Return the tables of a hull, which follow others; those of its faces come after those of its vertices."""
    faces, lengths = table(FACE, len(piece.faces)), [len(ring) for _, ring in piece.faces]
    faces.normal[:] = piece.normals
    faces.last[:] = before.corners + np.cumsum(lengths)
    faces.first[:] = faces.last - lengths
    corners = np.fromiter(chain.from_iterable(ring for _, ring in piece.faces), np.int64)
    starts, candidates, count = [], [], before.candidates
    for cells, points in zip(piece.cells, (piece.vertices, piece.normals)):
        rows = table(CANDIDATE, len(cells.members))
        rows.number[:], rows.point[:] = cells.members, points[cells.members]
        starts.append(count + cells.starts[:-1])
        candidates.append(rows)
        count += len(rows)
    every = np.concatenate(candidates).view(Columns)
    curved = no_hulls()[5:]
    return Hulls(piece.vertices, faces, corners, np.concatenate(starts), every, *curved)


def implicit_surface(surface, before: int) -> Hulls:
    """Return the tables of an implicit surface; `before` numbers come before its own."""
    rows = table(IMPLICIT_SURFACE, 1)
    row, given = rows[0], surface.lengths
    row.kind, row["size"][: len(given)] = SURFACE_KINDS.index(surface.kind), given
    row["size"][3] = surface.steepest
    row.first, row.last = before, before + len(surface.numbers)
    surface.write(row)
    return no_hulls()._replace(surfaces=rows, numbers=surface.numbers)
