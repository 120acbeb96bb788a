"""Series of four contacts at a time: four coefficients of one order are adjacent, for SIMD instructions.

Contact i is lane i % 4 of block i // 4. Lanes without a contact are zero. An array of a series has the shape
(ORDERS, B, 4); `line` is the distance from one order to the next, and `p` the start of a block in its order.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.simd import LANES, add, load, multiply, same


@kernel
def blocks(k):
    """Return the number of blocks of `k` contacts."""
    return (k + LANES - 1) // LANES


@kernel
def product(line, x, y, p, n):
    """Return the sums over j = 1 .. n of x_j y_(n-j), for the block at `p`."""
    s = same(0.0)
    i, j = p + line, p + (n - 1) * line
    for _ in range(n):
        s = add(s, multiply(load(x, i), load(y, j)))
        i += line
        j -= line
    return s


@kernel
def values(line, x, p, degree, h):
    """Return the values at `h` of the four polynomials of a block."""
    f, i = same(h), p + degree * line
    s = load(x, i)
    for _ in range(degree):
        i -= line
        s = add(multiply(s, f), load(x, i))
    return s


@kernel
def value_and_slope(x, i, degree, h):
    """Return the value at `h` of the polynomial of contact `i`, and its derivative."""
    b, l = i // LANES, i % LANES
    s, slope = x[degree, b, l], 0.0
    for j in range(degree - 1, -1, -1):
        slope = slope * h + s
        s = s * h + x[j, b, l]
    return s, slope
