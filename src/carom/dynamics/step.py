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
def step(model, data, method, h):
    """Write the state a time h later into `work.trial`.

    Return the work of loads without potential, and 0 or the number of a `Status`.
    """
    if method.kind == RUNGE_KUTTA:
        return explicit_step(model, data, method, h)
    return other_step(model, data, method, h)


@unit
def other_step(model, data, method, h) -> tuple[float, int]:
    """Write the state a time h later by a method that is not explicit; return what `step` does."""
    if method.kind == RATTLE:
        return rattle_step(model, data, method, h)
    if method.kind == IMPLICIT:
        return implicit_step(model, data, method, h)
    return three_field_step(model, data, method, h)
