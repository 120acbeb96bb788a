"""The normal law of a contact in the layer: continuous, hysteretic, energetic (mathematics page, §2.2).

N depends on the depth d = -s in the logarithmic coordinate and on a memory (d0, dm), which opening resets:

    open    N = 0                       until d > d0, the depth at the last opening
    load    N = kappa (d - d0)^p        until u_n > 0; then dm = d - d0
    unload  N = kappa dm^p ((d - d0 - (1 - e^2) dm) / (e^2 dm))^p      until N = 0, or d - d0 > dm

The work returned is e^2 times the work of loading for every p and any friction, which is Stronge's law. N is
continuous everywhere. The constant forces of a single contact (law A) are not, and do not exist for a contact
that touches at rest.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

OPEN, LOAD, UNLOAD = 0, 1, 2

E_MIN = 0.01  # replaces smaller e, because unloading is 1/e^2 stiffer than loading


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
    """Begin to load, from the depth at the last opening."""
    c.mode = LOAD
    c.slope, c.rest = c.root, c.d0


@kernel
def unload(c, d, p_n):
    """Begin to unload at depth `d`; `p_n` is the normal impulse so far."""
    c.mode = UNLOAD
    c.most = d - c.d0
    c.rest = c.d0 + (1.0 - c.e * c.e) * c.most
    c.slope = c.root / (c.e * c.e)
    c.loading += p_n - c.mark
    c.mark = p_n


@kernel
def load_again(c, p_n):
    """Load again, on the same curve as before."""
    c.mode = LOAD
    c.slope, c.rest = c.root, c.d0
    c.unloading += p_n - c.mark
    c.mark = p_n


@kernel
def release(c, d, p_n, p):
    """Open at depth `d`: the impact of this contact ends, and its works are added."""
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
    """Open a contact before the end of its impact, at depth `d`: add its works; stored energy is lost."""
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
