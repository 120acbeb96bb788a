"""The look of bodies: parts of one colour, springs and rods, and how far each body extends.

A body with a look of its own is that. Any other with a shape is its surface, with pips if it is a die and pins
at its joints. A body without one is a ball or disc that rolls, rods to its joints, or else the ellipsoid of its
inertia.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.model.switched import NOTHING_SWITCHED, stands_of
from carom.scene.belts import BeltRelation, BeltStretch
from carom.scene.bodies import Body
from carom.scene.coordinates import Axial, BodyTurn, Bush, Length, Strand, terms_of
from carom.scene.curves import Curve
from carom.scene.forces import Spring
from carom.scene.joints import CurveOnPoint, Distance, Joint, RollingDisc, RollingSphere
from carom.scene.look import Look
from carom.scene.more_forces import CurveSpring
from carom.scene.shapes import Box, Sphere
from carom.scene.shapes.revolved import Cylinder
from carom.scene.surface_definition import SurfaceDefinition
from carom.visual.curved_ground import ground
from carom.visual.dice import is_die, pip_colour, pips
from carom.visual.surface_arrows import arrows_of
from carom.visual.surfaces import is_round, surface

Surface = tuple[np.ndarray, np.ndarray]

STILL = 0.02  # fraction of the greatest displacement, or a rotation [rad], up to which a body counts as resting
PIN = 0.15  # of the size of a body: a pin is no thicker
#: Okabe and Ito's colours, told apart by colour-blind eyes; their vermilion and blue are for arrows
COLOURS = ("#56B4E9", "#E69F00", "#009E73", "#F0E442", "#CC79A7", "#999999")
JOINT, STATIC, ARROW = "#5b6873", "#c3ccd4", "#D55E00"
CORD = 12  # straight pieces of a slack cord
ROD = 0.012  # radius of rods of bodies without a shape, as a fraction of the size of the region
ORIGIN, NO_RADII = np.zeros(3), np.zeros(2)
RAIL, RING = 400, 8  # most points along a curve, and sides of its tube


class Part(NamedTuple):
    """A surface and the bodies that it moves with."""

    vertices: np.ndarray  #: (V, 3) body axes [m]; of a static body in the world
    triangles: np.ndarray  #: (F, 3) counter-clockwise from outside
    bodies: list[int]  #: -1 for a static one
    look: str  #: "solid", "round" (with a pattern), "joint", "pip" or "static"
    shape: Any = None  #: shape of which it is the whole surface
    colour: str | None = None  #: of a static body, or of a part of a look, that has one


class Link(NamedTuple):
    """A spring, a rod or a cord between points of two bodies; of the ground (-1) in world axes."""

    parent: int
    child: int
    parent_anchor: np.ndarray  #: (3,) body axes [m]
    child_anchor: np.ndarray
    kind: str  #: "spring", "rod" or "cord"
    length: float = 0.0  #: of a cord [m]
    radii: np.ndarray = (
        NO_RADII  #: (2,) of the circles round which a strand of rope goes, about `axis` (3,)
    )
    axis: np.ndarray = ORIGIN
    part: str = ""  #: name of the part of the scene that it is
    #: begins and ends of the times at which it is there [s]; None: always
    there: tuple[tuple[float, float], ...] | None = None

    def is_there(self, t: float) -> bool:
        """Return whether it is there at a time: not since it broke, or was switched off."""
        return self.there is None or any(begin <= t < end for begin, end in self.there)

    def ends(self, x: np.ndarray, Q: np.ndarray) -> list[np.ndarray]:
        """Return both ends (3,) at positions x (N, 3) and orientations Q (N, 4) of the bodies."""
        pairs = (self.parent, self.parent_anchor), (self.child, self.child_anchor)
        centres = [a if b < 0 else x[b] + quaternion.rotate(Q[b], a) for b, a in pairs]
        if not self.radii.any():
            return centres
        # as `carom.kinematics.coordinates.strand`: from where it leaves one circle to where it meets the other
        d = centres[1] - centres[0]
        d = d - np.asarray(d @ self.axis)[..., None] * self.axis
        square, rho = np.sum(d * d, axis=-1, keepdims=True), self.radii[0] - self.radii[1]
        length = np.sqrt(np.maximum(square - rho * rho, 0.0))
        along = (length * d + rho * np.cross(self.axis, d)) / square
        beside = np.cross(along, self.axis)
        return [centre + r * beside for centre, r in zip(centres, self.radii)]

    def line(self, x: np.ndarray, Q: np.ndarray, up: np.ndarray) -> np.ndarray:
        """Return the points (n, 3) along which it is drawn: a slack cord hangs as a parabola of its length.

        Its depth is d = k sqrt(L^2 - c^2) over the distance c of its ends: k = sqrt(3)/4 for a flat one, 1/2
        where the ends meet; between these it is taken as linear, within 2 % of the length of a level cord.
        """
        a, b = self.ends(x, Q)
        slack = self.length**2 - float(np.sum((b - a) ** 2))
        if not slack > 1e-3 * self.length**2:
            return np.array([a, b])
        bend = 0.5 - 0.067 * math.sqrt(1.0 - slack / self.length**2)
        s, depth = np.linspace(0.0, 1.0, CORD + 1)[:, None], bend * math.sqrt(slack)
        return a + s * (b - a) - 4.0 * s * (1.0 - s) * depth * up


class Outline(NamedTuple):
    """The extent of a body: a ball of radius `size` [m] about each of its `points` (3,), body axes."""

    points: list[np.ndarray]
    size: float

    @property
    def radius(self) -> float:
        """Radius of the body [m] about its mass centre."""
        return max(float(np.linalg.norm(point)) for point in self.points) + self.size


def colour_of(body: Body) -> str:
    """Return the colour of a body, ``#rrggbb``: its own, or one of `COLOURS` by its number."""
    return body.color or COLOURS[body.index % len(COLOURS)]


