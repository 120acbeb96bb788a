"""Broad phase: the pairs of balls that overlap, in near linear time.

A hierarchical hashed grid (Mirtich 1996; Eitz and Gu 2007): the cells of the coarsest level are as wide as the
largest ball, those of each further level half as wide, and a ball lies on the finest level that is wide
enough for it. It can touch balls of its own and of coarser levels only in the 27 cells around its centre on
that level. On its own level half of these cells are enough, because each pair is found from one side. A
counting sort puts the balls into the cells. The order of the pairs depends on the balls only.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import entry, kernel
from carom.collision.thresholds import CELL_SLACK
from carom.geometry.vectors import dot, minus

LEVELS = 40  # sizes down to 2^-40 of the largest ball; smaller balls share the last level
FARTHEST_CELL = 2**62  # bound of the integer coordinates of a cell
LOW = 2**28 - 1  # bits of such a coordinate that are hashed


class SweepWork(NamedTuple):
    """Workspace for up to n balls."""

    first: np.ndarray  # (cells + 2,) the balls of cell c begin in `ball` at first[c + 1]
    ball: np.ndarray  # (n,) balls, cell by cell
    place: np.ndarray  # (n, 5) level (-1: left out); three integer coordinates; hashed cell
    used: np.ndarray  # (LEVELS + 1,) balls on each level
    made: np.ndarray  # (2,) comparisons, pairs
    width: np.ndarray  # (LEVELS + 1,) of the cells of each level


def new_sweep_work(count: int) -> SweepWork:
    """Return the workspace of `sweep` for `count` balls."""
    cells = 1
    while cells < 2 * count:
        cells *= 2
    sizes = ((cells + 2,), (count,), (count, 5), (LEVELS + 1,), (2,))
    return SweepWork(
        *(np.zeros(size, dtype=np.int64) for size in sizes), width=np.zeros(LEVELS + 1)
    )


@entry
def sweep(centres, radii, pairs, work):
    """Write the pairs i < j of balls that overlap or touch to `pairs`; return how many there are.

    Parameters
    ----------
    centres : (n, 3)
        [m]. A ball must contain the whole path of its solid during the step.
    radii : (n,)
        At least 0 [m]; a negative one leaves the ball out.
    pairs : (m, 2) int64
        Pairs beyond the end of this table are only counted: after a result above m, the caller needs a longer
        table.
    work : SweepWork

    Returns
    -------
    int
        Number of pairs.
    """
    widest = 0.0
    for r in radii:
        widest = max(widest, r)
    _fill(centres, radii, widest if widest > 0.0 else 1.0, work)
    work.made[0], work.made[1] = 0, 0
    for i in range(len(radii)):
        if work.place[i, 0] >= 0:
            for e in range(work.place[i, 0], LEVELS + 1):
                if work.used[e] > 0:
                    _around(i, e, centres, radii, pairs, work)
    return work.made[1]


@kernel
def _fill(centres, radii, widest, work):
    """Put the balls into the cells of their levels."""
    n, mask = len(radii), len(work.first) - 3
    for c in range(len(work.first)):
        work.first[c] = 0
    for e in range(LEVELS + 1):
        work.used[e] = 0
        # The cells are slightly wider than the balls.
        work.width[e] = math.ldexp(2.0 * (1.0 + CELL_SLACK) * widest, e - LEVELS)
    for i in range(n):
        place = work.place[i]
        place[0] = -1
        if radii[i] >= 0.0:
            e = _level(radii[i], widest)
            place[0] = e
            for k in range(3):
                place[1 + k] = _cell(centres[i, k], work.width[e])
            place[4] = _hash(e, place[1], place[2], place[3], mask)
            work.first[place[4] + 1] += 1
            work.used[e] += 1
    for c in range(mask + 1):
        work.first[c + 1] += work.first[c]
    work.first[mask + 2] = work.first[mask + 1]
    for i in range(n - 1, -1, -1):  # a cell is filled from its end: its balls are in rising order
        if work.place[i, 0] >= 0:
            c = work.place[i, 4] + 1
            work.first[c] -= 1
            work.ball[work.first[c]] = i


@kernel
def _level(r, widest):
    """Return the finest level whose cells are at least as wide as a ball; LEVELS is the coarsest."""
    if not r > 0.0:
        return 0
    part, power = math.frexp(r / widest)
    return max(0, LEVELS + power - (part == 0.5))


@kernel
def _cell(x, width):
    """Return the integer coordinate of the cell that contains x."""
    return int(max(-FARTHEST_CELL, min(FARTHEST_CELL, math.floor(x / width))))


@kernel
def _hash(e, x, y, z, mask):
    """Return the hashed cell of integer coordinates: products with large primes (Teschner et al., VMV 2003)."""
    x, y, z = x & LOW, y & LOW, z & LOW  # so that no product overflows
    return ((x * 73856093) ^ (y * 19349663) ^ (z * 83492791) ^ (e * 2654435761)) & mask


@kernel
def _around(i, e, centres, radii, pairs, work):
    """Write the pairs of ball i with balls of level e in the 27 cells around it."""
    gx = _cell(centres[i, 0], work.width[e])
    gy = _cell(centres[i, 1], work.width[e])
    gz = _cell(centres[i, 2], work.width[e])
    same, made = work.place[i, 0] == e, work.made
    for k in range(14 if same else 27):  # k = 13 is the cell of the ball itself
        x, y, z = gx + k // 9 - 1, gy + (k // 3) % 3 - 1, gz + k % 3 - 1
        c = _hash(e, x, y, z, len(work.first) - 3)
        begin, end = work.first[c + 1], work.first[c + 2]
        made[0] += end - begin
        for at in range(begin, end):
            j = work.ball[at]
            p = work.place[j]
            # Balls from elsewhere in the grid may share the hashed cell; they are skipped.
            there = p[0] == e and p[1] == x and p[2] == y and p[3] == z
            if not there or (same and k == 13 and j <= i):
                continue
            d, r = minus(centres[i], centres[j]), radii[i] + radii[j]
            if not dot(d, d) <= r * r:
                continue
            if made[1] < len(pairs):
                pairs[made[1], 0], pairs[made[1], 1] = min(i, j), max(i, j)
            made[1] += 1
