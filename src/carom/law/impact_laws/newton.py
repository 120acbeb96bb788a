"""Kinematic restitution: the bodies separate with e times the speed of approach.

I. Newton, Philosophiae Naturalis Principia Mathematica (1687), scholium to the laws of motion. The
law of the paper. With friction this law can raise the energy (mathematics page, §1.10).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

MEASURE = "speed"
GAINS = True


@kernel
def goal(e, v0, p_c, work_c):
    """Return the value at which restitution ends: u_n = e v0."""
    return e * v0
