"""Triangles, planes and shadows onto pixels, nearest first: a depth buffer in three kernels.

Pixels have x to the right and y down; depth is kept as one over the distance along the line of sight, which is
linear over the picture. Two and more of these pixels make one of the film, which smooths edges.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import entry, kernel

AMBIENT = 0.55  # brightness of what is turned away from the light
GLOSS = 0.18  # of the highlight
INK = 0.28  # brightness of an edge


class Buffer(NamedTuple):
    """Pixels that are being painted."""

    image: np.ndarray  #: (H, W, 3) uint8
    depth: np.ndarray  #: (H, W) float32, one over the distance of what is seen, 0 where nothing is
    plane: (
        np.ndarray
    )  #: (H, W) uint8, number of the plane that is seen and lies in the light, 0 for none


@entry
def paint(seen, light, halfway, half_line, buffer):
    """Paint triangles that are turned to the eye.

    Parameters
    ----------
    seen : Model
        Its corners are pixel x, pixel y and inverse distance, which is not above 0 behind the eye.
    light, halfway : (3,)
        Unit vectors to the light, and halfway between light and eye.
    half_line : float
        Half the width of a line [pixels].
    buffer : Buffer
    """
    image, depth = buffer.image, buffer.depth
    corners, normals, colours, edges = seen.corners, seen.normals, seen.colours, seen.edges
    for f in range(len(corners)):
        at, near, area = _triangle(corners[f])
        # counter-clockwise from outside is clockwise in numbers, where y points down
        if not (area > 1e-9 and near[0] > 0.0 and near[1] > 0.0 and near[2] > 0.0):
            continue
        x0, y0, x1, y1, x2, y2 = at
        # distance of a corner from the side opposite, and how much of it a line takes; edges are 0 or 1
        ink0 = edges[f, 0] * half_line * math.hypot(x2 - x1, y2 - y1) / area
        ink1 = edges[f, 1] * half_line * math.hypot(x0 - x2, y0 - y2) / area
        ink2 = edges[f, 2] * half_line * math.hypot(x1 - x0, y1 - y0) / area
        top, bottom, left, right = _extent(at, depth.shape)
        for row in range(top, bottom):
            for column in range(left, right):
                l0, l1, l2 = _weights(at, area, column + 0.5, row + 0.5)
                if not (l0 >= 0.0 and l1 >= 0.0 and l2 >= 0.0):
                    continue
                here = l0 * near[0] + l1 * near[1] + l2 * near[2]
                if not here > depth[row, column]:
                    continue
                depth[row, column] = here
                bright, shine = INK, 0.0
                if l0 >= ink0 and l1 >= ink1 and l2 >= ink2:
                    bright, shine = _lit(normals[f], (l0, l1, l2), light, halfway)
                for k in range(3):
                    value = min(1.0, bright * colours[f, k] + shine)
                    image[row, column, k] = int(255.0 * value + 0.5)


@entry
def ground(eye, sight, grid, colours, number, buffer):
    """Paint a plane with a grid, which fades with the distance from a point.

    Parameters
    ----------
    eye : (3,)
        The camera from that point: height above the plane, and along the two directions of the grid [m].
    sight : (3, 3)
        Along normal and directions: change of the line of sight with the column, with the row, and the line
        itself in the first pixel.
    grid : (3,)
        Spacing of the lines, and from which distance on the plane begins and ends to fade [m].
    colours : (3, 3)
        Of the plane, of the lines, of the background.
    number : int
        Of the plane in `buffer`.
    buffer : Buffer
    """
    image, depth, plane = buffer.image, buffer.depth, buffer.plane
    spacing, begin, end = grid
    for row in range(depth.shape[0]):
        for column in range(depth.shape[1]):
            falls = _linear(sight[0], column, row)
            s = -eye[0] / falls  # distance along the line of sight
            if not (falls < 0.0 < s and 1.0 / s > depth[row, column]):
                continue
            u = eye[1] + s * _linear(sight[1], column, row)
            v = eye[2] + s * _linear(sight[2], column, row)
            fade = min(1.0, max(0.0, (math.sqrt(u * u + v * v) - begin) / (end - begin)))
            if not fade < 1.0:
                continue
            depth[row, column], plane[row, column] = 1.0 / s, number
            line = 0.0
            for k in range(1, 3):
                along = _linear(sight[k], column, row)
                # how far the coordinate goes from one pixel to the next, to the right and down
                p = s * (sight[k, 0] - along * sight[0, 0] / falls)
                q = s * (sight[k, 1] - along * sight[0, 1] / falls)
                pixel = max(math.sqrt(p * p + q * q), 1e-12 * spacing)
                at = (eye[k] + s * along) / spacing
                apart = abs(at - math.floor(at + 0.5)) * spacing / pixel
                seen = min(1.0, max(0.0, 1.5 - apart)) * min(1.0, 0.25 * spacing / pixel)
                line = max(line, seen)
            for k in range(3):
                value = colours[0, k] + line * (colours[1, k] - colours[0, k])
                value += fade * fade * (colours[2, k] - value)
                image[row, column, k] = int(255.0 * value + 0.5)


@entry
def shade(corners, dark, number, buffer):
    """Darken, once, what triangles (F, 3, 3) on a plane cover of it: pixels with its number."""
    image, plane = buffer.image, buffer.plane
    for f in range(len(corners)):
        at, near, area = _triangle(corners[f])
        if not (abs(area) > 1e-9 and near[0] > 0.0 and near[1] > 0.0 and near[2] > 0.0):
            continue
        top, bottom, left, right = _extent(at, plane.shape)
        for row in range(top, bottom):
            for column in range(left, right):
                if plane[row, column] != number:
                    continue
                l0, l1, l2 = _weights(at, area, column + 0.5, row + 0.5)
                if not (l0 >= 0.0 and l1 >= 0.0 and l2 >= 0.0):
                    continue
                plane[row, column] = 0
                for k in range(3):
                    image[row, column, k] = int(dark * image[row, column, k])


@kernel
def _triangle(corner):
    """Return x and y of its corners, their inverse distances, and twice its area, with a sign."""
    x0, y0, x1, y1 = corner[0, 0], corner[0, 1], corner[1, 0], corner[1, 1]
    x2, y2 = corner[2, 0], corner[2, 1]
    area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)
    return (x0, y0, x1, y1, x2, y2), (corner[0, 2], corner[1, 2], corner[2, 2]), area


@kernel
def _extent(at, shape):
    """Return the first row and the one after the last, and the columns, whose middles it may cover."""
    x0, y0, x1, y1, x2, y2 = at
    top = max(0, math.ceil(min(y0, y1, y2) - 0.5))
    bottom = min(shape[0], math.floor(max(y0, y1, y2) - 0.5) + 1)
    left = max(0, math.ceil(min(x0, x1, x2) - 0.5))
    right = min(shape[1], math.floor(max(x0, x1, x2) - 0.5) + 1)
    return top, bottom, left, right


@kernel
def _weights(at, area, x, y):
    """Return the parts of the three corners in a point: its barycentric coordinates."""
    x0, y0, x1, y1, x2, y2 = at
    l0 = ((x2 - x) * (y1 - y) - (x1 - x) * (y2 - y)) / area
    l1 = ((x0 - x) * (y2 - y) - (x2 - x) * (y0 - y)) / area
    return l0, l1, 1.0 - l0 - l1


@kernel
def _lit(normals, weights, light, halfway):
    """Return how bright a point of a triangle is, and its highlight."""
    square, lit, shine = 0.0, 0.0, 0.0
    for k in range(3):
        n = weights[0] * normals[0, k] + weights[1] * normals[1, k] + weights[2] * normals[2, k]
        square += n * n
        lit += n * light[k]
        shine += n * halfway[k]
    size = max(math.sqrt(square), 1e-12)
    bright = AMBIENT + (1.0 - AMBIENT) * max(lit / size, 0.0)
    return bright, GLOSS * max(shine / size, 0.0) ** 40


@kernel
def _linear(form, column, row):
    return form[0] * column + form[1] * row + form[2]
