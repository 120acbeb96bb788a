"""Checks of a scene from a file: the same as for parts that are added by the methods of `Scene`.

Records from a file are made without their constructors, which would change last digits. For the check they are
made again with their constructors, and the fields must agree up to rounding. For hulls, meshes and compounds,
which take long to make, only sizes and numbers are checked.
"""

from __future__ import annotations

import inspect
import math
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np

from carom import checks
from carom.scene import bodies, contacts, forces, joints, stops
from carom.scene.belts import BeltRelation, BeltStretch
from carom.scene.constraints import CONSTRAINTS, Constraint, Coupling, Gear
from carom.scene.coordinates import Combination, Length, Wrap, kind_of
from carom.scene.curves import Curve, Spline
from carom.scene.materials import Material
from carom.scene.pieces import Piece, Shape
from carom.scene.scene import Scene
from carom.scene.shapes.compound import Compound
from carom.scene.shapes.convex import Convex
from carom.scene.shapes.mesh import Mesh
from carom.scene.shapes.profile import Profile
from carom.scene.switch import Switch
from carom.scene.switches import SWITCHABLE
from carom.scene.user_surface import Surface

ROUNDING = 1e-9  # of what is worked out once more: of unit vectors, lengths, inertias
CORES = ("point", "segment", "box", "hull", "cylinder", "ellipsoid", "profile")
KINDS = (bodies.Body, *bodies.FIXED)


def check_record(record: Any) -> None:
    """Refuse a shape, material, law or definition that its constructor would not have made.

    Raises
    ------
    TypeError, ValueError
        With the name of the field.
    """
    kind = type(record)
    if kind in _LOOKS:
        _LOOKS[kind](record)
    elif kind is forces.Bushing:
        pairs = ("stiffness", "turn_stiffness", "damping", "turn_damping")
        given = {name: checks.finite_array(name, getattr(record, name), (3,))[:2] for name in pairs}
        _same(record, forces.Bushing(**given, axis=record.axis, anchor=record.anchor))
    else:
        _same(record, kind(**{name: getattr(record, name) for name in _arguments(kind)}))


def check_part(scene: Scene, part: Any) -> None:
    """Raise an error if the scene, with the parts before this one, would have refused this part.

    Raises
    ------
    TypeError, ValueError
        With the name of the field.
    """
    parts = scene._parts
    if not isinstance(part.name, str):
        raise ValueError(f"name must be a string, got {part.name!r}")
    index, _ = parts.new(type(part), part.name, "")
    if type(part.index) is not int or part.index != index:
        raise ValueError(f"index must be {index}, its number among its kind, got {part.index!r}")
    _same(part, _made(parts, part))


def check_pair(pair: frozenset) -> frozenset[str]:
    """Return the names of two parts that may touch, or be left out; raise for anything else."""
    allowed = (*KINDS, bodies.Ground)
    if len(pair) != 2 or not all(isinstance(one, allowed) for one in pair):
        raise ValueError(
            f"a pair must be two bodies, or a body and a half-space or static body, got {set(pair)}"
        )
    if not any(isinstance(one, bodies.Body) for one in pair):
        raise ValueError(f"one of a pair must be a body, got {set(pair)}")
    return frozenset(one.name for one in pair)


def _made(parts, part: Any) -> Any:
    """Return a part made again from its fields."""
    if isinstance(part, (joints.Joint, forces.AppliedForce, Constraint)):
        kinds = {joints.Joint: joints.JOINTS, forces.AppliedForce: forces.FORCES}
        checks.instance("definition", part.definition, kinds.get(type(part), CONSTRAINTS))
    if isinstance(part, (joints.Joint, forces.AppliedForce)):
        parts.pair(part.parent, part.child)  # a name is no body: `_same` finds out
    own = part.parts if isinstance(part, Constraint) else ()
    if isinstance(part, forces.AppliedForce):
        own = forces.force_on(part.definition) or ()
    for one in own:
        if isinstance(one, Length):
            parts.pair(one.parent, one.child)
            continue
        checks.instance("definition", one, (joints.Joint, bodies.Body))  # no name
        parts.member("definition", one, (joints.Joint, bodies.Body))
    if isinstance(part, stops.Stop):
        of = part.joint
        for one in of.joints if isinstance(of, Combination) else (of,):
            if isinstance(one, Length):
                parts.pair(one.parent, one.child)
            else:
                parts.member("joint", one, (joints.Joint,))
    if isinstance(part, Switch):
        for one in part.parts:
            parts.member("parts", one, SWITCHABLE)
    if isinstance(part, contacts.Contact):
        parts.member("body", part.body, (bodies.Body,))
        parts.member("other", part.other, KINDS)
        if part.body is part.other:
            raise ValueError(f"body and other must be two, got {part.body!r} for both")
    return type(part)(**{one.name: getattr(part, one.name) for one in fields(part)})


