"""Arrows of impulses, and points of persistent contacts."""

from __future__ import annotations

import numpy as np

from carom.geometry.frames import contact_axes
from carom.visual.plots import style

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
        pairs = solution.pairs
        table = solution.impacts
        drawn = np.flatnonzero(table.contact < len(pairs.body))  # stops have no point of contact
        self.time, self.point = table.time[drawn], table.point[drawn]
        push = np.zeros((len(drawn), 3))
        for row, k in enumerate(drawn):
            flat = 0 <= pairs.plane[table.contact[k]] < len(solution.scene.half_spaces)
            n = table.normal[k]
            push[row] = table.impulse[k] @ (contact_axes(n) if flat else pair_axes(n))
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


def pair_axes(normal: np.ndarray) -> np.ndarray:
    """Return rows n, t1, t2 of a contact of two bodies, as `carom.contact.pair_point.tangents`."""
    e = np.eye(3)[0 if abs(normal[0]) < 0.8 else 1]
    first = e - (e @ normal) * normal
    first /= np.linalg.norm(first)
    return np.stack([normal, first, np.cross(normal, first)])


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
