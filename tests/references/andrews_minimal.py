"""Andrews' mechanism by its published minimal equations, index reduced, by scipy.

``M(q) qdd + G(q)^T lambda = f(q, qd)``, ``g(q) = 0``: the 7 equations of the IVP test set as they
are published, not derived from the absolute model, whose mass matrix is checked against them. The
second derivative of g closes the system; the drift is taken out of the state by projection.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from references.andrews import PARAMETERS, _c, _s, closures

P = PARAMETERS["params"]


def mass(q):
    """Return the published mass matrix (7, 7)."""
    p, theta, phi, omega = P, q[1], q[3], q[5]
    ee, ff = p["e"] - p["ea"], p["zf"] - p["fa"]
    M = np.zeros((7, 7))
    M[0, 0] = (
        p["m1"] * p["ra"] ** 2
        + p["m2"] * (p["rr"] ** 2 - 2 * p["da"] * p["rr"] * np.cos(theta) + p["da"] ** 2)
        + p["i1"] + p["i2"]
    )  # fmt: skip
    M[0, 1] = p["m2"] * (p["da"] ** 2 - p["da"] * p["rr"] * np.cos(theta)) + p["i2"]
    M[1, 1] = p["m2"] * p["da"] ** 2 + p["i2"]
    M[2, 2] = p["m3"] * (p["sa"] ** 2 + p["sb"] ** 2) + p["i3"]
    M[3, 3] = p["m4"] * ee**2 + p["i4"]
    M[3, 4] = p["m4"] * (ee**2 + p["zt"] * ee * np.sin(phi)) + p["i4"]
    M[4, 4] = (
        p["m4"] * (p["zt"] ** 2 + 2 * p["zt"] * ee * np.sin(phi) + ee**2)
        + p["m5"] * (p["ta"] ** 2 + p["tb"] ** 2) + p["i4"] + p["i5"]
    )  # fmt: skip
    M[5, 5] = p["m6"] * ff**2 + p["i6"]
    M[5, 6] = p["m6"] * (ff**2 - p["u"] * ff * np.sin(omega)) + p["i6"]
    M[6, 6] = (
        p["m6"] * (ff**2 - 2 * p["u"] * ff * np.sin(omega) + p["u"] ** 2)
        + p["m7"] * (p["ua"] ** 2 + p["ub"] ** 2) + p["i6"] + p["i7"]
    )  # fmt: skip
    return M + np.triu(M, 1).T


def force(q, v):
    """Return the published force (7,)."""
    p = P
    _, theta, gamma, phi, _, omega, _ = q
    bep, thp, _, php, dep, omp, epp = v
    sg, cg = np.sin(gamma), np.cos(gamma)
    x, y = p["sd"] * cg + p["sc"] * sg + p["xb"], p["sd"] * sg - p["sc"] * cg + p["yb"]
    length = np.hypot(x - p["xc"], y - p["yc"])
    pull = -p["c0"] * (length - p["l0"]) / length
    fx, fy = pull * (x - p["xc"]), pull * (y - p["yc"])
    ee, ff = p["e"] - p["ea"], p["zf"] - p["fa"]
    two, four, six = p["m2"] * p["da"] * p["rr"], p["m4"] * p["zt"] * ee, p["m6"] * p["u"] * ff
    return np.array(
        [
            p["mom"] - two * thp * (thp + 2 * bep) * np.sin(theta),
            two * bep**2 * np.sin(theta),
            fx * (p["sc"] * cg - p["sd"] * sg) + fy * (p["sd"] * cg + p["sc"] * sg),
            four * dep**2 * np.cos(phi),
            -four * php * (php + 2 * dep) * np.cos(phi),
            -six * epp**2 * np.cos(omega),
            six * omp * (omp + 2 * epp) * np.cos(omega),
        ]
    )


def jacobian(q):
    """Return dg/dq (6, 7); c' = -s and s' = c."""
    p, (beta, theta, gamma, phi, delta, omega, epsilon) = P, q
    G = np.zeros((3, 2, 7))
    G[:, :, 1] = p["d"] * _s(beta + theta)
    G[:, :, 0] = G[:, :, 1] - p["rr"] * _s(beta)
    G[0, :, 2] = -p["ss"] * _c(gamma)
    G[1, :, 3] = -p["e"] * _c(phi + delta)
    G[1, :, 4] = G[1, :, 3] + p["zt"] * _s(delta)
    G[2, :, 5] = p["zf"] * _s(omega + epsilon)
    G[2, :, 6] = G[2, :, 5] - p["u"] * _c(epsilon)
    return G.reshape(6, 7)


def accelerations(q, v):
    """Return qdd from ``[M G^T; G 0] (qdd, lambda) = (f, -Gdot qd)``."""
    G = jacobian(q)
    turned = (jacobian(q + 1e-7 * v) - jacobian(q - 1e-7 * v)) / 2e-7 if np.any(v) else 0.0 * G
    left = np.block([[mass(q), G.T], [G, np.zeros((6, 6))]])
    return np.linalg.solve(left, np.concatenate([force(q, v), -turned @ v]))[:7]


def integrate(duration, rtol=1e-11):
    """Return q and qd at `duration`; their drift off the constraints is projected away."""
    q, v = np.array(PARAMETERS["q0"]), np.zeros(7)
    pieces = 60
    for _ in range(pieces):
        run = solve_ivp(
            lambda t, y: np.concatenate([y[7:], accelerations(y[:7], y[7:])]),
            (0.0, duration / pieces), [*q, *v], "DOP853", rtol=rtol, atol=1e-12,
        )  # fmt: skip
        q, v = run.y[:7, -1], run.y[7:, -1]
        for _ in range(2):
            q = q - np.linalg.lstsq(jacobian(q), closures(q), rcond=None)[0]
        G = jacobian(q)
        v = v - np.linalg.lstsq(G, G @ v, rcond=None)[0]
    return q, v
