"""The contact problem with a full matrix W: `solve_cones`."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction import layout as o
from carom.friction.layout import BAD_PROBLEM, DISC, NOT_SOLVED, SOLVED
from carom.friction.local import prepare, solve_local
from carom.friction.one_contact import upper_triangle
from carom.friction.residual import measure
from carom.friction.strategy import search


@entry
def solve_cones(k, problem, p, workspace):
    """Solve w = W p + c, 0 <= p_n _|_ w_n >= 0 with Coulomb friction; return (status, residual, iterations).

    `problem` is a `ContactProblem` of K >= k contacts, `p` (3K,) the first guess and then the solution,
    `workspace` from `layout.new_contact_work(K)`. Contacts of the kind STICKING have any tangential impulse,
    even if p_n = 0. Status: SOLVED; NOT_SOLVED, p is the best result found; BAD_PROBLEM, p is 0. The residual
    is that of `residual.measure`.
    """
    if k == 0:
        return SOLVED, 0.0, 0
    gamma = _load(workspace, k, problem, p)
    if not math.isfinite(gamma):
        for i in range(3 * k):
            p[i] = 0.0
        return BAD_PROBLEM, math.inf, 0
    iterations, q = 0, workspace.vector[o.ITERATE]
    if k == 1:
        alone, b = upper_triangle(workspace.W), workspace.vector[o.BIAS]
        _, q[0], q[1], q[2] = solve_local(workspace.contact[0], alone, (b[0], b[1], b[2]))
    else:
        search(workspace, k)
        iterations = workspace.count[o.ITERATIONS]
    for i in range(3 * k):
        p[i] = gamma * workspace.contact[i // 3].scale * q[i]
    residual, tolerance, _, _, _ = measure(k, problem, p)
    return SOLVED if residual <= tolerance else NOT_SOLVED, residual, iterations


@kernel
def _load(work, k, problem, p):
    """Write the problem in scaled variables; return gamma, or NaN if the input is bad.

    p_i = gamma s_i q_i, w_i = gamma v_i / s_i with s_i^2 = 3 / trace W_ii, so that each diagonal block
    has trace 3, and gamma such that the greatest entry of the scaled c is 1. The three rows of a contact
    have one scale, so that its cone does not change. Units and ratios of masses have no effect on the solver.
    """
    W, kind, heading, total = problem.W, problem.kind, problem.heading, 0.0
    for i in range(k):
        n = 3 * i
        trace = W[n, n] + W[n + 1, n + 1] + W[n + 2, n + 2]
        along = (heading[i, 0], heading[i, 1])
        if not set_contact(work.contact[i], problem.mu[i], kind[i], along, trace):
            return math.nan
    for i in range(3 * k):
        s = work.contact[i // 3].scale
        row, out = W[i], work.W[i]
        for j in range(3 * k):
            out[j] = s * row[j] * work.contact[j // 3].scale
            total += out[j]
    if not math.isfinite(total):
        return math.nan
    gamma = scale_vectors(work, k, problem.c, p)
    for i in range(k):
        if kind[i] == DISC:  # its radius is an impulse
            work.contact[i].h1 /= gamma * work.contact[i].scale
    return gamma


@kernel
def set_contact(contact, mu, kind, heading, trace):
    """Write the data of a contact and its scale; return whether they are valid."""
    contact.mu, contact.kind, contact.h1, contact.h2 = mu, kind, heading[0], heading[1]
    contact.scale = math.sqrt(3.0 / trace) if trace > 0.0 else 1.0
    return mu >= 0.0 and math.isfinite(mu + heading[0] + heading[1] + trace)


@kernel
def scale_link(link, contact, mu, kind, heading):
    """Add the products of rows and responses to `local`; scale all; return whether the contact is valid."""
    local = link.local
    for side in range(2):
        if link.body[side] < 0:
            continue
        G, Y, at = link.rows[side], link.response[side], 0
        for a in range(3):
            for d in range(a, 3):
                for j in range(6):
                    local[at] += G[a, j] * Y[j, d]
                at += 1
    if not set_contact(contact, mu, kind, heading, local[0] + local[3] + local[5]):
        return False
    for r in range(6):
        local[r] *= contact.scale * contact.scale
    prepare(link)
    for side in range(2):
        for r in range(6 if link.body[side] >= 0 else 0):
            for a in range(3):
                link.rows[side, a, r] *= contact.scale
                link.response[side, r, a] *= contact.scale
    return True


@kernel
def inverse_mass_of(link, contact, W):
    """Write the block W (3, 3) of a contact whose link is scaled."""
    at = 0
    for a in range(3):
        for b in range(a, 3):
            W[a, b] = W[b, a] = link.local[at] / (contact.scale * contact.scale)
            at += 1


@kernel
def scale_vectors(work, k, c, p):
    """Write c and p in scaled variables; return gamma, or NaN if c is not finite."""
    gamma = 0.0
    for i in range(3 * k):
        scaled = work.contact[i // 3].scale * c[i]
        work.vector[o.BIAS, i] = scaled
        if not math.isfinite(scaled):
            return math.nan
        gamma = max(gamma, abs(scaled))
    if gamma == 0.0:
        gamma = 1.0
    for i in range(3 * k):
        work.vector[o.BIAS, i] /= gamma
        q = p[i] / (work.contact[i // 3].scale * gamma)
        work.vector[o.ITERATE, i] = q if math.isfinite(q) else 0.0
    return gamma
