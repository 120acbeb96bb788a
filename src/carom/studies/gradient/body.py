"""The state of one body and its derivative along free flight.

Tangents are (dx, dtheta, dv, dw) in world axes, 12 numbers, with R -> exp(dtheta) R. In flight the spatial
angular momentum L = R J R^T w is constant, and the change of attitude phi = R^T dtheta satisfies

    dphi/dt = -W x phi - J^-1 (phi x l) + J^-1 R^T dL - J^-1 dJ J^-1 l,    l = R^T L,  W = J^-1 l

(mathematics page, §5.1). With constant equal moments the solution is closed: exp and its differential.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import solve_ivp

from carom.geometry import differential, quaternion

ACCURACY = 1e-12  # relative accuracy of the variational equation
#: components of a symmetric matrix: the indices of each, and its unit change
MOMENTS = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
UNITS = np.zeros((6, 3, 3))
for _k, (_i, _j) in enumerate(MOMENTS.values()):
    UNITS[_k, _i, _j] = UNITS[_k, _j, _i] = 1.0


def hat(a: np.ndarray) -> np.ndarray:
    """Return the matrix of the cross product a x; for columns (3, P) as (3, 3, P)."""
    o = np.zeros_like(a[0])
    return np.array([[o, -a[2], a[1]], [a[2], o, -a[0]], [-a[1], a[0], o]])


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a x b of vectors (3,) or columns (3, P)."""
    if a.ndim < b.ndim:
        a = a[:, None]
    elif b.ndim < a.ndim:
        b = b[:, None]
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


@dataclass(frozen=True, eq=False)
class Moving:
    """A body at a time, with the tangents X (12, P) of its state.

    `inertia` has the principal moments, R (3, 3) turns principal axes to the world; dm (P,), dJ (3, 3, P) and
    dg (3, P) are the changes of mass, of inertia in principal axes, and of gravity.
    """

    t: float
    x: np.ndarray
    R: np.ndarray
    v: np.ndarray
    w: np.ndarray
    X: np.ndarray
    mass: float
    inertia: np.ndarray
    gravity: np.ndarray
    dm: np.ndarray
    dJ: np.ndarray
    dg: np.ndarray

    @property
    def inverse_inertia(self) -> np.ndarray:
        """The inverse inertia R J^-1 R^T (3, 3)."""
        return (self.R / self.inertia) @ self.R.T

    @property
    def momentum(self) -> np.ndarray:
        """The angular momentum L = R J R^T w (3,)."""
        return self.R @ (self.inertia * (self.R.T @ self.w))

    @property
    def spin_rate(self) -> np.ndarray:
        """The rate dw/dt = -I^-1 (w x L) of free flight (3,)."""
        return -self.inverse_inertia @ np.cross(self.w, self.momentum)

    @property
    def d_momentum(self) -> np.ndarray:
        """The change dL of the angular momentum (3, P)."""
        d, w, L = self.X, self.w, self.momentum
        spin = self.R.T @ w
        return (
            cross(d[3:6], L)
            + (self.R * self.inertia) @ (self.R.T @ (d[9:] - cross(d[3:6], w)))
            + self.R @ np.einsum("ijp,j->ip", self.dJ, spin)
        )


def fly(body: Moving, until: float, accuracy: float = ACCURACY) -> Moving:
    """Return the body at the time `until`, in free flight, with its tangents to a relative `accuracy`."""
    h = until - body.t
    if h == 0.0:
        return body
    X = np.empty_like(body.X)
    d = body.X
    X[:3] = d[:3] + h * d[6:9] + 0.5 * h * h * body.dg
    X[6:9] = d[6:9] + h * body.dg
    closed = np.ptp(body.inertia) == 0.0 and not np.any(body.dJ)
    R, w, X[3:6], X[9:] = _turn_closed(body, h) if closed else _turn(body, h, accuracy)
    return replace(
        body, t=until, x=body.x + h * (body.v + 0.5 * h * body.gravity), R=R,
        v=body.v + h * body.gravity, w=w, X=X,
    )  # fmt: skip


def path(body: Moving, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return position (n, 3) and attitude (n, 3, 3) of a free flight at `times`."""
    from carom.kinematics.flight_arrays import torque_free

    h = (times - body.t)[:, None]
    x = body.x + h * (body.v + 0.5 * h * body.gravity)
    Q, w = (np.tile(a, (len(times), 1)) for a in (quaternion.from_matrix(body.R), body.w))
    return x, quaternion.matrix(torque_free(body.inertia, Q, w, times - body.t)[0])


def _turn_closed(body: Moving, h: float):
    """Return attitude, angular velocity and their tangents for equal moments."""
    turn = h * body.w
    step = quaternion.matrix(quaternion.exp(turn))
    d = body.X
    return step @ body.R, body.w, step @ d[3:6] + h * differential.matrix(-turn) @ d[9:], d[9:]


def _turn(body: Moving, h: float, accuracy: float):
    """Return the same for any moments: the motion is in closed form, its variation is integrated."""
    from carom.kinematics.flight_arrays import torque_free

    i, L, dL = 1.0 / body.inertia, body.momentum, body.d_momentum
    unit = np.einsum("i,kij,j->kij", i, UNITS, i)  # J^-1 dJ J^-1

    def rate(_, y):
        Q, phi = y[:4], y[4:].reshape(3, 12)
        R = quaternion.matrix(Q)
        l = R.T @ L
        W = i * l
        forced = np.concatenate([np.zeros((3, 3)), i[:, None] * R.T, -(unit @ l).T], axis=1)
        rates = forced - cross(W, phi) - i[:, None] * cross(phi, l)
        return np.concatenate([0.5 * quaternion.multiply(Q, np.append(0.0, W)), rates.ravel()])

    start = np.zeros((3, 12))
    start[:, :3] = np.eye(3)
    y0 = np.append(quaternion.from_matrix(body.R), start.ravel())
    # phi per unit of dL is of the order h / J, so tolerances have this scale
    size = np.concatenate(
        [np.ones(3), h * i.max() * np.ones(3), h * i.max() * np.linalg.norm(i * L) * np.ones(6)]
    )
    atol = accuracy * np.append(np.ones(4), np.tile(size + 1e-300, 3))
    done = solve_ivp(rate, (0.0, h), y0, method="DOP853", rtol=accuracy, atol=np.abs(atol))
    y = done.y[:, -1]
    Q, w = torque_free(body.inertia, y0[None, :4], body.w[None], np.array([h]))
    R, w = quaternion.matrix(Q[0]), w[0]
    moments = np.array([body.dJ[at] for at in MOMENTS.values()])
    phi = y[4:].reshape(3, 12) @ np.concatenate([body.R.T @ body.X[3:6], dL, moments])
    l = R.T @ L
    change = i[:, None] * (R.T @ dL - cross(phi, l) - np.einsum("ijp,j->ip", body.dJ, i * l))
    return R, w, R @ phi, cross(R @ phi, w) + R @ change