def _check_combination(record: Combination) -> None:
    if not isinstance(record.terms, tuple) or not record.terms:
        raise ValueError(f"terms must be a tuple of at least one, got {record.terms!r}")
    for joint, coordinate, factor in record.terms:
        kind_of(joint, coordinate)
        if checks.number("factor", factor) == 0.0:
            raise ValueError("factor must not be 0, got 0")


def _check_belt(record: BeltStretch | BeltRelation) -> None:
    """Raise for a strand or a belt whose fields do not fit each other."""
    _check_combination(record)
    if not isinstance(record.wheels, tuple) or len(record.wheels) != 2:
        raise ValueError(f"wheels must be two bodies, got {record.wheels!r}")
    for one in record.wheels:
        checks.instance("wheels", one, (bodies.Body,))
    checks.finite_array("centers", record.centers, (2, 3))
    checks.unit_vector("axis", record.axis)
    if not np.all(checks.finite_array("radii", record.radii, (2,)) != 0.0):
        raise ValueError(f"radii must not be 0, got {record.radii!r}")
    if isinstance(record, BeltRelation):
        checks.number("tension", record.tension, least=0.0)
        checks.number("start", record.start)


def _check_wrap(record: Wrap) -> None:
    """Raise for a rope whose fields do not fit each other."""
    if not isinstance(record.terms, tuple) or not record.terms:
        raise ValueError(f"terms must be a tuple of at least one, got {record.terms!r}")
    for joint, coordinate, factor in record.terms:
        kind_of(joint, coordinate)
        checks.number("factor", factor)
    count = len(record.terms)
    if not isinstance(record.slip, tuple) or len(record.slip) != count:
        raise ValueError(f"slip must be {count} numbers, got {record.slip!r}")
    if not all(isinstance(one, tuple) and len(one) == 2 for one in (record.strands, record.angles)):
        raise ValueError(
            f"strands and angles must be two each, got {record.strands!r}, {record.angles!r}"
        )
    for one in (*record.slip, *record.angles):
        checks.number("each of slip and angles", one)
    for one in record.strands:
        if checks.integer("each of strands", one, least=-1) >= count:
            raise ValueError(f"strands must be below {count}, got {record.strands!r}")
    if not isinstance(record.others, tuple) or not all(
        isinstance(one, tuple) and len(one) == 3 for one in record.others
    ):
        raise ValueError(f"others must be way, arc and friction of each, got {record.others!r}")
    for way, arc, friction in record.guides:
        if way not in (-1, 1):
            raise ValueError(f"way must be 1 or -1, got {way!r}")
        checks.number("arc", arc, least=0.0)
        checks.number("friction", friction, above=0.0)


@cache
def _arguments(kind: type) -> tuple[str, ...]:
    return tuple(inspect.signature(kind).parameters)


def _same(record: Any, made: Any) -> None:
    """Refuse a record whose fields differ from those of the record made again, beyond rounding."""
    for one in fields(made):
        here, there = getattr(record, one.name), getattr(made, one.name)
        if not _near(here, there):
            raise ValueError(f"{one.name} must be {there!r}, got {here!r}")


def _near(a: Any, b: Any) -> bool:
    if a is b:
        return True
    if isinstance(b, np.ndarray):
        alike = isinstance(a, np.ndarray) and a.shape == b.shape and a.dtype == b.dtype
        return alike and bool(np.all(np.abs(a - b) <= ROUNDING * np.max(np.abs(b), initial=0.0)))
    if isinstance(b, float):
        return type(a) in (int, float) and math.isclose(a, b, rel_tol=ROUNDING)
    if isinstance(b, tuple):
        return isinstance(a, tuple) and len(a) == len(b) and all(map(_near, a, b))
    if is_dataclass(b) or type(a) is not type(b):
        return False
    return a == b


def _check_convex(shape: Convex) -> None:
    """Raise for a hull whose fields do not fit each other."""
    points = _rows("points", shape.points)
    vertices = _rows("_vertices", shape._vertices)
    checks.number("radius", shape.radius, least=0.0)
    _solid(shape)
    if vertices.shape != points.shape:
        raise ValueError(f"_vertices must be as many as points, got {len(vertices)}")
    _check_faces(shape.faces, len(vertices))


def _check_mesh(shape: Mesh) -> None:
    """Raise for a mesh whose fields do not fit each other."""
    points, faces = _rows("points", shape.points), shape.faces
    if not (isinstance(faces, np.ndarray) and faces.dtype == np.int64 and faces.shape[1:] == (3,)):
        raise ValueError("faces must be whole numbers of shape (k, 3)")
    if not (faces.size and faces.min() >= 0 and faces.max() < len(points)):
        raise ValueError(f"faces must be numbers of vertices from 0 to {len(points) - 1}")
    checks.flag("convex", shape.convex)
    _solid(shape)
    _check_pieces(shape._pieces)


