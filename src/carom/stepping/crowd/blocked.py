"""Whether prescribed motions press the bodies of a crowd together, so that no motion is possible.

Without impulses the normals close by h faster than their gaps allow. By Farkas' lemma no velocities that the
joints and motors allow keep the points apart if and only if there are normal impulses that move nothing and
oppose it:

    lambda >= 0,    W lambda = 0,    h . lambda > 0,    W = G P G^T.

These bring lambda . W lambda + (1 - h . lambda)^2 to 0. Its least value is sought by conjugate gradients on the
points that press, which are changed where the gradient asks for it (Dostal 1997, with the proportioning and the
step of Dostal and Schoeberl 2005). Friction does not enter, because it forbids no velocity.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction import layout as o
from carom.friction.operators import multiply
from carom.impact.driven import free_inverse_mass
from carom.model.parts_of_system import has_relation_rows
from carom.model.workspace import MOTION_POINT
from carom.stepping import thresholds as limits
from carom.stepping.crowd.response import velocity_of

MOST_PRODUCTS = 500  # to find impulses that move nothing; a row of forty bodies takes two hundred

# places of vectors that the contact problem does not need after its solution
LACK, IMPULSE, GRADIENT, DIRECTION, PRODUCT = o.RHS, o.BEST, o.F, o.STEP, o.CHANGE


@unit(where=has_relation_rows, otherwise=False)
def blocked(system, k, h, slow, crowd, end) -> bool:
    """Return whether no motion keeps the k points of a piece of length h apart.

    It is asked where the contact problem leaves points that close faster than `slow`. The residual does not
    tell: beside impulses that grow without bound it is round-off.
    """
    work = crowd.problem
    if not closes(system, k, h, slow, crowd, end):
        return False
    lack, x = work.vector[LACK], work.vector[IMPULSE]
    g, p = work.vector[GRADIENT], work.vector[DIRECTION]
    if not write_lack(system, k, h, crowd):
        return False
    trace = dot(k, lack, lack)
    for i in range(k):
        trace += work.link[i].local[0]
        for r in range(3):
            n = 3 * i + r
            x[n], g[n], p[n] = 0.0, -lack[n], 0.0
    for _ in range(MOST_PRODUCTS):
        left = 1.0 - dot(k, lack, x)
        if is_possible(k, left, work):
            return False
        if moves_nothing(system, crowd, k, left):
            return True
        descend(k, 1.0 / trace, work)
    return False


@kernel
def closes(system, k, h, slow, crowd, end):
    """Return whether a point closes at the end of the piece, by more than its gap allows."""
    for i in range(k):
        spot = crowd.closed[i]
        if spot.motion == MOTION_POINT:
            u = velocity_of(system, crowd.points[0][i], crowd, end)[0] + spot.drift[0]
            if u + max(spot.gap, 0.0) / h < -slow:
                return True
    return False


@kernel
def write_lack(system, k, h, crowd):
    """Write by how much the points must open, as parts of the greatest; return whether any must."""
    work, most = crowd.problem, 0.0
    lack = work.vector[LACK]
    for i in range(k):
        spot, n = crowd.closed[i], 3 * i
        lack[n], lack[n + 1], lack[n + 2] = 0.0, 0.0, 0.0
        if spot.motion == MOTION_POINT:
            u = velocity_of(system, crowd.points[0][i], crowd, crowd.flight)[0] + spot.drift[0]
            lack[n] = -work.contact[i].scale * (u + max(spot.gap, 0.0) / h)
            most = max(most, lack[n])
    for i in range(k):
        lack[3 * i] /= most if most > 0.0 else 1.0
    return most > 0.0


@kernel
def dot(k, x, y):
    """Return the product of the normal parts of two vectors."""
    total = 0.0
    for i in range(k):
        total += x[3 * i] * y[3 * i]
    return total


@kernel
def is_possible(k, left, work):
    """Return whether the motion W lambda/(1 - h . lambda) opens each point by what it lacks."""
    gradient = work.vector[GRADIENT]  # W lambda - (1 - h . lambda) h
    for i in range(k):
        if gradient[3 * i] < -limits.POSSIBLE * left:
            return False
    return True


@kernel
def moves_nothing(system, crowd, k, left):
    """Return whether lambda . W lambda is round-off of the same impulses on bodies that are free."""
    work, moved, free = crowd.problem, 0.0, 0.0
    lack, impulse, gradient = work.vector[LACK], work.vector[IMPULSE], work.vector[GRADIENT]
    for i in range(k):
        n, s = 3 * i, work.contact[i].scale
        moved += impulse[n] * (gradient[n] + left * lack[n])
        inverse_mass = s * s * free_inverse_mass(system, crowd.points[0][i])
        free += impulse[n] ** 2 * max(work.link[i].local[0], inverse_mass)
    return moved <= limits.MOVES_NOTHING * free and free > 0.0


@kernel
def descend(k, width, work):
    """Make one step: along conjugate gradients to the first point that stops pressing, or to more points."""
    x, g, p = work.vector[IMPULSE], work.vector[GRADIENT], work.vector[DIRECTION]
    product = work.vector[PRODUCT]
    free, chopped = 0.0, 0.0
    for i in range(k):
        n = 3 * i
        if x[n] > 0.0:
            free += g[n] * min(x[n] / width, g[n])
        else:
            chopped += min(g[n], 0.0) ** 2
    more = chopped > free
    if more:
        for i in range(k):
            n = 3 * i
            p[n] = min(g[n], 0.0) if not x[n] > 0.0 else 0.0
    apply(k, p, product, work)
    inertia, room = dot(k, p, product), math.inf
    length = dot(k, g, p) / inertia if inertia > 0.0 else 0.0
    for i in range(k):
        if p[3 * i] > 0.0:
            room = min(room, x[3 * i] / p[3 * i])
    t = min(length, room)
    for i in range(k):
        n = 3 * i
        x[n], g[n] = max(0.0, x[n] - t * p[n]), g[n] - t * product[n]
    if length > room:  # a step along the gradient, over edges, and a new start
        for i in range(k):
            if x[3 * i] > 0.0:
                x[3 * i] = max(0.0, x[3 * i] - width * g[3 * i])
        apply(k, x, g, work)
        for i in range(k):
            g[3 * i] -= work.vector[LACK, 3 * i]
    conjugate = 0.0
    if not (more or length > room) and inertia > 0.0:
        for i in range(k):
            if x[3 * i] > 0.0:
                conjugate += g[3 * i] * product[3 * i] / inertia
    for i in range(k):
        n = 3 * i
        p[n] = (g[n] if x[n] > 0.0 else 0.0) - conjugate * p[n]


@kernel
def apply(k, x, out, work):
    """Write W x + h (h . x)."""
    lack = work.vector[LACK]
    along = dot(k, lack, x)
    for i in range(3 * k):
        out[i] = along * lack[i]
    multiply(work, k, x, out)
