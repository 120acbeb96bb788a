"""The inside of a tube of radius size[1], bent to a ring of radius size[0] about z."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.grounds.axis import across


@kernel
def field_at(surface, hulls, p):
    """Return phi, its gradient (3) and its Hessian (6) at a point.

    (u, w) is the direction away from the circle in the half-plane of the point.
    """
    z, size, (r, c, s) = p[2], surface["size"], across(p[0], p[1])
    d = r - size[0]
    D = math.sqrt(d * d + z * z)
    u, w = (d / D, z / D) if D > 0.0 else (0.0, -1.0)
    f = -1.0 / D if D > 0.0 else -math.inf
    along = -u / r if r > 0.0 else 0.0  # curvature along the ring
    a, b, m = f * w * w, f * u * u, -f * u * w
    H = (a * c * c + along * s * s, a * s * s + along * c * c, b, (a - along) * c * s, m * c, m * s)
    return size[1] - D, (-u * c, -u * s, -w), H
