"""A surface phi(x, y, z) = 0 of a function of the user's."""

from __future__ import annotations

import math

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel


@kernel
def field_at(surface, hulls, p):
    """Return phi, its gradient (3) and its Hessian (6) at a point."""
    numbers, k = hulls.numbers, surface.first
    x, out = numbers[k : k + 3], numbers[k + 3 : surface.last]
    x[0], x[1], x[2] = p
    call_function(surface.address, math.inf, x, out)
    return out[0], (out[1], out[2], out[3]), (out[4], out[8], out[12], out[5], out[6], out[9])
