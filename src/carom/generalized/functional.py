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
_FIRST = (1.0 / 12.0, -2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 12.0)  # weights of f(-2h) ... f(2h)
_SECOND = (-1.0 / 12.0, 4.0 / 3.0, -2.5, 4.0 / 3.0, -1.0 / 12.0)


class FunctionalModel:
    """Functions of a system of n coordinates, with `holonomic` and `rows` further constraints."""

    def __init__(self, n: int, given: dict[str, Callable | None], holonomic: int, rows: int):
        self.n, self.holonomic, self.rows = n, holonomic, holonomic + rows
        self.given = {name: as_array(one) for name, one in given.items()}
        self.contacts: list[tuple[Any, Any, Any, int]] = []

    def add_contact(self, gap, gradient, tangent, count: int) -> None:
        """Take the functions of a contact; `count` tangents."""
        self.contacts.append((as_array(gap), as_array(gradient), as_array(tangent), count))

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
        n, metric = self.n, self.given["metric"]
        slope = self.given["metric_derivative"] or derivative(metric, n, (n, n))

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

        return joined(inertia, metric, slope)

    def loads(self) -> Callable:
        """Return V, Q - dV, Q v."""
        n, like = self.n, self.given["metric"]
        potential = self.given["potential"] or joined(_nothing, like)
        slope = self.given["potential_gradient"] or derivative(potential, n, ())
        force = self.given["force"] or joined(_no_force, like)

        def loads(t, x):
            q, v = x[:n].copy(), x[n:].copy()
            out = np.zeros(n + 2)
            Q, dV = force(t, q, v), slope(q)
            out[0] = potential(q)
            for j in range(n):
                out[1 + j] = Q[j] - dV[j]
                out[n + 1] += Q[j] * v[j]
            return out

        return joined(loads, potential, slope, force)

    def row_terms(self) -> Callable:
        """Return phi, A, (dA/dt) v."""
        n, h, given = self.n, self.holonomic, self.given
        parts = []
        if h:
            phi, slope = given["constraint"], given["constraint_jacobian"]
            bend = along(slope, n, h) if slope else second(phi, n, (h,))
            slope = slope or swapped(derivative(phi, n, (h,)), n, h)
            parts.append((h, phi, slope, bend))
        if self.rows > h:
            rows = given["rows"]
            parts.append((0, joined(_no_positions, rows), rows, along(rows, n, self.rows - h)))
        made = None
        for start, (values, phi, slope, bend) in zip((0, h) if h else (h,), parts):
            made = _rows(made, n, values, h, self.rows, start, phi, slope, bend)
        assert made is not None
        return made

    def contact_terms(self) -> Callable:
        """Return gaps, G, (dG/dt) v."""
        n, made = self.n, None
        for c, (gap, gradient, tangent, count) in enumerate(self.contacts):
            normal = gradient or derivative(gap, n, ())
            bend = along_one(gradient, n) if gradient else second(gap, n, ())
            if tangent is None:
                tangent = joined(_no_rows, gap)
            elif np.ndim(tangent(np.ones(n))) == 1:
                tangent = as_rows(tangent, n)
            turn = along(tangent, n, count)
            made = _contact(made, n, c, len(self.contacts), count, gap, normal, tangent, bend, turn)
        assert made is not None
        return made


# A function for several contacts calls the one for those before: compiled code has no list of functions.


def _rows(before, n, values, h, k, start, phi, slope, bend):
    """Return the terms of one block of rows, after those of the blocks `before`."""
    before = before or joined(_zeros(h + k * n + k), phi, slope, bend)
    height = values if values else k - start

    def rows(t, x):
        out = before(t, x)
        q, v = x[:n].copy(), x[n:].copy()
        y, A, rate = phi(q), slope(q), bend(q, v)
        for i in range(values):
            out[i] = y[i]
        for i in range(height):
            for j in range(n):
                out[h + (start + i) * n + j] = A[i, j]
            out[h + k * n + start + i] = rate[i]
        return out

    return joined(rows, before, phi, slope, bend)


