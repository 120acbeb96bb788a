"""Energetic restitution: the work of restitution is e^2 times that lost in compression.

W. J. Stronge, Rigid body collisions with friction, Proc. R. Soc. A 431 (1990) 169-181. The law never
raises the energy.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

MEASURE = "work"
GAINS = False


@kernel
def goal(e, v0, p_c, work_c):
    """Return the value at which restitution ends: A_r = -e^2 A_c."""
    return max(0.0, -e * e * work_c)
