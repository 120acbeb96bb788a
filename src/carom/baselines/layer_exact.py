"""The exact motion through the boundary layer under law A, a reference for errors."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.impact.geometry import NormalMotion


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
    motion = checked_layer(speed, restitution, width, penetration)
    with np.errstate(over="ignore", invalid="ignore"):
        x, velocity = motion.x(t), motion.x_rate(t)
    if not np.all(np.isfinite(velocity)):
        raise ValueError(
            f"time must be finite and near the impact, which at speed {motion.approach_speed:g} ends after "
            f"{motion.compression_time + motion.restitution_time:g} s, got {checks.shown(time)}"
        )
    return x, velocity


def checked_layer(speed, restitution, width, penetration) -> NormalMotion:
    """Return the motion through the layer of checked numbers."""
    v0, b = checks.scale("speed", speed, "m/s"), checks.scale("width", width, "m")
    checks.number("restitution", restitution, above=0.0, most=1.0)
    checks.number("penetration", penetration, above=0.0, below=1.0)
    e, delta = checks.scale("restitution", restitution), checks.scale("penetration", penetration)
    return NormalMotion(v0, e, b, delta)