def _contact(before, n, c, C, count, gap, normal, tangent, bend, turn):
    """Return the terms of one contact, after those of the contacts `before`."""
    before = before or joined(_zeros(C * (4 + 3 * n)), gap, normal, tangent)
    g, r = C + 3 * n * c, C + 3 * n * C + 3 * c

    def contact(t, x):
        out = before(t, x)
        q, v = x[:n].copy(), x[n:].copy()
        out[c] = gap(q)
        G, rows, rate = normal(q), tangent(q), turn(q, v)
        for j in range(n):
            out[g + j] = G[j]
        out[r] = bend(q, v)
        for i in range(count):
            for j in range(n):
                out[g + n * (1 + i) + j] = rows[i, j]
            out[r + 1 + i] = rate[i]
        return out

    return joined(contact, before, gap, normal, tangent, bend, turn)


def _zeros(size):
    def zeros(t, x):
        return np.zeros(size)

    return zeros


def _nothing(q):
    return 0.0


def _no_force(t, q, v):
    return np.zeros(q.size)


def _no_positions(q):
    return np.zeros(0)


def _no_rows(q):
    return np.zeros((0, q.size))


def compiled(function) -> bool:
    """Return whether Numba has compiled a function."""
    from numba.core.dispatcher import Dispatcher

    return isinstance(function, Dispatcher)


def as_array(function) -> Any:
    """Return a plain function that gives an array, where it may give lists; others as they are."""
    if function is None or compiled(function):
        return function
    return lambda *arguments: np.asarray(function(*arguments), dtype=float)


def joined(function, *parts) -> Any:
    """Compile `function` if all that it calls is compiled."""
    if all(compiled(one) for one in parts):
        from numba import njit

        return njit(function)
    return function


# What follows is in loops over numbers: array expressions would take Numba seconds to compile.


def derivative(f, n, shape):
    """Return the derivatives (n, *shape) of f, a number or an array of one or two axes."""
    a, b = (*shape, 1, 1)[:2]

    def of_number(q):
        out = np.zeros(n)
        for k in range(n):
            h, at = STEP * max(1.0, abs(q[k])), q[k]
            for s in (-2, -1, 1, 2):
                q[k] = at + s * h
                out[k] += _FIRST[s + 2] / h * f(q)
            q[k] = at
        return out

    def of_vector(q):
        out = np.zeros((n, a))
        for k in range(n):
            h, at = STEP * max(1.0, abs(q[k])), q[k]
            for s in (-2, -1, 1, 2):
                q[k] = at + s * h
                y = f(q)
                for i in range(a):
                    out[k, i] += _FIRST[s + 2] / h * y[i]
            q[k] = at
        return out

    def of_matrix(q):
        out = np.zeros((n, a, b))
        for k in range(n):
            h, at = STEP * max(1.0, abs(q[k])), q[k]
            for s in (-2, -1, 1, 2):
                q[k] = at + s * h
                y = f(q)
                for i in range(a):
                    for j in range(b):
                        out[k, i, j] += _FIRST[s + 2] / h * y[i, j]
            q[k] = at
        return out

    return joined((of_number, of_vector, of_matrix)[len(shape)], f)


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
    """Return how long a motion with velocities v takes to go as far as coordinates of order 1 are."""
    speed, size = 0.0, 1.0
    for j in range(q.size):
        speed, size = max(speed, abs(v[j])), max(size, abs(q[j]))
    return size / speed if speed > 0.0 else 0.0


def along(rows, n, m):
    """Return (d rows/dt) v (m,), from the rows a little further along v and back."""
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
    each = along(as_rows(row, n), n, 1)

    def rate(q, v):
        return each(q, v)[0]

    return joined(rate, each)


def second(f, n, shape):
    """Return the second derivative of f along v; f is a number or has one axis."""
    reach, m = joined(_reach, f), (*shape, 1)[0]

    def of_number(q, v):
        out, h, y = 0.0, STEP_TWICE * reach(q, v), np.zeros(n)
        if h > 0.0:
            for s in range(-2, 3):
                for j in range(n):
                    y[j] = q[j] + s * h * v[j]
                out += _SECOND[s + 2] / (h * h) * f(y)
        return out

    def of_vector(q, v):
        out, h, y = np.zeros(m), STEP_TWICE * reach(q, v), np.zeros(n)
        if h > 0.0:
            for s in range(-2, 3):
                for j in range(n):
                    y[j] = q[j] + s * h * v[j]
                z = f(y)
                for i in range(m):
                    out[i] += _SECOND[s + 2] / (h * h) * z[i]
        return out

    return joined((of_number, of_vector)[len(shape)], f, reach)
