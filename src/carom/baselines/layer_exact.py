"""The exact motion through the boundary layer under law A, to measure errors against."""

from __future__ import annotations

import numpy as np

from carom import check


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
        Greatest penetration delta, as a part of the width, in (0, 1).

    Returns
    -------
    x, velocity : (K,) arrays
        Gap coordinate [m] and its rate xdot [m/s].
    """
    t = np.asarray(time, dtype=np.float64)
    v0, e, b, reach, compression = layer_constants(speed, restitution, width, penetration)
    z_c = t / compression
    z_r = (t - compression) * e / compression
    s = np.where(z_c < 1.0, -reach * (1.0 - (1.0 - z_c) ** 2), -reach * (1.0 - z_r**2))
    u = np.where(z_c < 1.0, -v0 * (1.0 - z_c), e * v0 * z_r)
    x = b * np.exp(s / b)
    return x, u * x / b


def layer_constants(speed, restitution, width, penetration):
    """Return checked ``v0, e, b``, the reach ``b l`` [m] and the compression time ``T_c`` [s]."""
    v0 = check.number("speed", speed, above=0.0, unit="m/s")
    e = check.number("restitution", restitution, above=0.0, most=1.0)
    b = check.number("width", width, above=0.0, unit="m")
    delta = check.number("penetration", penetration, above=0.0, below=1.0)
    reach = -b * np.log1p(-delta)
    return v0, e, b, float(reach), float(2.0 * reach / v0)
