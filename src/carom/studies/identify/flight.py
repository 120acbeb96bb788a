"""The state of a body in free flight from recorded poses, by least squares."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.geometry import quaternion
from carom.geometry.attitude import quaternions
from carom.scene.shapes import SHAPES
from carom.studies.identify.attitude import fit_attitude
from carom.studies.identify.recording import State, poses, times, unit

if TYPE_CHECKING:
    from carom.geometry.attitude import Orientation

_ROOM = "a fit needs more samples than unknowns"


@dataclass(frozen=True, eq=False)
class FreeFlight:
    """A body's state at `time`, fitted to n samples of its free flight; world axes.

    Attributes
    ----------
    time : float
        Time of the first sample [s].
    position, velocity, angular_velocity : (3,)
        Position and velocity of the mass centre [m], [m/s]; angular velocity [rad/s].
    orientation : (4,)
        Unit quaternion (w, x, y, z), body to world.
    acceleration : (3,)
        Acceleration of the mass centre, given or fitted [m/s^2].
    position_error, velocity_error, acceleration_error, orientation_error, angular_velocity_error : (3,)
        Standard errors of the components; for the orientation, of a small rotation about the world axes [rad].
        The noise is estimated from the residuals, under the assumption that it is independent and equal for all
        components and samples. `acceleration_error` is zero if the acceleration was given.
    position_residual : (n, 3)
        Recorded minus fitted positions [m].
    rotation_residual : (n, 3)
        Rotation vectors from the fitted to the recorded attitudes [rad].
    position_noise, rotation_noise : float
        Estimated standard deviation of one component of one sample [m], [rad].
    """

    time: float
    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    acceleration: np.ndarray
    position_error: np.ndarray
    orientation_error: np.ndarray
    velocity_error: np.ndarray
    angular_velocity_error: np.ndarray
    acceleration_error: np.ndarray
    position_residual: np.ndarray
    rotation_residual: np.ndarray
    position_noise: float
    rotation_noise: float

    @property
    def state(self) -> State:
        """The fitted state, for `Recording.start`."""
        return State(self.position, self.orientation, self.velocity, self.angular_velocity)


def fit_free_flight(
    t: ArrayLike,
    position: ArrayLike,
    orientation: Orientation,
    gravity: ArrayLike | None = (0.0, 0.0, -9.81),
    *,
    inertia: ArrayLike | None = None,
) -> FreeFlight:
    """Fit the motion of a free body to recorded poses, and return its state at the first sample.

    Parameters
    ----------
    t : (n,)
        Times of free flight, increasing [s]; at least 3, or 4 if gravity is fitted.
    position : (n, 3)
        Positions of the mass centre, world [m].
    orientation : (n, 4)
        Quaternions (w, x, y, z), body to world. Rotations between two samples must be less than half a turn,
        because larger ones cannot be distinguished from smaller ones.
    gravity : (3,) or None
        Acceleration of the mass centre [m/s^2]. Default (0, 0, -9.81). None: it is fitted too.
    inertia : (3,) or (3, 3), optional
        Inertia about the mass centre in body axes [kg m^2]; only its ratios matter. The angular velocity then
        satisfies Euler's equations without torque. Default: the angular velocity is constant in the world,
        which is exact for equal moments (a cube, a ball).

    Returns
    -------
    FreeFlight
        The fitted state, with errors and residuals.

    Raises
    ------
    ValueError
        If there are too few samples, shapes do not agree, or values are not finite.
    RuntimeError
        If the iteration does not converge, because the attitudes are not those of a free body.

    Notes
    -----
    Positions: least squares of ``x0 + v0 t + g t^2 / 2``. Attitudes: Gauss and Newton's method on
    ``log(R_k R_model(t_k)^T)``, with ``R_model = exp(w t) R0`` for constant w.
    """
    t = times(t)
    x = poses("position", position, t.size, 3)
    q = poses("orientation", quaternions("orientation", orientation), t.size, 4)
    for name, array in (("position", x), ("orientation", q)):
        if array.shape[1] != 1:
            raise ValueError(f"{name} must be of one body, got {array.shape[1]}")
    least = 3 if gravity is not None else 4
    if t.size < least:
        raise ValueError(f"t must have at least {least} times ({_ROOM}), got {t.size}")
    g = None if gravity is None else checks.finite_array("gravity", gravity, (3,), "m/s^2")
    since, x, q = t - t[0], x[:, 0], unit("orientation", q)[:, 0]
    return FreeFlight(float(t[0]), **_fit_positions(since, x, g), **fit_attitude(since, q, inertia))


def _fit_positions(t, x, gravity) -> dict:
    """Return the fields of a `FreeFlight` about position.

    Least squares of x0 + v0 t + g t^2/2, with times divided by their length for equal columns.
    """
    length = t[-1]
    s = t / length
    powers = np.stack([np.ones_like(s), s, 0.5 * s * s], axis=1)
    scale = np.array([1.0, length, length**2])
    fitted = powers if gravity is None else powers[:, :2]
    known = 0.0 if gravity is None else powers[:, 2:] * (gravity * length**2)
    solution, *_ = np.linalg.lstsq(fitted, x - known, rcond=None)
    residual = x - known - fitted @ solution
    spread = np.sqrt(np.diag(np.linalg.inv(fitted.T @ fitted)))
    with np.errstate(over="ignore"):
        noise = float(np.sqrt(np.sum(residual**2) / (residual.size - solution.size)))
    checks.number("the residual of gravity and position", noise, unit="m")
    state, error = np.zeros((3, 3)), np.zeros((3, 3))
    count = len(solution)
    state[:count] = solution / scale[:count, None]
    error[:count] = noise * (spread / scale[:count])[:, None]
    if gravity is not None:
        state[2] = gravity
    names = ("position", "velocity", "acceleration")
    return {
        **dict(zip(names, state)), **{f"{name}_error": row for name, row in zip(names, error)},
        "position_residual": residual, "position_noise": noise,
    }  # fmt: skip


def free_samples(
    position: ArrayLike,
    orientation: Orientation,
    shape,
    *,
    point: ArrayLike = (0.0, 0.0, 0.0),
    normal: ArrayLike = (0.0, 0.0, 1.0),
    clearance: float = 0.0,
) -> int:
    """Return the number of samples at the beginning in which a body does not touch a half-space.

    Parameters
    ----------
    position, orientation : (n, 3), (n, 4)
        Recorded poses, as for `fit_free_flight`.
    shape
        Shape of the body, as for `Scene.add_body`.
    point, normal : (3,)
        Point and normal of the half-space. Default: the plane z = 0.
    clearance : float
        Smallest gap without contact [m]: the error of the recording and of the shape. Default 0.

    Returns
    -------
    int
        Number of samples before the first sample with a gap below `clearance`; n if there is none.
    """
    checks.instance("shape", shape, SHAPES, "; a shape is needed")
    count = len(np.atleast_1d(checks.real_array("position", position, "(n, 3)")))
    x = poses("position", position, count, 3)[:, 0]
    turns = checks.vectors("orientation", quaternions("orientation", orientation), 4)
    if len(turns) != len(x):
        raise ValueError(
            f"orientation must have as many samples as position, got {len(turns)} and {len(x)}"
        )
    q = unit("orientation", poses("orientation", turns, len(x), 4))[:, 0]
    on_plane = checks.finite_array("point", point, (3,), "m")
    n = checks.unit_vector("normal", normal)
    clearance = checks.number("clearance", clearance, unit="m")
    down = quaternion.rotate_back(q, -n)
    depth = np.array([float(shape.support(d) @ d) for d in down])
    near = (x - on_plane) @ n - depth < clearance
    return int(np.argmax(near)) if np.any(near) else len(x)
