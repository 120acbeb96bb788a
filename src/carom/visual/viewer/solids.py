"""The surfaces of bodies: of their shapes, or rods and balls for bodies without a shape."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.scene.bodies import Body
from carom.scene.forces import Spring
from carom.scene.joints import Distance, Joint, RollingDisc, RollingSphere
from carom.scene.more_forces import CurveSpring
from carom.scene.shapes import Box, Sphere
from carom.scene.shapes.revolved import Cylinder
from carom.visual import surfaces
from carom.visual.details import is_die, pins, pips, turn_to
from carom.visual.viewer.frames import Outline

ROD = 0.012  # radius of rods of bodies without a shape, as a fraction of the radius of the region
TOP = 0.15  # height of walls above the motion, as a fraction of the radius of the region
LEVEL = 0.9  # cosine of the slope from which a half-space is a wall
#: half a side of the drawn part of a half-space, as a multiple of the radius of the region
WIDE = 1.5


class Part(NamedTuple):
    """A surface and the bodies that it moves with."""

    vertices: np.ndarray  #: (V, 3) body axes [m]; of a static body in the world
    triangles: np.ndarray  #: (F, 3) counter-clockwise from outside
    bodies: list[int]  #: -1 for a static one
    look: str  #: "solid", "round" (with a pattern), "joint", "pip" or "static"


class Plane(NamedTuple):
    """The part of a half-space that is drawn."""

    corners: np.ndarray  #: (P, 3) world [m], convex
    normal: np.ndarray  #: (3,)
    name: str


class Link(NamedTuple):
    """A spring or a rod between points of two bodies; of the ground (-1) in world axes."""

    parent: int
    child: int
    parent_anchor: np.ndarray  #: (3,) body axes [m]
    child_anchor: np.ndarray
    kind: str  #: "spring" or "rod"


def parts_of(scene, radius: float) -> list[Part]:
    """Return the surfaces of all bodies; equal ones once. `radius` is that of the region [m]."""
    parts: dict[tuple, Part] = {}
    known: dict = {}  # many bodies may have one shape
    fineness = 32 if len(scene.bodies) < 100 else 16
    for body in scene.bodies:
        shape = body.shape
        if shape is None:
            pieces = _without_shape(scene, body, ROD * radius)
        else:
            if shape not in known:
                known[shape] = surfaces.surface(shape, fineness)
            pieces = [(*known[shape], "round" if surfaces.is_round(shape) else "solid")]
            pieces += [(*pin, "joint") for pin in pins(scene, body, ROD * radius)]
            pieces += [(*pips(shape), "pip")] if is_die(body) else []
        for vertices, triangles, look in pieces:
            key = (vertices.tobytes(), triangles.tobytes(), look)
            parts.setdefault(key, Part(vertices, triangles, [], look)).bodies.append(body.index)
    return [*parts.values(), *(_static(solid) for solid in scene.statics)]


def _static(solid) -> Part:
    """Return the surface of a static body, in the world."""
    vertices, triangles = surfaces.surface(solid.shape, 32)
    placed = solid.position + quaternion.rotate(solid.orientation, vertices)
    return Part(placed, triangles, [-1], "static")


def outline_of(scene, body: Body) -> Outline:
    """Return the extent of a body; a body without a shape extends to its joints and springs."""
    if body.shape is not None:
        return Outline([np.zeros(3)], body.shape.size)
    anchors = _anchors(scene, body)
    if not any(np.any(anchor) for anchor in anchors):
        return Outline([np.zeros(3)], _gyration(body))
    return Outline([np.zeros(3), *anchors], 0.0)


def size_of(outline: Outline) -> float:
    """Return the radius of a body [m] about its mass centre."""
    return max(float(np.linalg.norm(point)) for point in outline.points) + outline.size


def _without_shape(scene, body: Body, thick: float) -> list[tuple[np.ndarray, np.ndarray, str]]:
    """Return rods from the mass centre to the anchors of joints and springs, and a ball at each end."""
    for joint in scene.joints:  # rolling bodies have a radius
        d = joint.definition
        if joint.child is body and isinstance(d, RollingSphere):
            return [(*surfaces.surface(Sphere(d.radius)), "round")]
        if joint.child is body and isinstance(d, RollingDisc):
            vertices, triangles = surfaces.surface(Cylinder(d.radius, 0.08 * d.radius))
            axis = quaternion.rotate_back(body.orientation, d.axis)
            return [(quaternion.rotate(turn_to(axis), vertices), triangles, "round")]
    anchors = _anchors(scene, body)
    if not anchors:  # the ellipsoid of even density with this mass and inertia
        moments, axes = np.linalg.eigh(body.inertia)
        squares = 5.0 / body.mass * (0.5 * np.sum(moments) - moments)
        vertices, triangles = surfaces.surface(Sphere(1.0))
        lengths = np.sqrt(np.maximum(squares, 1e-4 * np.max(squares)))
        axes = axes * [1.0, 1.0, np.linalg.det(axes)]
        return [((vertices * lengths) @ axes.T, triangles, "round")]
    out = []
    for anchor in anchors:
        length = float(np.linalg.norm(anchor))
        if length > 1e-6 * thick:
            vertices, triangles = surfaces.surface(Cylinder(0.6 * thick, length), 16)
            turned = quaternion.rotate(turn_to(anchor / length), vertices)
            out.append((turned + 0.5 * anchor, triangles, "solid"))
        vertices, triangles = surfaces.surface(Sphere(thick), 16)
        out.append((vertices + anchor, triangles, "joint"))
    edge = 2.4 * thick
    cube = surfaces.surface(Box(edge, edge, edge, radius=0.5 * thick), 16)
    return [*out, (*cube, "solid")]


def _anchors(scene, body: Body) -> list[np.ndarray]:
    """Return the anchors (3,) of joints and springs on a body, in its axes."""
    joints = [_anchor(j, body) for j in scene.joints if body in (j.parent, j.child)]
    links = [k for k in links_of(scene) if body.index in (k.parent, k.child)]
    ends = [k.parent_anchor if k.parent == body.index else k.child_anchor for k in links]
    return [np.array(a) for a in dict.fromkeys(tuple(a) for a in (*joints, *ends))]


def _anchor(joint: Joint, body: Body) -> np.ndarray:
    """Return the anchor of a joint on a body, in its axes."""
    if joint.frames is not None:
        position, orientation = joint.frames[1 if joint.child is body else 0]
        return position + quaternion.rotate(orientation, joint.anchor())
    d = joint.definition
    if isinstance(d, Distance):
        return _in_body(body, d.anchor_child if joint.child is body else d.anchor_parent)
    return _in_body(body, joint.anchor())


def links_of(scene) -> list[Link]:
    """Return springs and massless rods."""
    out = []
    for one in (*scene.forces, *scene.joints):
        d = one.definition
        if isinstance(d, (Spring, CurveSpring, Distance)):
            pair = (one.parent, d.anchor_parent), (one.child, d.anchor_child)
            start, end = (_in_body(part, a) if isinstance(part, Body) else a for part, a in pair)
            kind = "rod" if isinstance(d, Distance) else "spring"
            out.append(Link(one.parent.index, one.child.index, start, end, kind))
    return out


def ends_on_ground(link: Link) -> list[np.ndarray]:
    """Return the ends (3,) of a link that are fixed in the world."""
    ends = (link.parent, link.parent_anchor), (link.child, link.child_anchor)
    return [anchor for body, anchor in ends if body < 0]


def planes_of(scene, place, position: np.ndarray) -> list[Plane]:
    """Return half-spaces as squares around the motion, cut off at walls that no body passes.

    Walls end a little above the motion. `position` (F, N, 3) are the mass centres.
    """
    points = position.reshape(-1, 3)
    walls = [h for h in scene.half_spaces if np.all((points - h.point) @ h.normal >= 0.0)]
    top = points[np.argmax(points @ place.up)] + TOP * place.radius * place.up
    out = []
    for h in scene.half_spaces:
        middle = place.centre - ((place.centre - h.point) @ h.normal) * h.normal
        across = place.side - (place.side @ h.normal) * h.normal
        if not np.linalg.norm(across) > 0.3:
            across = place.up - (place.up @ h.normal) * h.normal
        a = across / np.linalg.norm(across) * WIDE * place.radius
        b = np.cross(h.normal, a)
        corners = middle + np.array([a + b, b - a, -a - b, a - b])
        for wall in walls:
            if wall is not h:
                corners = _cut(corners, wall.point, wall.normal)
        if abs(h.normal @ place.up) < LEVEL:
            corners = _cut(corners, top, -place.up)
        if len(corners) > 2:
            out.append(Plane(corners, h.normal, h.name))
    return out


def _cut(corners: np.ndarray, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the part of a convex polygon (P, 3) in front of a plane."""
    gap = (corners - point) @ normal
    kept = []
    for k in range(len(corners)):
        if gap[k - 1] * gap[k] < 0.0:
            part = gap[k - 1] / (gap[k - 1] - gap[k])
            kept.append(corners[k - 1] + part * (corners[k] - corners[k - 1]))
        if gap[k] >= 0.0:
            kept.append(corners[k])
    return np.array(kept).reshape(-1, 3)


def _in_body(body: Body, point: np.ndarray) -> np.ndarray:
    return quaternion.rotate_back(body.orientation, point - body.position)


def _gyration(body: Body) -> float:
    return float(np.sqrt(np.trace(body.inertia) / body.mass))
