"""Arrows of impulses, and points of persistent contacts."""

from __future__ import annotations

import numpy as np

from carom.visual.plots import style
from carom.visual.viewer.strikes import world_impulses

LINGER = 0.15  # time for which an arrow is shown [s of the film]
#: length of the arrow of the greatest impulse, as a fraction of the height of the view
LONGEST = 0.20
LEAST = 0.03  # fraction of the greatest impulse; smaller impulses are not drawn
HEAD = 0.35  # length of the head, as a fraction of an arrow
#: a point that lies below a surface by at most this fraction of the distance is visible
GRAZE = 0.004


class Marks:
    """Impulses of a run as arrows in the world."""

    def __init__(self, solution, length: float):
        self.solution, self.linger = solution, LINGER
        table, push = solution.impacts, world_impulses(solution)
        self.time, self.point = table.time, table.point
        size = np.linalg.norm(push, axis=1)
        greatest = float(size.max(initial=0.0)) or 1.0
        # lengths grow with the square root: the first impulse is often ten times the later ones
        scale = LONGEST * length * np.sqrt(size / greatest) / np.where(size > 0.0, size, 1.0)
        self.arrow = np.where((size > LEAST * greatest)[:, None], push * scale[:, None], 0.0)
        self.saved, self.points = solution.forces.saved, solution.forces.point

    def draw(self, pen, camera, depth, t: float) -> None:
        """Draw the arrows and points at a time."""
        unit = camera.height / 720.0
        k = int(np.clip(np.searchsorted(self.solution.t, t, side="right") - 1, 0, None))
        low, high = np.searchsorted(self.saved, [k, k + 1])
        dot = 2.6 * unit
        if high - low <= 60:  # in a pile they would hide the bodies
            for x, y, near in camera.project(self.points[low:high]):
                if _visible(x, y, near, depth):
                    pen.ellipse((x - dot, y - dot, x + dot, y + dot), fill="#202020")
        for row in np.flatnonzero((self.time <= t) & (self.time > t - self.linger)):
            ends = camera.project(np.array([self.point[row], self.point[row] + self.arrow[row]]))
            if np.all(ends[:, 2] > 0.0):
                _arrow(pen, ends[0, :2], ends[1, :2], unit)


def _visible(x: float, y: float, near: float, depth) -> bool:
    """Return whether a point is visible; a point just below the surface on which it lies is visible too."""
    height, width = depth.shape
    if not (near > 0.0 and 0.0 <= x < width and 0.0 <= y < height):
        return False
    return near >= (1.0 - GRAZE) * depth[int(y), int(x)]


def _arrow(pen, start, end, unit: float) -> None:
    """Draw an arrow, its head no longer than itself."""
    line = end - start
    length = float(np.hypot(*line))
    if not length > 2.0 * unit:
        return
    along = line / length
    across = np.array([-along[1], along[0]])
    head = min(HEAD * length, 16.0 * unit)
    neck = end - head * along
    wide = 0.42 * head
    pen.line(
        [tuple(start), tuple(neck + 0.2 * head * along)],
        fill=style.RED,
        width=max(1, round(4.0 * unit)),
    )
    tip = [tuple(end), tuple(neck + wide * across), tuple(neck - wide * across)]
    pen.polygon(tip, fill=style.RED)
    dot = 3.2 * unit
    pen.ellipse((start[0] - dot, start[1] - dot, start[0] + dot, start[1] + dot), fill=style.RED)
