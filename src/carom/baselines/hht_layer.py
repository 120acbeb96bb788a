"""HHT-alpha on the equation of the boundary layer, in the raw gap coordinate x (Hilber, Hughes, Taylor 1977).

The layer equation ``(g_11 v)' - L^1_11 g_11 v v - f_1 = 0`` with ``g_11 = m (b/x)^2``,
``L^1_11 = -1/x`` and law A, ``f_1 = m a b/x``, is, divided by g_11::

    xddot = phi(x, v) = v^2/x + a x/b ,     a = v0^2/(2 b l)  (compression),  e^2 a  (restitution)

Every term of the undivided equation is O(1/x), which makes it difficult for a classical integrator.

The smallest number of steps for a complete run depends on the residual of Newton's iteration, although the
solution does not. With the divided equation, which is used here, alpha = 0, e = 1 and delta = 0.8 need seven
steps, as in the paper. With the undivided equation, runs of 5 to 7 steps jump over the whole layer in one step,
to a meaningless root, and proper runs start at 8 steps.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom import checks
from carom.impact.geometry import NormalMotion

_MOST_INTERVALS = 3  # a run still in the layer after this multiple of the exact duration is stopped


@dataclass(frozen=True)
class LayerRun:
    """A passage through the layer by an integrator; the run may have failed.

    Parameters
    ----------
    t, x, velocity, u : (K,) arrays
        Time since entry [s], gap coordinate [m], its rate xdot [m/s], and the velocity in the flat
        coordinate ``u = b xdot / x`` [m/s], which is what enters and leaves the layer.
    normal_force : (K,) array
        Contact force ``m a`` dual to u at the saved states [N].
    completed : bool
        Whether x came back to the edge of the layer.
    message : str
        How the run ended, in a sentence.
    iterations : (K - 1,) array
        Newton iterations of each step.
    velocity_error : float
        Greatest ``|xdot - exact xdot| / v0`` over the saved states; inf for a failed run.
    """

    t: np.ndarray
    x: np.ndarray
    velocity: np.ndarray
    u: np.ndarray
    normal_force: np.ndarray
    completed: bool
    message: str
    iterations: np.ndarray = field(repr=False)
    velocity_error: float


def newmark_constants(alpha) -> tuple[float, float, float]:
    """Return the checked ``alpha``, ``beta = (1 + alpha)^2/4`` and ``gamma = 1/2 + alpha``."""
    alpha = checks.number("alpha", alpha, least=0.0, most=1.0 / 3.0)
    return alpha, 0.25 * (1.0 + alpha) ** 2, 0.5 + alpha


def checked_layer(speed, restitution, width, penetration) -> NormalMotion:
    """Return the motion through the layer of checked numbers."""
    v0, b = checks.scale("speed", speed, "m/s"), checks.scale("width", width, "m")
    checks.number("restitution", restitution, above=0.0, most=1.0)
    checks.number("penetration", penetration, above=0.0, below=1.0)
    e, delta = checks.scale("restitution", restitution), checks.scale("penetration", penetration)
    return NormalMotion(v0, e, b, delta)


def hht_alpha_layer(
    speed, restitution, *, mass, width, penetration, steps, alpha=0.0,
    tolerance=1e-12, max_iterations=50,
) -> LayerRun:  # fmt: skip
    """Integrate one frictionless passage through the layer by HHT-alpha.

    A step from n to n+1 solves ``a_{n+1} = (1 - alpha) phi_{n+1} + alpha phi_n`` with Newmark's formulas, by
    plain Newton iterations that start from the previous acceleration. The run fails at a step to x <= 0, where
    the equation is not defined. It ends when x >= b. The phase (compression or restitution) is that at the
    beginning of the step, so the force is smooth inside a step; for e < 1 the error of the turning point is
    less than one step.

    Parameters
    ----------
    speed : float
        Speed of entry v0 > 0 [m/s].
    restitution : float
        Kinematic coefficient e in (0, 1].
    mass : float
        Effective mass ``1 / W_nn`` [kg]. It only scales the force.
    width, penetration : float
        Width b [m] and greatest penetration delta in (0, 1) of the layer.
    steps : int
        Steps N, at most 100 000, over the exact impact interval ``T_c (1 + 1/e)``; the step is interval / N.
    alpha : float
        Parameter of the method in [0, 1/3]; default 0, average acceleration.
    tolerance, max_iterations : float, int
        Tolerance in (0, 1), and at most 10 000 iterations. Newton's iteration stops at
        ``|change of a| <= tolerance (|a| + v0^2/b)``.

    Returns
    -------
    LayerRun
        The passage. If the method fails, ``completed`` is False and ``message`` has the reason.
    """
    exact = checked_layer(speed, restitution, width, penetration)
    v0, e, b = exact.approach_speed, exact.restitution, exact.width
    m = checks.scale("mass", mass, "kg")
    steps = checks.integer("steps", steps, least=1, most=100_000)
    tolerance = checks.number("tolerance", tolerance, above=0.0, below=1.0)
    max_iterations = checks.integer("max_iterations", max_iterations, least=1, most=10_000)
    alpha, beta, gamma = newmark_constants(alpha)
    h = (exact.compression_time + exact.restitution_time) / steps
    press = exact.acceleration

    x, v, k, message, iterations = b, -v0, press, "", []
    a = v * v / x + k * x / b
    saved = [(0.0, x, v, m * k)]
    while not message:
        phi, a1, converged = v * v / x + k * x / b, a, False
        rounds = 0
        for _ in range(max_iterations + 1):
            x1 = x + h * v + h * h * ((0.5 - beta) * a + beta * a1)
            v1 = v + h * ((1.0 - gamma) * a + gamma * a1)
            if converged or not x1 > 0.0:
                break
            # r(a1) = 0,  dr/da1 = 1 - (1 - alpha)(dphi/dv gamma h + dphi/dx beta h^2)
            r = a1 - (1.0 - alpha) * (v1 * v1 / x1 + k * x1 / b) - alpha * phi
            slope = 2.0 * v1 / x1 * gamma * h + (k / b - (v1 / x1) ** 2) * beta * h * h
            change = -r / (1.0 - (1.0 - alpha) * slope)
            a1, rounds = a1 + change, rounds + 1
            converged = abs(change) <= tolerance * (abs(a1) + v0 * v0 / b)
        number = len(saved)
        if not x1 > 0.0:
            message = f"Step {number} left the layer through x = 0, where its equation ends."
        elif not converged:
            message = f"Newton's iteration of step {number} did not converge."
        else:
            x, v, a = x1, v1, a1
            k = press if v < 0.0 else e * e * press
            iterations.append(rounds)
            saved.append((number * h, x, v, m * k))
            if x >= b:
                message = "The run left the layer at its edge."
            elif number == _MOST_INTERVALS * steps:
                message = f"The run was still in the layer after {number} steps."
    t, gap, rate, force = np.array(saved).T
    completed = x >= b and len(saved) > 1
    error = float(np.max(np.abs(rate - exact.x_rate(t)))) / v0 if completed else np.inf
    return LayerRun(
        t, gap, rate, b * rate / gap, force, completed, message, np.array(iterations, int), error
    )


def completing_steps(speed, restitution, *, penetration, alpha=0.0, most=20) -> tuple[int, ...]:
    """Return all numbers of steps up to `most` (1 to 1000) with which HHT-alpha passes the layer.

    Mass and width only scale the equation. The numbers may have gaps, because a step that jumps over the whole
    layer (to a meaningless root) also counts as a passage.
    """
    return tuple(
        n
        for n in range(1, checks.integer("most", most, least=1, most=1000) + 1)
        if hht_alpha_layer(
            speed, restitution, mass=1.0, width=1.0, penetration=penetration, steps=n, alpha=alpha
        ).completed
    )


def first_completing_steps(speed, restitution, *, penetration, alpha=0.0, most=20) -> int | None:
    """Return the smallest number of steps with which HHT-alpha passes the layer; None if it is above `most`.

    It is seven for e = 1, delta = 0.8, alpha = 0, as in the paper. For alpha of 0.1 or more it is five, by a
    jump over the layer in one step (with errors above 100 %); `completing_steps` shows the gap.
    """
    found = completing_steps(speed, restitution, penetration=penetration, alpha=alpha, most=most)
    return found[0] if found else None
