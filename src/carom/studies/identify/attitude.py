"""Least squares of attitudes by Gauss and Newton's method on rotation vectors."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.model.compile import principal
from carom.scene.bodies import inertia_matrix

FIT_ITERATIONS = 50
DIFFERENCE = 1e-5  # [rad], for difference quotients


def fit_attitude(t, q, inertia=None) -> dict:
    """Return the fields of a `FreeFlight` about rotation: of quaternions q (n, 4) at times t (n,), t[0] = 0."""
    moments, to_principal = principal(np.eye(3) if inertia is None else inertia_matrix(inertia))
    spin = constant_spin if np.ptp(moments) == 0.0 else _torque_free(moments)
    q = quaternion.multiply(q, to_principal)
    # unknowns: a rotation of R0 about the world axes, and the rotation w t[-1] in the whole flight
    R0, turn = q[0], _first_guess(t, q) * t[-1]
    changes = np.concatenate([np.zeros((1, 6)), DIFFERENCE * np.eye(6), -DIFFERENCE * np.eye(6)])

    def residuals():
        """Return residuals (13, 3 n): at the present unknowns, and with each unknown larger and smaller."""
        starts = quaternion.multiply(quaternion.exp(changes[:, :3]), R0)
        model = spin(t, starts, (turn + changes[:, 3:]) / t[-1])
        off = quaternion.log(quaternion.multiply(q, quaternion.conjugate(model)))
        return off.reshape(13, -1)

    before = np.inf
    for _ in range(FIT_ITERATIONS):
        here = residuals()
        slope = (here[1:7] - here[7:]).T / (2.0 * DIFFERENCE)
        change = np.linalg.lstsq(slope, -here[0], rcond=None)[0]
        R0 = quaternion.normalize(quaternion.multiply(quaternion.exp(change[:3]), R0))
        turn, length = turn + change[3:], float(np.max(np.abs(change)))
        # at round-off it no longer decreases; the slopes have errors of 1e-10
        if length < 1e-12 or (length < 1e-7 and length > 0.5 * before):
            break
        before = length
    else:
        raise RuntimeError(
            "orientation is not that of a free body: the fit of the attitude did not converge in "
            f"{FIT_ITERATIONS} iterations (change in the last one: {length:.3g} rad); give only samples of "
            "free flight"
        )
    here = residuals()[0].reshape(-1, 3)
    noise = float(np.sqrt(np.sum(here**2) / (here.size - 6)))
    spread = np.sqrt(np.diag(np.linalg.inv(slope.T @ slope)))
    return {
        "orientation": quaternion.multiply(R0, quaternion.conjugate(to_principal)),
        "angular_velocity": turn / t[-1], "orientation_error": noise * spread[:3],
        "angular_velocity_error": noise * spread[3:] / t[-1],
        "rotation_residual": here, "rotation_noise": noise,
    }  # fmt: skip


def constant_spin(t, starts, w) -> np.ndarray:
    """Return attitudes exp(w t) R0 (m, n, 4) of starts (m, 4) and angular velocities (m, 3)."""
    return quaternion.multiply(quaternion.exp(w[:, None] * t[:, None]), starts[:, None])


def _first_guess(t, q) -> np.ndarray:
    """Return the median of the angular velocities from sample to sample.

    The rotation from the first sample to the last is not used, because it may be many revolutions.
    """
    steps = quaternion.log(quaternion.multiply(q[1:], quaternion.conjugate(q[:-1])))
    return np.median(steps / np.diff(t)[:, None], axis=0)


def _torque_free(moments):
    """Return the function that replaces `constant_spin` for a body with these principal moments."""
    from carom.kinematics.flight_arrays import torque_free

    def spin(t, starts, w):
        each = np.repeat(starts, t.size, axis=0), np.repeat(w, t.size, axis=0)
        return torque_free(moments, *each, np.tile(t, len(starts)))[0].reshape(len(starts), -1, 4)

    return spin
