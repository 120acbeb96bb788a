"""The torque-free top in closed form: constants of a flight, and its state at any time.

With b = R^T L/|L| the momentum in the body, i = 1/J, and axes in Jacobi's order,

    b_1 = A_1 cn u,   b_2 = A_2 sn u,   b_3 = A_3 dn u,   u = u_0 + p t,   p = -+|L| A_3 sqrt(d_31 d_32),

d_jk = |i_j - i_k|, and k^2 = (P d_21)/(Q d_32), 1 - k^2 = d_31 (d_32 b_3^2 - d_21 b_1^2)/(Q d_32), with the
constants P = d_31 b_1^2 + d_32 b_2^2 = d_31 A_1^2 and Q = d_31 b_3^2 + d_21 b_2^2 = d_31 A_3^2. These are
products and sums of nonnegative numbers, so no digits are lost if moments are nearly equal or the axis is
nearly principal. The attitude is C exp(theta e_3) M(b), where M(b) is the shortest rotation from b to e_3, and

    theta' = (2T/|L| + |L| i_3 b_3)/(1 + b_3),   theta/2 = lambda t + arg theta_4(z - i eta | q^2) + const,

z = pi u/2K, eta = pi w/2K, dn(iw) = 1/A_3 (mathematics page, free flight). For K' < K/2 the theta functions are
computed by Jacobi's imaginary transformation; in both cases four terms are enough. On the separatrix K is
infinite, and the same formulas hold. Sources: Jacobi 1849; van Zon and Schofield, J. Comput. Phys. 225, 145
(2007).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.elliptic import carlson, quarter_period
from carom.geometry.rotation import conjugate, multiply

#: how the elliptic functions are computed: k = 0 to round-off, theta series in z, or in i z
CIRCLE, NOME, COMPLEMENT = range(3)


@kernel
def order_axes(J, b):
    """Return the first, second and third axis in Jacobi's order; b is the momentum in the body.

    The second axis has the middle moment; the momentum moves around the third.
    """
    most = 0 if J[0] >= J[1] and J[0] >= J[2] else 1 if J[1] >= J[2] else 2
    least = 2 if J[2] <= J[0] and J[2] <= J[1] else 1 if J[1] <= J[0] else 0
    middle = 3 - most - least
    about_least = (J[middle] - J[least]) / J[least] * b[least] * b[least]
    about_most = (J[most] - J[middle]) / J[most] * b[most] * b[most]
    if J[middle] > J[least] and about_least >= about_most:
        return most, middle, least
    return least, middle, most


@kernel
def begin_top(J, q, W, top):
    """Write the constants of the flight that starts with attitude q and body rates W into `top`."""
    m = (J[0] * W[0], J[1] * W[1], J[2] * W[2])
    size = math.sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2])
    for k in range(3):
        top.axes[k], top.sign[k], top.amplitude[k] = k, 1.0, k // 2
    for k in range(2):
        top.rate[k] = 0.0
    top.kind, top.phase, top.magnitude, top.fastest = CIRCLE, 0.0, size, 0.0
    if size > 0.0:
        constants(J, (m[0] / size, m[1] / size, m[2] / size), size, top)
    turn, _ = attitude(top, 0.0)
    q = multiply(q, conjugate(turn))
    top.turn[0], top.turn[1], top.turn[2], top.turn[3] = q


@kernel
def constants(J, b, size, top):
    """Write amplitudes, rates and series of a flight into `top`; b is the direction of the momentum."""
    first, second, third = order_axes(J, b)
    unit = min(J[first], J[third])  # all i and d in units of its reciprocal
    faster = J[third] < J[first]
    d21 = abs(J[first] - J[second]) / J[first] * (unit / J[second])
    d32 = abs(J[second] - J[third]) / J[third] * (unit / J[second])
    d31 = abs(J[first] - J[third]) / J[third] * (unit / J[first])
    i1, i2, i3 = unit / J[first], unit / J[second], unit / J[third]
    even = second - first == 1 or second - first == -2
    s1, s3 = math.copysign(1.0, b[first]), math.copysign(1.0, b[third])
    s2 = s1 * s3 if even else -s1 * s3
    top.axes[first], top.axes[second], top.axes[third] = 0, 1, 2
    top.sign[0], top.sign[1], top.sign[2] = s1, s2, s3
    x1, x2, x3 = abs(b[first]), s2 * b[second], abs(b[third])
    P, Q = d31 * x1 * x1 + d32 * x2 * x2, d31 * x3 * x3 + d21 * x2 * x2
    A1, A2, A3 = math.sqrt(P / d31), math.sqrt(P / d32), math.sqrt(Q / d31)
    top.amplitude[0], top.amplitude[1], top.amplitude[2] = A1, A2, A3
    turns = size / unit
    p = turns * math.sqrt(Q * d32)
    p = -p if faster else p
    half = 0.5 * turns * (i1 * A1 * A1 + i3 * A3 * A3 + i3 * A3) / (1.0 + A3)  # theta'/2 at u = 0
    top.rate[0], top.rate[1] = half, p
    y1, y2 = x1 * math.sqrt(d31), x2 * math.sqrt(d32)
    top.phase = math.atan2(y2, y1)
    m, m1 = 0.0, 1.0
    if P * d21 > 0.0:
        m = min(P * d21 / (Q * d32), 1.0)
        m1 = min(d31 * max(d32 * x3 * x3 - d21 * x1 * x1, 0.0) / (Q * d32), 1.0)
    # |W|^2 is greatest at b_2 = 0 or at b_1 = 0; in |W'|^2 each product has its greatest value
    spin = max(i1 * i1 * A1 * A1 + i3 * i3 * A3 * A3, i2 * i2 * A2 * A2 + i3 * i3 * A3 * A3 * m1)
    change = max(i1 * d32 * A2, i2 * d31 * A1) * A3
    nod = 0.5 * i3 * d21 * A1 * A2
    top.fastest = turns * turns * (spin + math.sqrt(change * change + nod * nod))
    if 1.0 + m == 1.0:
        return
    K, Kc = quarter_period(math.sqrt(m1)), quarter_period(math.sqrt(m))
    w = math.sqrt(d32) * carlson(d21, d21 + m * d32, d21 + d32)
    still = y1 * y1 == 0.0 and m1 == 0.0  # constant rotation about the middle axis
    u = math.copysign(FAR, y2)
    if not still:
        u = y2 * carlson(y1 * y1, y1 * y1 + m1 * y2 * y2, y1 * y1 + y2 * y2)
    if Kc > 0.5 * K:
        start_nome(K, Kc, w, u, p, top)
    else:
        start_complement(K, Kc, w, u, p, top)
    if still:
        top.rate[1] = 0.0


#: u of a body that turns about its middle axis: exp(-FAR) = 0
FAR = 800.0


@kernel
def start_nome(K, Kc, w, u, p, top):
    """Write the series in z = pi u/2K into `top`; nome q = exp(-pi K'/K) < 0.21."""
    c, f = top.series, 0.5 * math.pi / K
    q = math.exp(-2.0 * f * Kc)
    q2, q4 = q * q, q * q * q * q
    q8 = q4 * q4
    c[0], c[1], c[2], c[3] = q, q4, q8 * q, q8 * q8
    c[4], c[5], c[6], c[7] = q2, q4 * q2, q8 * q4, q8 * q8 * q4
    up, down = math.exp(2.0 * f * (w - 2.0 * Kc)), math.exp(-2.0 * f * (w + 2.0 * Kc))
    a, b, power = up, down, -1.0
    slope, level = 0.0, 1.0
    for n in range(1, 4):  # q^(2 n^2) cosh and sinh of 2 n eta
        c[7 + n], c[10 + n] = power * (a + b), power * (a - b)
        slope, level = slope + 2.0 * n * c[10 + n], level + c[7 + n]
        a, b = a * up, b * down
        power *= -(q4**n)
    even, odd = 1.0 + 2.0 * (c[1] + c[3]), 2.0 * (c[0] + c[2])
    second = 1.0 + c[4] + c[5] + c[6] + c[7]
    top.amplitude[0] *= (even - odd) / second
    top.amplitude[1] *= (even + odd) / second
    top.amplitude[2] *= (even - odd) / (even + odd)
    top.kind = NOME
    top.rate[0] -= p * f * slope / level
    top.rate[1], top.phase = p * f, u * f


@kernel
def start_complement(K, Kc, w, u, p, top):
    """Write the series in pi u/2K' into `top`; nome q' = exp(-pi K/K') < 0.0019, 0 on the separatrix."""
    c, f = top.series, 0.5 * math.pi / Kc
    root = math.exp(-f * K)
    q = root * root
    q2, r2 = q * q, root * root
    a = 0.5 * f * w
    slope, level, power = 0.0, 0.0, 1.0
    for n in range(4):
        c[n], c[4 + n] = math.cos((2 * n + 1) * a), math.sin((2 * n + 1) * a)
        slope, level = slope + (2 * n + 1) * c[4 + n] * power, level + c[n] * power
        power *= r2 ** (n + 1)
    drift = 0.5 * f * w / K  # of the phase, along r
    c[8], c[9], c[10], c[11], c[12], c[13] = root, q, f, K, drift, 0.0
    second = 2.0 * (1.0 + q2 + q2 * q2 * q2)
    third, fourth = 1.0 + 2.0 * (q + q2 * q2), 1.0 + 2.0 * (q2 * q2 - q)
    top.amplitude[0] *= second / fourth
    top.amplitude[1] *= third / fourth
    top.amplitude[2] *= second / third
    top.kind = COMPLEMENT
    top.rate[0] -= p * (drift - 0.5 * f * slope / level)
    top.rate[1], top.phase = p, u


@kernel
def by_nome(c, z):
    """Return cn, sn, dn over their amplitudes, and cosine and sine of the phase of theta_4(z - i eta | q^2)."""
    x, y = math.cos(z), math.sin(z)
    x2, y2 = x * x - y * y, 2.0 * x * y
    x4, y4 = 2.0 * x2 * x2 - 1.0, 2.0 * x2 * y2
    x6, y6 = 2.0 * x2 * x4 - x2, 2.0 * x2 * y4 - y2
    x8 = 2.0 * x4 * x4 - 1.0
    x3, y3 = x * (2.0 * x2 - 1.0), y * (2.0 * x2 + 1.0)
    x5, y5 = 2.0 * x2 * x3 - x, 2.0 * x2 * y3 - y
    x7, y7 = 2.0 * x2 * x5 - x3, 2.0 * x2 * y5 - y3
    x9, y9 = 2.0 * x2 * x7 - x5, 2.0 * x2 * y7 - y5
    even, odd = 1.0 + 2.0 * (c[1] * x4 + c[3] * x8), 2.0 * (c[0] * x2 + c[2] * x6)
    f = 1.0 / (even - odd)
    cn = f * (x + c[4] * x3 + c[5] * x5 + c[6] * x7 + c[7] * x9)
    sn = f * (y - c[4] * y3 + c[5] * y5 - c[6] * y7 + c[7] * y9)
    X = 1.0 + c[8] * x2 + c[9] * x4 + c[10] * x6
    Y = c[11] * y2 + c[12] * y4 + c[13] * y6
    f2 = 1.0 / math.sqrt(X * X + Y * Y)
    return cn, sn, f * (even + odd), f2 * X, f2 * Y


@kernel
def by_complement(c, u):
    """Return the same for K' < K/2, from r = u minus whole periods 2K; the phase along r is returned apart."""
    periods = math.floor(0.5 * u / c[11] + 0.5)
    r = u - 2.0 * c[11] * periods if periods != 0.0 else u
    odd = periods - 2.0 * math.floor(0.5 * periods)
    root, q = c[8], c[9]
    e = math.exp(-c[10] * abs(r))  # exp(-v), v = pi |r|/2K'
    g = min(root / e, 1.0) if root > 0.0 else 0.0  # (q')^(1/2) exp(v)
    G, e2, q2 = g * g, e * e, q * q
    e4 = e2 * e2
    e6, q4 = e4 * e2, q2 * q2
    t1, t2, t3 = q * G, q4 * G * G, q2 * G * G
    one = 1.0 - e2 - t1 * (1.0 - e6) + t2 * (1.0 - e6 * e4)
    two = 1.0 + e2 + t1 * (1.0 + e6) + t2 * (1.0 + e6 * e4)
    even, rest = 1.0 + t3 * (1.0 + e4 * e4), G * (1.0 + e4) + q4 * q2 * G * G * G * (1.0 + e6 * e6)
    f, sign = 1.0 / two, 1.0 - 2.0 * odd
    cn, dn = f * e * (even - rest), f * e * (even + rest)
    sn = math.copysign(f * one, r)
    p1 = root * g
    p2, p3 = q2 * g * g, q2 * q2 * root * g * g * g
    e3 = e2 * e
    X = (
        c[0] * (1.0 + e)
        + p1 * c[1] * (1.0 + e3)
        + p2 * c[2] * (1.0 + e4 * e)
        + p3 * c[3] * (1.0 + e4 * e3)
    )
    Y = (
        c[4] * (1.0 - e)
        + p1 * c[5] * (1.0 - e3)
        + p2 * c[6] * (1.0 - e4 * e)
        + p3 * c[7] * (1.0 - e4 * e3)
    )
    f = 1.0 / math.sqrt(X * X + Y * Y)
    return sign * cn, sign * sn, dn, f * X, math.copysign(f * Y, -r), c[12] * r


@kernel
def attitude(top, t):
    """Return the rotation of the body since `top.turn` as a quaternion, and b, both in the body's own axes."""
    u = top.phase + top.rate[1] * t
    half = top.rate[0] * t
    X, Y = 1.0, 0.0
    if top.kind == CIRCLE:
        cn, sn, dn = math.cos(u), math.sin(u), 1.0
    elif top.kind == NOME:
        cn, sn, dn, X, Y = by_nome(top.series, u)
    else:
        cn, sn, dn, X, Y, drift = by_complement(top.series, u)
        half += drift
    c, s = math.cos(half), math.sin(half)
    c, s = c * X - s * Y, c * Y + s * X
    A = top.amplitude
    b1, b2, b3 = A[0] * cn, A[1] * sn, A[2] * dn
    a = math.sqrt(0.5 * (1.0 + b3))  # shortest turn to e_3: (a, b_2/2a, -b_1/2a, 0)
    f = 0.5 / a
    x, y = f * b2, -f * b1
    parts = top.sign[0] * (c * x - s * y), top.sign[1] * (c * y + s * x), top.sign[2] * (s * a)
    lie = top.sign[0] * b1, top.sign[1] * b2, top.sign[2] * b3
    i, j, k = top.axes[0], top.axes[1], top.axes[2]
    return (c * a, parts[i], parts[j], parts[k]), (lie[i], lie[j], lie[k])
