"""Find the level surfaces of the solids of a scene, and make the rows of contacts that stand for them.

Two faces are level if each corner of one is within the tolerance RESOLUTION times the size of the larger solid
from the plane of the other, and their normals agree. A surface is a set of level faces that are joined: each
touches another one, with a crack of at most the same tolerance. So a step or a crack above 1e-9 of the size
of a solid is an obstacle. Solids whose edges are rounded have none: there is a groove between them.

A body has one row for each surface, as for a half-space whose points count only above the faces
(`carom.contact.kinds.level_surfaces`). Where the laws of contact differ, each part of a surface with one law
has its own row. The rows of the solids themselves then have only contacts at the rims, and at other faces.

Faces of one moving body are level in its own axes. Its solids keep their points, each with its law; only what
the surface hides is left out, and points on one surface belong together.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.collision.level_layout import (
    LEVEL_FACE,
    LEVEL_SIDE,
    RIM_SEGMENT,
    SURFACE,
    Levels,
    no_levels,
)
from carom.geometry import quaternion
from carom.geometry.frames import contact_axes
from carom.geometry.thresholds import LAST_DIGIT, RESOLUTION
from carom.model.arrays import CONTACT
from carom.model.contact_kinds import ON_LEVEL
from carom.model.graph import Sets
from carom.scene.all_pairs import PairTable
from carom.scene.friction import anisotropy_of
from carom.scene.pieces import Piece
from carom.scene.scene import Scene
from carom.scene.speed_law import SpeedLaw

#: corners of the faces of a box, numbered as in `carom.scene.pieces.SIGNS`, counter-clockwise from outside
BOX_RINGS = (
    (0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3),
)  # fmt: skip


class Face(NamedTuple):
    """A face of a static solid, in the world."""

    solid: int
    static: int  # number of the static body
    material: str  # of its piece, in words, so that materials have an order
    size: float  # of the solid
    thickness: float  # of the solid below the face
    normal: np.ndarray  # (3,)
    corners: np.ndarray  # (n, 3) counter-clockwise about the normal
    inward: np.ndarray  # (n, 3) of each side, from a corner to the next
    levels: np.ndarray  # (n,) of each side
    centre: np.ndarray  # (3,)
    reach: float  # largest distance of a corner from the centre


class Region(NamedTuple):
    """The faces of a surface with one law of contact."""

    surface: int
    first: int  # range of its faces
    last: int


def find_levels(
    scene: Scene, pairs: PairTable, place: np.ndarray, every: list, to_principal: np.ndarray
) -> tuple[Levels, list[Region]]:
    """Return the level surfaces of a scene, those of static solids first, and their regions.

    In `pairs`, static bodies have the numbers after those of bodies that move; `place` has the first solid of
    each, and `every` its shape if it may touch other bodies.
    """
    surfaces, regions = _of_statics(scene, pairs, place) if scene.statics else ([], [])
    for b, shape in enumerate(every[: len(scene.bodies)]):
        if shape is not None and len(shape.pieces) > 1:
            surfaces += _of_shape(shape, tuple(to_principal[b].tolist()), int(place[b]))
    return (_tables(surfaces), regions) if surfaces else (no_levels(), [])


@lru_cache(maxsize=64)
def _of_shape(shape, to_principal: tuple[float, ...], first: int) -> list[tuple]:
    """Return the surfaces of a body that moves, in its principal axes; `first` is its first solid."""
    back = quaternion.conjugate(np.array(to_principal))
    faces = []
    for k, piece in enumerate(shape.pieces):
        if is_sharp(piece) and piece.corners is not None:
            faces += _faces_of(first + k, 0, piece, quaternion.rotate(back, piece.corners))
    surfaces = []
    for group in _joined(faces := _bare(faces), [((), ())]):
        members = [faces[i] for i in group]
        rims = _rims(members) if len(group) > 1 else None
        if rims is not None and len(rims[1]) < sum(len(face.corners) for face in members):
            surfaces.append((members, *rims))
    return surfaces


def _of_statics(scene: Scene, pairs: PairTable, place: np.ndarray) -> tuple[list, list[Region]]:
    """Return the surfaces of static solids, and their regions."""
    laws = _laws_of_statics(scene, pairs)
    faces = _bare([face for face in _faces(scene, place) if laws[face.static][0]])
    groups = [group for group in _joined(faces, laws) if len(group) > 1]
    surfaces, regions = [], []
    for group in groups:
        rims = _rims([faces[i] for i in group])
        if len(rims[1]) == sum(len(faces[i].corners) for i in group):  # no edge is between two
            continue
        group = sorted(group, key=lambda i: (laws[faces[i].static][1], faces[i].material))
        surfaces.append(([faces[i] for i in group], *rims))
    at = 0
    for s, (members, *_) in enumerate(surfaces):
        keys = [(laws[face.static][1], face.material) for face in members]
        changes = [k for k in range(1, len(keys)) if keys[k] != keys[k - 1]]
        for first, last in zip([0, *changes], [*changes, len(keys)]):
            regions.append(Region(s, at + first, at + last))
        at += len(members)
    return surfaces, regions


def _laws_of_statics(scene: Scene, pairs: PairTable) -> list[tuple[tuple, tuple]]:
    """Return for each static body the bodies that may touch it, and the laws of these contacts."""
    count, found = len(scene.bodies), [([], []) for _ in scene.statics]
    for body, other, law in zip(pairs.body.tolist(), pairs.other.tolist(), pairs.law.tolist()):
        if other >= count:
            one = pairs.laws[law]
            found[other - count][0].append(body)
            found[other - count][1].append(
                (
                    body, *_sortable(one.friction), *_sortable(one.friction_held), *_sortable(one.restitution),
                    one.tangential_restitution, one.relative_stiffness, one.adhesion,
                    one.rolling_friction, one.pivoting_friction, str(one.impact_law), str(one.multiple),
                    other if scene.statics[other - count].moves or anisotropy_of(one.friction) else -1,
                )
            )  # fmt: skip
    return [(tuple(sorted(bodies)), tuple(sorted(laws))) for bodies, laws in found]


def _sortable(e: float | SpeedLaw) -> tuple[float, str]:
    """Return a coefficient as a key that has an order: numbers, then laws, which are written out."""
    return (np.inf, repr(e)) if isinstance(e, SpeedLaw) else (e, "")


def _faces(scene: Scene, place: np.ndarray) -> Iterator[Face]:
    """Return the faces of all static solids with sharp edges."""
    for s, static in enumerate(scene.statics):
        for k, piece in enumerate(static.shape.pieces):
            if is_sharp(piece) and piece.corners is not None:
                world = static.position + quaternion.rotate(static.orientation, piece.corners)
                yield from _faces_of(int(place[len(scene.bodies) + s]) + k, s, piece, world)


def is_sharp(piece: Piece) -> bool:
    """Return whether a piece has faces with sharp edges."""
    return piece.radius == 0.0 and piece.kind in ("box", "hull")


def _faces_of(solid: int, static: int, piece: Piece, corners: np.ndarray) -> list[Face]:
    """Return the faces of a solid with these vertices."""
    rings = BOX_RINGS if piece.kind == "box" else (ring for _, ring in piece.faces)
    return [_face(solid, static, piece, corners, corners[list(ring)]) for ring in rings]


def _face(solid: int, static: int, piece: Piece, every: np.ndarray, corners: np.ndarray) -> Face:
    """Return a face with these corners, of a solid with these vertices."""
    sides = corners[[*range(1, len(corners)), 0]] - corners
    centre = corners.mean(axis=0)
    normal = _cross(sides[0], corners[2] - corners[1])
    normal /= math.sqrt(normal @ normal)
    inward = _cross(normal, sides.T).T
    inward /= np.sqrt(np.sum(inward**2, axis=1))[:, None]
    reach = math.sqrt(np.max(np.sum((corners - centre) ** 2, axis=1)))
    levels = np.sum(inward * corners, axis=1)
    thickness = float(np.max((centre - every) @ normal))
    return Face(
        solid=solid, static=static, material=repr(piece.material), size=piece.extent,
        thickness=thickness, normal=normal, corners=corners, inward=inward, levels=levels,
        centre=centre, reach=reach,
    )  # fmt: skip


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a x b, much faster than `numpy.cross` for few vectors; components are the first axis."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def _near(faces: list[Face], facing: float) -> Iterator[tuple[int, int]]:
    """Return pairs i < j of faces in about one plane that are near each other.

    `facing` is 1 for equal normals, -1 for opposite ones.
    """
    normals = np.array([face.normal for face in faces]).reshape(-1, 3)
    centres = np.array([face.centre for face in faces]).reshape(-1, 3)
    reaches = np.array([face.reach for face in faces])
    sizes = np.array([face.size for face in faces])
    order = np.argsort(centres[:, 0] - reaches, kind="stable")
    low, high = (centres[:, 0] - reaches)[order], (centres[:, 0] + reaches)[order]
    for at, i in enumerate(order.tolist()):
        face = faces[i]
        tolerance = RESOLUTION * np.maximum(sizes, face.size).max()
        end = np.searchsorted(low, high[at] + tolerance, side="right")
        others = order[at + 1 : end]
        apart = centres[others] - face.centre
        near = np.abs(apart @ face.normal) <= tolerance
        near &= facing * (normals[others] @ face.normal) > 0.5
        near &= np.sum(apart**2, axis=1) <= (reaches[others] + face.reach + tolerance) ** 2
        for j in others[near].tolist():
            yield min(i, j), max(i, j)


def _bare(faces: list[Face]) -> list[Face]:
    """Return the faces that do not lie against one face of another solid with all of their area."""
    hidden = set()
    for i, j in _near(faces, -1.0):
        a, b = faces[i], faces[j]
        tolerance = RESOLUTION * max(a.size, b.size)
        if _level(a, b):
            for k, one, other in ((i, a, b), (j, b, a)):
                if np.min(one.corners @ other.inward.T - other.levels) >= -tolerance:
                    hidden.add(k)
    return [face for k, face in enumerate(faces) if k not in hidden]


def _joined(faces: list[Face], laws: list) -> list[list[int]]:
    """Return the groups of joined level faces, of solids that the same bodies may touch."""
    sets = Sets(len(faces))
    for i, j in _near(faces, 1.0):
        a, b = faces[i], faces[j]
        same = sets.find(i) == sets.find(j) or laws[a.static][0] != laws[b.static][0]
        if not same and _level(a, b) and _touch(a, b):
            sets.join(i, j)
    groups: dict[int, list[int]] = {}
    for i in range(len(faces)):
        groups.setdefault(sets.find(i), []).append(i)
    return list(groups.values())


def _level(a: Face, b: Face) -> bool:
    """Return whether two faces are in one plane."""
    tolerance = RESOLUTION * max(a.size, b.size)
    above = np.abs((b.corners - a.centre) @ a.normal), np.abs((a.corners - b.centre) @ b.normal)
    return bool(max(above[0].max(), above[1].max()) <= tolerance)


def _touch(a: Face, b: Face) -> bool:
    """Return whether two faces in one plane touch: no side separates them by more than the tolerance."""
    tolerance = RESOLUTION * max(a.size, b.size)
    for one, other in ((a, b), (b, a)):
        inside = other.corners @ one.inward.T - one.levels
        if np.any(inside.max(axis=0) < -tolerance):
            return False
    return True


def _rims(faces: list[Face]) -> tuple[float, np.ndarray]:
    """Return the tolerance of a surface, and the parts (E, 2, 3) of edges beyond which no face continues."""
    tolerance = RESOLUTION * max(face.size for face in faces)
    centres = np.array([face.centre for face in faces])
    reaches = np.array([face.reach for face in faces])
    rims, alone = [], _edges_of_one(faces, tolerance)
    for i, face in enumerate(faces):
        for k in alone[i]:
            p, q = face.corners[k], face.corners[(k + 1) % len(face.corners)]
            inward = face.inward[k]
            length = math.sqrt((q - p) @ (q - p))
            far = np.sum((centres - 0.5 * (p + q)) ** 2, axis=1)
            near = np.flatnonzero(far <= (reaches + 0.5 * length + 8.0 * tolerance) ** 2)
            # parts of a line a little outside of the edge that other faces cover
            begin, end = p - 4.0 * tolerance * inward, q - 4.0 * tolerance * inward
            covered = (_part_inside(faces[j], begin, end, 2.0 * tolerance) for j in near if j != i)
            parts = [part for part in covered if part is not None]
            for a, b in _left_over(parts, 4.0 * tolerance / length):
                rims.append((p + a * (q - p), p + b * (q - p)))
    return tolerance, np.array(rims).reshape(-1, 2, 3)


def _edges_of_one(faces: list[Face], tolerance: float) -> list[list[int]]:
    """Return for each face its edges that are not also an edge of one other face, on its other side."""
    place: dict[tuple, list[tuple[int, int]]] = {}
    for i, face in enumerate(faces):
        middles = face.corners + face.corners[[*range(1, len(face.corners)), 0]]
        for k, key in enumerate(map(tuple, np.round(middles / (1e3 * tolerance)).tolist())):
            place.setdefault(key, []).append((i, k))
    alone: list[list[int]] = [[] for _ in faces]
    for edges in place.values():
        shared = False
        if len(edges) == 2:
            (i, k), (j, m) = edges
            shared = _same_edge((faces[i], k), (faces[j], m), tolerance)
        for i, k in edges if not shared else ():
            alone[i].append(k)
    return alone


def _same_edge(a: tuple[Face, int], b: tuple[Face, int], tolerance: float) -> bool:
    """Return whether two edges, each of a face, have the same ends in reverse order."""
    (one, i), (other, j) = a, b
    ends = one.corners[[i, (i + 1) % len(one.corners)]]
    return bool(np.abs(ends - other.corners[[(j + 1) % len(other.corners), j]]).max() <= tolerance)


def _part_inside(face: Face, begin: np.ndarray, end: np.ndarray, tolerance: float):
    """Return the part (a, b) of a segment, from 0 to 1, inside a face; None if there is none."""
    f = face.inward @ begin - face.levels + tolerance
    slope = face.inward @ (end - begin)
    low, high = 0.0, 1.0
    for value, rate in zip(f.tolist(), slope.tolist()):
        if rate == 0.0 and value < 0.0:
            return None
        if rate > 0.0:
            low = max(low, -value / rate)
        elif rate < 0.0:
            high = min(high, -value / rate)
    return (low, high) if high > low else None


def _left_over(parts: list[tuple[float, float]], least: float) -> list[tuple[float, float]]:
    """Return the parts of [0, 1] that are longer than `least` and in none of the given ones."""
    found, at = [], 0.0
    for low, high in sorted(parts):
        if low - at > least:
            found.append((at, low))
        at = max(at, high)
    if 1.0 - at > least:
        found.append((at, 1.0))
    return found


def _tables(surfaces: list[tuple[list[Face], float, np.ndarray]]) -> Levels:
    """Return the arrays of the surfaces; `own` is made with the rows of contacts."""
    every = [face for faces, *_ in surfaces for face in faces]
    surface, face_rows = table(SURFACE, len(surfaces)), table(LEVEL_FACE, len(every))
    side_rows = table(LEVEL_SIDE, sum(len(face.corners) for face in every))
    rim_rows = table(RIM_SEGMENT, sum(len(rims) for *_, rims in surfaces))
    face_at = side_at = rim_at = 0
    for row, (faces, tolerance, rims) in zip(surface, surfaces):
        largest = max(faces, key=lambda face: face.reach)
        row.normal[:] = _rounded(largest.normal)
        row.offset, row.tolerance = float(largest.centre @ row.normal), tolerance
        row.first, row.last = face_at, face_at + len(faces)
        row.first_rim, row.last_rim = rim_at, rim_at + len(rims)
        for one, (begin, end) in zip(rim_rows[rim_at : rim_at + len(rims)], rims):
            one.begin[:], one.end[:] = begin, end
        for one, face in zip(face_rows[face_at : face_at + len(faces)], faces):
            count = len(face.corners)
            one.centre[:], one.reach = face.centre, face.reach
            one.thickness, one.solid = face.thickness, face.solid
            one.first, one.last = side_at, side_at + count
            mine = side_rows[side_at : side_at + count]
            mine["inward"], mine["level"], mine["corner"] = face.inward, face.levels, face.corners
            side_at += count
        face_at, rim_at = face_at + len(faces), rim_at + len(rims)
    surface_of = np.repeat(np.arange(len(surface)), surface["last"] - surface["first"])
    pairs = np.unique(np.stack([face_rows["solid"], surface_of], axis=1), axis=0)
    solids, own = np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1])
    face_rows["first_own"] = np.searchsorted(solids, face_rows["solid"], "left")
    face_rows["last_own"] = np.searchsorted(solids, face_rows["solid"], "right")
    return Levels(surface, face_rows, side_rows, rim_rows, own, solids)


def _rounded(normal: np.ndarray) -> np.ndarray:
    """Return a normal without the round-off of zero in its components."""
    normal = np.where(np.abs(normal) < LAST_DIGIT, 0.0, normal)
    return normal / np.linalg.norm(normal)


def with_level_rows(rows: np.recarray, levels: Levels, regions: list[Region]) -> np.recarray:
    """Return the rows of contacts with those of level surfaces, sorted by number."""
    if not regions:
        return rows
    more = [rows]
    for region in regions:
        surface, first = levels.surfaces[region.surface], levels.faces[region.first]
        chosen = (rows["static"] == 1) & (rows["other_solid"] == first.solid)
        more.append(_surface_rows(rows[chosen].view(Columns), surface, region))
    joined = np.concatenate(more)
    return joined[np.argsort(joined["number"], kind="stable")].view(Columns)


def note_own(rows: np.recarray, levels: Levels) -> None:
    """Write to rows of two solids the ranges of the surfaces of both in `Levels.own`."""
    if not len(levels.own):
        return
    pair = (rows["other"] >= 0) | (rows["static"] == 1)
    for first, last, solid in (
        ("first_level", "last_level", "other_solid"), ("first_mine", "last_mine", "solid"),
    ):  # fmt: skip
        own = rows[solid][pair]
        rows[first][pair] = np.searchsorted(levels.solid_of_own, own, "left")
        rows[last][pair] = np.searchsorted(levels.solid_of_own, own, "right")


def _surface_rows(rows: np.recarray, surface: np.record, region: Region) -> np.recarray:
    """Return rows for a region of a surface, made from those of one of its solids."""
    out = table(CONTACT, len(rows))
    out[:] = rows
    for name in ("first", "last", "other_first", "other_last", "other_solid", "static"):
        out[name] = 0
    out["other"], out["kind"] = -1, ON_LEVEL
    out["axes"], out["offset"] = contact_axes(surface.normal), surface.offset
    out["surface"], out["first_level"] = region.surface + 1, region.first
    out["last_level"] = region.last
    return out
