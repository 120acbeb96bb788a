"""A `GeneralizedSystem` from SymPy expressions, with exact derivatives and generated code for Numba.

Its code is written by `carom.scene.expressions`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from carom import checks
from carom.generalized.thresholds import ZERO_EXPRESSION
from carom.scene import expressions

TERMS = ("inertia", "loads", "row_terms", "contact_terms")  # of the compiled functions


class SymbolicModel:
    """Expressions of a system, in symbols of its own: coordinates q, velocities v, time t."""

    kind = "expression"

    @property
    def sp(self) -> Any:
        """SymPy, which pickles cannot have."""
        return checks.need("sympy", "GeneralizedSystem.from_sympy", "sympy")

    def __init__(
        self, coordinates, velocities, kinetic_energy, metric, potential, forces, constraints, rates,
        parameters, time,
    ):  # fmt: skip
        sp = self.sp
        self.coordinates = self.symbols("coordinates", coordinates)
        n = self.n = len(self.coordinates)
        if n == 0:
            raise ValueError("coordinates must have at least one coordinate, got none")
        functions = all(isinstance(q, sp.core.function.AppliedUndef) for q in self.coordinates)
        if velocities is None:
            velocities = [q.diff(q.args[0]) for q in self.coordinates] if functions else []
        else:
            self.each("velocities", velocities)
        self.velocities = self.symbols("velocities", velocities)
        if not (parameters is None or isinstance(parameters, Mapping)):
            raise ValueError(
                f"parameters must be a mapping from symbols to numbers, got {checks.shown(parameters)}"
            )
        self.parameters = dict(parameters or {})
        for symbol, value in self.parameters.items():
            if not isinstance(symbol, (str, sp.Basic)):
                raise ValueError(
                    f"parameters must have symbols as its keys, got {checks.shown(symbol)}"
                )
            checks.number(f"parameters[{symbol}]", value)
        if not (time is None or isinstance(time, sp.Symbol)):
            raise ValueError(f"time must be a symbol, got {checks.shown(time)}")
        self.names = [one.func.__name__ if functions else str(one) for one in self.coordinates]
        self.time = time if time is not None or not functions else self.coordinates[0].args[0]
        self.q = sp.symbols(f"q:{n}", real=True, cls=sp.Dummy)
        self.v = sp.symbols(f"v:{n}", real=True, cls=sp.Dummy)
        self.t, self.speeds = sp.Dummy("t", real=True), sp.Matrix(self.v)
        if (kinetic_energy is None) == (metric is None):
            raise ValueError("kinetic_energy or metric must be given, and not both")
        if metric is None:
            otherwise = "be a quadratic form of the velocities (without terms of degree 0 or 1)"
            self.M = self.form("kinetic_energy", kinetic_energy, 2, otherwise)
        else:
            entries = self.table("metric", metric, n)
            self.M = sp.Matrix(n, n, [self.take("metric", one, "q") for one in entries])
            if not all(self.is_zero(one) for one in self.M - self.M.T):
                raise ValueError(f"metric must be symmetric, got {checks.shown(metric)}")
        self.V = self.take("potential", potential, "q")
        given = [0] * n if forces is None else self.each("forces", forces)
        self.forces = [self.take("forces", one, "tqv") for one in given]
        constraints = checks.listed("constraints", constraints, "expressions")
        self.phi = [self.take("constraints", one, "q") for one in constraints]
        rates = checks.listed("rates", rates, "expressions")
        speeds = [self.linear("rates", one) for one in rates]
        self.A = [*map(self.gradient, self.phi), *speeds]
        self.holonomic, self.rows = len(self.phi), len(self.A)
        self.contacts: list[tuple[Any, list]] = []
        self._codes: list[tuple[Callable | None, int]] = []

    def take(self, name: str, expression, allowed: str):
        """Return an expression in the symbols of this model; only those in `allowed` may occur (of t, q, v)."""
        sp = self.sp
        result = expressions.of(name, expression)
        result = result.subs(list(zip(self.velocities, self.v)))  # first: they may be derivatives
        result = result.subs(list(zip(self.coordinates, self.q)))
        result = result.subs(list(self.parameters.items()))
        if self.time is not None:
            result = result.subs(self.time, self.t)
        symbols = {"t": {self.t}, "q": set(self.q), "v": set(self.v)}
        unknown = result.free_symbols.difference(*(symbols[a] for a in allowed))
        unknown = sorted(map(str, unknown))
        if unknown or result.atoms(sp.Derivative):
            what = {"t": "the time", "q": "coordinates", "v": "velocities"}
            raise ValueError(
                f"{name} must be in terms of {' and '.join(what[a] for a in allowed)} and parameters "
                f"with a value, got {checks.shown(expression)} with {', '.join(unknown) or 'derivatives'}"
            )
        return result

    def symbols(self, name: str, given) -> list:
        """Return a list of different symbols, functions or derivatives."""
        found = [expressions.of(name, one) for one in checks.listed(name, given, "symbols")]
        if any(one.is_number for one in found) or len(set(found)) != len(found):
            raise ValueError(f"{name} must be symbols, each once, got {checks.shown(given)}")
        return found

    def each(self, name: str, given) -> list:
        """Return the members of a sequence that has one for each coordinate."""
        members = checks.listed(name, given, "expressions")
        if len(members) != self.n:
            raise ValueError(
                f"{name} must be {self.n}, one for each coordinate, got {checks.shown(given)}"
            )
        return members

    def table(self, name: str, given, n: int) -> list:
        """Return the entries of a square matrix, row by row."""
        given = given.tolist() if isinstance(given, self.sp.MatrixBase) else given
        rows = checks.listed(name, given, "rows")
        rows = [checks.listed(name, row, "rows of expressions") for row in rows]
        shape = len(rows), *map(len, rows)
        if set(shape) != {n}:
            raise ValueError(f"{name} must have shape ({n}, {n}), got {shape[:2]}")
        return [one for row in rows for one in row]

    def form(self, name: str, given, degree: int, otherwise: str) -> Any:
        """Return the derivatives of this degree by the velocities, if the expression is a form of this degree.

        Then they do not have velocities, and its first ones times the velocities are `degree` times itself.
        """
        expression = self.take(name, given, "qv")
        slope = self.sp.Matrix([expression]).jacobian(self.v)
        rest = degree * expression - (slope * self.speeds)[0]
        result = slope if degree == 1 else slope.jacobian(self.v)
        if result.has(*self.v) or not self.is_zero(rest):
            raise ValueError(f"{name} must {otherwise}, got {checks.shown(given)}")
        return result

    def linear(self, name: str, given) -> list:
        """Return the row of an expression that is linear in the velocities."""
        otherwise = "be linear in the velocities, without a term of degree 0"
        return list(self.form(name, given, 1, otherwise))

    def is_zero(self, expression) -> bool:
        """Return whether an expression is zero, by its form or at some points."""
        sp = self.sp
        if expression == 0:
            return True
        symbols = [*self.q, *self.v, self.t]
        f = sp.lambdify(symbols, [expression, sp.Integer(1)], "math")
        points = 0.1 + 0.8 * np.random.default_rng(0).random((4, len(symbols)))
        return all(abs(f(*point)[0]) <= ZERO_EXPRESSION for point in points)

    def add_contact(self, gap, gradient, tangent) -> None:
        """Store the expressions of a contact; its gradient is derived, not given."""
        if callable(gap) and not hasattr(gap, "free_symbols"):
            raise ValueError("gap must be an expression in a system from SymPy, got a function")
        given = [] if tangent is None else tangent if isinstance(tangent, Sequence) else [tangent]
        if len(given) > 2:
            raise ValueError(f"tangent must be one or two expressions, got {len(given)}")
        rho = self.take("gap", gap, "q")
        rows = [self.linear("tangent", one) for one in given]
        normal = self.gradient(rho)
        if all(one == 0 for one in normal):
            raise ValueError(f"gap must depend on the coordinates, got {checks.shown(gap)}")
        empty = [[self.sp.Integer(0)] * self.n] * (2 - len(rows))
        self.contacts.append((rho, [normal, *rows, *empty]))
        self._codes = []

    def marks(self, mark_of: Callable) -> list[str]:
        """Return a mark of the code of each function."""
        return [f"{name}: {code and mark_of(code)}" for name, (code, _) in zip(TERMS, self.codes())]

    def __getstate__(self) -> dict:
        """Return what a pickle has; code is written again."""
        return {**vars(self), "_codes": []}

    def has_tangent(self, contact: int) -> bool:
        """Return whether a contact has a tangent."""
        return any(one != 0 for row in self.contacts[contact][1][1:] for one in row)

    def metric_at(self, q) -> np.ndarray:
        """Return M (n, n) at numbers."""
        M = self.sp.lambdify(self.q, self.M.tolist(), "math")
        return np.array(M(*map(float, q)), dtype=float)

    def inertia(self) -> list:
        """Return M and Gamma_kij v_i v_j = (dM/dt v)_k - d_k (v M v) / 2."""
        momentum = self.M * self.speeds
        slope = self.gradient(momentum.dot(self.speeds))
        return [*self.M, *(rate - one / 2 for rate, one in zip(self.rates(momentum), slope))]

    def loads(self) -> list:
        """Return V, Q - dV, Q v."""
        total = [f - slope for f, slope in zip(self.forces, self.gradient(self.V))]
        return [self.V, *total, sum(f * v for f, v in zip(self.forces, self.v))]

    def row_terms(self) -> list:
        """Return phi, A, (dA/dt) v."""
        return [*self.phi, *self.with_rates(self.A)]

    def contact_terms(self) -> list:
        """Return gaps, G, (dG/dt) v."""
        rows = [row for _, G in self.contacts for row in G]
        return [*(rho for rho, _ in self.contacts), *self.with_rates(rows)]

    def with_rates(self, rows: list) -> list:
        """Return the entries of rows, and (d row/dt) v of each."""
        A = self.sp.Matrix(len(rows), self.n, [one for row in rows for one in row])
        return [*A, *self.rates(A * self.speeds)] if rows else []

    def rates(self, functions) -> Any:
        """Return the rates of a column of functions of the coordinates, for constant velocities."""
        return functions.jacobian(self.q) * self.speeds

    def gradient(self, expression) -> list:
        """Return the derivatives of an expression by the coordinates."""
        return [self.sp.diff(expression, q) for q in self.q]

    def codes(self) -> list[tuple[Callable | None, int]]:
        """Return the four functions, None without results, and the number of their results."""
        if not self._codes:
            x, found = [*self.q, *self.v], []
            for name in TERMS:
                terms = getattr(self, name)()
                code = expressions.written(name, terms, x, self.t) if terms else None
                found.append((code, len(terms)))
            self._codes = found  # all at once: another thread may ask
        return self._codes

    def addresses(self, functions) -> tuple[list[int], list]:
        """Return the addresses of the four compiled functions, which have no parts."""
        result = []
        for name, (code, count) in zip(TERMS, self.codes()):
            given = (2 * self.n,), (count,), f"an expression ({name})"
            result.append(functions.written(code, *given) if code else 0)
        return result, []
