"""A sentence about strands of ropes that leave the plane of their pulley, in which they are taken."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.model.switched import rows_with
from carom.scene.coordinates import BodyTurn, Strand, terms_of

TIPPED = 0.02  # of the length: so far from the plane a strand is .0002 longer than it is taken


def tipped_strands(run, states: np.ndarray, times: np.ndarray) -> tuple[str, ...]:
    """Return a sentence about the strand that is tipped most at saved times, if it is by too much."""
    along = [(stop, stop.joint) for stop in run.scene.stops]
    along += [(one, getattr(one.definition, "joint", None)) for one in run.scene.forces]
    parts = [(part, one) for one, joint in along for part, _, _ in terms_of(joint, 0)]
    compiled, most, when = run.everything, 0.0, 0.0
    for strand, rope in parts:
        if isinstance(strand, BodyTurn):
            row = compiled.system.relations.coordinates[compiled.numbers[strand.index, 0]]
            axis = quaternion.rotate(states["Q"][:, row.child], row.child_frame[:, 0])
            away = np.linalg.norm(np.cross(axis, strand.axis), axis=-1)
        elif isinstance(strand, Strand) and strand.axis.any():
            row = compiled.system.relations.coordinates[compiled.numbers[strand.index, 0]]
            ends = (row.child, row.child_anchor), (row.parent, row.parent_anchor)
            d = _end(*ends[0], states) - _end(*ends[1], states)
            away = np.abs(d @ strand.axis) / np.linalg.norm(d, axis=-1)
        else:
            continue
        away = away * rows_with(run, rope, len(states))
        if away.max() > most:
            most, when = float(away.max()), float(times[np.argmax(away)])
    if not most > TIPPED:
        return ()
    return (
        f"A strand of a rope, or a wheel that it turns, leans {most:.2g} rad out of the plane of its pulley, "
        f"most at t = {when:.6g} s. It is taken in this plane, so nothing brings it back, and it counts as "
        "shorter than it is. Guide what hangs on it in the plane (carom.joints.Planar), or lead the rope "
        "through a point.",
    )


def _end(body: int, anchor: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return the place (T, 3) of a point of a body, or of the ground (-1)."""
    if body < 0:
        return np.broadcast_to(anchor, (len(states), 3))
    return states["x"][:, body] + quaternion.rotate(states["Q"][:, body], anchor)
