"""The parts that can touch: geoms as shapes, moving bodies, and fixed geoms as half-spaces and fixed bodies."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.io.models.build import Build
from carom.io.models.hulls import hull_of_mesh, triangles_of
from carom.io.models.links import IDENTITY, Link, called, name_of, pose_on_link
from carom.io.models.report import need_mujoco
from carom.io.models.touching import Filter
from carom.io.models.urdf import VISUAL
from carom.scene import joints
from carom.scene.bodies import GROUND, Body, HalfSpace, StaticBody
from carom.scene.height_field import HeightField
from carom.scene.look import Look
from carom.scene.materials import Material
from carom.scene.shapes import Box, Compound, Ellipsoid, Part, Shape, Sphere
from carom.scene.shapes.revolved import Capsule, Cylinder

DENSITY = 1000.0  # [kg/m^3] of what is fixed to the ground, where it makes no difference
#: red, green, blue and opacity of geoms without a colour: then that of their material counts (mjmodel.h)
GREY = (0.5, 0.5, 0.5, 1.0)
SHOWN_GROUPS = (0, 1, 2)  # of geoms, that MuJoCo's viewer shows at first (mjv_defaultOption)
SAME = 1e-12  # of the size: a shape that lies in the mass centre, along the axes of its body


class Placed(NamedTuple):
    """A shape, and where its own centre and axes are in the body that carries the geom."""

    shape: Any  # in a look also vertices and triangles
    position: np.ndarray  # (3,)
    orientation: np.ndarray  # (4,)
    material: Material | None = None


def placed_shape(build: Build, geom: int) -> Placed | None:
    """Return the shape of a geom on its link; None for a plane, or if there is no equivalent."""
    kinds, model = need_mujoco().mjtGeom, build.model
    kind, (a, b, c) = model.geom_type[geom], model.geom_size[geom].tolist()
    offset = np.zeros(3)
    if kind == kinds.mjGEOM_SPHERE:
        shape = Sphere(a)
    elif kind == kinds.mjGEOM_CAPSULE:
        shape = Capsule(a, 2.0 * b)
    elif kind == kinds.mjGEOM_CYLINDER:
        shape = Cylinder(a, 2.0 * b)
    elif kind == kinds.mjGEOM_ELLIPSOID:
        shape = Ellipsoid(a, b, c)
    elif kind == kinds.mjGEOM_BOX:
        shape = Box(2.0 * a, 2.0 * b, 2.0 * c)
    elif kind == kinds.mjGEOM_MESH:
        shape = hull_of_mesh(build, int(model.geom_dataid[geom]))
        if shape is None:
            return None
        offset = shape.centroid
    else:
        if kind != kinds.mjGEOM_PLANE:
            what = {
                int(kinds.mjGEOM_HFIELD): "a height field on a body that moves",
                int(kinds.mjGEOM_SDF): "a distance field",
            }
            build.report.add(
                called(model, "geom", geom),
                what.get(int(kind), "of a kind without equivalent"),
                "left out",
            )
        return None
    on_body, turn = pose_on_link(model, int(model.geom_bodyid[geom]))
    position = model.geom_pos[geom] + quaternion.rotate(model.geom_quat[geom], offset)
    orientation = quaternion.multiply(turn, model.geom_quat[geom])
    return Placed(
        shape, on_body + quaternion.rotate(turn, position), quaternion.normalize(orientation)
    )


def body_shape(parts: list[Placed], centre: np.ndarray) -> Shape | None:
    """Return the parts as one shape about the mass centre of their body; None for none."""
    if not parts:
        return None
    alike = len({part.material for part in parts}) == 1
    moved = [
        Part(p.shape, p.position - centre, p.orientation, None if alike else p.material)
        for p in parts
    ]
    if len(moved) == 1:
        one = moved[0]
        central = np.linalg.norm(one.position) <= SAME * one.shape.size
        straight = abs(one.orientation @ IDENTITY) >= 1.0 - 1e-15
        if central and (isinstance(one.shape, Sphere) or straight):
            return one.shape
    return Compound(moved, centroid=(0.0, 0.0, 0.0))


class Solid(NamedTuple):
    """A part of the scene with the geoms that may touch."""

    part: Body | HalfSpace | StaticBody
    geoms: list[int]
    moves: bool


def geoms_of(build: Build, link: Link) -> list[int]:
    """Return all geoms of a link."""
    geoms = range(build.model.ngeom)
    return [g for g in geoms if int(build.model.geom_bodyid[g]) in link.members]


def covering(build: Build, link: Link, rules: Filter) -> tuple[Shape | None, list[int]]:
    """Return the shape of a link, and those of its geoms that may touch.

    If no geom may touch, the shape is that of all geoms, but for the visuals of a URDF.
    """
    geoms = [g for g in geoms_of(build, link) if VISUAL not in build.model.geom(g).name]
    touching = [g for g in geoms if rules.touches_at_all(g)]
    parts, used = _parts(build, touching or geoms)
    if touching:
        parts = [part._replace(material=rules.material(g)) for part, g in zip(parts, used)]
    return body_shape(parts, link.centre), used if touching else []


def look_of(build: Build, link: Link, cover: tuple) -> tuple[Look, ...] | None:
    """Return the look of a link some of whose geoms touch nothing, or None if its shape is its look.

    A look has the geoms that MuJoCo's viewer shows at first: those of groups 0 to 2 that are not transparent.
    """
    (shape, touching), seen = cover, [g for g in geoms_of(build, link) if is_seen(build, g)]
    if shape is not None and set(seen) <= set(touching or seen):
        return None
    found = [(placed_look(build, g), colour(build, [g])) for g in seen]
    looks = [Look(p.shape, p.position - link.centre, p.orientation, c) for p, c in found if p]
    return tuple(looks) or None


def world_look(build: Build, rules: Filter) -> list[Look]:
    """Return the looks of geoms that are fixed to the world and touch nothing. Planes have no end."""
    model, looks = build.model, []
    for g in range(model.ngeom):
        fixed = model.body_weldid[model.geom_bodyid[g]] == 0
        if not fixed or rules.touches_at_all(g) or not is_seen(build, g):
            continue
        if model.geom_type[g] == need_mujoco().mjtGeom.mjGEOM_PLANE:
            build.report.add(called(model, "geom", g), "a plane that touches nothing", "left out")
            continue
        own, axes = placed_look(build, g), build.data.geom_xmat[g].reshape(3, 3)
        if own is not None:
            place = build.data.geom_xpos[g]
            if not isinstance(own.shape, tuple):
                place = place + axes @ getattr(own.shape, "centroid", np.zeros(3))
            turn = quaternion.normalize(quaternion.from_matrix(axes))
            looks.append(Look(own.shape, place, turn, colour(build, [g])))
    return looks


def geoms_on(build: Build, body: int) -> range:
    """Return all geoms of a body of the model."""
    first = int(build.model.body_geomadr[body])
    return range(first, first + int(build.model.body_geomnum[body]))


def is_seen(build: Build, geom: int) -> bool:
    """Return whether MuJoCo's viewer shows a geom at first."""
    return int(build.model.geom_group[geom]) in SHOWN_GROUPS and tint_of(build, geom)[3] > 0.0


