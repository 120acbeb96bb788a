"""Kinematic restitution: the bodies part with e times the speed of approach.

I. Newton, Philosophiae Naturalis Principia Mathematica (1687), scholium to the laws of motion. The
law of the paper. With friction it can raise the energy (mathematics page, §1.10): that is the law.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

MEASURE = "speed"
GAINS = True


@kernel
def goal(e, v0, p_c, work_c):
    """Return the value at which restitution ends: u_n = e v0."""
    return e * v0
