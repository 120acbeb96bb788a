"""Scratch of impacts at a corner, with the addresses of what is compiled on its own."""

from __future__ import annotations

from carom.coulomb.search import with_address
from carom.impact.corner.adaptive import layer_unit
from carom.impact.corner.discs import discs_unit
from carom.impact.corner.fixed import fixed_unit
from carom.impact.corner.implicit import step_unit
from carom.impact.corner.layout import CornerScratch, CornerUnits, corner_arrays
from carom.impact.corner.one import single_unit
from carom.impact.corner.plastic import plastic_unit
from carom.jit import address


def new_corner_work(capacity: int) -> CornerScratch:
    """Return scratch for up to `capacity` contacts; compiles what is not on disk."""
    return with_units(corner_arrays(capacity))


def with_units(scratch: CornerScratch) -> CornerScratch:
    """Return the scratch with the addresses of what is compiled on its own."""
    work, none = scratch.work, CornerUnits(0, 0, 0, 0, 0, 0)
    v, matrix, cones = work.vector, work.matrix, with_address(scratch.cones)
    units = CornerUnits(
        discs=address(discs_unit, 1, matrix[0], matrix[0], v, work.index, 0.0),
        step=address(step_unit, 1, 1, work, none, 0.0, 0.0, 0.0),
        layer=address(layer_unit, 1, work, none, 0.0, 0.0, 1, 1),
        fixed=address(fixed_unit, 1, work, none, 1, 0.0, 1, 1),
        plastic=address(plastic_unit, 1, work, cones, 0.0),
        single=address(single_unit, work.clock, matrix[0], v[0], 0.0, 0.0, 0, v[0]),
    )
    return CornerScratch(work, cones, units)
