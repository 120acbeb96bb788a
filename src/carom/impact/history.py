"""`impact_layer`: one impact, resolved in time inside the boundary layer."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom import arguments, checks
from carom.impact.api import checked_impact, checked_tangential, need_path, phase_names, raise_for

MOST_STEPS = 100_000  # of one passage through the layer: more steps would only add round-off


@dataclass(frozen=True)
class LayerHistory:
    """An impact inside its boundary layer, over time. Vectors in contact axes: normal, tangent 1, tangent 2.

    Parameters
    ----------
    t : ndarray, shape (K,)
        Times of the knots of the spline since entry [s].
    x : ndarray, shape (K,)
        Normal coordinate in the layer [m]; it is the width b at entry and at exit.
    velocity : ndarray, shape (K, 3)
        Velocity in the flat coordinates [m/s]; the normal one is u_n = b xdot/x, which is xdot at
        entry and exit.
    normal_force : ndarray, shape (K,)
        Normal force just after each knot, and just before the last one [N].
    friction_force : ndarray, shape (K, 2)
        Friction force at the same times [N].
    x_min : float
        Smallest x, (1 - penetration) b [m].
    duration : float
        Time spent in the layer [s].
    velocity_after, impulse : ndarray, shape (3,)
        Velocity at exit [m/s] and impulse [N s], with the jump by tangential restitution after the last knot.
    energy_change : float
        Change of kinetic energy [J].
    phases : tuple of str
        As for `Impact`.
    width : float
        Width b of the layer [m].
    """

    t: np.ndarray
    x: np.ndarray
    velocity: np.ndarray
    normal_force: np.ndarray
    friction_force: np.ndarray
    x_min: float
    duration: float
    velocity_after: np.ndarray
    impulse: np.ndarray
    energy_change: float
    phases: tuple[str, ...]
    width: float
    _flat: np.ndarray = field(repr=False)

    def evaluate(self, t) -> tuple[np.ndarray, np.ndarray]:
        """Return x and velocity at times `t` on the geometric cubic spline.

        The spline is the cubic Hermite of (s, x^2, x^3), s = b ln(x/b), on each step; the velocity
        is its derivative.

        Parameters
        ----------
        t : array_like
            Times in [0, duration] [s].

        Returns
        -------
        x : ndarray, shape of t
        velocity : ndarray, shape of t + (3,)
        """
        given, t = t, checks.real_array("t", t, "(...,)")
        if not np.all((t >= 0.0) & (t <= self.duration)):
            raise ValueError(
                f"t must be within [0, duration = {self.duration:.9g}] [s], got {checks.shown(given)}"
            )
        i = np.clip(np.searchsorted(self.t, t, side="right") - 1, 0, len(self.t) - 2)
        d = (self.t[i + 1] - self.t[i])[..., None]
        z = ((t - self.t[i])[..., None]) / d
        y0, y1 = self._flat[i], self._flat[i + 1]
        u0, u1 = self.velocity[i], self.velocity[i + 1]
        mean = (y1 - y0) / d
        # The cubic Hermite polynomial in powers of z from its left end, and its derivative.
        y = y0 + d * z * (u0 + z * (3.0 * mean - 2.0 * u0 - u1 + z * (u0 + u1 - 2.0 * mean)))
        u = u0 + z * (2.0 * (3.0 * mean - 2.0 * u0 - u1) + 3.0 * z * (u0 + u1 - 2.0 * mean))
        return self.width * np.exp(y[..., 0] / self.width), u


@arguments.known
def impact_layer(
    inverse_mass,
    velocity,
    friction: float,
    restitution: float,
    *,
    penetration: float,
    width: float,
    law: str = "newton",
    steps: int = 2,
    tangential_restitution: float = 0.0,
) -> LayerHistory:
    """Integrate one impact through the boundary layer, in time, by geometric cubic splines.

    Parameters
    ----------
    inverse_mass, velocity, friction, restitution, law
        As for `resolve_impact`, except ``"moreau"``, which has no path. A restitution below 1e-6 ends the
        impact with compression.
    penetration : float
        Greatest penetration delta as a fraction of the width, in (0, 1).
    width : float
        Width b of the layer [m]. The velocity after the impact does not depend on it, nor on delta.
    steps : int
        Number of steps of the spline, half of them in compression and half in restitution; from 2 to 100 000. A
        step is divided where slip ends, and halved where slip turns sharply. Default 2, as in the paper: exact
        if the direction of slip is constant, otherwise of order 4.
    tangential_restitution : float
        e_t in [-1, 1], as for `resolve_impact`: the slip that returns is a jump at the exit, after the last
        knot. Default 0.

    Returns
    -------
    LayerHistory
        The impact over time.

    Raises
    ------
    ValueError
        If an argument is invalid, or the impact cannot be solved.

    Notes
    -----
    Mathematics page, §1.8 to §1.11; the paper, section on the boundary layer.

    Examples
    --------
    >>> layer = carom.impact_layer(np.diag([1.0, 3.5, 3.5]), (-1.0, 1.0, 0.0), 0.1, 0.5,
    ...                            penetration=0.9, width=1e-6)
    >>> print(f"{layer.x_min:.2g} m after {layer.t[1]:.3e} s, at {layer.normal_force[0]:.4g} N")
    1e-07 m after 4.605e-06 s, at 2.171e+05 N
    >>> print(layer.velocity_after)
    [0.5   0.475 0.   ]
    """
    from carom._compiled.record_arrays import table
    from carom.impact import layout as o
    from carom.impact.layer import traverse
    from carom.impact.phase import COLUMNS
    from carom.impact.tangential import return_slip
    from carom.model.workspace import HIT

    W, u, mu, e, number = checked_impact(inverse_mass, velocity, friction, restitution, law)
    need_path("the layer", law)
    delta = checks.number("penetration", penetration, above=0.0, below=1.0)
    b = checks.number("width", width, above=0.0, unit="m")
    steps = checks.integer("steps", steps, least=2, most=MOST_STEPS)
    e_t = checked_tangential(tangential_restitution)
    hit = table(HIT, 1)[0]
    hit.W, hit.u, hit.friction, hit.restitution = W, u, mu, e
    out, rows = hit.out, np.zeros((steps + 32, COLUMNS))
    raise_for(traverse(hit, number, (b, delta, steps), rows))
    if out[o.KNOTS] > len(rows):  # steps were halved: there are more knots than foreseen
        rows = np.zeros((int(out[o.KNOTS]), COLUMNS))
        raise_for(traverse(hit, number, (b, delta, steps), rows))
    rows = rows[: int(out[o.KNOTS])]
    if e_t != 0.0:
        return_slip(W, u, mu, e_t, out)
    return LayerHistory(
        t=rows[:, 0].copy(),
        x=b * np.exp(rows[:, 1] / b),
        velocity=rows[:, 2:5].copy(),
        normal_force=rows[:, 7].copy(),
        friction_force=rows[:, 8:10].copy(),
        x_min=float(out[o.X_MIN]),
        duration=float(out[o.DURATION]),
        velocity_after=out[o.VELOCITY : o.VELOCITY + 3].copy(),
        impulse=out[o.IMPULSE : o.IMPULSE + 3].copy(),
        energy_change=float(out[o.ENERGY_CHANGE]),
        phases=phase_names(int(out[o.PHASES])),
        width=b,
        _flat=rows[:, [1, 5, 6]].copy(),
    )
