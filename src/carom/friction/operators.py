"""The operations of the solver on the Delassus operator W, which is stored in one of two forms.

DENSE: W itself (`dense`). BY_BODIES: bodies and rows without W (`island`). Variables are scaled; there are k
contacts.
"""

from __future__ import annotations

from carom._compiled.decorators import inlined
from carom.friction import dense, island
from carom.friction.layout import DENSE


@inlined
def multiply(work, k, x, out):
    """Add W x to `out`."""
    if work.kind == DENSE:
        dense.add_product(3 * k, work.W, x, out)
    else:
        island.multiply(work, k, x, out)


@inlined
def magnitude(work, k):
    """Return the greatest (|W| |p|)_i, in units of velocity (scaled only by gamma)."""
    if work.kind == DENSE:
        return dense.magnitude(work, k)
    return island.magnitude(work, k)


@inlined
def sweep(work, k, backward):
    """Solve each contact in turn, exactly, with fixed impulses of the others."""
    if work.kind == DENSE:
        dense.sweep(work, k, backward)
    else:
        island.sweep(work, k, backward)


@inlined
def factor(work, k, eps):
    """Factor I - D + D (W + eps) at p, w; D is the slope of the projection."""
    if work.kind == DENSE:
        dense.factor_newton(work, k, eps)
    else:
        island.factor_newton(work, k, eps)


@inlined
def solve(work, k):
    """Write the step, with the present factors."""
    if work.kind == DENSE:
        dense.solve_newton(work, k)
    else:
        island.solve_newton(work, k)
