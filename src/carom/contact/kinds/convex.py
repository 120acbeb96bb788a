"""Two convex solids, moving or static: the common form of most operations is theirs."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.layout import BOX, HULL
from carom.contact.kinds import parting
from carom.contact.kinds.found_points import list_on_solid, nearest_touch

beside_face, stays_beside_face = parting.beside_face, parting.stays_beside_face


@kernel
def are_sharp(system, contact):
    """Return whether two solids are polyhedra whose edges are not rounded."""
    a, b = system.solids[contact.solid], system.solids[contact.other_solid]
    flat = (a.kind == BOX or a.kind == HULL) and (b.kind == BOX or b.kind == HULL)
    return flat and a.radius == 0.0 and b.radius == 0.0


@kernel
def distance(system, contact, state, work):
    """Return the gap of two convex solids."""
    list_on_solid(system, contact, contact.other_solid, state, 0.0, work)
    return nearest_touch(work).gap
