"""`Mesh`: a solid bounded by triangles."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import keep
from carom.scene.moments import about_centroid, of_triangles
from carom.scene.pieces import Piece, Shape
from carom.scene.shapes.convex import Convex, hull_of

THIN = 1e-12  # height of a triangle relative to the size of the mesh below which it is degenerate
BULGE = 1e-9  # height of a vertex above a face, relative to the size, that is rounding
SINGLE = 1e-6  # the same for vertices that a file has in single precision


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Mesh(Shape):
    """A solid bounded by a closed surface of triangles.

    Volume, mass centre and inertia are exact. Contact uses convex parts: the mesh itself if it is convex,
    otherwise the given parts. As for `Convex`, the shape is moved so that its centroid becomes the origin of
    the body.

    Parameters
    ----------
    vertices : (n, 3)
        Vertices [m]; or an object with `vertices` and `faces`, such as that of trimesh, in place of both.
    faces : (k, 3)
        Triangles, as indices of vertices, counter-clockwise from outside.
    parts : sequence of (m, 3), "coacd" or None
        For a surface that is not convex: the corners of each of its convex parts, in the same axes as
        `vertices`. ``"coacd"``: the optional package of this name computes parts that cover the solid
        approximately. Default None: a convex mesh needs no parts; without parts, any other mesh cannot touch.

    Attributes
    ----------
    points : (n, 3)
        The vertices as given [m].
    faces : (k, 3)
        The triangles.
    centroid : (3,)
        Centroid of the solid, in the axes of `points` [m].
    volume
        Volume [m^3].
    size
        Largest distance of a vertex, or of a corner of a part, from the centroid [m].
    convex : bool
        Whether the mesh is convex.

    Raises
    ------
    ValueError
        If the surface is not closed, is not oriented outwards everywhere, or has degenerate triangles; or if a
        part is not a solid.
    ImportError
        If ``parts="coacd"`` is given and the package is missing.
    """

    points: np.ndarray
    faces: np.ndarray
    centroid: np.ndarray
    volume: float
    size: float
    convex: bool
    _pieces: tuple[Piece, ...]
    _spread: np.ndarray
    radius = 0.0  #: a mesh is not swollen [m]

    def __init__(
        self,
        vertices: Any,
        faces: ArrayLike | None = None,
        parts: Sequence | str | None = None,
    ):
        if faces is None and hasattr(vertices, "vertices") and hasattr(vertices, "faces"):
            vertices, faces = vertices.vertices, vertices.faces
        if faces is None:
            raise TypeError(
                "Mesh needs faces: Mesh(vertices, faces), or Mesh(an object of trimesh)"
            )
        points = checks.finite_array("vertices", vertices, (None, 3), unit="m")
        checks.length("the greatest of vertices", np.max(np.abs(points), initial=0.0), zero=True)
        triangles = _checked_faces(faces, points)

        def integrals(origin):
            return of_triangles((points - origin)[triangles])

        used = points[np.unique(triangles)]
        if not integrals(used.mean(axis=0))[0] > 0.0:
            raise ValueError(
                "faces must be counter-clockwise seen from outside, got a closed surface that is "
                "oriented inwards; reverse them: faces[:, ::-1]"
            )
        volume, centroid, second = about_centroid(integrals, used)
        convex = _is_convex(points, triangles)
        pieces = _pieces(points, triangles, centroid, convex, parts)
        far = [used - centroid, *(piece.vertices + piece.position for piece in pieces)]
        size = float(np.max(np.linalg.norm(np.concatenate(far), axis=1)))
        keep(self, points=points, faces=triangles, centroid=centroid, volume=volume, size=size)
        keep(self, convex=convex, _pieces=pieces, _spread=second / volume)

    @classmethod
    @arguments.known
    def load(
        cls, path: str | os.PathLike, *, scale: float = 1.0, parts: Sequence | str | None = None
    ) -> Mesh:
        """Return the mesh in a file: STL, OBJ, PLY, OFF, glTF and others that trimesh reads.

        Vertices at the same position are merged. A surface that is oriented inwards is turned. It is convex if
        no vertex is above a face by more than 1e-6 of its size: files have single precision.

        Parameters
        ----------
        path : str or path
            The file. All its meshes together are the surface.
        scale : float
            Length of the unit of the file [m], above 0: 1e-3 for millimetres. Default 1.
        parts
            As for `Mesh`, in metres.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ImportError
            If trimesh is missing (``carom[shapes]``).
        ValueError
            If trimesh cannot read the file, or `Mesh` refuses its surface.
        """
        file, scale = checks.path("path", path), checks.scale("scale", scale)
        trimesh = checks.need("trimesh", "Mesh.load", "shapes")
        if not os.path.isfile(file):
            raise FileNotFoundError(f"path must be a file with a mesh, got {str(file)!r}")
        try:
            found = trimesh.load_mesh(file)
            found.merge_vertices(merge_tex=True, merge_norm=True)
            vertices, faces = np.asarray(found.vertices), np.asarray(found.faces)
            if not len(faces):
                raise ValueError("it has no triangles")
        except Exception as error:  # each format has errors of its own
            raise ValueError(
                f"path must be a file with a mesh that trimesh reads, got {str(file)!r}: {error}"
            ) from error
        inwards = np.sum(np.linalg.det(vertices[faces])) < 0.0  # six times the volume
        faces = faces[:, ::-1] if inwards else faces
        rounded = parts is None and len(vertices) > 3 and _is_convex(vertices, faces, SINGLE)
        made = cls(scale * vertices, faces, [scale * vertices] if rounded else parts)
        keep(made, convex=made.convex or rounded)
        return made

    def __repr__(self) -> str:
        return f"Mesh(<{len(self.points)} vertices, {len(self.faces)} faces>)"

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Hulls of the mesh itself or of its parts."""
        if not self._pieces:
            raise ValueError(
                f"{self!r} is not convex and has no parts for contact; give them: Mesh(vertices, faces, "
                'parts=[corners of each convex part]), or parts="coacd" with that package installed'
            )
        return self._pieces

    def _inertia(self, mass: float) -> np.ndarray:
        return mass * (np.trace(self._spread) * np.eye(3) - self._spread)


