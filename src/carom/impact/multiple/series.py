"""A step of high order: the Taylor series of the layer between changes of mode, for p = 1.

Normal forces are linear in the depth, friction of sticking contacts is linear in the other forces, and that
of slipping contacts follows order by order from q = u_t.u_t, r r = q, F r = mu N, T = -F u_t. If slip may end
soon, time is stretched: dt = sigma dtau with 1/sigma = 1 + sum c_i/|u_t,i|. In tau slip decays exponentially,
so the series reaches far. Changes of mode are found on the series, without another step.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.lanes import blocks, product
from carom._compiled.simd import LANES, add, load, multiply, same, store, subtract
from carom.impact.multiple import layout as o
from carom.impact.multiple.friction import stick
from carom.impact.multiple.normal_law import OPEN
from carom.impact.thresholds import MOMENT_AHEAD


@kernel
def into_lanes(k, work):
    """Copy W of the group, column by column, in the form for the series."""
    W, columns = work.matrix[o.MASS], work.columns
    width = columns.shape[1] // 3
    for j in range(3 * k):
        for b in range(blocks(k)):
            for r in range(3):
                for l in range(LANES):
                    i = LANES * b + l
                    columns[j, r * width + b, l] = W[j, 3 * i + r] if i < k else 0.0


@kernel
def degree_for(rtol):
    """Return the degree for which a step costs least per unit of its length."""
    return min(24, max(9, int(4.0 - 0.55 * math.log(rtol))))


@kernel
def slips(c):
    """Return whether the friction of contact `c` is that of slip."""
    return c.mode != OPEN and c.mu > 0.0 and c.sticks == 0


@kernel
def likely_force(c, d, u_n):
    """Return the normal force of contact `c`, or a bound for a moment later if its depth still grows."""
    force = c.slope * (d - c.rest)
    return max(force, max(0.0, force) + MOMENT_AHEAD * c.slope * max(0.0, -u_n))


@inlined
def stretch_weights(k, work):
    """Write c_i, the rate at which a contact's own friction can change its slip; return if any matters."""
    stretched = False
    u, d, weights = work.vector[o.NOW_U], work.vector[o.D], work.vector[o.WEIGHT]
    for i in range(k):
        weights[i] = 0.0
        c = work.contact[i]
        if slips(c):
            n = 3 * i
            r = math.sqrt(u[n + 1] * u[n + 1] + u[n + 2] * u[n + 2])
            weights[i] = c.grip * likely_force(c, d[i], u[n])
            if weights[i] * 2.0 > r:
                stretched = True
    return stretched


@inlined
def begin(k, work, stretched):
    """Write order 0 of the series, and the data of each contact; return the number of closed contacts."""
    S, vector, closed = work.series, work.vector, 0
    lane = S[o.S_LANE]
    for b in range(blocks(k)):
        for l in range(LANES):
            i = LANES * b + l
            slope, rest, rough, inverse, fine, r = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            pull = 0.0
            for s in range(3):
                S[o.S_U + s, 0, b, l] = vector[o.NOW_U, 3 * i + s] if i < k else 0.0
                S[o.S_P + s, 0, b, l] = vector[o.NOW_P, 3 * i + s] if i < k else 0.0
            S[o.S_D, 0, b, l] = vector[o.D, i] if i < k else 0.0
            S[o.S_LOSS, 0, b, l] = 0.0
            if i < k:
                c = work.contact[i]
                if c.mode != OPEN:
                    slope, rest = c.slope, c.rest
                    work.index[o.CLOSED, closed] = i
                    closed += 1
                if slips(c):
                    x, y = S[o.S_U1, 0, b, l], S[o.S_U2, 0, b, l]
                    r = math.sqrt(x * x + y * y)
                    rough, inverse, pull = c.mu, 1.0 / r, vector[o.WEIGHT, i]
                    fine = 1.0 / math.sqrt(min(1.0, r))
            S[o.S_N, 0, b, l] = slope * (S[o.S_D, 0, b, l] - rest)
            S[o.S_R, 0, b, l] = r
            S[o.S_G, 0, b, l] = inverse
            lane[o.SLOPE, b, l], lane[o.ROUGH, b, l], lane[o.ONE_OVER, b, l] = slope, rough, inverse
            lane[o.PULL, b, l], lane[o.SLOWNESS, b, l] = pull, fine
        v = lane[o.ONE_OVER, b]
        lane[o.SLIPPING, b, 0] = v[0] + v[1] + v[2] + v[3]
    return closed


