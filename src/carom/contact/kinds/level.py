"""A solid on a row of a level surface: a half-space whose points count where faces are below them.

Past its rim a point goes on with the solid that it has left. (Rules: `level_surfaces`.)
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.layout import PROFILE
from carom.contact.continuous_detection import CLEAR
from carom.contact.kinds import plane
from carom.contact.kinds.drift import drift_of_solids
from carom.contact.kinds.found_points import list_on_solid, which_touch
from carom.contact.kinds.level_surfaces import solid_beyond, solid_left
from carom.contact.kinds.partner import smaller
from carom.contact.kinds.plane import roll_on_plane
from carom.contact.kinds.profile_drift import drift_of_profile
from carom.contact.thresholds import ACTIVE_REACH

room, stays_far, list_touches = plane.room, plane.stays_far, plane.list_touches
way_past, curvatures = plane.way_past, plane.curvatures


@kernel
def touch_of_active(system, contact, feature, p, state, work):
    """Write the points of a contact; return the one that has a feature, or that replaces it.

    Past the rim of the surface that is one of the solid that has been left.
    """
    reach = ACTIVE_REACH * smaller(contact)
    list_touches(system, contact, state, reach, work)
    i = which_touch(system, contact, feature, p, state, work)
    solid = solid_left(system, contact, work.touches[i].on_b)
    if solid < 0:
        return i
    list_on_solid(system, contact, solid, state, reach, work)
    return which_touch(system, contact, feature, p, state, work)


@kernel
def passage_hidden(system, data, contact, bounds):
    """Return that the path is clear: the rows of the solids decide where no face is below."""
    return CLEAR, data.work.search[0].dt


@kernel
def drift(system, contact, feature, point, state, work):
    """Return (d/dt G) v of a point of the surface, or of the solid that it has left."""
    solid = solid_beyond(system, contact, point, state)
    profile = system.solids[contact.solid].kind == PROFILE
    if profile or (solid >= 0 and system.solids[solid].kind == PROFILE):
        return drift_of_profile(system, contact, solid, point, state)
    if solid < 0:
        return roll_on_plane(system, contact, feature, point, state)
    return drift_of_solids(system, contact, solid, point, state)
