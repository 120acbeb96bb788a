"""The motion of the lowest point of a curved solid on its body while the body rotates on a half-space.

With the normal u in axes of the solid, u' = -W x u, and the point p that is lowest,

    cylinder, disc     p = (r e, -+h),  e = -(u_x, u_y)/|(u_x, u_y)|:     p' = r phi' (-e_y, e_x, 0),
                                        phi' = (u_x u_y' - u_y u_x')/(u_x^2 + u_y^2)
    ellipsoid          p = -H u/s,  s^2 = u.H u,  H = diag(a^2, b^2, c^2):  p' = -H u'/s + H u (u.H u')/s^3
    all else           p' = 0: a vertex, a point fixed to a rim.

While v and w are constant, the velocity at the point, v + w x r, changes at the rate w x r', with
r' = w x r_core + R p'.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.features import vertex_a
from carom.collision.layout import CYLINDER, ELLIPSOID
from carom.collision.plane import LOWEST
from carom.geometry.rotation import cross, rotate, rotate_back


@kernel
def way_of_lowest(solid, feature, u, W):
    """Return p', in axes of the solid, for the normal u and the angular velocity W there."""
    h = solid.half
    d = cross(u[0], u[1], u[2], W[0], W[1], W[2])  # u' = -W x u
    if solid.kind == CYLINDER and vertex_a(feature) >= LOWEST:
        across = u[0] * u[0] + u[1] * u[1]
        if across > 0.0:
            f = h[0] * (u[0] * d[1] - u[1] * d[0]) / across**1.5
            return f * u[1], -f * u[0], 0.0
    if solid.kind == ELLIPSOID:
        a, b, c = h[0] * h[0], h[1] * h[1], h[2] * h[2]
        square = a * u[0] * u[0] + b * u[1] * u[1] + c * u[2] * u[2]
        f = (a * u[0] * d[0] + b * u[1] * d[1] + c * u[2] * d[2]) / square
        s = square**-0.5
        return a * s * (f * u[0] - d[0]), b * s * (f * u[1] - d[1]), c * s * (f * u[2] - d[2])
    return 0.0, 0.0, 0.0


@kernel
def roll_on_plane(system, contact, feature, point, state):
    """Return (d/dt G) v of a point of a curved solid on a half-space, contact axes."""
    solid, body, E = system.solids[contact.solid], state[contact.body], point.axes
    q, s, w, r = body.Q, solid.Q, body.w, point.arm_a
    n = rotate_back(q[0], q[1], q[2], q[3], E[0, 0], E[0, 1], E[0, 2])
    u = rotate_back(s[0], s[1], s[2], s[3], n[0], n[1], n[2])
    W = rotate_back(q[0], q[1], q[2], q[3], w[0], w[1], w[2])
    W = rotate_back(s[0], s[1], s[2], s[3], W[0], W[1], W[2])
    p = way_of_lowest(solid, feature, u, W)
    p = rotate(s[0], s[1], s[2], s[3], p[0], p[1], p[2])
    p = rotate(q[0], q[1], q[2], q[3], p[0], p[1], p[2])
    # the ball that enlarges a core does not turn
    c = cross(
        w[0], w[1], w[2],
        r[0] + solid.radius * E[0, 0], r[1] + solid.radius * E[0, 1], r[2] + solid.radius * E[0, 2],
    )  # fmt: skip
    a = cross(w[0], w[1], w[2], c[0] + p[0], c[1] + p[1], c[2] + p[2])
    return (
        E[0, 0] * a[0] + E[0, 1] * a[1] + E[0, 2] * a[2],
        E[1, 0] * a[0] + E[1, 1] * a[1] + E[1, 2] * a[2],
        E[2, 0] * a[0] + E[2, 1] * a[1] + E[2, 2] * a[2],
    )
