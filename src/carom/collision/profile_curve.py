"""The curve of a profile, by rows: values, places where m . c + w c . c/2 is greatest, stretches.

See `carom.collision.profile`.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision import thresholds as limits
from carom.collision.features import OF_FIXED, OF_SUPPORT
from carom.geometry.thresholds import ROUND_OFF

PEAK_STEPS = 60
ROWS_TOGETHER = 16  # in a block
ROWS_OF_BLOCKS = 128  # in a row of blocks, which may be passed over together
FINENESS = 1 << 30  # of a place on the curve, as a part


@inlined
def curve_at(row, t):
    """Return position, first and second derivative of a row of the curve at the distance t from its start."""
    c = row.c
    x, y, dx, dy, ex, ey = c[5, 0], c[5, 1], 0.0, 0.0, 0.0, 0.0
    for k in range(4, -1, -1):
        ex, ey = ex * t + 2.0 * dx, ey * t + 2.0 * dy
        dx, dy = dx * t + x, dy * t + y
        x, y = x * t + c[k, 0], y * t + c[k, 1]
    return x, y, dx, dy, ex, ey


@inlined
def block_at(rows, first, last):
    """Return the end of a block of rows, its middle, and how far the block is from the start of that row."""
    return rows_at(rows, first, min(first + ROWS_TOGETHER, last))


@inlined
def rows_at(rows, first, end):
    """Return the end of these rows, their middle, and how far they are from the start of that row."""
    middle = (first + end) >> 1
    arc = max(rows[middle].start - rows[first].start, rows[end].start - rows[middle].start)
    return end, middle, limits.CHORD * arc


@kernel
def peak_in_row(row, h, mx, my, w):
    """Return where in a row of length h the sign of (m + w c) . c' changes from + to -."""
    low, high, t = 0.0, h, 0.5 * h
    for _ in range(PEAK_STEPS):
        x, y, dx, dy, ex, ey = curve_at(row, t)
        ux, uy = mx + w * x, my + w * y
        g, slope = ux * dx + uy * dy, w * (dx * dx + dy * dy) + ux * ex + uy * ey
        if g > 0.0:
            low = t
        else:
            high = t
        new = t - g / slope if slope < 0.0 else low
        if not (low < new < high):
            new = 0.5 * (low + high)
        step, t = abs(new - t), new
        if not step > ROUND_OFF * h:
            break
    return t


@kernel
def place_of_part(solid, hulls, part):
    """Return the row of the curve, and the distance from its start, that a part of a profile stands for."""
    number = part & (FINENESS - 1)
    if part >= OF_FIXED:  # a corner
        return solid.first + number, 0.0
    rows = hulls.outlines
    s, low, high = number * (rows[solid.last].start / FINENESS), solid.first, solid.last
    while high - low > 1:
        middle = (low + high) >> 1
        if rows[middle].start <= s:
            low = middle
        else:
            high = middle
    return low, s - rows[low].start


@inlined
def part_of_place(solid, hulls, k, t):
    """Return the part of a profile for a place on its curve; a row of length 0 is a corner."""
    rows = hulls.outlines
    if rows[k + 1].start == rows[k].start:
        return OF_FIXED + k - solid.first
    return OF_SUPPORT + min(
        int((rows[k].start + t) / rows[solid.last].start * FINENESS), FINENESS - 1
    )


@kernel
def stretch(solid, hulls, s, length):
    """Return the number of the stretch between hollows; a circle of radius `length` enters flatter ones.

    A curve with one hollow, both sides of which may be touched, has two stretches, each a half of its length.
    """
    count, before, at, rows = 0, 0, 0.0, hulls.outlines
    for k in range(solid.first_face, solid.last_face):
        if -rows[k].c[0, 0] * length > limits.ENTERED:
            count += 1
            before += 1 if rows[k].start <= s else 0
            at = rows[k].start
    if count == 1:
        whole = rows[solid.last].start
        return 1 if (s - at if s >= at else s - at + whole) > 0.5 * whole else 0
    return 0 if before == count else before


@kernel
def is_peak(rows, k, mx, my, w, slack):
    """Return whether m . c + w c . c/2 has a greatest value in row k; at corners also nearly, by `slack`."""
    a, b = rows[k].c, rows[k + 1].c
    before = (mx + w * a[0, 0]) * a[1, 0] + (my + w * a[0, 1]) * a[1, 1]
    after = (mx + w * b[0, 0]) * b[1, 0] + (my + w * b[0, 1]) * b[1, 1]
    if slack > 0.0 and rows[k + 1].start == rows[k].start:
        return before > -slack and after < slack
    return before > 0.0 and after <= 0.0


@inlined
def is_straight(row, h):
    """Return whether a row is a straight line, not a corner."""
    c = row.c
    return h > 0.0 and c[2, 0] == 0.0 and c[2, 1] == 0.0 and c[5, 0] == 0.0 and c[5, 1] == 0.0


@kernel
def farthest_of_curve(solid, hulls, x, y):
    """Return the greatest x c_x + y c_y on the curve of a profile."""
    rows, best, across = hulls.outlines, -math.inf, math.sqrt(x * x + y * y)
    for k in range(solid.first, solid.last, ROWS_TOGETHER):
        _, at, _ = block_at(rows, k, solid.last)
        best = max(best, x * rows[at].c[0, 0] + y * rows[at].c[0, 1])
    for start in range(solid.first, solid.last, ROWS_TOGETHER):
        end, at, arc = block_at(rows, start, solid.last)
        if x * rows[at].c[0, 0] + y * rows[at].c[0, 1] + across * arc < best:
            continue
        for k in range(start, end):
            c = rows[k].c
            best = max(best, x * c[0, 0] + y * c[0, 1])
            if is_peak(rows, k, x, y, 0.0, 0.0) and rows[k + 1].start > rows[k].start:
                t = peak_in_row(rows[k], rows[k + 1].start - rows[k].start, x, y, 0.0)
                px, py, _, _, _, _ = curve_at(rows[k], t)
                best = max(best, x * px + y * py)
    return best
