"""Arrows on surfaces that move in themselves: belts, turntables, rollers."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.visual.surfaces import surface

ARROWS, AROUND = 4, 3  # arrows of a solid; of a plane that turns, about its axis
LONG, THICK = 0.12, 0.012  # length and thickness, as fractions of the size of the region
#: side view of an arrow of length 1 from its middle: along it, across it
OUTLINE = np.array(
    [(-0.5, -1.0), (0.1, -1.0), (0.1, -3.0), (0.5, 0.0), (0.1, 3.0), (0.1, 1.0), (-0.5, 1.0)]
)
FLAT = np.array([(0, 1, 5), (0, 5, 6), (2, 3, 4)])


def arrows_of(scene, radius: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return vertices and triangles of the arrows of all moving surfaces, by their motion at the start."""
    made = []
    for part in scene.fixed:
        if not part.moves:
            continue
        points, normals = _places(part, radius)
        try:
            velocity = _velocity(part, points)
        except RuntimeError:  # a function that the file of a run does not have
            continue
        velocity -= np.sum(velocity * normals, axis=1)[:, None] * normals
        speed = np.linalg.norm(velocity, axis=1)
        chosen = _apart(points, speed)
        made += [
            _arrow(points[k], normals[k], velocity[k] / speed[k], radius)
            for k in chosen
            if speed[k] > 0.0
        ]
    return made


def _places(part, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points of a surface, and the normals there."""
    if not hasattr(part, "shape"):
        if part.surface_spin is None:
            return part.point[None], part.normal[None]
        axis = np.cross(part.normal, np.eye(3)[np.argmin(np.abs(part.normal))])
        turns = 2.0 * np.pi * np.arange(AROUND)[:, None] / AROUND
        ring = np.cos(turns) * axis + np.sin(turns) * np.cross(part.normal, axis)
        middle = part.surface_spin[2] if part.surface_spin[2] is not None else part.point
        return middle + 0.4 * radius * ring, np.repeat(part.normal[None], AROUND, axis=0)
    vertices, triangles = surface(part.shape, 16)
    corners = (part.position + quaternion.rotate(part.orientation, vertices))[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return corners.mean(axis=1), normals / np.linalg.norm(normals, axis=1)[:, None]


def _velocity(part, points: np.ndarray) -> np.ndarray:
    """Return the velocity of the surface at points at the start."""
    velocity, spin = part.surface_velocity, part.surface_spin
    if velocity is None:
        velocity = np.zeros(3)
    v = velocity if isinstance(velocity, np.ndarray) else velocity(0.0)[0]
    moved = np.repeat(np.asarray(v, dtype=float)[None], len(points), axis=0)
    if spin is not None:
        axis, rate, own = spin
        middle = own if own is not None else getattr(part, "position", getattr(part, "point", None))
        moved += (rate if isinstance(rate, float) else rate(0.0)[0]) * np.cross(
            axis, points - middle
        )
    return moved


def _apart(points: np.ndarray, speed: np.ndarray) -> list[int]:
    """Return the indices of a few of the fastest points, far from each other."""
    fast = np.flatnonzero(speed >= 0.7 * speed.max())
    chosen = [int(fast[0])]
    while len(chosen) < min(ARROWS, len(fast)):
        away = np.min(np.linalg.norm(points[fast, None] - points[chosen], axis=2), axis=1)
        if not away.max() > 0.0:
            break
        chosen.append(int(fast[np.argmax(away)]))
    return chosen


def _arrow(point, normal, along, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Return an arrow that lies on a surface."""
    flat = LONG * radius * OUTLINE[:, :1] * along
    flat = flat + 0.5 * THICK * radius * OUTLINE[:, 1:] * np.cross(normal, along)
    low, high = point + flat, point + flat + THICK * radius * normal
    n = len(OUTLINE)
    sides = [
        t
        for k in range(n)
        for t in ((k, (k + 1) % n, n + k), ((k + 1) % n, n + (k + 1) % n, n + k))
    ]
    return np.concatenate([low, high]), np.concatenate([FLAT[:, ::-1], FLAT + n, sides])
