"""The contact problem of a crowd by alternating directions: one linear system, then projection onto the cones.

Two copies of the impulses, p without the cones and z in the cones, are made equal by u (scaled):

    (W + rho) p = rho (z - u) - c - s,   z = project(p' + u),   u = u + p' - z,   p' = a p + (1 - a) z,

with the projection on the cones, and s = mu |w_t| of the normal rows (de Saxce), w_t = -rho u_t (ADMM: Boyd et
al. 2011). W + rho is factored once, and an iteration costs little more than a sweep. The order of contacts has
no effect. The method is slow, but it comes near a solution where sweeps and steps of Newton's method do not: if
a wall is struck at 3 m/s and bricks are wedged, with impulses a hundred times those of a free impact, these
leave a residual of .1 m/s, and a thousand iterations of this method 1e-6.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction import layout as o
from carom.friction.cone import nearest, shift
from carom.friction.island import factor_shifted, solve_shifted
from carom.friction.newton import copy
from carom.friction.residual import residual
from carom.friction.thresholds import RELAXATION

UNCHECKED_ITERATIONS = 25  # iterations between two checks of the residual


@kernel
def alternate(work, k, rho, tolerance, at_least, most):
    """Iterate from the present impulses until the scaled residual is small; return it, and the iterations.

    `at_least` iterations are made, and more, up to `most`, while as many again halve the residual. `rho` is
    relative to the mean of the diagonal of W. The best impulses are returned.
    """
    z, u, best = work.vector[o.ITERATE], work.vector[o.CENTRE], work.vector[o.START_BEST]
    least, goal, _ = residual(work, k)
    copy(k, z, best)
    begin(work, k, rho)
    factor_shifted(work, k, rho)
    done, before = 0, least
    while not least <= max(tolerance, goal) and done < most:
        if done > 0 and done % at_least == 0:
            if not least < 0.5 * before:
                break
            before = least
        for _ in range(UNCHECKED_ITERATIONS):
            iterate(work, k, rho, z, u)
        done += UNCHECKED_ITERATIONS
        r, goal, _ = residual(work, k)
        if r < least:
            least = r
            copy(k, z, best)
    copy(k, best, z)
    return least, done


@kernel
def begin(work, k, rho):
    """Write u from the present velocities."""
    u, w = work.vector[o.CENTRE], work.vector[o.RESULTING]
    for i in range(k):
        n = 3 * i
        t = work.contact[i]
        s = shift((t.kind, t.mu, t.h1, t.h2), w[n + 1], w[n + 2])
        u[n], u[n + 1], u[n + 2] = -(w[n] + s) / rho, -w[n + 1] / rho, -w[n + 2] / rho


@kernel
def iterate(work, k, rho, z, u):
    """Make one iteration."""
    x, c = work.vector[o.RHS], work.vector[o.BIAS]
    for i in range(k):
        n, t = 3 * i, work.contact[i]
        s = rho * shift((t.kind, t.mu, t.h1, t.h2), u[n + 1], u[n + 2])
        x[n] = rho * (z[n] - u[n]) - c[n] - s
        x[n + 1] = rho * (z[n + 1] - u[n + 1]) - c[n + 1]
        x[n + 2] = rho * (z[n + 2] - u[n + 2]) - c[n + 2]
    solve_shifted(work, k)
    for i in range(k):
        n, t = 3 * i, work.contact[i]
        x0 = z[n] + u[n] + RELAXATION * (x[n] - z[n])
        x1 = z[n + 1] + u[n + 1] + RELAXATION * (x[n + 1] - z[n + 1])
        x2 = z[n + 2] + u[n + 2] + RELAXATION * (x[n + 2] - z[n + 2])
        z[n], z[n + 1], z[n + 2] = y = nearest((t.kind, t.mu, t.h1, t.h2), x0, x1, x2)
        u[n], u[n + 1], u[n + 2] = x0 - y[0], x1 - y[1], x2 - y[2]