@inlined
def expand(k, z, closed, work, first, degree):
    """Write the series of velocity, impulse and depth of orders `first` + 1 to `degree`.

    Orders up to `first` are known; `z` contacts stick (see `friction`).
    """
    S, lane = work.series, work.series[o.S_LANE]
    line = S.shape[2] * LANES
    un, u1, u2, d, normal = S[o.S_U], S[o.S_U1], S[o.S_U2], S[o.S_D], S[o.S_N]
    q, sigma, stretched = S[o.S_Q], S[o.S_SIGMA], work.clock[0].stretched == 1
    f = S[o.S_FS] if stretched else S[o.S_F]
    for n in range(first, degree):
        step = same(1.0 / (n + 1))
        back = same(-1.0 / (n + 1))
        for b in range(blocks(k)):
            if lane[o.SLIPPING, b, 0] > 0.0:
                _forces(line, S, LANES * b, n)
        if stretched:
            _stretch(k, line, S, n)
        for b in range(blocks(k)):
            p = LANES * b
            i, at = n * line + p, (n + 1) * line + p
            force, speed = load(normal, i), load(un, i)
            if stretched:
                force, speed, grip = same(0.0), same(0.0), same(0.0)
                j, m = p, n * line
                for _ in range(n + 1):
                    rate = load(sigma, m)
                    force = add(force, multiply(load(normal, j), rate))
                    speed = add(speed, multiply(load(un, j), rate))
                    grip = add(grip, multiply(load(S[o.S_F], j), rate))
                    j += line
                    m -= line
                store(f, i, grip)
            depth = multiply(back, speed)
            store(S[o.S_P], at, multiply(step, force))
            store(d, at, depth)
            store(normal, at, multiply(load(lane, o.SLOPE * line + p), depth))
            x, y, heat = same(0.0), same(0.0), same(0.0)
            if lane[o.SLIPPING, b, 0] > 0.0:
                j, m = p, i
                for _ in range(n + 1):
                    friction = load(f, j)
                    x = add(x, multiply(friction, load(u1, m)))
                    y = add(y, multiply(friction, load(u2, m)))
                    heat = add(heat, multiply(friction, load(q, m)))
                    j += line
                    m -= line
            store(S[o.S_P1], at, multiply(back, x))
            store(S[o.S_P2], at, multiply(back, y))
            store(S[o.S_LOSS], at, multiply(step, heat))
        _answer(k, closed, work, n + 1)
        if z > 0:
            _hold(k, z, work, n + 1)


@inlined
def _forces(line, S, p, n):
    """Write order `n` of |u_t|^2, |u_t| and mu N/|u_t| of the block at `p`; its sums in one loop."""
    u1, u2, r, f, lane, i = S[o.S_U1], S[o.S_U2], S[o.S_R], S[o.S_F], S[o.S_LANE], n * line + p
    x, y, g = load(u1, p), load(u2, p), load(lane, o.ONE_OVER * line + p)
    force = multiply(load(lane, o.ROUGH * line + p), load(S[o.S_N], i))
    if n == 0:
        store(S[o.S_Q], i, add(multiply(x, x), multiply(y, y)))
        store(f, i, multiply(force, g))
        return
    q, rr, rf = same(0.0), same(0.0), same(0.0)
    j, m = p + line, i - line
    for _ in range(1, n):
        speed = load(r, j)
        q = add(q, add(multiply(load(u1, j), load(u1, m)), multiply(load(u2, j), load(u2, m))))
        rr = add(rr, multiply(speed, load(r, m)))
        rf = add(rf, multiply(speed, load(f, m)))
        j += line
        m -= line
    ends = add(multiply(x, load(u1, i)), multiply(y, load(u2, i)))
    q = add(q, add(ends, ends))
    speed = multiply(multiply(same(0.5), subtract(q, rr)), g)
    rf = add(rf, multiply(speed, load(f, p)))
    store(S[o.S_Q], i, q)
    store(r, i, speed)
    store(f, i, multiply(subtract(force, rf), g))


@kernel
def _stretch(k, line, S, n):
    """Write order `n` of dtau/dt = 1 + sum c_i/|u_t,i| and of dt/dtau, the same in all lanes."""
    g, rate, sigma, lane, total = (
        S[o.S_G],
        S[o.S_RATE],
        S[o.S_SIGMA],
        S[o.S_LANE],
        1.0 if n == 0 else 0.0,
    )
    for b in range(blocks(k)):
        if lane[o.SLIPPING, b, 0] > 0.0:
            p = LANES * b
            if n > 0:
                s = product(line, S[o.S_R], g, p, n)
                s = multiply(s, load(lane, o.ONE_OVER * line + p))
                store(g, n * line + p, multiply(same(-1.0), s))
            for l in range(LANES):
                total += lane[o.PULL, b, l] * g[n, b, l]
    store(rate, n * line, same(total))
    if n == 0:
        s = same(1.0 / total)
    else:
        s = multiply(same(-sigma[0, 0, 0]), product(line, rate, sigma, 0, n))
    store(sigma, n * line, s)


@inlined
def _answer(k, closed, work, n):
    """Write order `n` of the velocities: W times the impulses of the closed contacts."""
    S, columns, slot = work.series, work.columns, work.index[o.CLOSED]
    line = S.shape[2] * LANES
    row, b0 = 3 * line, n * line  # `row`: length of a column of W
    for b in range(blocks(k)):
        p = LANES * b
        un, u1, u2 = same(0.0), same(0.0), same(0.0)
        for a in range(closed):
            i = slot[a]
            at = 3 * i * row + p
            for r in range(3):
                x = same(S[o.S_P + r, n, i // LANES, i % LANES])
                un = add(un, multiply(x, load(columns, at)))
                u1 = add(u1, multiply(x, load(columns, at + line)))
                u2 = add(u2, multiply(x, load(columns, at + 2 * line)))
                at += row
        store(S[o.S_U], b0 + p, un)
        store(S[o.S_U1], b0 + p, u1)
        store(S[o.S_U2], b0 + p, u2)


@kernel
def _hold(k, z, work, n):
    """Add the friction of stick to order `n`."""
    S, impulse, velocity = work.series, work.vector[o.ORDER_P], work.vector[o.ORDER_U]
    for i in range(k):
        for r in range(3):
            impulse[3 * i + r] = S[o.S_P + r, n, i // LANES, i % LANES]
            velocity[3 * i + r] = S[o.S_U + r, n, i // LANES, i % LANES]
    stick(k, z, work, impulse, velocity)
    for i in range(k):
        for r in range(3):
            S[o.S_P + r, n, i // LANES, i % LANES] = impulse[3 * i + r]
            S[o.S_U + r, n, i // LANES, i % LANES] = velocity[3 * i + r]
