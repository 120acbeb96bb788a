"""Curves of joints as arrays, in axes of their bodies."""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import table
from carom.model.arrays import CURVE, CURVE_PIECE, KIND, POINT_ON_CURVE
from carom.model.placement import Placement


class Curves:
    """The curves of a scene, one for each coordinate along a curve."""

    def __init__(self):
        self.rows: list[np.recarray] = []
        self.pieces: list[np.recarray] = []

    def add(self, joint, placement: Placement, row) -> None:
        """Add the curve of a joint, and write its coordinate: 0 at the foot of the anchor of the definition."""
        definition, anchor = joint.definition, joint.anchor()
        curve = definition.curve
        parent, child = (placement.side(joint, k) for k in range(2))
        row.kind, row.number = KIND[type(definition)], len(self.rows)
        row.parent, row.child = parent.body.index, child.body.index
        row.parent_anchor[:], row.child_anchor[:] = parent.point(anchor), child.point(anchor)
        owner = parent if row.kind == POINT_ON_CURVE else child
        count, start = len(curve.knots) - 1, definition.foot(anchor)
        pieces, one = table(CURVE_PIECE, count), table(CURVE, 1)
        one.first = sum(map(len, self.pieces))
        one.last = one.first + count
        one.low, one.high = -start, curve.length - start
        one.period, one.sharpest = curve.length if curve.closed else 0.0, curve.sharpest
        turn, origin = owner.axes(np.eye(3)), owner.point(np.zeros(3))
        pieces["start"] = curve.knots[:-1] - start
        pieces["c"] = np.moveaxis(curve.coefficients, 0, 1) @ turn.T
        pieces["c"][:, 0] += origin
        if joint.can_be_left:
            across, free = definition.across(anchor), definition.free(anchor, start)
            pieces["normal"] = owner.axes(across[:, None])[:, 0]
            one.side[0] = owner.axes((free if across.any() else definition.side)[:, None])[:, 0]
            if not across.any():
                slope = np.linalg.norm(definition.shadow.ends[:, 1], axis=1)
                one.sharpest = curve.sharpest / np.min(slope) ** 2
        else:
            pieces["normal"] = curve.normals @ turn.T
        self.rows.append(one)
        self.pieces.append(pieces)
