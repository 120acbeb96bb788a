"""A linear system that may be singular, by corrections with the factor of a regular one near it.

    A x = r,    z = (A + eps S)^-1 r,

each z made of what the present error r asks for. They are taken in the combination of least error (generalised
conjugate residuals; Eisenstat, Elman and Schultz 1983), so that slow ones, of a heavy body on a light one, do
not add up by their number. Where rows depend on each other and do not fit, each z has the same part that
changes nothing, and grows like 1/eps: it is removed, and the error stays. The same holds for rows that fit only
by a multiple `MULTIPLE` of z: they differ by the error of a stage (two ends of links that touch a box
at the joint between them), and forces that large are those of the error, not of the contact.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction import lu
from carom.persistent.by_bodies import knows_arms, multiply_by_bodies, solve_by_bodies
from carom.persistent.thresholds import MULTIPLE, REMOVED

CORRECTIONS = 30


@kernel
def settle(n, held, enough, small, force, equations):
    """Solve A x = r with the factor of A + eps S; return the greatest error left, which r becomes.

    `held` corrections of the first r are in the solution already. An error below `small` asks for no entry of x
    above `force`: the rows have it.
    """
    x, r, Z, part = equations.x, equations.r, equations.directions, equations.part
    size, first, room = greatest(n, r), 0, Z.shape[0] // 2
    for i in range(n):
        x[i] = 0.0
    for turn in range(CORRECTIONS):
        if size <= enough and turn > 0:
            break
        first = turn if turn - first == room else first  # no room for more directions
        z, q = Z[2 * (turn - first)], Z[2 * (turn - first) + 1]
        correct(n, equations, z)
        part[turn - first] = 1.0
        multiply(n, equations, z, q)
        for j in range(turn - first):
            c = dot(n, Z[2 * j + 1], q)
            part[turn - first] -= c * part[j]
            for i in range(n):
                z[i], q[i] = z[i] - c * Z[2 * j, i], q[i] - c * Z[2 * j + 1, i]
        square, whole, along = 0.0, 0.0, 0.0
        for i in range(n):
            square += q[i] * q[i]
            whole += r[i] * r[i]
            along += q[i] * r[i]
        length = math.sqrt(square)
        along = along / length if length > 0.0 else 0.0
        removes = along * along > REMOVED * REMOVED * whole and abs(along) <= MULTIPLE * length
        removes = removes and not (size <= small and abs(along) * greatest(n, z) > length * force)
        if not removes:
            correct(n, equations, z)
            for i in range(n):
                x[i] -= held * z[i]
            break
        part[turn - first] /= length
        held += along * part[turn - first]
        for i in range(n):
            z[i], q[i] = z[i] / length, q[i] / length
            x[i], r[i] = x[i] + along * z[i], r[i] - along * q[i]
        size = greatest(n, r)
    return size


@kernel
def correct(n, equations, z):
    """Write z = (A + eps S)^-1 r."""
    for i in range(n):
        z[i] = equations.r[i]
    solve_regular(n, equations, z)


@kernel
def solve_regular(n, equations, x):
    """Replace x by the solution of (A + eps S) x = x, with the present factor."""
    if knows_arms(equations):
        solve_by_bodies(n, equations.rows, equations, x)
    else:
        lu.substitute(equations.factor, n, equations.pivot, x)


@kernel
def multiply(n, equations, z, q):
    """Write q = A z, four rows at a time: a sum waits for its last term, four do not wait for each other."""
    if knows_arms(equations):
        multiply_by_bodies(n, equations.rows, equations, z, q)
        return
    A = equations.A
    whole = n - n % 4
    for i in range(0, whole, 4):
        a0, a1, a2, a3 = A[i], A[i + 1], A[i + 2], A[i + 3]
        s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
        for j in range(n):
            s0, s1 = s0 + a0[j] * z[j], s1 + a1[j] * z[j]
            s2, s3 = s2 + a2[j] * z[j], s3 + a3[j] * z[j]
        q[i], q[i + 1], q[i + 2], q[i + 3] = s0, s1, s2, s3
    for i in range(whole, n):
        q[i] = dot(n, A[i], z)


@kernel
def dot(n, a, b):
    """Return the product of two vectors."""
    return add_product(0.0, n, a, b)


@kernel
def add_product(total, n, a, b):
    """Return a number plus the product of two vectors."""
    for i in range(n):
        total += a[i] * b[i]
    return total


@kernel
def greatest(n, a):
    """Return the greatest entry of a vector; NaN if it has one."""
    most = 0.0
    for i in range(n):
        if not abs(a[i]) <= most and most == most:
            most = abs(a[i])
    return most
