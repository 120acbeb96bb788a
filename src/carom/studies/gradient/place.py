"""The contact point of two bodies, and its derivatives by the poses of the bodies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.geometry.frames import pair_axes
from carom.studies.gradient.body import Moving, hat

STEP = 2.0**-9  # step of differences of order 4, relative to the size of the smaller body
AGREE = 1e-6  # allowed difference of two such differences, relative to the size


class Place(NamedTuple):
    """A point of contact of one body (with a half-space) or of two.

    Derivatives have a last axis for (dx, dtheta) of each body, 6 or 12.
    """

    gap: float
    axes: np.ndarray  # (3, 3) rows n, t1, t2
    arms: np.ndarray  # (B, 3) from the mass centres, world
    d_gap: np.ndarray  # (6 B,)
    d_axes: np.ndarray  # (3, 3, 6 B)
    d_arms: np.ndarray  # (B, 3, 6 B)


def vertex_place(row, core: np.ndarray, body: Moving) -> Place:
    """Return the contact point, on a half-space, of a ball around a vertex, `core` in principal axes."""
    n = row.axes[0]
    c = body.R @ core
    arm = c - row.radius * n
    d_arm = np.zeros((1, 3, 6))
    d_arm[0, :, 3:] = -hat(c)  # dtheta x c
    return Place(
        float(n @ (body.x + arm) - row.offset), row.axes.copy(), arm[None],
        np.concatenate([n, np.cross(c, n)]), np.zeros((3, 3, 6)), d_arm,
    )  # fmt: skip


def found_place(system, row, bodies: list[Moving]) -> Place | None:
    """Return the nearest point of two solids, or of a curved solid and a half-space.

    Its derivatives are differences of order 4, with two steps. If these do not agree, the result is None: at an
    edge or face from which the point may jump to another.
    """
    finder = _Finder(system, row)
    size = float(row.extent if row.other < 0 else min(row.extent, row.other_extent))
    here = finder(bodies, np.zeros(6 * len(bodies)))
    if here is None:
        return None
    unit = np.tile([size, size, size, 1.0, 1.0, 1.0], len(bodies))
    slopes = [_differences(finder, bodies, STEP * part * unit) for part in (1.0, 0.5)]
    if slopes[0] is None or slopes[1] is None:
        return None
    scale = np.concatenate([[size], np.ones(9), np.full(here.size - 10, size)])
    if not np.max(np.abs(slopes[0] - slopes[1]) * unit / scale[:, None]) <= AGREE:
        return None
    d, count = slopes[1], len(bodies)
    return Place(
        float(here[0]), here[1:10].reshape(3, 3), here[10:].reshape(count, 3), d[0],
        d[1:10].reshape(3, 3, -1), d[10:].reshape(count, 3, -1),
    )  # fmt: skip


def _differences(finder, bodies, steps):
    """Return the derivatives of the values of `finder` by all poses, (values, 6 B)."""
    columns = []
    for k, step in enumerate(steps):
        total = 0.0
        for at, weight in ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12)):
            change = np.zeros(len(steps))
            change[k] = at * step
            value = finder(bodies, change)
            if value is None:
                return None
            total = total + weight / step * value
        columns.append(total)
    return np.stack(columns, axis=1)


class _Finder:
    """The nearest point of a contact for changed poses: gap, axes and arms in one array."""

    def __init__(self, system, row):
        from carom.collision.layout import new_pair_work, new_points

        self.system, self.row = system, row
        self.work, self.out = new_pair_work(), new_points()
        self.poses = [(np.zeros(3), np.zeros(4)) for _ in range(2)]

    def __call__(self, bodies: list[Moving], change: np.ndarray):
        from carom.collision.frame import place
        from carom.collision.layout import Placed, Plane
        from carom.collision.plane import touch_plane
        from carom.collision.touch import touch

        row, system = self.row, self.system
        solids = (system.solids[row.solid], system.solids[row.other_solid])
        centres = []
        for k, body in enumerate(bodies):
            d = change[6 * k : 6 * k + 6]
            x = body.x + d[:3]
            Q = quaternion.from_matrix(quaternion.matrix(quaternion.exp(d[3:])) @ body.R)
            place(solids[k], x, Q, *self.poses[k])
            centres.append(x)
        a, b = (Placed(solid, *pose) for solid, pose in zip(solids, self.poses))
        if len(bodies) == 1:
            plane = Plane(np.ascontiguousarray(row.axes[0]), float(row.offset))
            count = touch_plane(a, plane, system.hulls, 0.0, self.work, self.out)
        else:
            count = touch(a, b, system.hulls, 0.0, self.work, self.out)
        if count < 1:
            return None
        best = self.out[int(np.argmin(self.out["gap"][:count]))]
        axes = row.axes if len(bodies) == 1 else pair_axes(best.normal)
        arms = [best.on_a - centres[0]]
        if len(bodies) == 2:
            arms.append(best.on_b - centres[1])
        return np.concatenate([[best.gap], axes.ravel(), *arms])
