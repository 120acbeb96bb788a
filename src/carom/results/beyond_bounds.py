"""A sentence about contacts on a `Surface` outside the bounds in which its function is checked and drawn."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.results.names import contact_name
from carom.scene.user_surface import Surface
from carom.status import Advice

BEYOND = 1e-9  # of the size of the bounds: what is less far outside is round-off


def beyond_bounds(run, impact, touch, times: np.ndarray) -> tuple[str, ...]:
    """Return a sentence for each surface with impacts, or contacts at saved times, outside its bounds."""
    scene, pairs, said = run.scene, run.pairs, []
    for number, solid in enumerate(scene.statics, len(scene.half_spaces)):
        if not isinstance(solid.shape, Surface):
            continue
        own = np.flatnonzero(pairs.plane == number)
        time = np.concatenate([impact["time"], times[touch["saved"]]])
        contact = np.concatenate([impact["contact"], touch["contact"]])
        point = np.concatenate([impact["point"], touch["point"]])
        here = np.isin(contact, own)
        at = quaternion.rotate_back(solid.orientation, point[here] - solid.position)
        (low, high), spare = solid.shape.bounds, BEYOND * solid.shape.size
        out = np.flatnonzero(here)[np.any((at < low - spare) | (at > high + spare), axis=1)]
        if len(out):
            first = out[np.argmin(time[out])]
            said.append(
                f"Contact {contact_name(scene, pairs, int(contact[first]))!r} is outside the bounds of the "
                f"surface {solid.name!r} at t = {time[first]:.6g} s: the surface goes on there as its function "
                "does, but was not checked, and is not drawn. Give larger bounds."
            )
    return tuple(map(Advice, said))
