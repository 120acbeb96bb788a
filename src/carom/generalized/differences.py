"""Derivatives of functions by central differences, as compiled functions.

    f' = [8 (f(+h) - f(-h)) - (f(+2h) - f(-2h))] / 12 h,   h = eps^(1/5) max(1, |q|) = 7.4e-4 max(1, |q|)

of order 4: the errors by round-off and by truncation are about 1e-12 of the scale of f, if f varies on a scale
of 1. Second derivatives, of constraints and gaps of persistent contacts along the velocity, use h = eps^(1/6),
with an error of 1e-10. (Mathematics page, §4.1.)

Functions of compiled functions are compiled too. Therefore the code has loops over numbers: Numba would need
seconds to compile array expressions.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from carom._compiled.composed import is_compiled, joined

STEP = float(np.finfo(float).eps ** 0.2)
STEP_TWICE = float(np.finfo(float).eps ** (1.0 / 6.0))
_FIRST = (1.0 / 12.0, -2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 12.0)  # weights of f(-2h) ... f(2h)
_SECOND = (-1.0 / 12.0, 4.0 / 3.0, -2.5, 4.0 / 3.0, -1.0 / 12.0)


def as_array(function) -> Any:
    """Return a function with arrays as results for a plain one that may return lists; others unchanged."""
    if function is None or is_compiled(function):
        return function
    return lambda *arguments: np.asarray(function(*arguments), dtype=float)


def flat(f, shape):
    """Return a function with the results of f, of `shape`, in one axis."""

    def of_number(q):
        out = np.empty(1)
        out[0] = f(q)
        return out

    def of_array(q):
        return np.ascontiguousarray(f(q)).reshape(-1)

    return joined(of_array if shape else of_number, f)


def derivative(f, n, shape):
    """Return the derivatives (n, *shape) of f, a number or an array."""
    g, m, whole = flat(f, shape), math.prod(shape), (n, *shape)

    def slope(q):
        out = np.zeros((n, m))
        for k in range(n):
            h, at = STEP * max(1.0, abs(q[k])), q[k]
            for s in (-2, -1, 1, 2):
                q[k] = at + s * h
                y = g(q)
                for i in range(m):
                    out[k, i] += _FIRST[s + 2] / h * y[i]
            q[k] = at
        return out.reshape(whole)

    return joined(slope, f, g)


def swapped(f, n, m):
    """Return the rows (m, n) from derivatives (n, m)."""

    def rows(q):
        y, out = f(q), np.zeros((m, n))
        for i in range(m):
            for j in range(n):
                out[i, j] = y[j, i]
        return out

    return joined(rows, f)


def as_rows(f, n):
    """Return one row (1, n) of a function that gives (n,)."""

    def rows(q):
        y, out = f(q), np.zeros((1, n))
        for j in range(n):
            out[0, j] = y[j]
        return out

    return joined(rows, f)


def _reach(q, v):
    """Return the time in which velocities v change coordinates by their own size, at least by 1."""
    speed, size = 0.0, 1.0
    for j in range(q.size):
        speed, size = max(speed, abs(v[j])), max(size, abs(q[j]))
    return size / speed if speed > 0.0 else 0.0


def points(q, v):
    """Yield the coordinates at which differences at a state (q, v) call functions, q first."""
    yield q
    for s in (-1, 1, -2, 2):
        for k in range(len(q)):
            yield q + s * STEP * max(1.0, abs(q[k])) * (np.arange(len(q)) == k)
        for step in (STEP, STEP_TWICE):
            yield q + s * step * _reach(q, v) * v


def along(rows, n, m):
    """Return (d rows/dt) v (m,), from the rows at points slightly forward and backward along v."""
    reach = joined(_reach, rows)

    def rates(q, v):
        out, h, y = np.zeros(m), STEP * reach(q, v), np.zeros(n)
        if h > 0.0:
            for s in (-2, -1, 1, 2):
                for j in range(n):
                    y[j] = q[j] + s * h * v[j]
                A = rows(y)
                for r in range(m):
                    for j in range(n):
                        out[r] += _FIRST[s + 2] / h * A[r, j] * v[j]
        return out

    return joined(rates, rows, reach)


def along_one(row, n):
    """Return (d row/dt) v of one row (n,)."""
    return first_of(along(as_rows(row, n), n, 1))


def first_of(f):
    """Return the first number of the result of a function of q and v."""

    def first(q, v):
        return f(q, v)[0]

    return joined(first, f)


def second(f, n, shape):
    """Return the second derivative of f along v; f is a number or has one axis."""
    g, reach, m = flat(f, shape), joined(_reach, f), math.prod(shape)

    def bend(q, v):
        out, h, y = np.zeros(m), STEP_TWICE * reach(q, v), np.zeros(n)
        if h > 0.0:
            for s in range(-2, 3):
                for j in range(n):
                    y[j] = q[j] + s * h * v[j]
                z = g(y)
                for i in range(m):
                    out[i] += _SECOND[s + 2] / (h * h) * z[i]
        return out

    made = joined(bend, g, reach)
    return made if shape else first_of(made)
