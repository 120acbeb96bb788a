"""Moreau-Jean time stepping for one body and one contact (Moreau 1988, Jean 1999).

Events are not located: an impact is part of a step of length h. With v = (xdot world, W body axes)::

    M (v+ - v) = h (theta f+ + (1 - theta) f) + G^T P
    active if gap(q + h/2 v) <= 0:   0 <= u_n+ + e min(u_n, 0)  _|_  P_n >= 0 ,  Coulomb on u_t+
    q+ = Exp_q(h (theta v+ + (1 - theta) v)) ,       u = G v ,  G at the predicted position q + h/2 v

With impacts the method has order 1 in time, because an impact belongs to the whole step. It allows penetrations
of order h.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom import checks
from carom.baselines._body import OneBody, contact_jacobian, lowest_point, read_scene
from carom.baselines.one_contact import solve_one_contact
from carom.geometry import quaternion

MOST_STEPS = 1e6  # greatest number of steps of a run, which is in plain Python


@dataclass(frozen=True)
class MoreauJeanRun:
    """Motion computed by `moreau_jean`; field names, shapes and axes are those of `Solution`.

    Parameters
    ----------
    t : (T,) array
        Times [s].
    position, velocity, angular_velocity : (T, 1, 3) arrays
        Mass centre [m], its velocity [m/s], angular velocity [rad/s]; all in world axes.
    orientation : (T, 1, 4) array
        Unit quaternions (w, x, y, z), body to world.
    gap : (T,) array
        Distance of the lowest point from the half-space [m]; negative where it penetrates.
    impulse : (T, 3) array
        Impulse of the step that ends at t, in contact axes: normal, tangent 1, tangent 2 [N s].
    kinetic_energy, potential_energy, total_energy : (T,) arrays
        Energies [J]; the potential is zero at the world's origin.
    """

    t: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    gap: np.ndarray
    impulse: np.ndarray
    kinetic_energy: np.ndarray
    potential_energy: np.ndarray
    total_energy: np.ndarray


def moreau_jean(scene, duration, *, step, theta=0.5) -> MoreauJeanRun:
    """Run a scene of one body and one contact by the Moreau-Jean theta-scheme.

    Parameters
    ----------
    scene : Scene
        One body, one half-space and one contact; no joints, and no forces except gravity. The coefficient of
        restitution of the contact is used in Newton's law, whatever its impact law is.
    duration, step : float
        Duration of the run and time step [s], at most a million steps; the last step is shortened to end at
        `duration`.
    theta : float
        Weight of the end of the step, in [0.5, 1]. Default 0.5, which has order 2 in free motion.

    Returns
    -------
    MoreauJeanRun
        The motion.

    Raises
    ------
    ValueError
        If the scene has more than one body or contact, or an argument is out of range.
    """
    end = checks.number("duration", duration, least=0.0, unit="s")
    h_all = checks.number("step", step, above=0.0, unit="s")
    theta = checks.number("theta", theta, least=0.5, most=1.0)
    count = checks.steps(end, h_all, MOST_STEPS)
    system, body = read_scene(scene)
    x = np.array(body.position, dtype=np.float64)
    Q = np.array(body.orientation, dtype=np.float64)
    R = quaternion.matrix(Q)
    v = np.array([*body.velocity, *(R.T @ np.asarray(body.angular_velocity, dtype=np.float64))])
    inverse = np.zeros((6, 6))
    inverse[:3, :3] = np.eye(3) / system.mass
    inverse[3:, 3:] = np.linalg.inv(system.inertia)

    t, saved = 0.0, [(0.0, x, Q, v, np.zeros(3))]
    for number in range(1, count + 1):
        t1 = min(number * h_all, end)
        h = t1 - t
        x, Q, v, p = _step(system, inverse, x, Q, v, h, theta)
        t = t1
        saved.append((t, x, Q, v, p))
    return _run(system, saved)


def _step(system: OneBody, inverse, x, Q, v, h, theta):
    """Return x, Q, v and the contact impulse after one step."""
    v1 = np.array([*(v[:3] + h * system.gravity), *_free_spin(system.inertia, v[3:], h, theta)])
    p = np.zeros(3)
    x_mid, R_mid = x + 0.5 * h * v[:3], quaternion.matrix(_turned(Q, 0.5 * h * v[3:]))
    gap, arm = lowest_point(system, x_mid, R_mid)
    if gap <= 0.0:
        G = contact_jacobian(system, R_mid, arm)
        c = G @ v1
        c[0] += system.restitution * min(0.0, G[0] @ v)
        p = solve_one_contact(G @ inverse @ G.T, c, system.friction)
        v1 = v1 + inverse @ (G.T @ p)
    mean = theta * v1 + (1.0 - theta) * v
    return x + h * mean[:3], _turned(Q, h * mean[3:]), v1, p


def _free_spin(J, W, h, theta):
    """Solve ``J (W+ - W) = -h (theta W+ x J W+ + (1 - theta) W x J W)`` for W+ by Newton's method."""
    start = J @ W - h * (1.0 - theta) * np.cross(W, J @ W)
    W1 = W
    for _ in range(20):
        L = J @ W1
        residual = L + h * theta * np.cross(W1, L) - start
        slope = J + h * theta * (np.cross(W1, J, axisb=0).T - np.cross(L, np.eye(3)).T)
        change = np.linalg.solve(slope, residual)
        W1 = W1 - change
        if np.abs(change).max() <= 1e-14 * np.abs(W1).max():
            break
    return W1


def _turned(Q, angle):
    """Return the quaternion Q after a rotation by a vector in body axes."""
    return quaternion.normalize(quaternion.multiply(Q, quaternion.exp(angle)))


def _run(system: OneBody, saved) -> MoreauJeanRun:
    """Return the saved states in the shapes of a solution, with gap and energies."""
    t, x, Q, v, p = (np.array(column) for column in zip(*saved))
    R = quaternion.matrix(Q)
    W = v[:, 3:]
    kinetic = 0.5 * system.mass * (v[:, :3] ** 2).sum(axis=1)
    kinetic = kinetic + 0.5 * np.einsum("ti,ij,tj->t", W, system.inertia, W)
    potential = -system.mass * x @ system.gravity
    return MoreauJeanRun(
        t=t,
        position=x[:, None],
        orientation=Q[:, None],
        velocity=v[:, None, :3],
        angular_velocity=np.einsum("tij,tj->ti", R, W)[:, None],
        gap=np.array([lowest_point(system, a, b)[0] for a, b in zip(x, R)]),
        impulse=p,
        kinetic_energy=kinetic,
        potential_energy=potential,
        total_energy=kinetic + potential,
    )
