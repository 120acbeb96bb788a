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
from carom.impact.multiple.friction import stick
from carom.impact.multiple.normal_law import OPEN
from carom.impact.thresholds import MOMENT_AHEAD


@kernel
def into_lanes(k, work):
    """Copy W of the group, column by column, in the form for the series."""
    W, columns = work.W, work.series.columns
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
    u, d = work.now.velocity, work.now.depth
    for i in range(k):
        c = work.contact[i]
        c.braking = 0.0
        if slips(c):
            n = 3 * i
            r = math.sqrt(u[n + 1] * u[n + 1] + u[n + 2] * u[n + 2])
            c.braking = c.grip * likely_force(c, d[i], u[n])
            if c.braking * 2.0 > r:
                stretched = True
    return stretched


@inlined
def begin(k, work, stretched):
    """Write order 0 of the series, and the data of each contact; return the number of closed contacts."""
    S, closed = work.series, 0
    for b in range(blocks(k)):
        for l in range(LANES):
            i = LANES * b + l
            slope, rest, rough, inverse, fine, r = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            braking = 0.0
            for s in range(3):
                S.u[s, 0, b, l] = work.now.velocity[3 * i + s] if i < k else 0.0
                S.P[s, 0, b, l] = work.now.impulse[3 * i + s] if i < k else 0.0
            S.depth[0, b, l] = work.now.depth[i] if i < k else 0.0
            S.loss[0, b, l] = 0.0
            if i < k:
                c = work.contact[i]
                if c.mode != OPEN:
                    slope, rest = c.slope, c.rest
                    work.closed[closed] = i
                    closed += 1
                if slips(c):
                    x, y = S.u[1, 0, b, l], S.u[2, 0, b, l]
                    r = math.sqrt(x * x + y * y)
                    rough, inverse, braking = c.mu, 1.0 / r, c.braking
                    fine = 1.0 / math.sqrt(min(1.0, r))
            S.N[0, b, l] = slope * (S.depth[0, b, l] - rest)
            S.slip[0, b, l] = r
            S.inverse[0, b, l] = inverse
            S.slope[b, l], S.mu[b, l], S.over[b, l] = slope, rough, inverse
            S.braking[b, l], S.slowness[b, l] = braking, fine
        v = S.over[b]
        S.slipping[b, 0] = v[0] + v[1] + v[2] + v[3]
    return closed


@inlined
def expand(k, z, closed, work, first, degree):
    """Write the series of velocity, impulse and depth of orders `first` + 1 to `degree`.

    Orders up to `first` are known; `z` contacts stick (see `friction`).
    """
    S = work.series
    line = S.depth.shape[1] * LANES
    un, u1, u2, d, normal = S.u[0], S.u[1], S.u[2], S.depth, S.N
    q, sigma, stretched = S.square, S.sigma, work.clock[0].stretched == 1
    f = S.stretched_rub if stretched else S.rub
    for n in range(first, degree):
        step = same(1.0 / (n + 1))
        back = same(-1.0 / (n + 1))
        for b in range(blocks(k)):
            if S.slipping[b, 0] > 0.0:
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
                    grip = add(grip, multiply(load(S.rub, j), rate))
                    j += line
                    m -= line
                store(f, i, grip)
            depth = multiply(back, speed)
            store(S.P[0], at, multiply(step, force))
            store(d, at, depth)
            store(normal, at, multiply(load(S.slope, p), depth))
            x, y, heat = same(0.0), same(0.0), same(0.0)
            if S.slipping[b, 0] > 0.0:
                j, m = p, i
                for _ in range(n + 1):
                    friction = load(f, j)
                    x = add(x, multiply(friction, load(u1, m)))
                    y = add(y, multiply(friction, load(u2, m)))
                    heat = add(heat, multiply(friction, load(q, m)))
                    j += line
                    m -= line
            store(S.P[1], at, multiply(back, x))
            store(S.P[2], at, multiply(back, y))
            store(S.loss, at, multiply(step, heat))
        _answer(k, closed, work, n + 1)
        if z > 0:
            _hold(k, z, work, n + 1)


@inlined
def _forces(line, S, p, n):
    """Write order `n` of |u_t|^2, |u_t| and mu N/|u_t| of the block at `p`; its sums in one loop."""
    u1, u2, r, f, i = S.u[1], S.u[2], S.slip, S.rub, n * line + p
    x, y, g = load(u1, p), load(u2, p), load(S.over, p)
    force = multiply(load(S.mu, p), load(S.N, i))
    if n == 0:
        store(S.square, i, add(multiply(x, x), multiply(y, y)))
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
    store(S.square, i, q)
    store(r, i, speed)
    store(f, i, multiply(subtract(force, rf), g))


@kernel
def _stretch(k, line, S, n):
    """Write order `n` of dtau/dt = 1 + sum c_i/|u_t,i| and of dt/dtau, the same in all lanes."""
    g, rate, sigma, total = S.inverse, S.rate, S.sigma, 1.0 if n == 0 else 0.0
    for b in range(blocks(k)):
        if S.slipping[b, 0] > 0.0:
            p = LANES * b
            if n > 0:
                s = product(line, S.slip, g, p, n)
                s = multiply(s, load(S.over, p))
                store(g, n * line + p, multiply(same(-1.0), s))
            for l in range(LANES):
                total += S.braking[b, l] * g[n, b, l]
    store(rate, n * line, same(total))
    if n == 0:
        s = same(1.0 / total)
    else:
        s = multiply(same(-sigma[0, 0, 0]), product(line, rate, sigma, 0, n))
    store(sigma, n * line, s)


@inlined
def _answer(k, closed, work, n):
    """Write order `n` of the velocities: W times the impulses of the closed contacts."""
    S, columns, slot = work.series, work.series.columns, work.closed
    line = S.depth.shape[1] * LANES
    row, b0 = 3 * line, n * line  # `row`: length of a column of W
    for b in range(blocks(k)):
        p = LANES * b
        un, u1, u2 = same(0.0), same(0.0), same(0.0)
        for a in range(closed):
            i = slot[a]
            at = 3 * i * row + p
            for r in range(3):
                x = same(S.P[r, n, i // LANES, i % LANES])
                un = add(un, multiply(x, load(columns, at)))
                u1 = add(u1, multiply(x, load(columns, at + line)))
                u2 = add(u2, multiply(x, load(columns, at + 2 * line)))
                at += row
        store(S.u[0], b0 + p, un)
        store(S.u[1], b0 + p, u1)
        store(S.u[2], b0 + p, u2)


@kernel
def _hold(k, z, work, n):
    """Add the friction of stick to order `n`."""
    S, impulse, velocity = work.series, work.more_impulse, work.more_velocity
    for i in range(k):
        for r in range(3):
            impulse[3 * i + r] = S.P[r, n, i // LANES, i % LANES]
            velocity[3 * i + r] = S.u[r, n, i // LANES, i % LANES]
    stick(k, z, work, impulse, velocity)
    for i in range(k):
        for r in range(3):
            S.P[r, n, i // LANES, i % LANES] = impulse[3 * i + r]
            S.u[r, n, i // LANES, i % LANES] = velocity[3 * i + r]
