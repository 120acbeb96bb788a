"""The camera of a picture: position, directions and distance."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom import checks

VIEWS = {"oblique": (-65.0, 18.0), "front": (-90.0, 8.0), "side": (0.0, 8.0), "top": (-90.0, 90.0)}
OPENING = math.tan(math.radians(13.0))  # half the height of the picture divided by its distance
MARGIN = 1.14  # size of the picture divided by that of the moving bodies
#: least distance of the camera divided by the distance of the nearest point from the centre
NEAR = 1.3


class Axes(NamedTuple):
    """Directions of a camera, world."""

    right: np.ndarray
    up: np.ndarray
    towards: np.ndarray  #: from what is seen to the eye


class Camera(NamedTuple):
    """A camera that looks at `centre` from a `distance` [m]."""

    axes: Axes
    centre: np.ndarray
    distance: float
    width: int
    height: int

    @property
    def eye(self) -> np.ndarray:
        """Position of the camera (3,) [m]."""
        return self.centre + self.distance * self.axes.towards

    @property
    def focal(self) -> float:
        """Focal length [pixels]."""
        return 0.5 * min(self.height, self.width) / OPENING

    @property
    def rays(self) -> np.ndarray:
        """Change of the line of sight with the column, with the row, and it in the first pixel: columns."""
        right, down = self.axes.right / self.focal, -self.axes.up / self.focal
        corner = 0.5 * (1.0 - self.width) * right + 0.5 * (1.0 - self.height) * down
        return np.stack([right, down, corner - self.axes.towards], axis=1)

    def project(self, points: np.ndarray) -> np.ndarray:
        """Return pixel x, pixel y and inverse distance (..., 3) of points (..., 3)."""
        apart = points - self.eye
        away = np.maximum(-(apart @ self.axes.towards), 1e-9 * self.distance)
        scale = self.focal / away
        x = 0.5 * self.width + scale * (apart @ self.axes.right)
        y = 0.5 * self.height - scale * (apart @ self.axes.up)
        behind = away <= 1e-3 * self.distance
        return np.stack([x, y, np.where(behind, -1.0, 1.0 / away)], axis=-1)


def vertical(scene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the vertical, against gravity or z without it, and two horizontal directions."""
    gravity = np.asarray(scene.gravity, dtype=float)
    up = -gravity / np.linalg.norm(gravity) if np.any(gravity) else np.eye(3)[2]
    first = np.eye(3)[0 if abs(up[0]) < 0.8 else 1]
    first = first - (first @ up) * up
    first /= np.linalg.norm(first)
    return up, first, np.cross(up, first)


def axes_of(view, scene) -> Axes:
    """Return the directions of a camera from the name of a view or (azimuth, elevation) [degrees]."""
    if isinstance(view, str):
        view = VIEWS[checks.choice("view", view, VIEWS)]
    azimuth, elevation = checks.finite_array("view", view, (2,), "degrees")
    checks.number("view[1], the elevation,", elevation, least=-90.0, most=90.0, unit="degrees")
    up, first, second = vertical(scene)
    a, e = math.radians(azimuth), math.radians(elevation)
    right = -math.sin(a) * first + math.cos(a) * second
    towards = math.cos(e) * (math.cos(a) * first + math.sin(a) * second) + math.sin(e) * up
    return Axes(right, np.cross(towards, right), towards)


def fitted(axes: Axes, places, radii, size: tuple[int, int]) -> Camera:
    """Return a camera that sees balls of `radii` (P,) at `places` (P, 3)."""
    width, height = size
    across = np.array(axes) @ places.T  # (3, P)
    middle = 0.5 * ((across - radii).min(axis=1) + (across + radii).max(axis=1))
    far = np.linalg.norm(across - middle[:, None], axis=0) + radii
    camera = Camera(axes, middle @ np.array(axes), float(np.max(far)) / OPENING, width, height)
    # what is near is larger: middle and size of the picture follow from each other
    for _ in range(8):
        seen = camera.project(places)
        reach = radii[:, None] * camera.focal * seen[:, 2:]
        low, high = (seen[:, :2] - reach).min(axis=0), (seen[:, :2] + reach).max(axis=0)
        x, y = (0.5 * (low + high) - (0.5 * width, 0.5 * height)) * camera.distance / camera.focal
        part = float(np.max((high - low) / (width, height)))  # of the picture
        away = max(MARGIN * part * camera.distance, NEAR * float(np.max(radii)))
        camera = camera._replace(centre=camera.centre + x * axes.right - y * axes.up, distance=away)
        camera = camera._replace(distance=max(away, _before(camera, places, radii)))
    return camera


def _before(camera: Camera, places, radii) -> float:
    """Return a distance from which all balls are in front of the camera."""
    return NEAR * float(np.max((places - camera.centre) @ camera.axes.towards + radii))
