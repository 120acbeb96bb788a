"""Scratch of impacts at a corner, with the addresses of what is compiled on its own."""

from __future__ import annotations

import numpy as np

from carom.coulomb.layout import new_cone_work
from carom.impact import layout as one
from carom.impact.corner.adaptive import layer_unit
from carom.impact.corner.discs import discs_unit
from carom.impact.corner.fixed import fixed_unit
from carom.impact.corner.implicit import step_unit
from carom.impact.corner.layout import (
    CLOCK,
    CONTACT,
    ORDERS,
    CornerScratch,
    CornerUnits,
    CornerWork,
)
from carom.impact.corner.one import single_unit
from carom.impact.corner.plastic import plastic_unit
from carom.jit import address
from carom.system.arrays import table


def new_corner_work(capacity: int) -> CornerScratch:
    """Return scratch for up to `capacity` contacts."""
    k = max(int(capacity), 1)
    n = 3 * k
    work = CornerWork(
        contact=table(CONTACT, k),
        saved=table(CONTACT, k),
        clock=table(CLOCK, 1),
        index=np.zeros((9, n), dtype=np.int64),
        matrix=np.zeros((9, n, n)),
        vector=np.zeros((33, n)),
        series=np.zeros((13, ORDERS, n)),
        single=np.zeros(one.SIZE),
    )
    cones = new_cone_work(k)
    v, matrix = work.vector, work.matrix
    units = CornerUnits(
        discs=address(discs_unit, 1, matrix[0], matrix[0], v, work.index, 0.0),
        step=address(step_unit, 1, 1, work, CornerUnits(0, 0, 0, 0, 0, 0), 0.0, 0.0, 0.0),
        layer=address(layer_unit, 1, work, CornerUnits(0, 0, 0, 0, 0, 0), 0.0, 0.0, 1, 1),
        fixed=address(fixed_unit, 1, work, CornerUnits(0, 0, 0, 0, 0, 0), 1, 0.0, 1, 1),
        plastic=address(plastic_unit, 1, work, cones, 0.0),
        single=address(single_unit, work.clock, matrix[0], v[0], 0.0, 0.0, 0, v[0]),
    )
    return CornerScratch(work, cones, units)
