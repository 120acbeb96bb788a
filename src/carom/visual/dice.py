"""Dice as they are drawn: which bodies are dice, and their pips."""

from __future__ import annotations

import re

import numpy as np

from carom.scene.bodies import Body
from carom.scene.shapes import Box

DARK, LIGHT = "#1d252c", "#ffffff"
DIE = re.compile(r"(?<![a-z])(die|dice)(?![a-z])")  # in the name of a die
#: by the edge of a die: radius of a pip, distance from the middle, height above the face
PIP, AWAY, ABOVE = 0.09, 0.25, 0.004
SIDES = 20  # of the polygon of a pip


def pip_colour(colour: str) -> str:
    """Return the colour of pips: dark on light dice, light on dark ones."""
    red, green, blue = bytes.fromhex(colour[1:])
    return DARK if 0.299 * red + 0.587 * green + 0.114 * blue > 110 else LIGHT


def is_die(body: Body) -> bool:
    """Return whether a body is a die: a cube that is called so, with room for pips between its roundings."""
    shape = body.shape
    if not isinstance(shape, Box) or not DIE.search(body.name.lower()):
        return False
    cube = np.ptp((shape.lx, shape.ly, shape.lz)) <= 1e-9 * shape.lx
    return bool(cube and shape.half[0] > 2.5 * PIP * shape.lx)


def pips(shape: Box) -> tuple[np.ndarray, np.ndarray]:
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
