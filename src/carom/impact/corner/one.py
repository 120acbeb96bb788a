"""One contact, exactly: the resolver of `carom.impact.resolve`, compiled on its own."""

from __future__ import annotations

from carom.dispatch import by_address
from carom.impact import layout as o
from carom.impact.resolve import resolve_one
from carom.jit import unit

_WEDGED = 1e3  # u_n of the normal impulse alone, over the velocities before: beyond, W is singular in stick


@unit
def single_unit(clock, W, u, mu, e, law, out):
    """Resolve one impact into `out`; its code goes to the clock.

    A contact that sticks may have no freedom left to part (W of rank 2): its impulse would grow to 1/round-off.
    """
    code = resolve_one(W, u, mu, e, law, out)
    size = abs(u[0]) + abs(u[1]) + abs(u[2])
    if code == o.OK and not out[o.IMPULSE] * W[0, 0] <= _WEDGED * size:
        code = o.NO_END
    clock[0].code = code


#: resolve_single(address, clock, W, u, mu, e, law, out)
resolve_single = by_address(single_unit)
