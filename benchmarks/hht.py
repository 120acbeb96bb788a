"""HHT-alpha for ``M qdd = f(t, q, qd)`` in vector coordinates (Hilber, Hughes, Taylor 1977).

In the paper's parameters, ``0 <= alpha <= 1/3``, ``beta = (1 + alpha)^2/4`` and
``gamma = 1/2 + alpha``, one step solves (h the step, a the acceleration)::

    M a_{n+1} = (1 - alpha) f_{n+1} + alpha f_n
    q_{n+1} = q_n + h v_n + h^2 ((1/2 - beta) a_n + beta a_{n+1})
    v_{n+1} = v_n + h ((1 - gamma) a_n + gamma a_{n+1})

Elsewhere the parameter is often alpha_H = -alpha in [-1/3, 0], and the weights are written
``(1 + alpha_H) f_{n+1} - alpha_H f_n``, which are the same numbers. The order is 2 for every alpha;
alpha > 0 damps high frequencies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from carom import checks
from carom.baselines.hht_layer import newmark_constants
from carom.baselines.moreau_jean import MOST_STEPS


@dataclass(frozen=True)
class HHTRun:
    """Motion computed by `hht_alpha`.

    Parameters
    ----------
    t : (T,) array
        Times [s].
    position, velocity, acceleration : (T, n) arrays
        Coordinates q, their rates, and the accelerations of the method (these belong to the time
        ``t - alpha h``; at t they are accurate to first order).
    success : bool
        Whether the run reached its end.
    message : str
        How the run ended, in a sentence.
    iterations : (T - 1,) array
        Newton iterations of each step.
    """

    t: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    success: bool
    message: str
    iterations: np.ndarray = field(repr=False)


def hht_alpha(
    mass, force: Callable, position, velocity, duration, *, step, alpha=0.0,
    jacobian: Callable | None = None, tolerance=1e-12, max_iterations=30,
) -> HHTRun:  # fmt: skip
    """Integrate ``M qdd = f(t, q, qd)`` by HHT-alpha with Newton iterations in each step.

    Parameters
    ----------
    mass : array_like, shape (n, n)
        Constant mass matrix.
    force : callable
        ``force(t, q, v)`` returns the (n,) generalised force.
    position, velocity : array_like, shape (n,)
        State at t = 0.
    duration, step : float
        Duration of the run and time step [s], at most a million steps; the last step is shortened to end at
        `duration`.
    alpha : float
        Parameter in [0, 1/3]. Default 0 (trapezoidal rule, no numerical damping).
    jacobian : callable, optional
        ``jacobian(t, q, v)`` returns ``(df/dq, df/dv)``, each (n, n). Default: central differences.
    tolerance, max_iterations : float, int
        Tolerance in (0, 1), and at most 10 000 iterations. Newton's iteration stops when the last change of
        every velocity is below `tolerance` times the greatest velocity.

    Returns
    -------
    HHTRun
        The motion. If Newton's iteration does not converge, the motion up to that step, with ``success`` False.

    Raises
    ------
    ValueError
        If an argument is out of range or of the wrong shape.
    """
    q = checks.finite_array("position", position, (None,))
    if not q.size:
        raise ValueError(
            f"position must have at least one coordinate, got {checks.shown(position)}"
        )
    n, fit = q.size, f"as position has {q.size} coordinates"
    v = checks.finite_array("velocity", velocity, (None,))
    M = checks.finite_array("mass", mass, (None, None), "kg")
    if v.shape != (n,) or M.shape != (n, n):
        raise ValueError(
            f"velocity and mass must have shapes ({n},) and ({n}, {n}), {fit}, got {v.shape} and {M.shape}"
        )
    if not np.linalg.cond(M) < 1e15:
        raise ValueError(f"mass must be regular, got {checks.shown(mass)}")
    end = checks.number("duration", duration, least=0.0, unit="s")
    h_all = checks.number("step", step, above=0.0, unit="s")
    alpha, beta, gamma = newmark_constants(alpha)
    count = checks.steps(end, h_all, MOST_STEPS)
    tolerance = checks.number("tolerance", tolerance, above=0.0, below=1.0)
    max_iterations = checks.integer("max_iterations", max_iterations, least=1, most=10_000)
    checks.function("force", force)
    checks.function("jacobian", jacobian, optional=True)
    start = "(0, position, velocity)"
    f = checks.finite_array(f"force{start}", checks.call("force", force, 0.0, q, v), (n,), "N")
    slopes = jacobian or (lambda t, q, v: _differences(force, t, q, v))
    if jacobian is not None:
        checks.finite_array(
            f"jacobian{start}", checks.call("jacobian", jacobian, 0.0, q, v), (2, n, n)
        )

    a = np.linalg.solve(M, f)
    t, message, iterations, saved = 0.0, "The run reached its end.", [], [(0.0, q, v, a)]
    for number in range(1, count + 1):
        t1 = min(number * h_all, end)
        h, a1, change, rounds = t1 - t, a, np.inf, 0
        for _ in range(max_iterations + 1):
            q1 = q + h * v + h * h * ((0.5 - beta) * a + beta * a1)
            v1 = v + h * ((1.0 - gamma) * a + gamma * a1)
            f1 = np.asarray(checks.call("force", force, t1, q1, v1), dtype=np.float64)
            if change <= tolerance:
                break
            K, C = slopes(t1, q1, v1)
            residual = M @ a1 - (1.0 - alpha) * f1 - alpha * f
            tangent = M - (1.0 - alpha) * (beta * h * h * K + gamma * h * C)
            try:
                delta = np.linalg.solve(tangent, -residual)
            except np.linalg.LinAlgError:  # singular: no Newton step
                change = np.inf
                break
            a1, rounds = a1 + delta, rounds + 1
            change = h * np.abs(delta).max() / max(np.abs(v1).max(), h * np.abs(a1).max(), 1e-300)
        if not change <= tolerance:
            message = f"Newton's iteration of step {number} did not converge; take a smaller step."
            break
        t, q, v, a, f = t1, q1, v1, a1, f1
        iterations.append(rounds)
        saved.append((t, q, v, a))
    times, q_all, v_all, a_all = (np.array(column) for column in zip(*saved))
    return HHTRun(times, q_all, v_all, a_all, t >= end, message, np.array(iterations, int))


def _differences(force, t, q, v):
    """Return ``df/dq`` and ``df/dv`` by central differences."""
    columns = []
    for which, vector in enumerate((q, v)):
        size = 6e-6 * max(1.0, float(np.abs(vector).max()))
        block = np.empty((q.size, q.size))
        for i in range(q.size):
            shift = np.zeros(q.size)
            shift[i] = size
            up = force(t, q + shift, v) if which == 0 else force(t, q, v + shift)
            down = force(t, q - shift, v) if which == 0 else force(t, q, v - shift)
            block[:, i] = (np.asarray(up) - np.asarray(down)) / (2.0 * size)
        columns.append(block)
    return columns