def colours_of(part: Part, scene) -> list[str]:
    """Return the colour of a part on each of its bodies."""
    if part.look in ("joint", "static"):
        return [JOINT if part.look == "joint" else part.colour or STATIC] * len(part.bodies)
    own = [part.colour or colour_of(scene.bodies[b]) for b in part.bodies]
    return [pip_colour(one) for one in own] if part.look == "pip" else own


def parts_of(
    scene, radius: float, fineness: int | None = None, centre: np.ndarray = ORIGIN
) -> list[Part]:
    """Return the surfaces of all bodies; equal ones once. The region of the motion is a ball [m]."""
    parts: dict[tuple, Part] = {}
    known: dict = {}  # many bodies may have one shape
    fineness = fineness or (32 if len(scene.bodies) < 100 else 16)
    for body in scene.bodies:
        shape = body.shape
        if body.look is not None:
            pieces = [_seen(one, fineness) for one in body.look]
        elif shape is None:
            pieces = [(*piece, None, None) for piece in _without_shape(scene, body, ROD * radius)]
        else:
            if shape not in known:
                known[shape] = surface(shape, fineness)
            pieces = [(*known[shape], "round" if is_round(shape) else "solid", shape, None)]
            pieces += [(*pips(shape), "pip", None, None)] if is_die(body) else []
        if shape is not None:
            pieces += [(*pin, "joint", None, None) for pin in pins(scene, body, ROD * radius)]
        for vertices, triangles, look, whole, colour in pieces:
            key = (vertices.tobytes(), triangles.tobytes(), look, colour)
            made = Part(vertices, triangles, [], look, whole, colour)
            parts.setdefault(key, made).bodies.append(body.index)
    rails = [_rail(j, 0.5 * ROD * radius) for j in scene.joints if j.definition.guide == "curve"]
    fixed = [static_part(solid, fineness, centre, radius) for solid in scene.statics]
    fixed = [part for part in fixed if len(part.triangles)]
    looks = [_seen(one, fineness) for one in scene.look]
    seen = [Part(v, f, [-1], "static", None, colour) for v, f, _, _, colour in looks]
    return [*parts.values(), *fixed, *rails, *seen, *surface_arrows(scene, radius)]


def _seen(one: Look, fineness: int) -> tuple[np.ndarray, np.ndarray, str, Any, str | None]:
    """Return a part of a look in body axes: vertices, triangles, kind, shape and colour."""
    whole = None if isinstance(one.shape, tuple) else one.shape
    vertices, triangles = one.shape if whole is None else surface(whole, fineness)
    placed = one.position + quaternion.rotate(one.orientation, vertices)
    return placed, triangles, "solid", whole, one.color


