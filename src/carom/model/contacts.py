"""The contacts of a scene as arrays."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom._compiled.template import Template
from carom.collision.layout import SOLID, Hulls, no_hulls, solid_table
from carom.collision.level_layout import Levels
from carom.geometry import quaternion
from carom.geometry.frames import contact_axes, length, upright
from carom.model.arrays import BODY_AXES, CONTACT, OTHER_AXES, WORLD_AXES
from carom.model.contact_kinds import write_kinds
from carom.model.contact_rows import Rows, contact_rows, first_pairs
from carom.model.cores import Cores, new_cores, singly, swollen_alike
from carom.model.laws import LawTable
from carom.model.level_surfaces import find_levels, note_own, with_level_rows
from carom.model.moving_surfaces import write_fields
from carom.model.thresholds import LAYER_WIDTH, LEAST_SPEED, MOST_DEFLECTION, STILL_SPEED
from carom.options import Options
from carom.scene.all_pairs import Defaults, PairTable, meeting
from carom.scene.friction import FIXED_TO, anisotropy_of
from carom.scene.materials import ContactLaw, Material
from carom.scene.scene import Scene
from carom.scene.shapes import Shape
from carom.scene.speed_law import SpeedLaw
from carom.scene.stiffness import Hertz
from carom.scene.surfaces import SurfaceDefinition


class Surfaces(NamedTuple):
    """The surfaces of bodies, from which rows of contacts are made, at the start and later."""

    grounded: Cores  # against half-spaces
    single: Cores  # piece by piece, against each other
    shared: int  # first vertex of `single`, after those of contacts with half-spaces
    place: np.ndarray  # (N,) first solid of each body
    solids: np.recarray  # SOLID
    laws: LawTable
    first_law: int  # number of the first law of the pairs, which has two
    turns: np.ndarray  # (N + S, 4) from principal to body axes; of static bodies from world axes
    levels: Levels


class Contacts(NamedTuple):
    """The contacts of a scene at the start, and the data for further ones."""

    rows: np.recarray  # CONTACT
    vertices: np.ndarray  # (V, 3)
    solids: np.recarray  # SOLID, of bodies whose points the kernels of pairs find
    hulls: Hulls
    levels: Levels
    pairs: PairTable  # those of the rows, by number
    surfaces: Surfaces
    later: Defaults | None  # pairs of bodies that get rows when they come near each other


def compile_contacts(
    scene: Scene, to_principal, options: Options, laws: LawTable, apart: bool = False
) -> Contacts:
    """Return the contacts of a scene.

    A contact of two bodies has a row for each pair of pieces. Faces of static bodies in one plane have rows of
    their own (`carom.model.level_surfaces`). A contact with a half-space has one row for all
    vertices of equal radius, and one for each curved piece. If bodies move `apart`, more rows may follow later.
    """
    known, later = first_pairs(scene, apart)
    first_law = len(laws.rows)
    laws.stiffest = _stiffest(known, later is not None)
    for one in known.laws:
        laws.add_pair(one)
    many = later is not None or len(known.body) > FEW_CONTACTS
    own = scene.statics or any(plane.moves for plane in scene.half_spaces)
    own = own or any(law.of_materials for law in known.laws)
    if many or own or not scene.gravity.any():  # without gravity, speeds count too
        return _contacts(scene, known, later, (laws, first_law), to_principal, options)
    # contacts of scenes that differ in their motion, as in many throws, are copies of each other
    of_pairs = known.body, known.other, known.plane, known.law, to_principal, scene.gravity
    key = (
        *(one.tobytes() for one in of_pairs), first_law, options.layer_width, options.penetration,
        *(anisotropy_of(one.friction) for one in known.laws),
        *((plane.point.tobytes(), plane.normal.tobytes()) for plane in scene.half_spaces),
        *((body.shape, body.modes is None) for body in scene.bodies),
    )  # fmt: skip
    template = _KNOWN.get(key)
    if template is not None:
        made = template.make()
        return made._replace(pairs=known, surfaces=made.surfaces._replace(laws=laws))
    if len(_KNOWN) >= MOST_KNOWN:
        _KNOWN.clear()
    made = _contacts(scene, known, None, (laws, first_law), to_principal, options)
    bare = made._replace(pairs=None, surfaces=made.surfaces._replace(laws=None))
    _KNOWN[key] = Template(bare)
    return made


def _stiffest(known: PairTable, more: bool) -> float:
    """Return the greatest modulus E* [Pa] of the pairs, if all have Hertz's law, else 0.

    If `more` pairs may come, all laws count.
    """
    used = known.laws if more else [known.laws[k] for k in sorted(set(known.law.tolist()))]
    moduli = [law.stiffness.modulus for law in used if isinstance(law.stiffness, Hertz)]
    return max(moduli) if moduli and len(moduli) == len(used) else 0.0


#: contacts by all that they depend on
_KNOWN: dict[tuple, Template] = {}
FEW_CONTACTS = 64  # pairs of a scene whose contacts are kept
MOST_KNOWN = 64  # such scenes


def _contacts(scene: Scene, known: PairTable, later, laws, to_principal, options: Options):
    """Return the contacts of the pairs `known`; `laws` are all laws, and the number of the first of these."""
    pairs, to_principal = _with_statics(scene, known), _and_of_statics(scene, to_principal)
    meets = pairs.other >= 0
    bends = [getattr(part, "modes", None) is not None for part in _parts(scene)]
    grounded = new_cores(_shapes(scene, pairs.body[~meets]), swollen_alike, to_principal, bends)
    others = np.zeros(0, dtype=np.int64) if later is None else np.flatnonzero(meeting(later))
    every = _shapes(scene, pairs.body[meets], pairs.other[meets], others)
    single = new_cores(every, singly, to_principal)
    which = contact_rows(pairs, grounded, single)
    flat, curved = pairs.other[which.number] < 0, which.core["curved"] == 1
    rolls = pairs.body[which.number[flat & curved]]
    place, solids, hulls = _solids(scene, every, rolls, to_principal)
    _place_statics(scene, single, solids, place)
    # a vertex carries a contact, so each row with a half-space has its own
    ranges = (which.core[end][flat & ~curved].tolist() for end in ("first", "last"))
    own = [grounded.vertices[first:last] for first, last in zip(*ranges)]
    vertices = np.concatenate([*own, single.vertices])
    levels, regions = find_levels(scene, pairs, place, every, to_principal)
    surfaces = Surfaces(
        grounded,
        single,
        len(vertices) - len(single.vertices),
        place,
        solids,
        laws[0],
        laws[1],
        to_principal,
        levels,
    )
    rows = with_level_rows(_rows(scene, options, pairs, which, surfaces), levels, regions)
    return Contacts(rows, vertices, solids, hulls, levels, known, surfaces, later)


def _with_statics(scene: Scene, pairs: PairTable) -> PairTable:
    """Return the pairs with static bodies as bodies, which come after those that move."""
    if not scene.statics:
        return pairs
    static = pairs.plane - len(scene.half_spaces)
    other = np.where(static >= 0, len(scene.bodies) + static, pairs.other)
    return replace(pairs, other=other, plane=np.where(static >= 0, -1, pairs.plane))


def _and_of_statics(scene: Scene, to_principal: np.ndarray) -> np.ndarray:
    """Return the rotations (N + S, 4) from the axes in use to body axes; static bodies use world axes."""
    if not scene.statics:
        return to_principal
    axes = [quaternion.conjugate(solid.orientation) for solid in scene.statics]
    return np.concatenate([to_principal, np.reshape(axes, (-1, 4))])


def _place_statics(scene: Scene, single: Cores, solids: np.recarray, place: np.ndarray) -> None:
    """Move vertices and solids of static bodies, which are rotated already, to their world positions."""
    for b, solid in enumerate(scene.statics, start=len(scene.bodies)):
        mine = single.group[single.first[b] : single.first[b + 1]]
        if len(mine):
            single.vertices[mine["first"][0] : mine["last"][-1]] += solid.position
            solids["x"][place[b] : place[b] + len(mine)] += solid.position


def more_contacts(
    scene: Scene, options: Options, pairs: PairTable, surfaces: Surfaces, first: int
) -> np.recarray:
    """Return the rows of further pairs of two bodies, numbered from `first` on."""
    which = contact_rows(pairs, surfaces.grounded, surfaces.single)
    rows = _rows(scene, options, pairs, which, surfaces)
    rows["number"] += first
    return rows


def _rows(scene, options: Options, pairs: PairTable, which: Rows, surfaces: Surfaces):
    """Return the rows of contacts."""
    rows = table(CONTACT, len(which.number))
    rows["number"], rows["body"] = which.number, pairs.body[which.number]
    rows["other"] = pairs.other[which.number]
    _write_half_spaces(rows, scene, pairs.plane[which.number])
    write_fields(rows, scene, pairs.plane[which.number])
    _write_shapes(rows, which)
    _write_ranges(rows, which, surfaces.shared)
    _write_solids(rows, which, surfaces.place)
    _write_laws(rows, scene, pairs, which, surfaces)
    _write_statics(rows, scene)
    write_kinds(rows, surfaces.solids)
    note_own(rows, surfaces.levels)
    _write_bends(rows, scene)
    extent = rows["extent"]
    rows["still"] = np.maximum(STILL_SPEED * _speed(scene, extent), LEAST_SPEED)
    rows["width"] = LAYER_WIDTH * extent if options.layer_width is None else options.layer_width
    rows["penetration"] = options.penetration
    return rows


def _write_bends(rows: np.recarray, scene: Scene) -> None:
    """Write which rows have a body with modes, and make room around it for its deflection."""
    bends = np.array([getattr(part, "modes", None) is not None for part in _parts(scene)] + [False])
    if not bends.any():
        return
    for side, name in (("body", "extent"), ("other", "other_extent")):
        bent = bends[rows[side]]
        rows["bends"][bent] = 1
        rows[name][bent] *= 1.0 + MOST_DEFLECTION


def _speed(scene: Scene, extent: np.ndarray) -> np.ndarray | float:
    """Return the speed of a fall by the size of a body; without gravity, the greatest speed at the start."""
    if scene.gravity.any():
        return np.sqrt(length(scene.gravity) * extent)
    return max((length(body.velocity) for body in scene.bodies), default=0.0)


def _shapes(scene: Scene, *chosen: np.ndarray) -> list[Shape | None]:
    """Return the shape of each body, None for those that are not chosen."""
    bodies = {b for some in chosen for b in some.tolist()}
    return [part.shape if b in bodies else None for b, part in enumerate(_parts(scene))]


def _parts(scene: Scene) -> tuple:
    """Return the bodies, then the static ones."""
    return (*scene.bodies, *scene.statics)


def _write_statics(rows: np.recarray, scene: Scene) -> None:
    """Write whether the other side of each row is static, and its position; for kernels it is not a body."""
    if not scene.statics:
        return
    count = len(scene.bodies)
    rows["static"] = rows["other"] >= count
    for b, solid in enumerate(scene.statics, start=count):
        rows["centre"][rows["other"] == b] = solid.position
        if isinstance(solid.shape, SurfaceDefinition):
            rows["axes"][rows["other"] == b] = upright(scene.gravity)
    rows["other"][rows["static"] == 1] = -1
    rows["axis_of"][(rows["static"] == 1) & (rows["axis_of"] == OTHER_AXES)] = WORLD_AXES


def _write_half_spaces(rows: np.recarray, scene: Scene, plane: np.ndarray) -> None:
    """Write axes and offset of the half-space of each row; `plane` is its index, -1 for none."""
    for h, half_space in enumerate(scene.half_spaces):
        here = plane == h
        rows["axes"][here] = contact_axes(half_space.normal)
        rows["offset"][here] = half_space.point @ half_space.normal


def _write_shapes(rows: np.recarray, which: Rows) -> None:
    """Write form and size of both sides."""
    core, other = which.core, which.other
    rows["ball_like"] = np.maximum(core["ball_like"], other["ball_like"])
    rows["part"] = np.maximum(core["several"], other["several"])
    rows["extent"], rows["other_extent"] = core["extent"], other["extent"]
    rows["radius"], rows["core"] = core["radius"] + other["radius"], core["reach"]


def _write_ranges(rows: np.recarray, which: Rows, shared: int) -> None:
    """Write the ranges of vertices.

    Each row with a half-space has its own vertices. Points of two bodies are found anew in each state, so all
    contacts of a piece share its vertices, which begin at `shared`.
    """
    core, other = which.core, which.other
    flat = (rows["other"] < 0) & (core["curved"] == 0)
    count = flat * (core["last"] - core["first"])
    last = count.cumsum()
    rows["first"], rows["last"] = flat * (last - count), flat * last
    pair = rows["other"] >= 0
    if not pair.any():
        return
    for name, end, body in (
        ("first", "first", core), ("last", "last", core),
        ("other_first", "first", other), ("other_last", "last", other),
    ):  # fmt: skip
        rows[name][pair] = body[end][pair] + shared


def _solids(scene: Scene, every: list[Shape | None], curved: np.ndarray, to_principal: np.ndarray):
    """Return the first solid (N,) of each body, and the table of all solids, with their hulls.

    It contains bodies that may touch other bodies, and those with a curved piece on a half-space.
    """
    meets = [b for b, shape in enumerate(every) if shape is not None]
    parts = _parts(scene)
    place = np.zeros(len(parts), dtype=np.int64)
    if not (meets or len(curved)):
        return place, table(SOLID, 0), no_hulls()
    bodies = np.union1d(np.array(meets, dtype=np.int64), curved)
    solids, hulls = solid_table([parts[b].shape for b in bodies], to_principal[bodies])
    place[bodies] = np.searchsorted(solids.body, np.arange(len(bodies)))
    return place, solids, hulls


def _write_solids(rows: np.recarray, which: Rows, place: np.ndarray) -> None:
    """Write the solids of each row."""
    rows["solid"] = which.core["piece"] + place[rows["body"]]
    between = rows["other"] >= 0
    rows["other_solid"] = between * (place[rows["other"]] + which.other["piece"])


def _write_laws(rows: np.recarray, scene: Scene, pairs: PairTable, which: Rows, surfaces: Surfaces):
    """Write the numbers of the laws of each contact to its rows, and the axes of anisotropic friction."""
    laws, number, of_row = _laws_by_part(scene, pairs, which, surfaces)
    rows["law"] = number[of_row][:, None] + np.arange(2)
    anisotropies = [anisotropy_of(one.friction) for one in laws]
    if any(anisotropies):
        axes = [
            (1 + FIXED_TO.index(a.of), *a.axis, a.ratio) if a else (0.0,) * 5 for a in anisotropies
        ]
        _write_anisotropy(rows, np.array(axes)[of_row], surfaces.turns)


def _write_anisotropy(rows: np.recarray, anisotropies: np.ndarray, turns: np.ndarray) -> None:
    """Write the axes of anisotropic friction, in the axes of the bodies that they are fixed to."""
    of, body, other = anisotropies[:, 0].astype(int), rows["body"], rows["other"]
    of = np.where((of == OTHER_AXES) & (other < 0), WORLD_AXES, of)  # of a half-space
    side = np.where(of == BODY_AXES, body, other)
    turned = quaternion.rotate_back(turns[side], anisotropies[:, 1:4])
    rows["friction_axis"] = np.where((of == WORLD_AXES)[:, None], anisotropies[:, 1:4], turned)
    rows["axis_of"], rows["across"] = of, anisotropies[:, 4]


class Surface(NamedTuple):
    """The surface of a piece of a body."""

    name: str  # of the body
    material: Material | None


def _laws_by_part(scene: Scene, pairs: PairTable, which: Rows, surfaces: Surfaces):
    """Return the different laws, their first numbers, and that of each row: pieces may have own materials."""
    laws, of_row = list(pairs.laws), pairs.law[which.number]
    number = [surfaces.first_law + 2 * k for k in range(len(laws))]
    parts = (*scene.bodies, *scene.statics)
    by_part = np.array([bool(law.of_materials) for law in laws], dtype=bool)
    known: dict[tuple, int] = {}
    for row in np.flatnonzero(by_part[of_row]).tolist() if by_part.any() else ():
        contact = which.number[row]
        plane, other = pairs.plane[contact], pairs.other[contact]
        one = _surface(parts[pairs.body[contact]], which.core["piece"][row])
        if other >= 0:
            two = _surface(parts[other], which.other["piece"][row])
        else:
            two = Surface(scene.half_spaces[plane].name, scene.half_spaces[plane].material)
        key = (int(of_row[row]), one.material, two.material)
        if key not in known:
            known[key] = len(laws)
            whole = laws[key[0]]
            laws.append(_checked(scene._pairs.law_of_parts(whole, one, two), whole, one))
            number.append(surfaces.laws.add_once(key, laws[-1]))
        of_row[row] = known[key]
    return laws, np.array(number, dtype=np.int64), of_row


def _checked(law: ContactLaw, whole: ContactLaw, surface: Surface) -> ContactLaw:
    """Return the law of two parts; refuse coefficients of parts that are different laws of the speed."""
    for name in ("restitution", "friction", "friction_held"):
        e = getattr(law, name), getattr(whole, name)
        if e[0] != e[1] and any(isinstance(one, SpeedLaw) and one.by_speed for one in e):
            raise ValueError(
                f"{name} must be a number for each part of {surface.name!r}, or one law for all, "
                f"got {e[0]:g} and {e[1]:g}"
            )
    return law


def _surface(part, piece: int) -> Surface:
    return Surface(part.name, part.shape.pieces[piece].material or part.material)