def _check_compound(shape: Compound) -> None:
    """Raise for a compound whose fields do not fit each other."""
    if not isinstance(shape.parts, tuple) or not shape.parts:
        raise ValueError("parts must be a tuple of at least one")
    for part, position, orientation, *material in shape.parts:
        checks.instance("a part", part, (Shape,))
        checks.finite_array("position of a part", position, (3,))
        checks.unit_quaternion("orientation of a part", orientation)
        for one in material:
            checks.instance("material of a part", one, (Material,))
    _solid(shape, flat=True)
    if not shape._pieces:
        raise ValueError("_pieces must be at least one")
    _check_pieces(shape._pieces)


def _check_profile(shape: Profile) -> None:
    """Raise for a profile whose fields do not fit each other."""
    checks.number("thickness", shape.thickness, above=0.0)
    _solid(shape)
    _check_outline(shape.rows)


def _check_outline(rows) -> None:
    """Refuse a curve without pieces, or whose pieces do not follow each other, or with wrong directions."""
    rows = checks.finite_array("outline", rows, (None, 13))
    if not (len(rows) > 3 and rows[0, 0] == 0.0 and np.all(np.diff(rows[:, 0]) >= 0.0)):
        raise ValueError("outline must be rows of arc lengths that increase from 0")
    if not np.all(np.abs(np.linalg.norm(rows[:, 3:5], axis=1) - 1.0) <= ROUNDING):
        raise ValueError("outline must have directions of length 1")
    if not _near(rows[-1, 1:5], rows[0, 1:5]):
        raise ValueError("outline must be closed")


def _check_piece(piece: Piece) -> None:
    """Raise for a piece whose fields do not fit each other."""
    checks.choice("kind", piece.kind, CORES)
    if not np.all(checks.finite_array("half", piece.half, (3,)) >= 0.0):
        raise ValueError(f"half must be at least 0, got {piece.half!r}")
    for name in ("radius", "inner", "extent", "bend"):
        checks.number(name, getattr(piece, name), least=0.0)
    checks.finite_array("position", piece.position, (3,))
    checks.unit_quaternion("orientation", piece.orientation)
    checks.instance("material", piece.material, (Material, type(None)))
    checks.finite_array("hollows", piece.hollows, (None, 2))
    if piece.kind == "profile":
        _check_outline(piece.outline)
    elif len(piece.outline) or len(piece.hollows):
        raise ValueError(f"outline and hollows must be none of a {piece.kind}")
    vertices = _rows("vertices", piece.vertices, 4 if piece.kind == "hull" else 0)
    if piece.kind == "hull":
        _check_faces(piece.faces, len(vertices))
    elif len(vertices) or piece.faces != ():
        raise ValueError(f"vertices and faces must be none of a {piece.kind}")


def _check_curve(curve: Curve) -> None:
    """Raise for a curve whose table has no pieces, or directions that are no unit vectors."""
    knots = checks.finite_array("knots", curve.knots, (None,))
    ends = checks.finite_array("ends", curve.ends, (len(knots), 3, 3))
    if not (len(knots) > 1 and knots[0] == 0.0 and np.all(np.diff(knots) > 0.0)):
        raise ValueError("knots must be two or more numbers that increase from 0")
    if not np.all(np.abs(np.linalg.norm(ends[:, 1], axis=1) - 1.0) <= ROUNDING):
        raise ValueError("ends must have directions of length 1")
    if checks.flag("closed", curve.closed) and not np.array_equal(ends[0], ends[-1]):
        raise ValueError("ends of a closed curve must be equal")


def _check_surface(surface: Surface) -> None:
    """Raise for a surface of a function, which may be missing, with a wrong box or bound."""
    for name in ("function", "gradient", "hessian"):
        checks.function(name, getattr(surface, name), optional=name != "function")
    if (surface.gradient is None) != (surface.hessian is None):
        raise ValueError("gradient and hessian must be given both or not at all")
    low, high = checks.finite_array("bounds", surface.bounds, (2, 3))
    if not np.all(high > low):
        raise ValueError(f"bounds must have sides above 0, got {checks.shown(surface.bounds)}")
    checks.number("bend", surface.bend, least=0.0)
    checks.number("steepest", surface.steepest, above=0.0)


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


#: records that are not made again: their checks
_LOOKS = {
    Convex: _check_convex, Mesh: _check_mesh, Compound: _check_compound, Piece: _check_piece,
    Profile: _check_profile, Curve: _check_curve, Spline: _check_curve, Surface: _check_surface,
    **dict.fromkeys((Combination, Coupling, Gear), _check_combination),
    **dict.fromkeys((BeltStretch, BeltRelation), _check_belt),
    Wrap: _check_wrap,
}  # fmt: skip
