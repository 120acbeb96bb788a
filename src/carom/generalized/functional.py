"""A system in coordinates from functions of the user's; derivatives that are not given by central differences.

    f' = [8 (f(+h) - f(-h)) - (f(+2h) - f(-2h))] / 12 h,   h = eps^(1/5) max(1, |q|) = 7.4e-4 max(1, |q|)

of order 4: its error is about 1e-12 of f's own scale, round-off and truncation alike, where f changes over
lengths of 1. Second derivatives, of constraints and held gaps along the velocity, take h = eps^(1/6): 1e-10.

What is handed to the compiled loop is compiled too if all functions in it are, and plain Python else.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

STEP = float(np.finfo(float).eps ** 0.2)
STEP_TWICE = float(np.finfo(float).eps ** (1.0 / 6.0))


class FunctionalModel:
    """Functions of a system of n coordinates."""

    def __init__(self, n: int, given: dict[str, Callable | None], holonomic: int, rows: int):
        self.n, self.holonomic, self.rows = n, holonomic, holonomic + rows
        self.given = given
        self.contacts: list[tuple[Callable, Callable | None, Callable | None, int]] = []

    def metric_at(self, q) -> np.ndarray:
        """Return M (n, n) at numbers."""
        return np.array(self.given["metric"](q.copy()), dtype=float)

    def addresses(self, functions) -> list[int]:
        """Return where the four functions are."""
        n, C = self.n, len(self.contacts)
        sizes = (n * n + n, n + 2, self.holonomic + self.rows * (n + 1), C * (4 + 3 * n))
        made = [self.inertia(), self.loads()]
        made.append(self.row_terms() if self.rows else None)
        made.append(self.contact_terms() if C else None)
        return [
            functions.address(one, (2 * n,), (size,)) if one is not None else 0
            for one, size in zip(made, sizes)
        ]

    def inertia(self) -> Callable:
        """Return M and Gamma_kij v_i v_j."""
        n, metric, slope = self.n, self.given["metric"], self.given["metric_derivative"]
        slope = slope or _each(metric, n, n * n, (n, n, n))

        def inertia(t, x):
            q, v = x[:n].copy(), x[n:]
            M, dM = metric(q), slope(q)
            out = np.zeros(n * n + n)
            for i in range(n):
                for j in range(n):
                    out[n * i + j] = M[i, j]
                    for k in range(n):
                        w = v[k] * v[j]
                        out[n * n + i] += dM[k, i, j] * w - 0.5 * dM[i, k, j] * w
            return out

        return _joined(inertia, metric, slope)

    def loads(self) -> Callable:
        """Return V, Q - dV, Q v."""
        n, nothing = self.n, _as(self.given["metric"], _nothing)
        potential, force = self.given["potential"] or nothing, self.given["force"]
        slope = self.given["potential_gradient"]
        if slope is None:
            slope = _gradient(potential, n)
        if force is None:
            force = _as(self.given["metric"], _no_force)

        def loads(t, x):
            q, v = x[:n].copy(), x[n:].copy()
            out = np.zeros(n + 2)
            Q, dV = force(t, q, v), slope(q)
            out[0] = potential(q)
            for j in range(n):
                out[1 + j] = Q[j] - dV[j]
                out[n + 1] += Q[j] * v[j]
            return out

        return _joined(loads, potential, slope, force)

    def row_terms(self) -> Callable:
        """Return phi, A, (dA/dt) v."""
        n, h, k, given = self.n, self.holonomic, self.rows, self.given
        like = given["metric"]
        phi = given["constraint"] or _as(like, _nothing_at_all)
        slope = given["constraint_jacobian"]
        if slope is None:
            slope = _jacobian(phi, n, h) if h else _as(like, _no_rows)
        rows = given["rows"] or _as(like, _no_rows)

        bend = _along(slope, n, h) if given["constraint_jacobian"] else _second(phi, h)
        along = _along(rows, n, k - h)

        def row_terms(t, x):
            q, v = x[:n].copy(), x[n:].copy()
            out = np.zeros(h + k * n + k)
            a, r = h + k * n, h + h * n
            if h > 0:
                out[:h] = phi(q)
                out[h:r] = slope(q).ravel()
                out[a : a + h] = bend(q, v)
            if k > h:
                out[r:a] = rows(q).ravel()
                out[a + h :] = along(q, v)
            return out

        return _joined(row_terms, phi, slope, bend, rows, along)

    def contact_terms(self) -> Callable:
        """Return gaps, G, (dG/dt) v."""
        n, C = self.n, len(self.contacts)
        parts = [self.contact_part(*one) for one in self.contacts]
        size = 4 + 3 * n

        def scatter(out, c, part):
            out[c] = part[0]
            g, r = C + 3 * n * c, C + 3 * n * C + 3 * c
            for j in range(3 * n):
                out[g + j] = part[1 + j]
            for j in range(3):
                out[r + j] = part[1 + 3 * n + j]

        chain = parts[0]
        scatter = _joined(scatter, chain) if C else scatter
        made = None
        for c, part in enumerate(
            parts
        ):  # one calls the one before: no list of functions in compiled code
            made = _chained(made, part, scatter, c, C * size)
        assert made is not None
        return made

    def contact_part(self, gap, gradient, tangent, count) -> Callable:
        """Return gap, G, (dG/dt) v of one contact."""
        n = self.n
        slope = gradient or _gradient(gap, n)
        rows = tangent or _as(gap, _no_rows)

        def G(q):
            out = np.zeros((3, n))
            out[0] = slope(q)
            if count == 1:
                out[1] = np.asarray(rows(q)).reshape(n)
            elif count == 2:
                out[1:] = rows(q)
            return out

        def one(q):
            out = np.zeros(1)
            out[0] = gap(q)
            return out

        G = _joined(G, slope, rows)
        along = _along(G, n, 3)
        bend = _second(_joined(one, gap), 1)
        exact = gradient is not None

        def part(t, x):
            q, v = x[:n].copy(), x[n:].copy()
            out = np.zeros(4 + 3 * n)
            out[0] = gap(q)
            out[1 : 1 + 3 * n] = G(q).ravel()
            out[1 + 3 * n :] = along(q, v)
            if not exact:
                out[1 + 3 * n] = bend(q, v)[0]
            return out

        return _joined(part, gap, G, along, bend)


def _chained(before, part, scatter, c, size):
    if before is None:

        def first(t, x):
            out = np.zeros(size)
            scatter(out, c, part(t, x))
            return out

        return _joined(first, part)

    def further(t, x):
        out = before(t, x)
        scatter(out, c, part(t, x))
        return out

    return _joined(further, part, before)


def _nothing(q):
    return 0.0


def _nothing_at_all(q):
    return np.zeros(0)


def _no_force(t, q, v):
    return np.zeros(q.size)


def _no_rows(q):
    return np.zeros((0, q.size))


def compiled(function) -> bool:
    """Return whether Numba has compiled a function."""
    from numba.core.dispatcher import Dispatcher

    return isinstance(function, Dispatcher)


def _as(other, function) -> Any:
    return _joined(function, other)


def _joined(function, *parts) -> Any:
    """Compile `function` if all that it calls is compiled."""
    if all(compiled(one) for one in parts):
        from numba import njit

        return njit(function)
    return function


def _each(f, n, size, shape):
    """Return the derivatives of an array-valued f, the coordinate first."""

    def derivative(q):
        out = np.zeros((n, size))
        for k in range(n):
            h, at = STEP * max(1.0, abs(q[k])), q[k]
            for s in range(1, 3):
                w = (8.0 if s == 1 else -1.0) / (12.0 * h)
                q[k] = at + s * h
                out[k] += w * np.asarray(f(q)).ravel()
                q[k] = at - s * h
                out[k] -= w * np.asarray(f(q)).ravel()
            q[k] = at
        return out.reshape(shape)

    return _joined(derivative, f)


def _gradient(f, n):
    """Return the gradient of a scalar f."""

    def gradient(q):
        out = np.zeros(n)
        for k in range(n):
            h, at = STEP * max(1.0, abs(q[k])), q[k]
            for s in range(1, 3):
                w = (8.0 if s == 1 else -1.0) / (12.0 * h)
                q[k] = at + s * h
                out[k] += w * f(q)
                q[k] = at - s * h
                out[k] -= w * f(q)
            q[k] = at
        return out

    return _joined(gradient, f)


def _jacobian(f, n, m):
    """Return the rows (m, n) of a vector-valued f."""
    each = _each(f, n, m, (n, m))

    def jacobian(q):
        return each(q).T.copy()

    return _joined(jacobian, each)


def _along(rows, n, m):
    """Return (d rows/dt) v, from the rows a little further along v and back."""

    def along(q, v):
        speed, size = np.max(np.abs(v)), max(1.0, np.max(np.abs(q)))
        out = np.zeros(m)
        if not speed > 0.0:
            return out
        h = STEP * size / speed
        for s in range(1, 3):
            w = (8.0 if s == 1 else -1.0) / (12.0 * h)
            ahead, back = rows(q + s * h * v), rows(q - s * h * v)
            for r in range(m):
                for j in range(n):
                    out[r] += w * (ahead[r, j] - back[r, j]) * v[j]
        return out

    return _joined(along, rows)


def _second(f, m):
    """Return the second derivative of a vector-valued f along v."""

    def second(q, v):
        speed, size = np.max(np.abs(v)), max(1.0, np.max(np.abs(q)))
        out = np.zeros(m)
        if not speed > 0.0:
            return out
        h = STEP_TWICE * size / speed
        w = 1.0 / (12.0 * h * h)
        out -= 30.0 * w * f(q)
        for s in range(1, 3):
            out += (16.0 if s == 1 else -1.0) * w * (f(q + s * h * v) + f(q - s * h * v))
        return out

    return _joined(second, f)
