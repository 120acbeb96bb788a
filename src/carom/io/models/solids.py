"""The parts that can touch: moving bodies, and fixed geoms as half-spaces and fixed bodies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.io.models.build import Build
from carom.io.models.links import Link, name_of
from carom.io.models.report import need_mujoco
from carom.io.models.shapes import Placed, body_shape, placed_shape
from carom.io.models.touching import Filter
from carom.scene import joints
from carom.scene.bodies import GROUND, Body, HalfSpace
from carom.scene.shapes import Shape

DENSITY = 1000.0  # [kg/m^3] of what is fixed to the ground, where it makes no difference


class Solid(NamedTuple):
    """A part of the scene with the geoms that may touch."""

    part: Body | HalfSpace
    geoms: list[int]
    moves: bool


def covering(build: Build, link: Link, rules: Filter) -> tuple[Shape | None, list[int]]:
    """Return the shape of a link, and those of its geoms that may touch.

    If no geom may touch, the shape is that of the visible geoms.
    """
    model = build.model
    geoms = [g for g in range(model.ngeom) if int(model.geom_bodyid[g]) in link.members]
    touching = [g for g in geoms if rules.touches_at_all(g)]
    parts, used = _parts(build, touching or geoms)
    return body_shape(parts, link.centre), used if touching else []


def _parts(build: Build, geoms: list[int]) -> tuple[list[Placed], list[int]]:
    found = [(g, placed_shape(build.model, g, build.report)) for g in geoms]
    known = [(g, part) for g, part in found if part is not None]
    return [part for _, part in known], [g for g, _ in known]


def add_standing(build: Build, rules: Filter) -> list[Solid]:
    """Add the geoms of the world that may touch: planes as half-spaces, others as bodies that are fixed."""
    model, solids = build.model, []
    for g in range(model.ngeom):
        if model.body_weldid[model.geom_bodyid[g]] != 0 or not rules.touches_at_all(g):
            continue
        is_plane = model.geom_type[g] == need_mujoco().mjtGeom.mjGEOM_PLANE
        part = _half_space(build, g) if is_plane else _fixed(build, g)
        if part is not None:
            build.geoms[g] = part
            solids.append(Solid(part, [g], False))
    return solids


def _half_space(build: Build, g: int) -> HalfSpace:
    name = build.names.new(name_of(build.model.geom(g), "geom"), "geom")
    normal = build.data.geom_xmat[g].reshape(3, 3)[:, 2]
    return build.scene.add_half_space(build.data.geom_xpos[g], normal, name=name)


def _fixed(build: Build, g: int) -> Body | None:
    part = placed_shape(build.model, g, build.report)
    if part is None:
        return None
    name = build.names.new(name_of(build.model.geom(g), "geom"), "geom")
    axes, place = build.data.geom_xmat[g].reshape(3, 3), build.data.geom_xpos[g]
    offset = getattr(part.shape, "centroid", np.zeros(3))
    wall = build.scene.add_body(
        part.shape,
        density=DENSITY,
        position=place + axes @ offset,
        orientation=quaternion.normalize(quaternion.from_matrix(axes)),
        name=name,
    )
    build.scene.add_joint(
        joints.Fixed(), GROUND, wall, name=build.names.new(f"{name}:fixed", "joint")
    )
    return wall
