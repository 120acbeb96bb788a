"""Compiled loops over many impacts, so that the cost of calls from Python is not measured."""

from __future__ import annotations

from carom._compiled.decorators import entry
from carom.impact.layer import traverse
from carom.impact.resolve import resolve


@entry
def resolve_many(W, u, mu, e, law, out):
    """Resolve each impact; return the number of failures."""
    failed = 0
    for i in range(u.shape[0]):
        if resolve(W[i], u[i], mu, e, law, out) != 0:
            failed += 1
    return failed


@entry
def traverse_many(W, u, mu, e, law, history, out):
    """Pass each impact through the layer; return the number of failures."""
    failed = 0
    for i in range(u.shape[0]):
        if traverse(W[i], u[i], mu, e, law, (1e-6, 0.2, 2), history, out) != 0:
            failed += 1
    return failed
