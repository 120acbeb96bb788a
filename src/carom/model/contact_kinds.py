"""The kinds of contacts by number, and what the sizes of workspaces, islands and reports depend on.

The files of these names in `carom.contact.kinds` have what differs between them. Only those files, `model` and
`scene` ask a contact for its kind (a test).
"""

from __future__ import annotations

import numpy as np

from carom.collision import layout
from carom.collision.layout import MOST_POINTS

#: files of `carom.contact.kinds`; a new kind comes last
KINDS = ("vertices", "plane", "level", "convex", "profile", "ground", "stop")
VERTICES, PLANE, LEVEL, CONVEX, PROFILE, GROUND, STOP = range(len(KINDS))
#: kinds whose points are found anew in each state; those of the others are known
FOUND = (PLANE, LEVEL, CONVEX, PROFILE, GROUND)


def write_kinds(rows: np.recarray, solids: np.recarray) -> None:
    """Write the kind of each contact of bodies; `curved` rows have no vertices on their half-space."""
    plane = (rows["other"] < 0) & (rows["static"] == 0)
    vertices = plane & (rows["last"] > rows["first"])
    rows["kind"] = np.where(vertices, VERTICES, np.where(plane, PLANE, CONVEX))
    if plane.all():
        return
    two = ~plane
    first, second = (solids["kind"][rows[name][two]] for name in ("solid", "other_solid"))
    kind = np.full(len(first), CONVEX)
    kind[(first == layout.PROFILE) | (second == layout.PROFILE)] = PROFILE
    kind[second == layout.CURVED_GROUND] = GROUND
    rows["kind"][two] = kind


def is_of_joint(contacts) -> np.ndarray:
    """Return which contacts are stops of joints, or rails."""
    return contacts["kind"] == STOP


def has_vertices(contacts) -> np.ndarray:
    """Return which contacts have their points at vertices of a body, where they stay."""
    return contacts["kind"] == VERTICES


def is_found(contacts) -> np.ndarray:
    """Return which contacts have points that are found anew in each state."""
    return np.isin(contacts["kind"], FOUND)


def most_points(contacts) -> np.ndarray:
    """Return the greatest number of points of each contact."""
    return np.where(is_found(contacts), MOST_POINTS, contacts["last"] - contacts["first"])
