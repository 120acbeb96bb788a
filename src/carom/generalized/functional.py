"""A `GeneralizedSystem` from user-defined functions, with given derivatives or central differences."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from carom._compiled.composed import joined
from carom._compiled.user_functions import raised, returned
from carom.generalized.differences import (
    along,
    along_one,
    as_array,
    as_rows,
    derivative,
    points,
    second,
    swapped,
)


class FunctionalModel:
    """Functions of a system of n coordinates, with `holonomic` constraints and `rows` further ones."""

    def __init__(self, n: int, given: dict[str, Callable | None], holonomic: int, rows: int):
        self.n, self.holonomic, self.rows = n, holonomic, holonomic + rows
        self.given = {name: as_array(one) for name, one in given.items()}
        self.contacts: list[tuple[Any, Any, Any, int]] = []

    def add_contact(self, gap, gradient, tangent, count: int) -> None:
        """Store the functions of a contact with `count` tangents."""
        self.contacts.append((as_array(gap), as_array(gradient), as_array(tangent), count))

    def metric_at(self, q) -> np.ndarray:
        """Return M (n, n) at numbers."""
        return np.array(self.given["metric"](q.copy()), dtype=float)

    def addresses(self, functions) -> list[int]:
        """Return the addresses of the four functions."""
        n, C = self.n, len(self.contacts)
        sizes = (n * n + n, n + 2, self.holonomic + self.rows * (n + 1), C * (4 + 3 * n))
        made: list[Any] = [self.inertia(), self.loads()]
        made.append(self.row_terms() if self.rows else None)
        made.append(self.contact_terms() if C else None)
        return [
            functions.address(one, (2 * n,), (size,), self.fault) if one is not None else 0
            for one, size in zip(made, sizes)
        ]

    def fault(self, t: float, x: np.ndarray) -> str:
        """Return which function raises an error or has a result that is not finite, at a state or beside it.

        Return "" if none has: their products overflow.
        """
        n, parts = self.n, {name: f for name, f in self.given.items() if f is not None}
        for c, (gap, gradient, tangent, _) in enumerate(self.contacts):
            own = {"gap": gap, "gap_gradient": gradient, "tangent": tangent}
            parts |= {f"{name} of contact {c}": f for name, f in own.items() if f is not None}
        for q in points(x[:n], x[n:]):
            for name, f in parts.items():
                try:
                    values = f(t, q.copy(), x[n:].copy()) if name == "force" else f(q.copy())
                except Exception as error:
                    return f"the function {name!r} {raised(error)}"
                if said := returned(values):
                    return f"the function {name!r} {said}"
        return ""

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
        parts: list[tuple[int, Any, Any, Any]] = []
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


# The function for several contacts calls that for the contacts before: compiled code has no list of functions.


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
