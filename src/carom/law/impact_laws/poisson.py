"""Kinetic restitution: the normal impulse of restitution is e times that of compression.

S. D. Poisson, Traite de mecanique (1833), and E. J. Routh, Dynamics of a System of Rigid Bodies
(1905), who extends it to slip and stick.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

MEASURE = "impulse"
GAINS = False


@kernel
def goal(e, v0, p_c, work_c):
    """Return the value at which restitution ends: p_r = e p_c."""
    return e * p_c
