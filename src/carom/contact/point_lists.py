"""Rows of a list of contact points: which contact and feature, and where on the body."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.model.workspace import MOTION_POINT


@kernel
def write_closed(c, feature, p, parent, closed_point):
    """Write an entry that is not known to be active; the force of entry `parent` bounds its friction."""
    closed_point.contact, closed_point.feature, closed_point.active = c, feature, -1
    closed_point.motion, closed_point.parent = MOTION_POINT, parent
    for k in range(3):
        closed_point.point[k] = p[k]


@kernel
def write_turning(i, motion, point, closed_point):
    """Write the rolling (`MOTION_ROLL`) or pivoting friction of point i of a list."""
    write_closed(point.contact, point.feature, point.point, i, closed_point)
    closed_point.motion, closed_point.active = motion, point.active


@kernel
def mark(active, active_point, carries):
    """Note whether a vertex carries; the other kinds of points are known by contact and feature."""
    if active_point.fixed == 1:
        active.carries[active_point.feature] = carries


@kernel
def is_active(active, c):
    """Return whether a contact has active points."""
    for i in range(active.count[0]):
        if active.points[i].contact == c:
            return True
    return False
