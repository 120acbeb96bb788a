"""One step of the free phase by the chosen method."""

from __future__ import annotations

from carom._compiled.choice import by_method
from carom.dynamics.explicit import Explicit, explicit_step
from carom.dynamics.implicit import Implicit, implicit_step
from carom.dynamics.rattle import Rattle, rattle_step
from carom.dynamics.three_field import ThreeField, three_field_step

#: step(method, system, held, start, h, end, work): write the state a time h after `start` into `end`; return
#: the work of loads without potential, the work of friction in held contacts, and 0 or the number of a
#: `Status`.
step = by_method(
    {
        Explicit: explicit_step,
        Rattle: rattle_step,
        ThreeField: three_field_step,
        Implicit: implicit_step,
    }
)
