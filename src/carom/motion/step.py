"""One step of the free phase by the chosen method."""

from __future__ import annotations

from numba.core import types
from numba.extending import overload

from carom.jit import OPTIONS
from carom.motion.explicit import Explicit, explicit_step
from carom.motion.three_field import ThreeField, three_field_step

_STEPS = {Explicit: explicit_step, ThreeField: three_field_step}


def step(system, method, held, start, h, end, work):
    """Write the state a time h after `start` into `end`.

    Returns the work of loads without potential, the work of friction in held contacts, and 0 or the
    number of a `Status`. Compiled code takes the method from its type.
    """
    return _STEPS[type(method)](system, method, held, start, h, end, work)


@overload(step, **OPTIONS)
def _step(system, method, held, start, h, end, work):
    if not isinstance(method, types.BaseNamedTuple):
        return None
    chosen = _STEPS[method.instance_class]
    return lambda system, method, held, start, h, end, work: chosen(
        system, method, held, start, h, end, work
    )
