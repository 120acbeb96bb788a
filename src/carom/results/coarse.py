"""Detection of steps that are far too long for the motion, from the states at their ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from carom.results.solution import Solution

#: allowed difference, relative to the path at the greatest speed: that of a harmonic motion with 1.1 rad in a
#: step, and with 2.2 rad for the method of order 8, which is still accurate then
COARSE, OF_ORDER_8 = 0.1, 0.4
SEEN = 1e-3  # of the size of a body: smaller differences do not count
GOOD = 1e-3  # the same difference for the step that the sentence recommends


def too_long(solution: Solution, bodies, step: float, method: str) -> tuple[str, ...]:
    """Return a sentence if a given step is far too long for the motion of joined or loaded bodies.

    The displacement of such a body in a step is compared with the trapezoidal rule: for an angular frequency
    omega the two differ by (omega h)^2 / 12 of the displacement. Free flight is exact with any step, and steps
    with impacts are left out because the velocity jumps.

    Parameters
    ----------
    solution
        A solution in which each step is saved.
    bodies : (N,) BODY
        The records of the bodies in the kernels: sizes, and which bodies are neither joined nor loaded.
    step : float
        Length of a step [s].
    method : str
        Method of the run.
    """
    t, bound, sizes = solution.t, np.flatnonzero(bodies["ballistic"] == 0), bodies["extent"]
    if len(t) < 3 or not len(bound):
        return ()
    x, v = solution.position[:, bound], solution.velocity[:, bound]
    h = np.diff(t)[:, None, None]
    off = np.linalg.norm(np.diff(x, axis=0) - 0.5 * h * (v[1:] + v[:-1]), axis=-1)
    fastest = np.linalg.norm(v, axis=-1).max(axis=0)
    strikes = np.searchsorted(t, solution.impacts.time)
    smooth = np.ones(len(t) - 1, dtype=bool)
    for k in (strikes - 1, strikes):
        smooth[np.clip(k, 0, len(smooth) - 1)] = False
    if not smooth.any():
        return ()
    # a quarter of all steps differ by more; the few first steps in which a stiff damper acts do not count
    most = np.quantile(off[smooth], 0.75, axis=0)
    part = np.where(most > SEEN * sizes[bound], most, 0.0) / np.maximum(step * fastest, 1e-300)
    worst = int(np.argmax(part))
    if not part[worst] > (OF_ORDER_8 if method == "rk8" else COARSE):
        return ()
    name, good = solution.scene.bodies[bound[worst]].name, step * np.sqrt(GOOD / part[worst])
    return (
        f"step={step:g} s is far too long for the motion of {name!r}: its velocity changes too much in one "
        f"step. Take step={good:.1g} or less, or leave step out.",
    )
