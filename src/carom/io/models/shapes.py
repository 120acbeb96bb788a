"""The shapes of a model: a geom as a shape of the scene, several geoms as one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.io.models.links import IDENTITY, name_of, pose_on_link
from carom.io.models.report import Report, need_mujoco
from carom.scene.shapes import Box, Compound, Ellipsoid, Shape, Sphere
from carom.scene.shapes.convex import Convex
from carom.scene.shapes.revolved import Capsule, Cylinder

SAME = 1e-12  # of the size: a shape that lies in the mass centre, along the axes of its body


class Placed(NamedTuple):
    """A shape, and where its own centre and axes are in the body that carries the geom."""

    shape: Shape
    position: np.ndarray  # (3,)
    orientation: np.ndarray  # (4,)


def placed_shape(model, geom: int, report: Report) -> Placed | None:
    """Return the shape of a geom on its link; None for a plane, or if there is no equivalent."""
    kinds = need_mujoco().mjtGeom
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
        shape = _hull(model, geom, report)
        if shape is None:
            return None
        offset = shape.centroid
    else:
        if kind != kinds.mjGEOM_PLANE:
            what = {
                int(kinds.mjGEOM_HFIELD): "a height field",
                int(kinds.mjGEOM_SDF): "a distance field",
            }
            report.add(
                _called(model, geom),
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


def _hull(model, geom: int, report: Report) -> Convex | None:
    """Return the convex hull of the vertices of a mesh, which is what MuJoCo touches with."""
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    try:
        return Convex(np.array(model.mesh_vert[first : first + count], dtype=float))
    except ValueError as error:
        report.add(_called(model, geom), f"its mesh has no volume ({error})", "left out")
        return None


def _called(model, geom: int) -> str:
    return f"geom {name_of(model.geom(geom), 'geom')!r}"


def body_shape(parts: list[Placed], centre: np.ndarray) -> Shape | None:
    """Return the parts as one shape about the mass centre of their body; None for none."""
    if not parts:
        return None
    moved = [(shape, position - centre, turn) for shape, position, turn in parts]
    if len(moved) == 1:
        shape, position, turn = moved[0]
        central = np.linalg.norm(position) <= SAME * shape.size
        if central and (isinstance(shape, Sphere) or abs(turn @ IDENTITY) >= 1.0 - 1e-15):
            return shape
    return Compound(moved, centroid=(0.0, 0.0, 0.0))
