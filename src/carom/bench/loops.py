"""Compiled loops over many impacts, so that the cost of calls from Python is not measured."""

from __future__ import annotations

from carom._compiled.decorators import entry
from carom.impact.resolve import resolve


@entry
def resolve_many(W, u, mu, e, law, out):
    """Resolve each impact; return the number of failures."""
    failed = 0
    for i in range(u.shape[0]):
        if resolve(W[i], u[i], mu, e, law, out) != 0:
            failed += 1
    return failed
