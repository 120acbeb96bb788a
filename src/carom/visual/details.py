"""Details of drawn bodies: colours, pips of dice, pins of joints."""

from __future__ import annotations

import re

import numpy as np

from carom.geometry import quaternion
from carom.scene.bodies import Body
from carom.scene.joints import Joint
from carom.scene.shapes import Box, Sphere
from carom.scene.shapes.revolved import Cylinder
from carom.visual.surfaces import surface

Surface = tuple[np.ndarray, np.ndarray]

DARK, LIGHT = "#1d252c", "#ffffff"
DIE = re.compile(r"(?<![a-z])(die|dice)(?![a-z])")  # in the name of a die
#: by the edge of a die: radius of a pip, distance from the middle, height above the face
PIP, AWAY, ABOVE = 0.09, 0.25, 0.004
SIDES = 20  # of the polygon of a pip
STILL = 0.02  # fraction of the greatest displacement, or a rotation [rad], up to which a body counts as resting
PIN = 0.15  # of the size of a body: a pin is no thicker


def colour_of(body: Body, palette) -> str:
    """Return the colour of a body, ``#rrggbb``: its own, or one of a palette by its number."""
    return body.color or palette[body.index % len(palette)]


def moving(position: np.ndarray, orientation: np.ndarray) -> np.ndarray:
    """Return which bodies (N,) move by more than a small fraction of the largest motion of a body.

    `position` (T, N, 3), `orientation` (T, N, 4).
    """
    displacements = np.ptp(position, axis=0).max(axis=1)
    return (displacements > STILL * displacements.max()) | (
        np.ptp(orientation, axis=0).max(axis=1) > STILL
    )


def pip_colour(colour: str) -> str:
    """Return the colour of pips: dark on light dice, light on dark ones."""
    red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return DARK if 0.299 * red + 0.587 * green + 0.114 * blue > 110 else LIGHT


def is_die(body: Body) -> bool:
    """Return whether a body is a die: a cube that is called so, with room for pips between its roundings."""
    shape = body.shape
    if not isinstance(shape, Box) or not DIE.search(body.name.lower()):
        return False
    cube = np.ptp((shape.lx, shape.ly, shape.lz)) <= 1e-9 * shape.lx
    return bool(cube and shape.half[0] > 2.5 * PIP * shape.lx)


def pips(shape: Box) -> Surface:
    """Return the pips of a die, discs a little above its faces: opposite faces make seven."""
    from carom.studies.ensembles.dice import FACES

    edge = shape.lx
    radius = PIP * edge
    away = min(AWAY * edge, float(shape.half[0]) - radius)
    angle = 2.0 * np.pi / SIDES * np.arange(SIDES)
    disc = radius * np.array([[0.0, 0.0], *np.stack([np.cos(angle), np.sin(angle)], axis=1)])
    fan = [(0, 1 + k, 1 + (k + 1) % SIDES) for k in range(SIDES)]
    vertices, triangles = [], []
    for side, count in enumerate(FACES.tolist()):
        axis, sign = side // 2, 1.0 - 2.0 * (side % 2)
        u = np.eye(3)[(axis + 1) % 3]
        n = sign * np.eye(3)[axis]
        v = np.cross(n, u)
        for place in _places(count):
            middle = (0.5 + ABOVE) * edge * n + away * (place[0] * u + place[1] * v)
            triangles += [tuple(len(vertices) + k for k in three) for three in fan]
            vertices += list(middle + disc[:, :1] * u + disc[:, 1:] * v)
    return np.array(vertices), np.array(triangles, dtype=np.int64)


def _places(count: int) -> list[tuple[float, float]]:
    """Return where the pips of a face are, from -1 to 1."""
    out = [(0.0, 0.0)] if count % 2 else []
    out += [(-1.0, -1.0), (1.0, 1.0)] if count > 1 else []
    out += [(-1.0, 1.0), (1.0, -1.0)] if count > 3 else []
    return out + ([(-1.0, 0.0), (1.0, 0.0)] if count == 6 else [])


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
    end = 1 if joint.child is body else 0
    place, axis = joint.anchor(), joint.definition.frame()[:, 0]
    if joint.frames is not None:
        position, orientation = joint.frames[end]
        place = position + quaternion.rotate(orientation, place)
        axis = quaternion.rotate(orientation, axis)
    else:
        place = quaternion.rotate_back(body.orientation, place - body.position)
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
