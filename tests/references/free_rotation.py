"""Free rotation by Taylor series in integers: Euler's equations and dQ/dt = Q (0, W)/2, to 30 digits."""

import math
from fractions import Fraction

BITS, ORDER, STEP = 140, 26, 0.15  # of the radius of convergence, about 1/|W|, a tenth


def _fixed(x):
    return (Fraction(x).numerator << BITS) // Fraction(x).denominator


def _body_rates(q, w):
    """Return R^T w exactly, of a quaternion of any length."""
    s, (x, y, z) = q[0], (-c for c in q[1:])
    R = (
        (s * s + x * x - y * y - z * z, 2 * (x * y - s * z), 2 * (x * z + s * y)),
        (2 * (x * y + s * z), s * s - x * x + y * y - z * z, 2 * (y * z - s * x)),
        (2 * (x * z - s * y), 2 * (y * z + s * x), s * s - x * x - y * y + z * z),
    )
    return [sum(a * b for a, b in zip(row, w)) / sum(c * c for c in q) for row in R]


def _advance(gain, W, q, h):
    """Return body rates and quaternion a time h later, all in integers."""
    a, b = [[c] for c in W], [[c] for c in q]
    for n in range(ORDER):
        back = [c[::-1] for c in a]
        euler = [
            sum(x * y for x, y in zip(a[i], back[j])) >> BITS for i, j in ((1, 2), (2, 0), (0, 1))
        ]
        dot = [
            [sum(x * y for x, y in zip(b[i], back[j])) >> BITS for j in range(3)] for i in range(4)
        ]
        turn = (
            -dot[1][0] - dot[2][1] - dot[3][2],
            dot[0][0] + dot[2][2] - dot[3][1],
            dot[0][1] - dot[1][2] + dot[3][0],
            dot[0][2] + dot[1][1] - dot[2][0],
        )
        for k in range(3):
            a[k].append(((gain[k] * euler[k] >> BITS) * h >> BITS) // (n + 1))
        for k in range(4):
            b[k].append((turn[k] * h >> BITS) // (2 * (n + 1)))
    return [sum(c) for c in a], [sum(c) for c in b]


def free_rotation(moments, orientation, spin, time, fastest):
    """Return the quaternion after `time`, as fractions of length 1, from numbers taken as exact.

    `spin` is the angular velocity in world axes, `fastest` about the greatest |W| on the way.
    """
    J = [Fraction(j) for j in moments]
    q, w = [Fraction(c) for c in orientation], [Fraction(c) for c in spin]
    unit = Fraction(fastest)
    gain = [_fixed((J[k - 2] - J[k - 1]) / J[k]) for k in range(3)]
    W = [_fixed(c / unit) for c in _body_rates(q, w)]
    length = Fraction(math.isqrt(_fixed(_fixed(sum(c * c for c in q)))), 1 << BITS)
    Q = [_fixed(c / length) for c in q]
    steps = max(1, math.ceil(abs(float(time * fastest)) / STEP))
    h = _fixed(Fraction(time) * unit / steps)
    for _ in range(steps):
        W, Q = _advance(gain, W, Q, h)
    return [Fraction(c, 1 << BITS) for c in Q]


def angle_between(p, q):
    """Return the angle [rad] between two attitudes, to its own digits however small."""
    p, q = ([Fraction(c) for c in a] for a in (p, q))
    off = [
        a * d - b * c for i, (a, b) in enumerate(zip(p, q)) for c, d in zip(p[i + 1 :], q[i + 1 :])
    ]
    sine = math.sqrt(sum(float(c) ** 2 for c in off))  # |p ^ q| = sin(angle / 2)
    return 2.0 * math.atan2(sine, abs(float(sum(a * b for a, b in zip(p, q)))))