def shape_given(shape) -> Any:
    """Return a shape as it is; an object of trimesh, with vertices and faces, as a `Mesh`."""
    if isinstance(shape, (Shape, type)) or not (
        hasattr(shape, "vertices") and hasattr(shape, "faces")
    ):
        return shape
    return Mesh(shape)


def _checked_faces(faces, points: np.ndarray) -> np.ndarray:
    """Return the triangles (k,3) of a closed, oriented surface without degenerate ones."""
    checks.real_array("faces", faces, "(k, 3)")
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or not np.issubdtype(given.dtype, np.integer):
        raise ValueError(f"faces must be whole numbers of shape (k, 3), got {checks.shown(faces)}")
    triangles = given.astype(np.int64)
    if len(triangles) < 4:
        raise ValueError(f"faces must be at least 4 to enclose a volume, got {len(triangles)}")
    low, high = triangles.min(), triangles.max()
    if low < 0 or high >= len(points):
        bad = low if low < 0 else high
        raise ValueError(
            f"faces must be numbers of vertices from 0 to {len(points) - 1}, got {bad}"
        )
    corners = points[triangles]
    sides = corners - np.roll(corners, 1, axis=1)
    longest = np.max(np.linalg.norm(sides, axis=2), axis=1)
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    thin = ~(areas > THIN * np.ptp(points, axis=0).max() * longest)
    if np.any(thin):
        k = int(np.argmax(thin))
        raise ValueError(
            f"faces must not be degenerate, got face {k} {triangles[k].tolist()} whose corners lie on one "
            f"line ({int(thin.sum())} such faces); leave them out"
        )
    _check_closed(triangles)
    return triangles


def _check_closed(triangles: np.ndarray) -> None:
    """Refuse a surface in which an edge is not used once in each direction."""
    edges = Counter((int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3))
    twice = [edge for edge, count in edges.items() if count > 1]
    if twice:
        raise ValueError(
            "faces must have one orientation, with each edge used once in each direction, got edge "
            f"{twice[0]} used twice in one direction ({len(twice)} such edges)"
        )
    open_edges = [(i, j) for i, j in edges if (j, i) not in edges]
    if open_edges:
        raise ValueError(
            f"faces must form a closed surface, got edge {open_edges[0]} with a face on one side only "
            f"({len(open_edges)} such edges); fill the holes, and merge vertices at the same position"
        )


def _is_convex(points, triangles, bulge: float = BULGE) -> bool:
    """Return True if no vertex lies above the plane of a face, by more than rounding."""
    used = points[np.unique(triangles)]
    size = np.ptp(used, axis=0).max()
    for a, b, c in points[triangles]:
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        if np.max((used - a) @ normal) > bulge * size:
            return False
    return True


def _pieces(points, triangles, centroid, convex, parts) -> tuple[Piece, ...]:
    """Return the convex pieces in body axes; an empty tuple if parts are needed but not given."""
    if parts is None:
        corners = [hull_of(points[np.unique(triangles)])[0]] if convex else []
    elif isinstance(parts, str):
        checks.choice("parts", parts, ("coacd",))
        corners = _decomposed(points, triangles)
    else:
        corners = checks.listed("parts", parts, "corners (m, 3) of convex parts")
        if not corners:
            raise ValueError("parts must be at least one set of corners (m, 3), got none")
    pieces = []
    for k, part in enumerate(corners):
        try:
            hull = Convex(part)
        except ValueError as error:
            raise ValueError(f"parts[{k}]: {error}") from None
        pieces += [
            piece.placed(hull.centroid - centroid, np.array([1.0, 0, 0, 0]))
            for piece in hull.pieces
        ]
    return tuple(pieces)


def _decomposed(points, triangles) -> list:
    """Return the corners of approximate convex parts by CoACD (Wei et al., SIGGRAPH 2022)."""
    coacd = checks.need("coacd", 'parts="coacd"', "shapes")
    coacd.set_log_level("error")
    return [vertices for vertices, _ in coacd.run_coacd(coacd.Mesh(points, triangles), seed=0)]
