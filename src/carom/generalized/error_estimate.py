"""The error of a step in coordinates, relative to the tolerances.

The estimate is that for bodies (`carom.dynamics.adapt`), where each coordinate has the size 1 in its own unit.
With e_q, e_v = h times the sum of E_s times the derivatives of the stages, the error of coordinate i is

    miss_i = max(|e_q|, T |e_v|),     T = 1 / max(|v_i|, sqrt |a_i|),

and a step is accepted if miss_i <= LOCAL (atol + rtol max(1, h |v_i|)) for all of them.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.adapt import allowed_error
from carom.generalized.layout import N


@kernel
def step_error(motion, h, plan):
    """Return the greatest error of the step h whose stages are in the workspace; up to 1 it is accepted."""
    E, stages, n = motion.method.E, motion.work.stages, motion.system.size[N]
    first, second = 0.0, 0.0
    for i in range(n):
        pace, speed = 0.0, 0.0
        for s in range(E.shape[1]):
            speed = max(speed, abs(stages[s, i]))
            pace = max(pace, math.sqrt(abs(stages[s, n + i])))
        pace = max(pace, speed)
        T = 1.0 / pace if pace > 0.0 else 0.0
        allowed = allowed_error(plan.rtol, plan.atol, 1.0, h * speed)
        for e in range(E.shape[0]):
            q, v = 0.0, 0.0
            for s in range(E.shape[1]):
                q += E[e, s] * stages[s, i]
                v += E[e, s] * stages[s, n + i]
            miss = h * max(abs(q), T * abs(v)) / allowed
            if e == 0 and not miss <= first:
                first = miss
            if e == 1:
                second = max(second, miss)
    if second > 0.0:
        return first * first / math.sqrt(first * first + 0.01 * second * second)
    return first
