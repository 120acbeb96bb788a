"""Checks of the hulls, meshes and compounds in a file: shapes, sizes, numbers of vertices."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.scene.pieces import Piece, Shape
from carom.scene.shapes.compound import Compound
from carom.scene.shapes.convex import Convex
from carom.scene.shapes.mesh import Mesh

CORES = ("point", "segment", "box", "hull", "cylinder", "ellipsoid")


def check_convex(shape: Convex) -> None:
    """Raise for a hull whose fields do not fit each other."""
    points = _rows("points", shape.points)
    vertices = _rows("_vertices", shape._vertices)
    checks.number("radius", shape.radius, least=0.0)
    _solid(shape)
    if vertices.shape != points.shape:
        raise ValueError(f"_vertices must be as many as points, got {len(vertices)}")
    _check_faces(shape.faces, len(vertices))


def check_mesh(shape: Mesh) -> None:
    """Raise for a mesh whose fields do not fit each other."""
    points, faces = _rows("points", shape.points), shape.faces
    if not (isinstance(faces, np.ndarray) and faces.dtype == np.int64 and faces.shape[1:] == (3,)):
        raise ValueError("faces must be whole numbers of shape (k, 3)")
    if not (faces.size and faces.min() >= 0 and faces.max() < len(points)):
        raise ValueError(f"faces must be numbers of vertices from 0 to {len(points) - 1}")
    checks.flag("convex", shape.convex)
    _solid(shape)
    _check_pieces(shape._pieces)


def check_compound(shape: Compound) -> None:
    """Raise for a compound whose fields do not fit each other."""
    if not isinstance(shape.parts, tuple) or not shape.parts:
        raise ValueError("parts must be a tuple of at least one")
    for part, position, orientation in shape.parts:
        checks.instance("a part", part, (Shape,))
        checks.finite_array("position of a part", position, (3,))
        checks.unit_quaternion("orientation of a part", orientation)
    _solid(shape, flat=True)
    if not shape._pieces:
        raise ValueError("_pieces must be at least one")
    _check_pieces(shape._pieces)


def check_piece(piece: Piece) -> None:
    """Raise for a piece whose fields do not fit each other."""
    checks.choice("kind", piece.kind, CORES)
    if not np.all(checks.finite_array("half", piece.half, (3,)) >= 0.0):
        raise ValueError(f"half must be at least 0, got {piece.half!r}")
    for name in ("radius", "inner", "extent"):
        checks.number(name, getattr(piece, name), least=0.0)
    checks.finite_array("position", piece.position, (3,))
    checks.unit_quaternion("orientation", piece.orientation)
    vertices = _rows("vertices", piece.vertices, 4 if piece.kind == "hull" else 0)
    if piece.kind == "hull":
        _check_faces(piece.faces, len(vertices))
    elif len(vertices) or piece.faces != ():
        raise ValueError(f"vertices and faces must be none of a {piece.kind}")


def _solid(shape, flat: bool = False) -> None:
    """Refuse a shape without centroid, size and spread; one that is `flat` may have no volume or spread."""
    checks.finite_array("centroid", shape.centroid, (3,))
    checks.number("size", shape.size, above=0.0)
    if not (checks.number("volume", shape.volume, least=0.0) > 0.0 or flat):
        raise ValueError("volume must be above 0, got 0")
    if not (flat and shape._spread is None):
        checks.finite_array("_spread", shape._spread, (3, 3))


def _rows(name: str, value, least: int = 4) -> np.ndarray:
    array = checks.finite_array(name, value, (None, 3))
    if len(array) < least:
        raise ValueError(f"{name} must be at least {least}, got {len(array)}")
    return array


def _check_pieces(pieces) -> None:
    if not isinstance(pieces, tuple) or not all(isinstance(one, Piece) for one in pieces):
        raise ValueError("_pieces must be a tuple of Piece")


def _check_faces(faces, vertices: int) -> None:
    """Refuse faces that are not normals with rings of vertices."""
    if not isinstance(faces, tuple) or len(faces) < 4:
        raise ValueError("faces must be a tuple of four or more")
    for normal, ring in faces:
        checks.unit_vector("normal of a face", normal)
        if not isinstance(ring, tuple) or len(ring) < 3:
            raise ValueError(f"a face must have three vertices or more, got {ring!r}")
        for one in ring:
            checks.integer("vertex of a face", one, least=0, most=vertices - 1)