def _rail(joint: Joint, thick: float) -> Part:
    """Return a tube along the curve of a joint."""
    curve, owner = curve_of(joint)
    n = max(2, min(RAIL, 4 * len(curve.knots)))
    s = np.linspace(0.0, curve.length, n)
    k = np.clip(np.searchsorted(curve.knots, s, side="right") - 1, 0, len(curve.knots) - 2)
    t = curve.tangent(s)
    across = curve.normals[k] - np.sum(curve.normals[k] * t, axis=1)[:, None] * t
    across /= np.linalg.norm(across, axis=1)[:, None]
    angle = 2.0 * np.pi / RING * np.arange(RING)[:, None, None]
    ring = np.cos(angle) * across + np.sin(angle) * np.cross(t, across)
    place, turn = place_of_curve(joint)
    centre = place + quaternion.rotate(turn, curve.point(s))
    tube = (centre + thick * quaternion.rotate(turn, ring)).reshape(-1, 3)
    vertices = np.vstack([tube, centre[[0, -1]]])
    side, step = np.meshgrid(np.arange(RING), np.arange(n - 1), indexing="ij")
    a, b = side * n + step, (side + 1) % RING * n + step
    walls = np.stack([a, b, b + 1, a, b + 1, a + 1], axis=-1).reshape(-1, 3)
    first, last = np.arange(RING) * n, np.arange(RING) * n + n - 1
    caps = [(RING * n, b, a) for a, b in zip(first, np.roll(first, -1))]
    caps += [(RING * n + 1, a, b) for a, b in zip(last, np.roll(last, -1))]
    faces = np.concatenate([walls, np.array(caps)])
    if owner.index < 0:
        return Part(vertices, faces, [-1], "static", None, JOINT)
    return Part(vertices, faces, [owner.index], "joint")


def curve_of(joint: Joint) -> tuple[Curve, Any]:
    """Return the curve of a joint, and the body or ground that it belongs to."""
    d: Any = joint.definition
    return d.curve, joint.child if isinstance(d, CurveOnPoint) else joint.parent


def place_of_curve(joint: Joint) -> tuple[np.ndarray, np.ndarray]:
    """Return position and orientation of the axes of a curve, in axes of its body."""
    owner = curve_of(joint)[1]
    if joint.frames is not None:
        return joint.frames[0 if owner is joint.parent else 1]
    turn = np.array([1.0, 0.0, 0.0, 0.0])
    if isinstance(owner, Body):
        turn = quaternion.conjugate(owner.orientation)
    return _in_body(owner, np.zeros(3)), turn


def ground_rails(scene) -> list[Joint]:
    """Return the joints whose curves are fixed in the ground."""
    on_curves = [joint for joint in scene.joints if joint.definition.guide == "curve"]
    return [joint for joint in on_curves if curve_of(joint)[1].index < 0]


def ground_curves(scene, points: int = RAIL) -> list[np.ndarray]:
    """Return points (K, 3) along each curve that is fixed in the ground."""
    out = []
    for joint in ground_rails(scene):
        curve, (place, turn) = curve_of(joint)[0], place_of_curve(joint)
        s = np.linspace(0.0, curve.length, points)
        out.append(place + quaternion.rotate(turn, curve.point(s)))
    return out


def surface_arrows(scene, radius: float) -> list[Part]:
    """Return the arrows of surfaces that move in themselves."""
    return [Part(*arrow, [-1], "static", None, ARROW) for arrow in arrows_of(scene, radius)]


def static_part(solid, fineness: int, centre: np.ndarray, radius: float) -> Part:
    """Return the surface of a static body, in the world; of curved ground a part about the motion."""
    if isinstance(solid.shape, SurfaceDefinition):
        middle = quaternion.rotate_back(solid.orientation, centre - solid.position)
        vertices, triangles = ground(solid.shape, middle, radius, 2 * fineness)
    else:
        vertices, triangles = surface(solid.shape, fineness)
    placed = solid.position + quaternion.rotate(solid.orientation, vertices)
    return Part(placed, triangles, [-1], "static", solid.shape, solid.color)


def outline_of(scene, body: Body) -> Outline:
    """Return the extent of a body; a body without a shape extends to its joints and springs."""
    if body.look is not None:
        own = 0.0 if body.shape is None else body.shape.size
        return Outline([np.zeros(3)], max([own, *(one.reach for one in body.look)]))
    if body.shape is not None:
        return Outline([np.zeros(3)], body.shape.size)
    anchors = _anchors(scene, body)
    if not any(np.any(anchor) for anchor in anchors):
        return Outline([np.zeros(3)], _gyration(body))
    return Outline([np.zeros(3), *anchors], 0.0)


