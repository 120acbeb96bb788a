"""One contact, exactly: the solver of `carom.impact.resolve`, compiled separately."""

from __future__ import annotations

from carom._compiled.units import unit
from carom.impact.resolve import resolve_one


@unit
def resolve_single(clock, W, u, mu, e, law, out):
    """Resolve one impact into `out`; the clock gets its code."""
    clock[0].code = resolve_one(W, u, mu, e, law, out)
