"""The normal law of a contact in the layer: continuous, hysteretic, energetic (mathematics page, §2.2).

Of the depth d = -s in the logarithmic coordinate, with the memory (d0, dm), erased at opening:

    open    N = 0                       until d > d0, the depth at the last opening
    load    N = kappa (d - d0)^p        until u_n > 0; then dm = d - d0
    unload  N = kappa dm^p ((d - d0 - (1 - e^2) dm) / (e^2 dm))^p      until N = 0, or d - d0 > dm

The work that is returned is e^2 times the work of loading for every p, whatever friction does: Stronge's
law. N is continuous everywhere, unlike the constant forces of one contact (law A), which are void for
a contact that touches at rest.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

OPEN, LOAD, UNLOAD = 0, 1, 2

E_MIN = 0.01  # unloading is 1/e^2 stiffer: smaller e are taken as this one


@kernel
def force(c, d, p):
    """Return N of the contact `c` at depth `d`."""
    if c.mode == OPEN:
        return 0.0
    x = c.slope * (d - c.rest)
    if not x > 0.0:
        return 0.0
    return x if p == 1.0 else x**p


@kernel
def close(c):
    """Begin to load: from the depth at the last opening."""
    c.mode = LOAD
    c.slope, c.rest = c.root, c.d0


@kernel
def unload(c, d, p_n):
    """Begin to unload at depth `d`, normal impulse `p_n` so far."""
    c.mode = UNLOAD
    c.most = d - c.d0
    c.rest = c.d0 + (1.0 - c.e * c.e) * c.most
    c.slope = c.root / (c.e * c.e)
    c.loading += p_n - c.mark
    c.mark = p_n


@kernel
def load_again(c, p_n):
    """Go on with loading, on the same curve."""
    c.mode = LOAD
    c.slope, c.rest = c.root, c.d0
    c.unloading += p_n - c.mark
    c.mark = p_n


@kernel
def release(c, d, p_n, p):
    """Open at depth `d`; the blow is over, and its works are written down."""
    if c.mode == UNLOAD:
        c.unloading += p_n - c.mark
        work = (c.root * c.most) ** p * c.most / (p + 1.0)
        c.absorbed += work
        c.returned += c.e * c.e * work
    else:
        c.loading += p_n - c.mark
    c.mark = p_n
    c.mode = OPEN
    c.d0 = d
    c.slope = 0.0


@kernel
def abandon(c, d, p):
    """Write down the works of a blow that is broken off at depth `d`; what is stored is lost."""
    if c.mode == OPEN:
        return
    depth = d - c.d0 if c.mode == LOAD else c.most
    if depth > 0.0:
        work = (c.root * depth) ** p * depth / (p + 1.0)
        c.absorbed += work
        if c.mode == UNLOAD:
            left = max(0.0, d - c.rest)
            c.returned += max(0.0, c.e * c.e * work - (c.slope * left) ** p * left / (p + 1.0))
    c.mode = OPEN
    c.d0 = d
    c.slope = 0.0
