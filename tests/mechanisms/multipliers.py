"""The paper's second-order multipliers, from a finished run: NumPy, dense, for reports and tests.

Each constraint row a^R has a direction of motion c_R in which only this row is violated,

    c_R = M^-1 a^R / (a^R M^-1 a^R),     a^R(c_R) = 1,

and its multiplier lambda^R is a coordinate along it (paper, Eqs. (4)-(7)). Newton's law contracted
with c_R is the equation of that one-dimensional motion; its right-hand side is the reaction,

    h_R = (m_RR mu)' + c_RR mu + k_RR lambda - f_R,     mu = lambda',
    m_RR = c_R . M c_R,   c_RR = -c_R . (df/dv) c_R,   k_RR = -c_R . (df/dq) c_R,   f_R = c_R . f.

On the constraints a^R v = 0, and the law becomes

    h_R + sum over S != R of a^S(c_R) h_S + f_R + affinity_R = 0,
    affinity_R = m_RR (nabla_v a^R)(v) - c_R . (W x J W).

So h_R is Lagrange's multiplier, for any lambda; (lambda, mu) are another representation of its history. If
rows depend on each other, h is the solution of least norm, with rows weighted by (a^R M^-1 a^R)^(1/2). All is
in the left-invariant frame: linear components in world axes, angular ones in principal body axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.dynamics.mobility import mass_matrix
from carom.geometry import quaternion
from carom.model import arrays as kinds
from carom.model import records as r
from carom.model.arrays import DISTANCE, KNIFE_EDGE, System
from carom.model.compile import compile_scene


def mounted(bushing, x, Q):
    """Return displacement and rotation (T, 3) in mount axes, these axes (T, 4), and the child's anchor (T, 3).

    x (T, N, 3), Q (T, N, 4): positions and attitudes of all bodies.
    """
    (a, p), (b, q) = (
        (frame + np.zeros((len(x), 4)), anchor + np.zeros((len(x), 3)))
        if k < 0
        else (quaternion.multiply(Q[:, k], frame), x[:, k] + quaternion.rotate(Q[:, k], anchor))
        for k, frame, anchor in (
            (bushing.parent, bushing.parent_frame, bushing.parent_anchor),
            (bushing.child, bushing.child_frame, bushing.child_anchor),
        )
    )
    turn = quaternion.log(quaternion.multiply(quaternion.conjugate(a), b))
    return quaternion.rotate_back(a, q - p), turn, a, q


@dataclass(frozen=True, eq=False)
class Multipliers:
    """Second-order multipliers of K constraint rows at T saved times, N bodies.

    Attributes
    ----------
    joint : (K,)
        The joint of each row.
    rows : (T, K, N, 6)
        a^R: linear in world axes, angular in principal body axes. Distances are measured in metres
        (a unit vector), angles in radians.
    directions : (T, K, N, 6)
        c_R.
    mass, damping, stiffness, force, affinity : (T, K)
        m_RR, c_RR, k_RR, f_R, affinity_R.
    reaction : (T, K)
        h_R.
    position, velocity : (T, K)
        lambda^R and mu^R, from 0 at the start.
    """

    joint: np.ndarray
    rows: np.ndarray
    directions: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    force: np.ndarray
    affinity: np.ndarray
    reaction: np.ndarray
    position: np.ndarray
    velocity: np.ndarray


def second_order_multipliers(solution) -> Multipliers:
    """Return the second-order multipliers of a solution whose scene has joints and no persistent contact.

    (lambda, mu) are integrated over the saved times by `integrate`: save every step. Loads that
    jump at an impact make no difference: the reaction there is the one after it.

    Parameters
    ----------
    solution : Solution

    Raises
    ------
    ValueError
        If the scene has no joints, or has other constraints or user-defined forces, or if a contact is active.
    """
    if not solution.scene.joints:
        raise ValueError("solution must be of a scene with joints, got none")
    if solution.scene.constraints or solution._run.compiled.system.relations.there:
        raise ValueError(
            "solution must be without constraints beyond joints, and without forces along coordinates, by "
            "curves or functions, got some"
        )
    if np.any(solution.contact_mode != 0):
        raise ValueError("solution must be without persistent contacts, got some")
    run = solution._run
    system = compile_scene(solution.scene, run.options, loops=True).system  # no joint is flipped
    state = r.trimmed(run.records, run.clock).state
    x, Q, v, w = (np.array(a) for a in (state.x, state.Q, state.v, state.w))
    W = quaternion.rotate_back(Q, w)
    M = mass_matrix(system)
    A, bias, owner = constraint_rows(system, x, Q, v, w)
    Y = A / M
    S = np.einsum("tknc,tlnc->tkl", Y, A)  # A M^-1 A^T
    mass = 1.0 / np.einsum("tkk->tk", S)
    c = Y * mass[..., None, None]
    f = applied_force(system, x, Q, v, w)
    gyro = np.zeros_like(f)
    gyro[..., 3:] = np.cross(W, system.bodies.inertia * W)
    affinity = -np.einsum("tknc,tnc->tk", c, gyro) - mass * bias
    force = np.einsum("tknc,tnc->tk", c, f)
    root = np.sqrt(mass)
    scaled = S * root[:, :, None] * root[:, None, :]
    h = np.linalg.pinv(scaled, rcond=1e-8, hermitian=True) @ (-(force + affinity) / root)[..., None]
    h = h[..., 0] * root
    damping, stiffness = _derivatives(system, x, Q, v, w, c)
    coupling = mass * np.einsum("tkl,tl->tk", S, h) - h  # sum over S != R of a^S(c_R) h_S
    position, velocity = integrate(solution.t, h, mass, damping, stiffness, force + coupling)
    return Multipliers(
        owner, A, c, mass, damping, stiffness, force, affinity, h, position, velocity
    )


def integrate(t, reaction, mass, damping, stiffness, force) -> tuple[np.ndarray, np.ndarray]:
    """Return lambda and mu (T, K) from the reaction, by the paper's update, from 0 at the start.

    ``h = (sigma+ - sigma)/dt + c mubar + k lambar - f``, ``sigma = m mu``, ``lambda+ = lambda + dt
    mubar``; bars are means over the step.
    """
    lam, mu = np.zeros_like(reaction), np.zeros_like(reaction)
    drive = reaction + force
    for n, dt in enumerate(np.diff(t)):
        c, k, d = (0.5 * (a[n] + a[n + 1]) for a in (damping, stiffness, drive))
        drag = 0.5 * dt * (c + 0.5 * dt * k)  # of a unit of mu at one end
        right = mass[n] * mu[n] + dt * (d - k * lam[n]) - drag * mu[n]
        mu[n + 1] = right / (mass[n + 1] + drag)
        lam[n + 1] = lam[n] + 0.5 * dt * (mu[n] + mu[n + 1])
    return lam, mu


def constraint_rows(system: System, x, Q, v, w):
    """Return a^R (T, K, N, 6), the bias (T, K) with a^R(acceleration) = bias, and the joint of each.

    Accelerations are linear in world axes and angular as dW/dt in the body: the same numbers as
    those of dw/dt in world axes.
    """
    times, count = x.shape[:2]
    rows, biases, owner = [], [], []
    for j, joint in enumerate(system.joints):
        p, c = int(joint.parent), int(joint.child)
        angular, linear, arms, ends = _directions(joint, x, Q, v, w)
        for turn, along in zip(angular, linear):
            row = np.zeros((times, count, 6))
            for b, sign, arm in ((c, 1.0, arms[0]), (p, -1.0, arms[1])):
                if b >= 0:
                    row[:, b, :3] += sign * along
                    moment = sign * (np.cross(arm, along) + turn)
                    row[:, b, 3:] += quaternion.rotate_back(Q[:, b], moment)
            rows.append(row)
            biases.append(np.sum(turn * ends[0] + along * ends[1], axis=-1))
            owner.append(j)
    return np.stack(rows, axis=1), np.stack(biases, axis=1), np.array(owner)


def _directions(joint, x, Q, v, w):
    """Return constrained directions, arms of child and parent, and the bias of the relative acceleration.

    Directions and bias are pairs (angular, linear); directions are lists of (T, 3).
    """
    p, c, kind = int(joint.parent), int(joint.child), joint.kind
    zero = np.zeros_like(x[:, 0])

    def to_world(b, local):
        return quaternion.rotate(Q[:, b], local) if b >= 0 else zero + local

    xp, vp, wp = (x[:, p], v[:, p], w[:, p]) if p >= 0 else (zero, zero, zero)
    rc, rp = to_world(c, joint.child_anchor), to_world(p, joint.parent_anchor)
    gap = x[:, c] + rc - xp - rp
    if kind in kinds.SLIDING:
        rp = rp + gap
    wc = w[:, c]
    u = v[:, c] + np.cross(wc, rc) - vp - np.cross(wp, rp)
    turning = zero
    bias = np.cross(wp, np.cross(wp, rp)) - np.cross(wc, np.cross(wc, rc))
    frame = [to_world(p, joint.parent_frame[:, k]) for k in range(3)]
    if kind in kinds.ROLLING:
        a = to_world(c, joint.child_frame[:, 1]) if kind == kinds.ROLLING_DISC else zero
        rc, turned = _rolling_arm(
            joint.length, frame[0], np.cross(wp, frame[0]), a, np.cross(wc, a)
        )
        rp = x[:, c] + rc - xp
        bias = np.cross(wp, v[:, c] + turned - vp) - np.cross(wc, turned)
        return [zero] * 3, [zero + e for e in np.eye(3)], (rc, rp), (zero, bias)
    if kind == DISTANCE:
        length = np.linalg.norm(gap, axis=1, keepdims=True)
        e = gap / length
        across = u - np.sum(u * e, axis=1, keepdims=True) * e
        bias = bias - np.sum(across**2, axis=1, keepdims=True) / length * e
        return [zero], [e], (rc, rp), (turning, bias)
    if kind == KNIFE_EDGE:
        e = to_world(c, joint.child_frame[:, 1])
        bias = bias - np.sum(np.cross(wc, e) * u, axis=1, keepdims=True) * e
        return [zero], [e], (rc, rp), (turning, bias)
    along, about = [zero + e for e in np.eye(3)], []
    if kind in kinds.SLIDING:
        bias = bias + 2.0 * np.cross(wp, u)
        along = frame[1:] if kind in kinds.ALONG else frame[:1]
    if kind in kinds.TURNING:
        turning = np.cross(wp, wc)
        about = frame[1:]
    elif kind in kinds.RIGID:
        about = frame
    elif kind == kinds.UNIVERSAL:
        a, b = frame[0], to_world(c, joint.child_frame[:, 1])
        n, turned = np.cross(a, b), np.cross(np.cross(wp, a), b) + np.cross(a, np.cross(wc, b))
        turning = -np.sum(turned * (wc - wp), axis=1, keepdims=True) * n
        about = [n]
    screw = [frame[0]] if kind == kinds.SCREW else []
    angular = [zero] * len(along) + [-joint.length * a for a in screw] + about
    linear = [*along, *screw] + [zero] * len(about)
    return angular, linear, (rc, rp), (turning, bias)


def _rolling_arm(radius, n, n_rate, a, a_rate):
    """Return the arm (T, 3) of a rolling body and its rate, as `carom.kinematics.joints.rolling_bias`."""

    def dot(p, q):
        return np.sum(p * q, axis=1, keepdims=True)

    g = n - dot(n, a) * a
    rate = n_rate - (dot(n_rate, a) + dot(n, a_rate)) * a - dot(n, a) * a_rate
    size = np.linalg.norm(g, axis=1, keepdims=True)
    e = g / size
    return -radius * e, -radius * (rate - dot(rate, e) * e) / size


def mount_wrench(bushing, x, Q, v, w):
    """Return the point at which a mount acts, its force and its torque on the child (T, 3), world axes."""
    d, turn, axes, place = mounted(bushing, x, Q)
    p, c = int(bushing.parent), int(bushing.child)
    u, spin = v[:, c] + np.cross(w[:, c], place - x[:, c]), w[:, c]
    if p >= 0:
        u, spin = u - v[:, p] - np.cross(w[:, p], place - x[:, p]), spin - w[:, p]
    u, spin = quaternion.rotate_back(axes, u), quaternion.rotate_back(axes, spin)
    m = bushing.turn_stiffness * turn
    t2 = np.sum(turn**2, axis=1, keepdims=True)
    t = np.sqrt(np.maximum(t2, 1e-4))
    b = np.where(t2 > 1e-4, 1.0 / t**2 - 0.5 / (t * np.tan(0.5 * t)), 1.0 / 12.0 + t2 / 720.0)
    moment = m + 0.5 * np.cross(turn, m) + b * np.cross(turn, np.cross(turn, m))
    force = bushing.stiffness * d + bushing.damping * u
    moment = moment + bushing.turn_damping * spin
    return place, -quaternion.rotate(axes, force), -quaternion.rotate(axes, moment)


def applied_force(system: System, x, Q, v, w) -> np.ndarray:
    """Return gravity, springs, dampers, mounts and loads (T, N, 6): force, and torque in principal axes."""
    out = np.zeros((*x.shape[:2], 6))
    out[..., :3] = system.bodies.mass[:, None] * system.gravity

    def ends(b, local):
        if b < 0:
            return local, local, 0.0
        arm = quaternion.rotate(Q[:, b], local)
        return arm, x[:, b] + arm, v[:, b] + np.cross(w[:, b], arm)

    def add(b, arm, force, torque: Any = 0.0):
        if b >= 0:
            out[:, b, :3] += force
            out[:, b, 3:] += quaternion.rotate_back(Q[:, b], np.cross(arm, force) + torque)

    for s in system.forces.spring:
        p, c = int(s.parent), int(s.child)
        (ap, xp, up), (ac, xc, uc) = ends(p, s.parent_anchor), ends(c, s.child_anchor)
        length = np.linalg.norm(xc - xp, axis=1, keepdims=True)
        e = (xc - xp) / length
        rate = np.sum(e * (uc - up), axis=1, keepdims=True)
        pull = (s.stiffness * (length - s.rest_length) + s.damping * rate) * e
        add(c, ac, -pull)
        add(p, ap, pull)
    for load in system.forces.load:
        b, frame = int(load.body), int(load.frame)
        force, torque = (
            np.zeros_like(x[:, b]) + a if frame < 0 else quaternion.rotate(Q[:, frame], a)
            for a in (load.force, load.torque)
        )
        add(b, ends(b, load.anchor)[0], force, torque)
    for mount in system.forces.bushing:
        place, force, torque = mount_wrench(mount, x, Q, v, w)
        for b, sign in ((int(mount.child), 1.0), (int(mount.parent), -1.0)):
            if b >= 0:
                add(b, place - x[:, b], sign * force, sign * torque)
    return out


def _derivatives(system, x, Q, v, w, c, step=1e-5):
    """Return c_RR and k_RR (T, K) by central differences of the force along each c_R.

    Bodies turn by `step`, or move by that fraction of their size.
    """
    unit = np.ones((len(system.bodies), 6))
    unit[:, :3] = system.bodies["extent"][:, None]
    damping, stiffness = np.zeros(c.shape[:2]), np.zeros(c.shape[:2])
    for k in range(c.shape[1]):
        along, turn = c[:, k, :, :3], c[:, k, :, 3:]
        size = step / np.max(np.abs(c[:, k]) / unit, axis=(1, 2))[:, None, None]  # (T, 1, 1)
        pair = []
        for e in (size, -size):
            spin = w + e * quaternion.rotate(Q, turn)
            fast = applied_force(system, x, Q, v + e * along, spin)
            moved = quaternion.multiply(Q, quaternion.exp(e * turn))
            # the components of the velocity in the left-invariant frame do not change
            carried = quaternion.rotate(moved, quaternion.rotate_back(Q, w))
            pair.append((fast, applied_force(system, x + e * along, moved, v, carried)))
        for out, plus, minus in zip((damping, stiffness), *pair):
            change = (plus - minus) / (2.0 * size)
            out[:, k] = -np.einsum("tnc,tnc->t", c[:, k], change)
    return damping, stiffness
