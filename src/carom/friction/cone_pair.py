"""One contact on the central path of `carom.friction.interior`: its scaling, and its direction.

The disc of friction is a pair y _|_ z in the cone of Lorentz, y = (sigma, mu w_t), z = (p_n, p_t/mu). Its
scaling (Nesterov and Todd 1997) is S = beta (c, s; s, c) in the plane of e_0 and d, and beta across:
S z = S^-1 y = l. With D = 2 c^2 - 1, S dz + S^-1 dy = r and dy_t = mu dw_t + e_t give along d and across

    dz_d = (s r_0 + c r_d)/(beta D) - 2 c s/D dz_0 - K_d (mu dw_d + e_d),   K_d = 1/(beta^2 D),
    dz_p = r_p/beta - K_p (mu dw_p + e_p),                                  K_p = 1/beta^2.

All is written without differences of numbers that are nearly equal, which near the end are all round-off. With
the proximal term, w + eps dp for w, K becomes h K, h = 1/(1 + eps mu^2 K).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.layout import DISC
from carom.friction.thresholds import LEAST_INSIDE


@kernel
def scale(row, contact, w, K, eps):
    """Write the scaling, the errors of the slacks, and K of dp = a - K dw; return both products."""
    x, y, z, l, mu = row.x, row.y, row.z, row.l, contact.mu
    row.error[0], row.error[1], row.error[2] = w[0] - x, mu * w[1] - y[1], mu * w[2] - y[2]
    for i in range(3):
        for j in range(3):
            K[i, j] = 0.0
    # the normal: z_0 dx + x dz_0 = r_n
    row.k, normal = 0.0, 0.0
    if contact.kind != DISC:
        row.k, normal = z[0] / (x + eps * z[0]), x * z[0]
        K[0, 0] = row.k
    if not mu > 0.0:
        return normal, 0.0
    # the scaling of the disc: beta, and the point (c, s d, 0)
    product = y[0] * z[0] + y[1] * z[1] + y[2] * z[2]
    a, b = math.sqrt(inside(y)), math.sqrt(inside(z))
    g = 0.5 / math.sqrt(0.5 * (1.0 + product / (a * b)))
    c, beta = g * (y[0] / a + z[0] / b), math.sqrt(a / b)
    q1, q2 = g * (y[1] / a - z[1] / b), g * (y[2] / a - z[2] / b)
    s = math.sqrt(q1 * q1 + q2 * q2)
    d1, d2 = (q1 / s, q2 / s) if s > 0.0 else (1.0, 0.0)
    D = 2.0 * c * c - 1.0
    row.c, row.s, row.beta, row.D, row.d[0], row.d[1] = c, s, beta, D, d1, d2
    along, across = d1 * z[1] + d2 * z[2], d1 * z[2] - d2 * z[1]
    l[0], l[1], l[2] = beta * (c * z[0] + s * along), beta * (s * z[0] + c * along), beta * across
    # what slip along d and across it, and the normal impulse, change of the tangential one
    row.kd, row.kp = 1.0 / (beta * beta * D), 1.0 / (beta * beta)
    row.hd, row.hp = 1.0 / (1.0 + eps * mu * mu * row.kd), 1.0 / (1.0 + eps * mu * mu * row.kp)
    row.turn = 2.0 * c * s / D
    A, B, f = mu * mu * row.hd * row.kd, mu * mu * row.hp * row.kp, -mu * row.hd * row.turn * row.k
    K[1, 0], K[2, 0] = f * d1, f * d2
    K[1, 1], K[2, 2] = A * d1 * d1 + B * d2 * d2, A * d2 * d2 + B * d1 * d1
    K[1, 2] = K[2, 1] = (A - B) * d1 * d2
    return normal, product


@kernel
def inside(x):
    """Return x_0^2 - |x_t|^2, which is positive inside the cone."""
    s = math.sqrt(x[1] * x[1] + x[2] * x[2])
    return max(LEAST_INSIDE, (x[0] - s) * (x[0] + s))


@kernel
def aim(row, contact, eps, wanted, corrects):
    """Write the right-hand sides for products `wanted`; return the part a of dp = a - K dw.

    If it `corrects`, the products of the last direction are taken into account (Mehrotra 1992).
    """
    l, e, r, d, z, mu = row.l, row.error, row.r, row.d, row.z, contact.mu
    if contact.kind == DISC:
        normal = contact.h1 - z[0]  # the radius follows the normal impulse of another contact
    else:
        row.normal = wanted - row.x * z[0] - (row.dx * row.dz[0] if corrects else 0.0)
        normal = (row.normal - z[0] * e[0]) / (row.x + eps * z[0])
    if not mu > 0.0:
        return normal, 0.0, 0.0
    # l o r = wanted - l o l - dy o dz, in the scaled space
    c0 = wanted - (l[0] * l[0] + l[1] * l[1] + l[2] * l[2])
    c1, c2 = -2.0 * l[0] * l[1], -2.0 * l[0] * l[2]
    if corrects:
        a, b = row.sy, row.sz
        c0 -= a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
        c1, c2 = c1 - a[0] * b[1] - a[1] * b[0], c2 - a[0] * b[2] - a[2] * b[0]
    r[0] = (l[0] * c0 - l[1] * c1 - l[2] * c2) / inside(l)
    r[1], r[2] = (c1 - r[0] * l[1]) / l[0], (c2 - r[0] * l[2]) / l[0]
    # in the axes of the disc
    row.along = (row.s * r[0] + row.c * r[1]) / (row.beta * row.D) - row.kd * (
        d[0] * e[1] + d[1] * e[2]
    )
    row.across = r[2] / row.beta - row.kp * (d[0] * e[2] - d[1] * e[1])
    along, across = row.hd * (row.along - row.turn * normal), row.hp * row.across
    return normal, mu * (d[0] * along - d[1] * across), mu * (d[1] * along + d[0] * across)


@kernel
def turn_back(row, contact, eps, normal, u):
    """Write the direction for the change u of the velocity; `normal` is the first of the part a of dp."""
    d, r, dy, dz, sy, sz, mu = row.d, row.r, row.dy, row.dz, row.sy, row.sz, contact.mu
    dz[0] = normal - row.k * u[0]
    if contact.kind != DISC:
        row.dx = (row.normal - row.x * dz[0]) / row.z[0]
    if not mu > 0.0:
        return
    # dz in the axes of the disc, then S dz = r - S^-1 dy, of which all else follows
    c, s, D, beta = row.c, row.s, row.D, row.beta
    slid = row.hd * (row.along - row.kd * mu * (d[0] * u[1] + d[1] * u[2]))
    along = slid - row.hd * row.turn * dz[0]
    across = row.hp * (row.across - row.kp * mu * (d[0] * u[2] - d[1] * u[1]))
    dz[1], dz[2] = d[0] * along - d[1] * across, d[1] * along + d[0] * across
    less = eps * mu * mu * row.kd * row.hd  # 1 - h
    sz[0] = beta * (dz[0] * c * (1.0 + 2.0 * s * s * less) / D + s * slid)
    sz[1] = beta * (dz[0] * s * (2.0 * c * c * less - 1.0) / D + c * slid)
    sz[2] = beta * across
    sy[0], sy[1], sy[2] = r[0] - sz[0], r[1] - sz[1], r[2] - sz[2]
    yd, yp = beta * (s * sy[0] + c * sy[1]), beta * sy[2]
    dy[0] = beta * (c * sy[0] + s * sy[1])
    dy[1], dy[2] = d[0] * yd - d[1] * yp, d[1] * yd + d[0] * yp


@kernel
def to_edge(x, d):
    """Return the greatest t with x + t d in the cone, infinite if there is none."""
    a = d[0] * d[0] - d[1] * d[1] - d[2] * d[2]
    b = x[0] * d[0] - x[1] * d[1] - x[2] * d[2]
    c, least = inside(x), math.inf
    under = b * b - a * c
    if under >= 0.0:
        q = -(b + math.copysign(math.sqrt(under), b))
        if a != 0.0 and q / a > 0.0:
            least = min(least, q / a)
        if q != 0.0 and c / q > 0.0:
            least = min(least, c / q)
    return min(least, -x[0] / d[0]) if d[0] < 0.0 else least
