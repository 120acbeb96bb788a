"""The layout of the results of the kernels of an impact, and the codes that they return.

Velocities and impulses in contact axes: normal, tangent 1, tangent 2.
"""

from __future__ import annotations

VELOCITY = 0  #: velocity after the impact, 3 numbers [m/s]
IMPULSE = 3  #: impulse of the whole impact, 3 numbers [N s]
COMPRESSION = 6  #: impulse up to the end of compression, 3 numbers [N s]
WORK_C = 9  #: work of the normal force in compression, A_c <= 0 [J]
WORK_R = 10  #: work of the normal force in restitution, A_r >= 0 [J]
FRICTION_LOSS = 11  #: energy dissipated by friction, >= 0 [J]
ENERGY_CHANGE = 12  #: change of kinetic energy, A_c + A_r - friction loss [J]
P_C = 13  #: normal impulse at the end of compression [N s]
PHASES = 14  #: bit mask of the phases passed, below
STEPS = 15  #: integrator steps, closed-form pieces included
SLIP_END_P = 16  #: normal impulse at which slip first stops, -1 if it never stops [N s]
SLIP_END_UN = 17  #: normal velocity at which slip first stops [m/s]
DURATION = 18  #: duration of the impact in the layer [s]; 0 from `resolve`
X_MIN = 19  #: least x in the layer [m]; 0 from `resolve`
KNOTS = 20  #: knots of the history; 0 from `resolve`
STILL = 21  #: an input: speed that counts as zero, round-off of u itself [m/s]
SIZE = 24  #: length of `out`; the rest is free

PHASE_SLIP = 1  #: the contact slipped
PHASE_STICK = 2  #: the contact stuck until the end
PHASE_RESTART = 4  #: slip stopped and began again at once (reversal)
PHASE_JAM = 8  #: the normal force drove the bodies together while slipping (Painleve)
WEDGED = (
    16  #: friction blocked the pair in restitution, however large the impulse: W is singular there
)
AT_END = 32  #: its time was not located: an impact in a crowd, at the end of a step
AT_ONCE = 64  #: several points as one contact problem, because the passage of their layers failed
PLASTIC = (
    128  #: several points without restitution although e > 0: no velocity satisfies their laws
)

OK = 0
BAD_INPUT = 1  #: a number is not finite, or W_nn is not positive
NOT_APPROACHING = 2  #: u_n is not negative
NO_END = 3  #: the pair approaches, and no impulse stops it: W is singular during the impact
TOO_MANY_STEPS = 4  #: the integrator did not reach the end
SPLINE_FAILED = 5  #: a step of the spline was not solved

MESSAGES = {
    BAD_INPUT: "a number is not finite, or the inverse mass of the normal is not positive",
    NOT_APPROACHING: "the normal velocity is not negative: the bodies do not approach",
    NO_END: "the pair is wedged and still approaches: no impulse stops it (the inverse mass is singular)",
    TOO_MANY_STEPS: "the equation of slip was not integrated to its end",
    SPLINE_FAILED: "a step of the spline through the layer was not solved to round-off",
}
