"""One step of the free phase by the chosen method."""

from __future__ import annotations

from carom._compiled.decorators import inlined
from carom._compiled.units import unit
from carom.dynamics.explicit import explicit_step
from carom.dynamics.implicit import implicit_step
from carom.dynamics.rattle import rattle_step
from carom.dynamics.three_field import three_field_step
from carom.model.method import IMPLICIT, RATTLE, RUNGE_KUTTA


@inlined
def step(method, system, active, start, h, end, work):
    """Write the state a time h after `start` into `end`.

    Return the work of loads without potential, and 0 or the number of a `Status`.
    """
    if method.kind == RUNGE_KUTTA:
        return explicit_step(method, system, active, start, h, end, work)
    return other_step(method, system, active, start, h, end, work)


@unit
def other_step(method, system, active, start, h, end, work) -> tuple[float, int]:
    """Write the state at the end of a step by a method that is not explicit."""
    if method.kind == RATTLE:
        return rattle_step(method, system, active, start, h, end, work)
    if method.kind == IMPLICIT:
        return implicit_step(method, system, active, start, h, end, work)
    return three_field_step(method, system, active, start, h, end, work)
