"""The kinds of contacts by number, and what the sizes of workspaces, islands and reports depend on.

The files of these names in `carom.contact.kinds` have what differs between them. Only those files, `model` and
`scene` ask a contact for its kind (a test).
"""

from __future__ import annotations

import numpy as np

from carom.collision import layout
from carom.collision.layout import MOST_POINTS

#: files of `carom.contact.kinds`, and whether their points are found anew in each state; a new kind comes last
KINDS = {
    "vertices": False, "plane": True, "level": True, "convex": True, "profile": True, "ground": True,
    "stop": False,
}  # fmt: skip
OF_VERTICES, ON_PLANE, ON_LEVEL, OF_CONVEX, WITH_PROFILE, ON_GROUND, OF_JOINT = range(len(KINDS))
FOUND = tuple(number for number, found in enumerate(KINDS.values()) if found)


def write_kinds(rows: np.recarray, solids: np.recarray) -> None:
    """Write the kind of each contact of bodies; `curved` rows have no vertices on their half-space."""
    plane = (rows["other"] < 0) & (rows["static"] == 0)
    vertices = plane & (rows["last"] > rows["first"])
    rows["kind"] = np.where(vertices, OF_VERTICES, np.where(plane, ON_PLANE, OF_CONVEX))
    if plane.all():
        return
    two = ~plane
    first, second = (solids["kind"][rows[name][two]] for name in ("solid", "other_solid"))
    kind = np.full(len(first), OF_CONVEX)
    kind[(first == layout.PROFILE) | (second == layout.PROFILE)] = WITH_PROFILE
    kind[second == layout.CURVED_GROUND] = ON_GROUND
    rows["kind"][two] = kind


def is_of_joint(contacts) -> np.ndarray:
    """Return which contacts are stops of joints, or rails."""
    return contacts["kind"] == OF_JOINT


def has_vertices(contacts) -> np.ndarray:
    """Return which contacts have their points at vertices of a body, where they stay."""
    return contacts["kind"] == OF_VERTICES


def is_found(contacts) -> np.ndarray:
    """Return which contacts have points that are found anew in each state."""
    return np.isin(contacts["kind"], FOUND)


def most_points(contacts) -> np.ndarray:
    """Return the greatest number of points of each contact."""
    return np.where(is_found(contacts), MOST_POINTS, contacts["last"] - contacts["first"])