def _without_shape(scene, body: Body, thick: float) -> list[tuple[np.ndarray, np.ndarray, str]]:
    """Return rods from the mass centre to the anchors of joints and springs, and a ball at each end."""
    for joint in scene.joints:  # rolling bodies have a radius
        d = joint.definition
        if joint.child is body and isinstance(d, RollingSphere):
            return [(*surface(Sphere(d.radius)), "round")]
        if joint.child is body and isinstance(d, RollingDisc):
            vertices, triangles = surface(Cylinder(d.radius, 0.08 * d.radius))
            axis = quaternion.rotate_back(body.orientation, d.axis)
            return [(quaternion.rotate(turn_to(axis), vertices), triangles, "round")]
    anchors = _anchors(scene, body)
    if not anchors:  # the ellipsoid of even density with this mass and inertia
        moments, axes = np.linalg.eigh(body.inertia)
        squares = 5.0 / body.mass * (0.5 * np.sum(moments) - moments)
        vertices, triangles = surface(Sphere(1.0))
        lengths = np.sqrt(np.maximum(squares, 1e-4 * np.max(squares)))
        axes = axes * [1.0, 1.0, np.linalg.det(axes)]
        return [((vertices * lengths) @ axes.T, triangles, "round")]
    out = []
    for anchor in anchors:
        length = float(np.linalg.norm(anchor))
        if length > 1e-6 * thick:
            vertices, triangles = surface(Cylinder(0.6 * thick, length), 16)
            turned = quaternion.rotate(turn_to(anchor / length), vertices)
            out.append((turned + 0.5 * anchor, triangles, "solid"))
        vertices, triangles = surface(Sphere(thick), 16)
        out.append((vertices + anchor, triangles, "joint"))
    edge = 2.4 * thick
    cube = surface(Box(edge, edge, edge, radius=0.5 * thick), 16)
    return [*out, (*cube, "solid")]


def _anchors(scene, body: Body) -> list[np.ndarray]:
    """Return the anchors (3,) of joints and springs on a body, in its axes."""
    joints = [_anchor(j, body) for j in scene.joints if body in (j.parent, j.child)]
    links = [k for k in links_of(scene) if body.index in (k.parent, k.child)]
    ends = [k.parent_anchor if k.parent == body.index else k.child_anchor for k in links]
    return [np.array(a) for a in dict.fromkeys(tuple(a) for a in (*joints, *ends))]


def _anchor(joint: Joint, body) -> np.ndarray:
    """Return the anchor of a joint on one of its bodies, in its axes; on the ground in the world."""
    if joint.frames is not None:
        position, orientation = joint.frames[1 if joint.child is body else 0]
        return position + quaternion.rotate(orientation, joint.anchor())
    d = joint.definition
    if isinstance(d, Distance):
        return _in_body(body, d.anchor_child if joint.child is body else d.anchor_parent)
    return _in_body(body, joint.anchor())


def links_of(scene) -> list[Link]:
    """Return springs, massless rods and cords; a rod with two limits is one."""
    out = []
    for one in (*scene.forces, *scene.joints):
        d = one.definition
        if isinstance(d, (Spring, CurveSpring, Distance)):
            pair = (one.parent, d.anchor_parent), (one.child, d.anchor_child)
            start, end = (_in_body(part, a) for part, a in pair)
            kind = "rod" if isinstance(d, Distance) else "spring"
            out.append(Link(one.parent.index, one.child.index, start, end, kind, part=one.name))
    of_part = [(one, one.definition) for one in scene.constraints]
    along = [(one, getattr(one.definition, "joint", None)) for one in scene.forces]
    of_part += [*along, *((stop, stop.joint) for stop in scene.stops)]
    for one, of in of_part:
        out += [link._replace(part=one.name) for link in _strands_of(of)]
    rods = {id(stop.joint) for stop in scene.stops if stop.upper is None}
    for force, of in along:
        for one, _, _ in terms_of(of, 0):
            out += [link._replace(part=force.name) for link in _cord(one, "cord", 0.0)]
    for stop in scene.stops:
        kind = "rod" if stop.upper is None else "cord"
        for one, _, _ in terms_of(stop.joint, stop.coordinate):
            if kind == "rod" or id(stop.joint) not in rods:
                cords = _cord(one, kind, stop.end if kind == "cord" else 0.0)
                out += [link._replace(part=stop.name) for link in cords]
    return out


def links_in(solution) -> list[Link]:
    """Return the links of the scene of a run, or of its start, with the times at which each is there."""
    scene, run = solution.scene, getattr(solution, "_run", None)
    switched = NOTHING_SWITCHED if run is None else run.switched
    links, stands = links_of(scene), stands_of(scene, switched)
    if len(stands) == 1 and not stands[0][1].off:
        return links
    changes = [float(solution.t[row - 1]) for row, _ in stands[1:] if row <= len(solution.t)]
    edges = [-math.inf, *changes, math.inf]
    off = [stand.view(scene)._off or frozenset() for _, stand in stands]
    spans = list(zip(edges, edges[1:], off))
    return [
        link._replace(there=tuple((a, b) for a, b, names in spans if link.part not in names))
        for link in links
    ]