def placed_look(build: Build, geom: int) -> Placed | None:
    """Return what a geom looks like on its link: a mesh as its triangles, any other as its shape."""
    model, kinds = build.model, need_mujoco().mjtGeom
    if model.geom_type[geom] != kinds.mjGEOM_MESH:
        return placed_shape(build, geom)
    on_body, turn = pose_on_link(model, int(model.geom_bodyid[geom]))
    position = on_body + quaternion.rotate(turn, model.geom_pos[geom])
    orientation = quaternion.normalize(quaternion.multiply(turn, model.geom_quat[geom]))
    return Placed(triangles_of(build, int(model.geom_dataid[geom])), position, orientation)


def tint_of(build: Build, geom: int) -> np.ndarray:
    """Return red, green, blue and opacity of a geom: its own, or those of its material."""
    model = build.model
    rgba = model.geom_rgba[geom]
    if np.allclose(rgba, GREY) and model.geom_matid[geom] >= 0:
        rgba = model.mat_rgba[model.geom_matid[geom]]
    return rgba


def colour(build: Build, geoms: list[int]) -> np.ndarray | None:
    """Return the colour (3,) of the first of some geoms that has one and is visible; None if none has."""
    for g in geoms:
        rgba = tint_of(build, g)
        if rgba[3] > 0.0 and not np.allclose(rgba, GREY):
            return np.clip(rgba[:3], 0.0, 1.0)
    return None


