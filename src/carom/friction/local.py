"""One contact of any kind, with fixed impulses of the others: the step of a Gauss-Seidel sweep."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction.layout import CONE, DISC, SLIDING
from carom.friction.one_contact import basis_of, solve_in_basis, solve_one
from carom.friction.rays import solve_tangential
from carom.friction.thresholds import NORMAL_PART


@kernel
def solve_local(contact, W, c):
    """Return (found, p_n, p_1, p_2) of w = W p + c; W is an upper triangle (W_nn, W_n1, W_n2, W_11, ...)."""
    if contact.kind == CONE:
        return solve_one(W, c, contact.mu)
    return solve_other(contact, W, c)


@kernel
def solve_prepared(contact, link, c):
    """Solve as `solve_local` does, with the stored eigenbasis of W, as sweeps use the same W many times."""
    row, basis = link.local, link.basis
    W = (row[0], row[1], row[2], row[3], row[4], row[5])
    d = (basis[0], basis[1], basis[2], basis[3])
    if contact.kind == CONE:
        return solve_in_basis(W, d, c, contact.mu)
    if contact.kind == DISC:
        flat = (1.0, 0.0, 0.0, row[3], row[4], row[5])
        return solve_in_basis(flat, d, (-contact.h1, c[1], c[2]), 1.0)
    return solve_other(contact, W, c)


@kernel
def prepare(link):
    """Write the eigenbasis of W of a contact, or of the disc of a torque, which has no normal row."""
    row, basis = link.local, link.basis
    W = row[0] if row[0] > 0.0 else 1.0, row[1], row[2], row[3], row[4], row[5]
    basis[0], basis[1], basis[2], basis[3] = basis_of(W)


@kernel
def solve_other(contact, W, c):
    """Solve a contact of a kind other than CONE."""
    kind, mu = contact.kind, contact.mu
    w00, w01, w02, w11, w12, w22 = W
    c0, c1, c2 = c
    if kind == DISC:
        return solve_one((1.0, 0.0, 0.0, w11, w12, w22), (-contact.h1, c1, c2), 1.0)
    if kind == SLIDING:
        h1, h2 = contact.h1, contact.h2
        if c0 >= 0.0:
            return True, 0.0, 0.0, 0.0
        d = w00 - mu * (w01 * h1 + w02 * h2)
        if not d > 0.0:  # the normal force with friction makes the bodies approach: a jam
            return False, 0.0, 0.0, 0.0
        n = -c0 / d
        return True, n, -mu * n * h1, -mu * n * h2
    # Sticking: eliminate the tangents, then solve the normal.
    a1, a2 = solve_tangential(w11, w12, w22, w01, w02)
    b1, b2 = solve_tangential(w11, w12, w22, c1, c2)
    d = w00 - w01 * a1 - w02 * a2
    g = c0 - w01 * b1 - w02 * b2
    n = 0.0
    if g < 0.0 and d > NORMAL_PART * w00:
        n = -g / d
    return True, n, -b1 - a1 * n, -b2 - a2 * n
