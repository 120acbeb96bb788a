"""Triangles, grounds and shadows onto pixels, nearest first: a depth buffer in a few kernels.

Pixels have x to the right and y down; depth is kept as one over the distance along the line of sight, which is
linear over the picture. Two and more of these pixels make one of the film, which smooths edges.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry

AMBIENT = 0.55  # brightness of what is turned away from the light
GLOSS = 0.18  # of the highlight
INK = 0.28  # brightness of an edge


@entry
def paint(corners, normals, colours, edges, light, towards, half_line, image, depth):
    """Paint triangles that are turned to the eye.

    Parameters
    ----------
    corners : (F, 3, 3)
        Pixel x, pixel y and inverse distance of the corners; not above 0 behind the eye.
    normals : (F, 3, 3)
        Unit normals at the corners.
    colours : (F, 3)
    edges : (F, 3)
        Not 0 where the side opposite the corner is drawn as a line.
    light, towards : (3,)
        Unit vectors to the light and to the eye.
    half_line : float
        Half the width of a line [pixels].
    image, depth : (H, W, 3) uint8, (H, W) float32
    """
    height, width = depth.shape
    for f in range(len(corners)):
        x0, y0, w0 = corners[f, 0, 0], corners[f, 0, 1], corners[f, 0, 2]
        x1, y1, w1 = corners[f, 1, 0], corners[f, 1, 1], corners[f, 1, 2]
        x2, y2, w2 = corners[f, 2, 0], corners[f, 2, 1], corners[f, 2, 2]
        # counter-clockwise from outside is clockwise in numbers, where y points down
        area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)
        if not (area > 1e-9 and w0 > 0.0 and w1 > 0.0 and w2 > 0.0):
            continue
        far0 = area / math.hypot(x2 - x1, y2 - y1)  # distance of a corner from the side opposite
        far1 = area / math.hypot(x0 - x2, y0 - y2)
        far2 = area / math.hypot(x1 - x0, y1 - y0)
        top = max(0, math.ceil(min(y0, y1, y2) - 0.5))
        bottom = min(height - 1, math.floor(max(y0, y1, y2) - 0.5))
        left = max(0, math.ceil(min(x0, x1, x2) - 0.5))
        right = min(width - 1, math.floor(max(x0, x1, x2) - 0.5))
        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(left, right + 1):
                x = column + 0.5
                l0 = ((x2 - x) * (y1 - y) - (x1 - x) * (y2 - y)) / area
                l1 = ((x0 - x) * (y2 - y) - (x2 - x) * (y0 - y)) / area
                l2 = 1.0 - l0 - l1
                if not (l0 >= 0.0 and l1 >= 0.0 and l2 >= 0.0):
                    continue
                near = l0 * w0 + l1 * w1 + l2 * w2
                if not near > depth[row, column]:
                    continue
                depth[row, column] = near
                bright, shine = INK, 0.0
                line = (edges[f, 0] != 0 and l0 * far0 < half_line) or (
                    edges[f, 1] != 0 and l1 * far1 < half_line
                )
                line = line or (edges[f, 2] != 0 and l2 * far2 < half_line)
                if not line:
                    n0 = l0 * normals[f, 0, 0] + l1 * normals[f, 1, 0] + l2 * normals[f, 2, 0]
                    n1 = l0 * normals[f, 0, 1] + l1 * normals[f, 1, 1] + l2 * normals[f, 2, 1]
                    n2 = l0 * normals[f, 0, 2] + l1 * normals[f, 1, 2] + l2 * normals[f, 2, 2]
                    size = max(math.sqrt(n0 * n0 + n1 * n1 + n2 * n2), 1e-12)
                    lit = (n0 * light[0] + n1 * light[1] + n2 * light[2]) / size
                    bright = AMBIENT + (1.0 - AMBIENT) * max(lit, 0.0)
                    h0, h1, h2 = light[0] + towards[0], light[1] + towards[1], light[2] + towards[2]
                    h = max(math.sqrt(h0 * h0 + h1 * h1 + h2 * h2), 1e-12)
                    shine = GLOSS * max((n0 * h0 + n1 * h1 + n2 * h2) / (size * h), 0.0) ** 40
                for k in range(3):
                    value = min(1.0, bright * colours[f, k] + shine)
                    image[row, column, k] = int(255.0 * value + 0.5)


@entry
def ground(eye, right, up, forward, focal, plane, grid, colours, image, depth, marks, number):
    """Paint a plane with a grid, which fades with the distance from a point.

    Parameters
    ----------
    eye, right, up, forward : (3,)
        Of the camera: where, and its axes.
    focal : float
        Focal length [pixels].
    plane : (4, 3)
        A point that the grid fades around, the normal, two directions in the plane.
    grid : (3,)
        Spacing of the lines, and from which distance on the plane begins and ends to fade [m].
    colours : (3, 3)
        Of the plane, of the lines, of the background.
    image, depth : (H, W, 3) uint8, (H, W) float32
    marks : (H, W) uint8
        Written: `number` where the plane is seen.
    number : int
    """
    height, width = depth.shape
    spacing, begin, end = grid[0], grid[1], grid[2]
    n, u, v = plane[1], plane[2], plane[3]
    above = -_dot(n, eye[0] - plane[0, 0], eye[1] - plane[0, 1], eye[2] - plane[0, 2])
    side = _dot(n, right[0], right[1], right[2]) / focal
    rise = -_dot(n, up[0], up[1], up[2]) / focal
    for row in range(height):
        for column in range(width):
            a, b = (column + 0.5 - 0.5 * width) / focal, (0.5 * height - row - 0.5) / focal
            d0 = forward[0] + a * right[0] + b * up[0]
            d1 = forward[1] + a * right[1] + b * up[1]
            d2 = forward[2] + a * right[2] + b * up[2]
            falls = _dot(n, d0, d1, d2)
            if not falls < 0.0:
                continue
            s = above / falls  # distance along the line of sight
            if not (s > 0.0 and 1.0 / s > depth[row, column]):
                continue
            r0 = eye[0] + s * d0 - plane[0, 0]
            r1 = eye[1] + s * d1 - plane[0, 1]
            r2 = eye[2] + s * d2 - plane[0, 2]
            away = math.sqrt(r0 * r0 + r1 * r1 + r2 * r2)
            fade = min(1.0, max(0.0, (away - begin) / (end - begin)))
            if not fade < 1.0:
                continue
            depth[row, column], marks[row, column] = 1.0 / s, number
            line = 0.0
            for which in range(2):
                e = u if which == 0 else v
                along = _dot(e, d0, d1, d2)
                # how far the coordinate goes from one pixel to the next, to the right and down
                p = s * (_dot(e, right[0], right[1], right[2]) / focal - along * side / falls)
                q = s * (-_dot(e, up[0], up[1], up[2]) / focal - along * rise / falls)
                pixel = max(math.sqrt(p * p + q * q), 1e-12 * spacing)
                at = _dot(e, r0, r1, r2) / spacing
                apart = abs(at - math.floor(at + 0.5)) * spacing / pixel
                seen = min(1.0, max(0.0, 1.5 - apart)) * min(1.0, 0.25 * spacing / pixel)
                line = max(line, seen)
            for k in range(3):
                value = colours[0, k] + line * (colours[1, k] - colours[0, k])
                value += fade * fade * (colours[2, k] - value)
                image[row, column, k] = int(255.0 * value + 0.5)


@entry
def shade(corners, dark, number, image, marks):
    """Darken, once, what triangles (F, 3, 3) on a plane cover of it: pixels with its mark."""
    height, width = marks.shape
    for f in range(len(corners)):
        x0, y0, w0 = corners[f, 0, 0], corners[f, 0, 1], corners[f, 0, 2]
        x1, y1, w1 = corners[f, 1, 0], corners[f, 1, 1], corners[f, 1, 2]
        x2, y2, w2 = corners[f, 2, 0], corners[f, 2, 1], corners[f, 2, 2]
        area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)
        if not (abs(area) > 1e-9 and w0 > 0.0 and w1 > 0.0 and w2 > 0.0):
            continue
        top = max(0, math.ceil(min(y0, y1, y2) - 0.5))
        bottom = min(height - 1, math.floor(max(y0, y1, y2) - 0.5))
        left = max(0, math.ceil(min(x0, x1, x2) - 0.5))
        right = min(width - 1, math.floor(max(x0, x1, x2) - 0.5))
        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(left, right + 1):
                if marks[row, column] != number:
                    continue
                x = column + 0.5
                l0 = ((x2 - x) * (y1 - y) - (x1 - x) * (y2 - y)) / area
                l1 = ((x0 - x) * (y2 - y) - (x2 - x) * (y0 - y)) / area
                if l0 >= 0.0 and l1 >= 0.0 and 1.0 - l0 - l1 >= 0.0:
                    marks[row, column] = 0
                    for k in range(3):
                        image[row, column, k] = int(dark * image[row, column, k])


@entry
def _dot(a, b0, b1, b2):
    return a[0] * b0 + a[1] * b1 + a[2] * b2