def _cord(of: Any, kind: str, length: float) -> list[Link]:
    """Return a strand of a rope, or a massless rod or cord; none of any other coordinate."""
    if not isinstance(of, Length) or isinstance(of, (Bush, Axial, BodyTurn)):
        return []
    ends = _in_body(of.parent, of.ends[0]), _in_body(of.child, of.ends[1])
    pair = of.parent.index, of.child.index
    if isinstance(of, Strand):
        return [Link(*pair, *ends, "cord", 0.0, of.radii, of.axis)]
    return [Link(*pair, *ends, kind, length)]


def _strands_of(of: Any) -> list[Link]:
    """Return the strands of a belt, or the one of a stretch; none of anything else."""
    if not isinstance(of, (BeltRelation, BeltStretch)):
        return []
    a, b = of.wheels
    ends = (_in_body(body, center) for body, center in zip(of.wheels, of.centers))
    sides = (-1.0, 1.0) if isinstance(of, BeltRelation) else (1.0,)
    start, end = ends
    return [
        Link(a.index, b.index, start, end, "cord", 0.0, side * of.radii, of.axis) for side in sides
    ]


def ground_points(scene) -> list[np.ndarray]:
    """Return the points (3,) of the ground at which bodies are joined or hang."""
    placed = [j for j in scene.joints if getattr(j.definition, "anchor", None) is not None]
    joined = [_anchor(j, j.parent) for j in placed if j.parent.index < 0]
    ends = [((k.parent, k.parent_anchor), (k.child, k.child_anchor)) for k in links_of(scene)]
    rails = [point for curve in ground_curves(scene, 50) for point in curve]
    return joined + rails + [anchor for pair in ends for body, anchor in pair if body < 0]


def moving(position: np.ndarray, orientation: np.ndarray) -> np.ndarray:
    """Return which bodies (N,) move by more than a small fraction of the largest motion of a body.

    `position` (T, N, 3), `orientation` (T, N, 4).
    """
    displacements = np.ptp(position, axis=0).max(axis=1)
    return (displacements > STILL * displacements.max()) | (
        np.ptp(orientation, axis=0).max(axis=1) > STILL
    )


def pins(scene, body: Body, thick: float) -> list[Surface]:
    """Return what shows the joints of a body with a shape, in its axes: pins along axes, balls without one.

    Each joint is shown once, on its child if that has a shape. `thick` is the radius of a ball [m].
    """
    out = []
    assert body.shape is not None
    thick = min(thick, PIN * body.shape.size)
    for joint in scene.joints:
        d = joint.definition
        if d.guide not in ("point", "line") or d.turn not in ("ball", "cross", "axis"):
            continue
        owner = joint.child if joint.child.shape is not None else joint.parent
        if owner is body:
            out.append(_pin(joint, body, thick))
    return out


def _pin(joint: Joint, body: Body, thick: float) -> Surface:
    assert body.shape is not None
    place, axis = _anchor(joint, body), joint.definition.frame()[:, 0]
    if joint.frames is not None:
        axis = quaternion.rotate(joint.frames[1 if joint.child is body else 0][1], axis)
    else:
        axis = quaternion.rotate_back(body.orientation, axis)
    if joint.definition.turn != "axis":
        vertices, triangles = surface(Sphere(1.5 * thick), 16)
        return vertices + place, triangles
    along = (surface(body.shape, 16)[0] - place) @ axis
    low, high = min(float(along.min()), 0.0) - thick, max(float(along.max()), 0.0) + thick
    vertices, triangles = surface(Cylinder(thick, high - low), 16)
    return place + 0.5 * (low + high) * axis + quaternion.rotate(turn_to(axis), vertices), triangles


def turn_to(axis: np.ndarray) -> np.ndarray:
    """Return a quaternion (4,) that takes z to the unit vector `axis`."""
    if axis[2] < -1.0 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    half = np.array([1.0 + axis[2], -axis[1], axis[0], 0.0])
    return half / np.linalg.norm(half)


def _in_body(body, point: np.ndarray) -> np.ndarray:
    """Return a point of the world in the axes of a body; of the ground it stays the same."""
    if not isinstance(body, Body):
        return point
    return quaternion.rotate_back(body.orientation, point - body.position)


def _gyration(body: Body) -> float:
    return float(np.sqrt(np.trace(body.inertia) / body.mass))
