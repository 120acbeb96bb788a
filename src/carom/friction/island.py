"""W = G P G^T is used through the bodies, without being formed: products, sweeps, and the linear systems.

Both linear systems have the form J x + D W x = r with 3x3 blocks J and D of each contact. With the motion of
the bodies, y = P G^T x, the contacts are eliminated, x = J^-1 (r - D G y), and

    (I + P G^T K G) y = P G^T J^-1 r,   K = J^-1 D,

is a system on the graph of the bodies. Without joints P is M^-1; with joints an impulse also moves the bodies
joined to its own (`OTHER`). The system is stiff, K ~ 1/eps if a contact sticks. The next iteration starts from
the true residual, and so corrects the round-off.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction import layout as o
from carom.friction.blocks import begin_blocks, factor_blocks, substitute_blocks
from carom.friction.cone import slope
from carom.friction.local import solve_prepared


@unit
def multiply(work, k, x, out):
    """Add W x to `out`."""
    write_motion(work, k, x)
    add_rates(work, k, out)


@unit
def magnitude(work, k) -> float:
    """Return the greatest (|G| |M^-1 G^T| |p|)_i / s_i, at least (|W| |p|)_i / s_i."""
    _rest(work)
    most = 0.0
    for i in range(k):
        _push_size(work, i)
    for i in range(k):
        for a in range(3):
            most = max(most, _pull_size(work, i, a) / work.contact[i].scale)
    return most


@kernel
def _push_size(work, i):
    """Add the absolute values of the motion that the impulse of contact i causes."""
    link, p = work.link[i], work.vector[o.ITERATE]
    for side in range(2):
        if link.body[side] >= 0:
            Y, v = link.response[side], work.body[link.body[side]].motion
            for r in range(6):
                for a in range(3):
                    v[r] += abs(Y[r, a] * p[3 * i + a])
    for e in range(link.others, link.others_end):
        Y, v = work.other[e].response, work.body[work.other[e].body].motion
        for r in range(6):
            for a in range(3):
                v[r] += abs(Y[r, a] * p[3 * i + a])


@kernel
def _pull_size(work, i, a):
    """Return component `a` of the velocity of contact i, in absolute values."""
    link, s = work.link[i], 0.0
    for side in range(2):
        if link.body[side] >= 0:
            G, v = link.rows[side], work.body[link.body[side]].motion
            for j in range(6):
                s += abs(G[a, j]) * v[j]
    for e in range(link.others, link.others_end if link.spans == 1 else link.others):
        G, v = work.other[e].rows, work.body[work.other[e].body].motion
        for j in range(6):
            s += abs(G[a, j]) * v[j]
    return s


@unit
def sweep(work, k, backward):
    """Solve each contact in turn, with fixed impulses of the others."""
    p, c = work.vector[o.ITERATE], work.vector[o.BIAS]
    write_motion(work, k, p)
    for place in range(k):
        i = k - 1 - place if backward else place
        n = 3 * i
        row = work.link[i].local
        W = row[0], row[1], row[2], row[3], row[4], row[5]
        q0, q1, q2 = p[n], p[n + 1], p[n + 2]
        u0, u1, u2 = _pull(work, i)
        c0 = c[n] + u0 - (W[0] * q0 + W[1] * q1 + W[2] * q2)
        c1 = c[n + 1] + u1 - (W[1] * q0 + W[3] * q1 + W[4] * q2)
        c2 = c[n + 2] + u2 - (W[2] * q0 + W[4] * q1 + W[5] * q2)
        found, x0, x1, x2 = solve_prepared(work.contact[i], work.link[i], (c0, c1, c2))
        if found:
            p[n], p[n + 1], p[n + 2] = x0, x1, x2
            _push(work, i, x0 - q0, x1 - q1, x2 - q2)


@unit
def factor_newton(work, k, eps):
    """Factor for J = I - D + eps D, D the slope of the projection at p, w."""
    p, w = work.vector[o.ITERATE], work.vector[o.RESULTING]
    e = 1.0 - eps
    for i in range(k):
        contact, n = work.contact[i], 3 * i
        d00, d10, d11, d12, d20, d21, d22 = slope(
            contact, p[n] - w[n], p[n + 1] - w[n + 1], p[n + 2] - w[n + 2]
        )
        # J is block-triangular, so the normal is solved first.
        j00, j10, j20 = 1.0 - e * d00, -e * d10, -e * d20
        j11, j12, j22 = 1.0 - e * d11, -e * d12, 1.0 - e * d22
        det = j11 * j22 - j12 * j12
        C, K = work.link[i].compliance, work.link[i].stiffness
        C[0, 0], C[0, 1], C[0, 2] = 1.0 / j00, 0.0, 0.0
        C[1, 1], C[1, 2], C[2, 1], C[2, 2] = j22 / det, -j12 / det, -j12 / det, j11 / det
        C[1, 0] = -(C[1, 1] * j10 + C[1, 2] * j20) / j00
        C[2, 0] = -(C[2, 1] * j10 + C[2, 2] * j20) / j00
        for r in range(3):
            K[r, 0] = C[r, 0] * d00 + C[r, 1] * d10 + C[r, 2] * d20
            K[r, 1] = C[r, 1] * d11 + C[r, 2] * d21
            K[r, 2] = C[r, 1] * d12 + C[r, 2] * d22
    _assemble(work, k)
    factor_blocks(work)
    work.count[o.FACTOR_ROWS] = 3 * k


@unit
def solve_newton(work, k):
    """Write the step for the present f."""
    f, step, rhs = work.vector[o.F], work.vector[o.STEP], work.vector[o.RHS]
    for i in range(3 * k):
        rhs[i] = -f[i]
    solve_shifted(work, k)
    for i in range(3 * k):
        step[i] = rhs[i]


@unit
def factor_shifted(work, k, sigma):
    """Factor for W + sigma: J = sigma, D = I."""
    for i in range(k):
        C, K = work.link[i].compliance, work.link[i].stiffness
        for r in range(3):
            for j in range(3):
                C[r, j] = K[r, j] = 1.0 / sigma if r == j else 0.0
    _assemble(work, k)
    factor_blocks(work)


@unit
def factor_links(work, k):
    """Factor I + P G^T K G for the K that the contacts have."""
    _assemble(work, k)
    factor_blocks(work)


@unit
def solve_motion(work, k):
    """Write the motion y of (I + P G^T K G) y = lack + P G^T x for the right-hand side x."""
    x = work.vector[o.RHS]
    for b in range(work.body.shape[0]):
        body = work.body[b]
        for j in range(6):
            body.motion[j] = body.lack[j]
    for i in range(k):
        _push(work, i, x[3 * i], x[3 * i + 1], x[3 * i + 2])
    substitute_blocks(work)


@kernel
def add_rates(work, k, out):
    """Add the velocities of the contacts in the present motion to `out`."""
    for i in range(k):
        u0, u1, u2 = _pull(work, i)
        out[3 * i] += u0
        out[3 * i + 1] += u1
        out[3 * i + 2] += u2


@unit
def solve_shifted(work, k):
    """Replace the right-hand side r by the solution x of J x + D W x = r."""
    x = work.vector[o.RHS]
    _rest(work)
    for i in range(k):
        n, C = 3 * i, work.link[i].compliance
        r0, r1, r2 = x[n], x[n + 1], x[n + 2]
        for r in range(3):
            x[n + r] = C[r, 0] * r0 + C[r, 1] * r1 + C[r, 2] * r2
        _push(work, i, x[n], x[n + 1], x[n + 2])
    substitute_blocks(work)
    for i in range(k):
        K = work.link[i].stiffness
        u0, u1, u2 = _pull(work, i)
        for r in range(3):
            x[3 * i + r] -= K[r, 0] * u0 + K[r, 1] * u1 + K[r, 2] * u2


@kernel
def _assemble(work, k):
    """Write the blocks of I + P G^T K G."""
    begin_blocks(work)
    for i in range(k):
        link = work.link[i]
        K = link.stiffness
        if K[0, 0] == 0.0 and K[1, 1] == 0.0 and K[2, 2] == 0.0:
            continue  # open
        for side in range(2):
            if link.body[side] >= 0:
                _add_columns(work, link, side)


@kernel
def _add_columns(work, link, side):
    """Add P G^T K G of a contact: the columns of its body `side`, the rows of all bodies that it moves."""
    G, K = link.rows[side], link.stiffness
    for j in range(6):
        a = K[0, 0] * G[0, j] + K[0, 1] * G[1, j] + K[0, 2] * G[2, j]
        b = K[1, 0] * G[0, j] + K[1, 1] * G[1, j] + K[1, 2] * G[2, j]
        c = K[2, 0] * G[0, j] + K[2, 1] * G[1, j] + K[2, 2] * G[2, j]
        for other in range(2):
            if link.body[other] < 0:
                continue
            Y, A = link.response[other], work.block[link.corner[other, side]]
            for r in range(6):
                A[r, j] += Y[r, 0] * a + Y[r, 1] * b + Y[r, 2] * c
        for e in range(link.others, link.others_end):
            Y, A = work.other[e].response, work.block[work.other[e].corner[side]]
            for r in range(6):
                A[r, j] += Y[r, 0] * a + Y[r, 1] * b + Y[r, 2] * c


@kernel
def write_motion(work, k, x):
    """Write the motion that impulses x cause."""
    _rest(work)
    for i in range(k):
        _push(work, i, x[3 * i], x[3 * i + 1], x[3 * i + 2])


@kernel
def _rest(work):
    for b in range(work.body.shape[0]):
        for j in range(6):
            work.body[b].motion[j] = 0.0


@kernel
def _push(work, i, p0, p1, p2):
    """Add the motion that an impulse of contact i causes."""
    link = work.link[i]
    for side in range(2):
        if link.body[side] >= 0:
            Y, v = link.response[side], work.body[link.body[side]].motion
            for r in range(6):
                v[r] += Y[r, 0] * p0 + Y[r, 1] * p1 + Y[r, 2] * p2
    for e in range(link.others, link.others_end):
        Y, v = work.other[e].response, work.body[work.other[e].body].motion
        for r in range(6):
            v[r] += Y[r, 0] * p0 + Y[r, 1] * p1 + Y[r, 2] * p2


@kernel
def _pull(work, i):
    """Return the velocity of contact i in the present motion."""
    link = work.link[i]
    u0, u1, u2 = _rate(link.rows[0], work.body[link.body[0]].motion)
    if link.body[1] >= 0:
        v0, v1, v2 = _rate(link.rows[1], work.body[link.body[1]].motion)
        u0, u1, u2 = u0 + v0, u1 + v1, u2 + v2
    for e in range(link.others, link.others_end if link.spans == 1 else link.others):
        v0, v1, v2 = _rate(work.other[e].rows, work.body[work.other[e].body].motion)
        u0, u1, u2 = u0 + v0, u1 + v1, u2 + v2
    return u0, u1, u2


@kernel
def _rate(G, v):
    """Return G v of one body; two separate sums, linear and angular, are faster than one long sum."""
    a0 = G[0, 0] * v[0] + G[0, 1] * v[1] + G[0, 2] * v[2]
    a1 = G[1, 0] * v[0] + G[1, 1] * v[1] + G[1, 2] * v[2]
    a2 = G[2, 0] * v[0] + G[2, 1] * v[1] + G[2, 2] * v[2]
    b0 = G[0, 3] * v[3] + G[0, 4] * v[4] + G[0, 5] * v[5]
    b1 = G[1, 3] * v[3] + G[1, 4] * v[4] + G[1, 5] * v[5]
    b2 = G[2, 3] * v[3] + G[2, 4] * v[4] + G[2, 5] * v[5]
    return a0 + b0, a1 + b1, a2 + b2