def _parts(build: Build, geoms: list[int]) -> tuple[list[Placed], list[int]]:
    found = [(g, placed_shape(build, g)) for g in geoms]
    known = [(g, part) for g, part in found if part is not None]
    return [part for _, part in known], [g for g, _ in known]


def add_standing(build: Build, rules: Filter) -> list[Solid]:
    """Add the geoms of the world that may touch: planes, height fields, others as bodies that are fixed."""
    model, solids, kinds = build.model, [], need_mujoco().mjtGeom
    make = {int(kinds.mjGEOM_PLANE): _half_space, int(kinds.mjGEOM_HFIELD): _terrain}
    for g in range(model.ngeom):
        if model.body_weldid[model.geom_bodyid[g]] != 0 or not rules.touches_at_all(g):
            continue
        part = make.get(int(model.geom_type[g]), _fixed)(build, g, rules.material(g))
        if part is not None:
            build.geoms[g] = part
            solids.append(Solid(part, [g], False))
    return solids


def _half_space(build: Build, g: int, material: Material | None) -> HalfSpace:
    name = build.names.new(name_of(build.model, "geom", g), "geom")
    normal = build.data.geom_xmat[g].reshape(3, 3)[:, 2]
    point, tint = build.data.geom_xpos[g], colour(build, [g])
    return build.scene.add_half_space(point, normal, material=material, color=tint, name=name)


def _terrain(build: Build, g: int, material: Material | None) -> StaticBody:
    """Add a height field: MuJoCo's rows go along y, and its heights are parts of the greatest one."""
    model, field = build.model, int(build.model.geom_dataid[g])
    shape = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    first, (wide, deep, high, _) = int(model.hfield_adr[field]), model.hfield_size[field].tolist()
    heights = model.hfield_data[first : first + shape[0] * shape[1]].reshape(shape).T
    spacing = 2.0 * wide / (shape[1] - 1), 2.0 * deep / (shape[0] - 1)
    build.report.add(
        called(model, "geom", g),
        "a height field of triangles, with a border",
        "a smooth surface through its heights, without an end",
    )
    return build.scene.add_surface(
        HeightField(high * heights, spacing),
        position=build.data.geom_xpos[g],
        orientation=quaternion.from_matrix(build.data.geom_xmat[g].reshape(3, 3)),
        material=material,
        color=colour(build, [g]),
        name=build.names.new(name_of(model, "geom", g), "geom"),
    )


def _fixed(build: Build, g: int, material: Material | None) -> Body | None:
    part = placed_shape(build, g)
    if part is None:
        return None
    name = build.names.new(name_of(build.model, "geom", g), "geom")
    axes, place = build.data.geom_xmat[g].reshape(3, 3), build.data.geom_xpos[g]
    offset = getattr(part.shape, "centroid", np.zeros(3))
    seen = any(is_seen(build, k) for k in geoms_on(build, int(build.model.geom_bodyid[g])))
    wall = build.scene.add_body(
        part.shape,
        look=() if seen and not is_seen(build, g) else None,
        density=DENSITY,
        position=place + axes @ offset,
        orientation=quaternion.normalize(quaternion.from_matrix(axes)),
        material=material,
        color=colour(build, [g]),
        name=name,
    )
    build.scene.add_joint(
        joints.Fixed(), GROUND, wall, name=build.names.new(f"{name}:fixed", "joint")
    )
    return wall
