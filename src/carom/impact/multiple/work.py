"""Scratch of impacts at a corner, with the addresses of what is compiled on its own."""

from __future__ import annotations

from carom._compiled.decorators import address
from carom.friction.strategy import with_address
from carom.impact.multiple.adaptive import layer_unit
from carom.impact.multiple.at_once import at_once_unit
from carom.impact.multiple.by_stages import stages_unit
from carom.impact.multiple.discs import discs_unit
from carom.impact.multiple.fixed import fixed_unit
from carom.impact.multiple.grip import holding_unit
from carom.impact.multiple.implicit import step_unit
from carom.impact.multiple.layout import (
    MISSING,
    NO_UNITS,
    CornerScratch,
    corner_arrays,
    new_corner_result,
)
from carom.impact.multiple.one import single_unit
from carom.impact.multiple.plastic import plastic_unit


def new_corner_work(capacity: int) -> CornerScratch:
    """Return scratch for up to `capacity` contacts; compiles what is not on disk."""
    return with_all_units(with_units(corner_arrays(capacity)))


_WANTED = False  # in this process, what is rarely needed


def with_units(scratch: CornerScratch, find=address) -> CornerScratch:
    """Return the scratch with the addresses of what is compiled on its own.

    What is rarely needed comes where `scratch` has the others already: it takes as long to compile as these.
    """
    global _WANTED
    _WANTED = _WANTED or scratch.units.layer != MISSING
    work = scratch.work
    units = NO_UNITS._replace(
        layer=find(layer_unit, 1, work, NO_UNITS, 0.0, 0.0, 1, 1),
        single=find(
            single_unit, work.clock, work.matrix[0], work.vector[0], 0.0, 0.0, 0, work.vector[0]
        ),
    )
    scratch = scratch._replace(units=units)
    return with_all_units(scratch, find) if _WANTED else scratch


def with_all_units(scratch: CornerScratch, find=address) -> CornerScratch:
    """Return the scratch with the addresses of all."""
    work, none = scratch.work, NO_UNITS
    v, matrix, cones = work.vector, work.matrix, with_address(scratch.cones, find)
    scratch = scratch._replace(cones=cones)
    out = new_corner_result(1)
    units = scratch.units._replace(
        discs=find(discs_unit, 1, matrix[0], matrix[0], v, work.index, 0.0),
        step=find(step_unit, 1, 1, work, none, 0.0, 0.0, 0.0),
        stages=find(stages_unit, 1, work, none, 0.0, 0.0),
        hold=find(holding_unit, 1, work),
        fixed=find(fixed_unit, 1, work, none, 1, 0.0, 1, 1),
        plastic=find(plastic_unit, 1, work, cones, 0.0),
        at_once=find(at_once_unit, 1, v[0], v[0], v[0], scratch, out),
    )
    return scratch._replace(units=units)
