"""Kinematic restitution with friction by the final slip: no path, one contact problem of the whole impulse.

u_n+ = -e u_n-, and Coulomb's law between the impulse and the slip after the impact. J. J. Moreau, Unilateral
contact and dry friction in finite freedom dynamics, CISM 302 (1988); Ch. Glocker, Set-Valued Force Laws (2001).
With friction this law can raise the energy, as Newton's can (mathematics page, part 1, law by the final slip).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

MEASURE = "nothing"
GAINS = True


@kernel
def goal(e, v0, p_c, work_c):
    """Return the normal velocity after the impact, u_n = e v0."""
    return e * v0
