"""Random impacts whose W has rank 1 to 3 or nearly so, and what must hold of any of them."""

import numpy as np

from carom.impact import layout as o
from carom.impact.resolve import resolve

EPS = np.finfo(float).eps


def draw(rng, n):
    """Return W (n, 3, 3), u, mu, e, law of n impacts, and whether W is singular and u in its range.

    A sixth each: rank 1, rank 2, regular, eigenvalues of 1e-6 to 1e-17 with u of finite energy and with any
    u, and rank 1 to 3 in badly scaled axes. Friction up to 1000, a tenth within round-off of what is critical.
    """
    kind = rng.integers(6, size=n)
    turn = np.linalg.qr(rng.normal(size=(n, 3, 3)))[0]
    part = np.ones((n, 3))
    part[kind == 0, 1:] = 0.0
    part[kind == 1, 2] = 0.0
    thin = (kind == 3) | (kind == 4)
    part[thin, 2] = 10.0 ** -rng.uniform(6, 17, thin.sum())
    part[thin, 1] = 10.0 ** -rng.choice([0.0, 1.5, 8.0, 12.0], thin.sum())
    part[~thin] *= rng.uniform(0.05, 2.0, ((~thin).sum(), 3))
    A = turn * np.sqrt(part)[:, None]
    bad = kind == 5
    A[bad] = 10.0 ** rng.uniform(-3, 3, (bad.sum(), 3, 1)) * rng.normal(size=(bad.sum(), 3, 3))
    rank = rng.integers(1, 4, n)
    A[bad & (rank < 3), :, 2] = 0.0
    A[bad & (rank < 2), :, 1] = 0.0
    flat = (rng.random(n) < 0.2) & (kind < 2)  # planar: nothing in the second tangent
    A[flat, 2] = 0.0
    W = A @ A.transpose(0, 2, 1)
    u = np.einsum("nij,nj->ni", A, rng.normal(size=(n, 3)))
    u[kind == 4] = rng.normal(size=((kind == 4).sum(), 3))
    u *= -np.sign(u[:, :1])
    mu = rng.choice([0.0, 0.3, 1.0, 3.0, 30.0, 1000.0], n) * rng.uniform(0, 1, n) ** rng.integers(
        2, size=n
    )
    tau = np.einsum("nij,nj->ni", np.linalg.pinv(W[:, 1:, 1:], 1e-10), W[:, 1:, 0])
    edge = rng.random(n) < 0.1
    offset = 1.0 + rng.choice([0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-6, -1e-6], n)
    mu = np.where(edge, np.hypot(*tau.T) * offset, mu)
    e = rng.choice([0.0, 1.0, 1e-6, 0.5, 0.9], n)
    keeps = W[:, 0, 0] > 0.0
    sound = np.isin(kind, (0, 1)) & keeps
    return W[keeps], u[keeps], mu[keeps], e[keeps], rng.integers(3, size=n)[keeps], sound[keeps]


def resolve_all(W, u, mu, e, law):
    """Return the codes (n,) and the results (n, SIZE)."""
    out = np.zeros((len(u), o.SIZE))
    code = [resolve(*one) for one in zip(W, u, mu.tolist(), e.tolist(), law.tolist(), out)]
    return np.array(code), out


def least_in_cone(W, mu):
    """Return the least z.W z of z = (1, tau), |tau| <= mu: one disc, in the principal axes of W_tt."""
    b, V = np.linalg.eigh(W[:, 1:, 1:])
    b = np.maximum(b, 0.0)
    a = np.einsum("nij,ni->nj", V, W[:, 1:, 0])
    high = np.linalg.norm(a, axis=1) / np.maximum(mu, 1e-100) + 1e-150
    low = 1e-40 * high
    for _ in range(70):  # |(b + alpha)^-1 a| falls with alpha; bisected in the exponent
        middle = np.sqrt(low * high)
        over = np.linalg.norm(a / (b + middle[:, None]), axis=1) > mu
        low, high = np.where(over, middle, low), np.where(over, high, middle)
    tau = -a / (b + high[:, None])
    tau *= np.minimum(1.0, mu / np.maximum(np.linalg.norm(tau, axis=1), 1e-300))[:, None]
    return W[:, 0, 0] + np.sum(2.0 * a * tau + b * tau**2, axis=1)


def unit(v):
    """Return the directions of v (n, 2)."""
    return v / np.maximum(np.linalg.norm(v, axis=1), 1e-300)[:, None]


def follow(W, u, mu, p, steps, speed):
    """Return u (n, 3), P_t (n, 2) and the work of the normal force after the impulse p (n,), independently.

    Fixed steps: where friction can bring u_t to rest within the step it does, by projection; else it acts
    against u_t at the middle of the step. Rest is judged by `speed` (n,).
    """
    u, dp = u.copy(), p / steps
    B, a = W[:, 1:, 1:], W[:, 1:, 0]
    inverse = np.linalg.pinv(B, 1e-10)
    P, work = np.zeros((len(u), 2)), np.zeros(len(u))
    for _ in range(steps):
        free = u[:, 1:] + a * dp[:, None]
        rest = -np.einsum("nij,nj->ni", inverse, free)
        left = free + np.einsum("nij,nj->ni", B, rest)
        most = (mu * dp)[:, None]
        sticks = (np.linalg.norm(rest, axis=1) <= mu * dp * (1 + 1e-9)) & (
            np.linalg.norm(left, axis=1) <= 1e-9 * speed
        )
        slow = np.linalg.norm(u[:, 1:], axis=1) <= 1e-300
        first = -most * unit(np.where(slow[:, None], -rest, u[:, 1:]))
        middle = u[:, 1:] + 0.5 * (a * dp[:, None] + np.einsum("nij,nj->ni", B, first))
        T = np.where(sticks[:, None], rest, -most * unit(middle))
        change = W[:, :, 0] * dp[:, None] + np.einsum("nij,nj->ni", W[:, :, 1:], T)
        work += dp * (u[:, 0] + 0.5 * change[:, 0])
        u, P = u + change, P + T
    return u, P, work
