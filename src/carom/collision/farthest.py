"""The point of many that is farthest along a direction, from the candidates in the cell of the direction."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel

VERTICES, NORMALS = range(2)  # of a hull


@inlined
def _place(part, whole, across):
    """Return the place along an edge of the cube of a coordinate from -whole to whole."""
    return min(int(0.5 * across * (part / whole + 1.0)), across - 1)


@kernel
def _cell(across, x, y, z):
    """Return the number of the cell of a direction, as in `carom.geometry.cells`; 0 for none, such as NaN."""
    if across == 0:
        return 0
    a, b, c = abs(x), abs(y), abs(z)
    if a >= b and a >= c:
        side, whole, u, v = 1 if x < 0.0 else 0, a, y, z
    elif b >= c:
        side, whole, u, v = 3 if y < 0.0 else 2, b, z, x
    else:
        side, whole, u, v = 5 if z < 0.0 else 4, c, x, y
    if not (0.0 < whole < math.inf and abs(u) <= whole and abs(v) <= whole):
        return 0
    return (side * across + _place(u, whole, across)) * across + _place(v, whole, across)


@kernel
def farthest(solid, hulls, what, x, y, z):
    """Return the greatest product of (x, y, z) with the VERTICES or NORMALS of a hull, and its candidate."""
    cell = solid.cell[what] + _cell(solid.across[what], x, y, z)
    first = hulls.starts[cell]
    best, chosen = -math.inf, first
    for i in range(first, hulls.starts[cell + 1]):
        p = hulls.candidates[i].point
        along = p[0] * x + p[1] * y + p[2] * z
        if along > best:
            best, chosen = along, i
    return best, chosen
