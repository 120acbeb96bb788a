"""A sentence about strands of ropes that leave the plane of their pulley, in which they are taken."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.model.switched import rows_with
from carom.scene.coordinates import Strand, terms_of

TIPPED = 0.02  # of the length: so far from the plane a strand is .0002 longer than it is taken


def tipped_strands(run, states: np.ndarray, times: np.ndarray) -> tuple[str, ...]:
    """Return a sentence about the strand that is tipped most at saved times, if it is by too much."""
    along = [(stop, stop.joint) for stop in run.scene.stops]
    along += [(one, getattr(one.definition, "joint", None)) for one in run.scene.forces]
    parts = [(part, one) for one, joint in along for part, _, _ in terms_of(joint, 0)]
    compiled, most, when = run.everything, 0.0, 0.0
    for strand, rope in parts:
        if not isinstance(strand, Strand) or not strand.axis.any():
            continue
        row = compiled.system.relations.coordinates[compiled.numbers[strand.index, 0]]
        d = _end(row.child, row.child_anchor, states) - _end(row.parent, row.parent_anchor, states)
        away = np.abs(d @ strand.axis) / np.linalg.norm(d, axis=-1)
        away = away * rows_with(run, rope, len(states))
        if away.max() > most:
            most, when = float(away.max()), float(times[np.argmax(away)])
    if not most > TIPPED:
        return ()
    return (
        f"A strand of a rope is {most:.2g} of its length out of the plane of its pulley, most at "
        f"t = {when:.6g} s. It is taken in this plane, so nothing brings it back, and it counts as shorter "
        "than it is. Guide what hangs on it in the plane (carom.joints.Planar), or lead the rope through a "
        "point.",
    )


def _end(body: int, anchor: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return the place (T, 3) of a point of a body, or of the ground (-1)."""
    if body < 0:
        return np.broadcast_to(anchor, (len(states), 3))
    return states["x"][:, body] + quaternion.rotate(states["Q"][:, body], anchor)
