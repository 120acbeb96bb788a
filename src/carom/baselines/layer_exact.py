"""The exact motion through the boundary layer under law A, a reference for errors."""

from __future__ import annotations

import numpy as np

from carom import checks


def layer_motion(time, speed, restitution, *, width, penetration):
    """Return gap coordinate and velocity in the layer at the given times.

    The flat coordinate ``s = b ln(x/b)`` has a constant acceleration in each phase, so with
    ``l = -ln(1 - delta)``, ``T_c = 2 b l / v0``, ``T_r = T_c / e``::

        compression  z = t / T_c          s = -b l (1 - (1 - z)^2)   u = -v0 (1 - z)
        restitution  z = (t - T_c) / T_r  s = -b l (1 - z^2)         u = +e v0 z

    and ``x = b exp(s/b)``, ``xdot = u x / b``. Times after the exit continue the second line.

    Parameters
    ----------
    time : array_like, shape (K,)
        Times since entry [s].
    speed : float
        Speed of entry v0 > 0 [m/s].
    restitution : float
        Kinematic coefficient e in (0, 1].
    width : float
        Width b of the layer [m].
    penetration : float
        Greatest penetration delta, as a fraction of the width, in (0, 1).

    Returns
    -------
    x, velocity : (K,) arrays
        Gap coordinate [m] and its rate xdot [m/s].
    """
    t = checks.real_array("time", time, "(K,)")
    v0, e, b, reach, compression = layer_constants(speed, restitution, width, penetration)
    with np.errstate(over="ignore", invalid="ignore"):
        z_c = t / compression
        z_r = (t - compression) * e / compression
        s = np.where(z_c < 1.0, -reach * (1.0 - (1.0 - z_c) ** 2), -reach * (1.0 - z_r**2))
        u = np.where(z_c < 1.0, -v0 * (1.0 - z_c), e * v0 * z_r)
        x = b * np.exp(s / b)
        velocity = u * x / b
    if not np.all(np.isfinite(velocity)):
        raise ValueError(
            f"time must be finite and near the impact, which at speed {v0:g} ends after "
            f"{compression * (1 + 1 / e):g} s, got {checks.shown(time)}"
        )
    return x, velocity


def layer_constants(speed, restitution, width, penetration):
    """Return checked ``v0, e, b``, the reach ``b l`` [m] and the compression time ``T_c`` [s]."""
    v0, b = checks.scale("speed", speed, "m/s"), checks.scale("width", width, "m")
    checks.number("restitution", restitution, above=0.0, most=1.0)
    checks.number("penetration", penetration, above=0.0, below=1.0)
    e, delta = checks.scale("restitution", restitution), checks.scale("penetration", penetration)
    reach = -b * np.log1p(-delta)
    return v0, e, b, float(reach), float(2.0 * reach / v0)
