"""One contact, exactly: the resolver of `carom.impact.resolve`, compiled on its own."""

from __future__ import annotations

from carom._compiled.choice import by_address
from carom._compiled.decorators import unit
from carom.impact.resolve import resolve_one


@unit
def single_unit(clock, W, u, mu, e, law, out):
    """Resolve one impact into `out`; its code goes to the clock."""
    clock[0].code = resolve_one(W, u, mu, e, law, out)


#: resolve_single(address, clock, W, u, mu, e, law, out)
resolve_single = by_address(single_unit)
