"""A `GeneralizedSystem` from SymPy expressions, with exact derivatives and generated code for Numba.

SymPy is imported here and nowhere else.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from carom import checks


def sympy() -> Any:
    """Return the module, or raise an error with the command that installs it."""
    return checks.need("sympy", "GeneralizedSystem.from_sympy", "sympy")


class SymbolicModel:
    """Expressions of a system, in symbols of its own: coordinates q, velocities v, time t."""

    kind = "expression"

    def __init__(
        self, coordinates, velocities, kinetic_energy, metric, potential, forces, constraints, rates,
        parameters, time,
    ):  # fmt: skip
        sp = self.sp = sympy()
        self.coordinates = self.symbols("coordinates", coordinates)
        n = self.n = len(self.coordinates)
        if n == 0:
            raise ValueError("coordinates must have at least one coordinate, got none")
        functions = all(isinstance(q, sp.core.function.AppliedUndef) for q in self.coordinates)
        if velocities is None and functions:
            velocities = [q.diff(q.args[0]) for q in self.coordinates]
        self.velocities = [] if velocities is None else self.symbols("velocities", velocities)
        if velocities is not None and len(self.velocities) != n:
            raise ValueError(
                f"velocities must be {n}, one for each coordinate, got {checks.shown(velocities)}"
            )
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
        self.time = time if time is not None or not functions else self.coordinates[0].args[0]
        self.q = sp.symbols(f"q:{n}", real=True, cls=sp.Dummy)
        self.v = sp.symbols(f"v:{n}", real=True, cls=sp.Dummy)
        self.t = sp.Dummy("t", real=True)
        q, v = list(self.q), list(self.v)

        if (kinetic_energy is None) == (metric is None):
            raise ValueError("kinetic_energy or metric must be given, and not both")
        if metric is None:
            T = self.take("kinetic_energy", kinetic_energy, "qv")
            self.M = sp.hessian(T, v)
            rest = T - sum(self.M[i, j] * v[i] * v[j] for i in range(n) for j in range(n)) / 2
            if self.M.has(*v) or not self.is_zero(rest):
                raise ValueError(
                    "kinetic_energy must be a quadratic form of the velocities (without terms of degree 0 "
                    f"or 1), got {checks.shown(kinetic_energy)}"
                )
        else:
            entries = self.table("metric", metric, n)
            self.M = sp.Matrix(n, n, [self.take("metric", one, "q") for one in entries])
            if not all(self.is_zero(one) for one in self.M - self.M.T):
                raise ValueError(f"metric must be symmetric, got {checks.shown(metric)}")
        self.V = self.take("potential", potential, "q")
        given = [0] * n if forces is None else checks.listed("forces", forces, "expressions")
        if len(given) != n:
            raise ValueError(
                f"forces must be {n}, one for each coordinate, got {checks.shown(forces)}"
            )
        self.forces = [self.take("forces", one, "tqv") for one in given]
        constraints = checks.listed("constraints", constraints, "expressions")
        self.phi = [self.take("constraints", one, "q") for one in constraints]
        rates = checks.listed("rates", rates, "expressions")
        speeds = [self.linear("rates", one) for one in rates]
        self.holonomic = len(self.phi)
        self.A = [[sp.diff(one, x) for x in q] for one in self.phi] + speeds
        self.rows = len(self.A)
        self.contacts: list[tuple[Any, list]] = []

    def take(self, name: str, expression, allowed: str):
        """Return an expression in the symbols of this model; only those in `allowed` may occur (of t, q, v)."""
        sp = self.sp
        result = self.expression(name, expression)
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

    def expression(self, name: str, given) -> Any:
        """Return an expression; raise an error for texts, which SymPy would evaluate, and other objects."""
        sp = self.sp
        result: Any = None
        with suppress(Exception):  # of any kind, in the conversion of a foreign object
            result = sp.sympify(given, strict=True)
        infinite = (sp.nan, sp.zoo, sp.oo, -sp.oo)
        good = isinstance(result, sp.Expr) and not result.has(*infinite)
        if isinstance(given, np.ndarray) or not good:
            raise ValueError(f"{name} must be a SymPy expression, got {checks.shown(given)}")
        return result

    def symbols(self, name: str, given) -> list:
        """Return a list of different symbols, functions or derivatives."""
        found = [self.expression(name, one) for one in checks.listed(name, given, "symbols")]
        if any(one.is_number for one in found) or len(set(found)) != len(found):
            raise ValueError(f"{name} must be symbols, each once, got {checks.shown(given)}")
        return found

    def table(self, name: str, given, n: int) -> list:
        """Return the entries of a square matrix, row by row."""
        rows = (
            given.tolist()
            if isinstance(given, self.sp.MatrixBase)
            else checks.listed(name, given, "rows")
        )
        rows = [checks.listed(name, row, "rows of expressions") for row in rows]
        if {len(rows), *map(len, rows)} != {n}:
            raise ValueError(
                f"{name} must have shape ({n}, {n}), got {(len(rows), *map(len, rows))[:2]}"
            )
        return [one for row in rows for one in row]

    def linear(self, name: str, expression) -> list:
        """Return the row of an expression that is linear in the velocities."""
        taken = self.take(name, expression, "qv")
        row = [self.sp.diff(taken, v) for v in self.v]
        rest = taken - sum(a * v for a, v in zip(row, self.v))
        if any(a.has(*self.v) for a in row) or not self.is_zero(rest):
            raise ValueError(
                f"{name} must be linear in the velocities, without a term of degree 0, got "
                f"{checks.shown(expression)}"
            )
        return row

    def is_zero(self, expression) -> bool:
        """Return whether an expression is zero, by its form or at some points."""
        sp = self.sp
        if expression == 0:
            return True
        symbols = [*self.q, *self.v, self.t]
        f = sp.lambdify(symbols, [expression, sp.Integer(1)], "math")
        points = 0.1 + 0.8 * np.random.default_rng(0).random((4, len(symbols)))
        return all(abs(f(*point)[0]) <= 1e-9 for point in points)

    def add_contact(self, gap, gradient, tangent) -> None:
        """Store the expressions of a contact; its gradient is derived, not given."""
        if callable(gap) and not hasattr(gap, "free_symbols"):
            raise ValueError("gap must be an expression in a system from SymPy, got a function")
        given = () if tangent is None else tangent
        given = tuple(given) if isinstance(given, Sequence) else (given,)
        if len(given) > 2:
            raise ValueError(f"tangent must be one or two expressions, got {len(given)}")
        rho = self.take("gap", gap, "q")
        rows = [self.linear("tangent", one) for one in given]
        normal = [self.sp.diff(rho, q) for q in self.q]
        if all(one == 0 for one in normal):
            raise ValueError(f"gap must depend on the coordinates, got {checks.shown(gap)}")
        empty = [[self.sp.Integer(0)] * self.n] * (2 - len(rows))
        self.contacts.append((rho, [normal, *rows, *empty]))

    def metric_at(self, q) -> np.ndarray:
        """Return M (n, n) at numbers."""
        return np.array(
            self.sp.lambdify(self.q, self.M.tolist(), "math")(*map(float, q)), dtype=float
        )

    def inertia(self) -> list:
        """Return M and Gamma_kij v_i v_j = (dM/dt v)_k - d_k (v M v) / 2."""
        sp = self.sp
        momentum = list(self.M * sp.Matrix(list(self.v)))
        twice = sum(p * w for p, w in zip(momentum, self.v))
        bend = [self.rate(p) - sp.diff(twice, q) / 2 for p, q in zip(momentum, self.q)]
        return [*self.M, *bend]

    def loads(self) -> list:
        """Return V, Q - dV, Q v."""
        total = [f - self.sp.diff(self.V, q) for f, q in zip(self.forces, self.q)]
        return [self.V, *total, sum(f * v for f, v in zip(self.forces, self.v))]

    def row_terms(self) -> list:
        """Return phi, A, (dA/dt) v."""
        return [*self.phi, *self.with_rates(self.A)]

    def contact_terms(self) -> list:
        """Return gaps, G, (dG/dt) v."""
        return [
            *(rho for rho, _ in self.contacts),
            *self.with_rates([row for _, G in self.contacts for row in G]),
        ]

    def with_rates(self, rows: list) -> list:
        """Return the entries of rows, and (d row/dt) v of each."""
        speeds = [sum(a * v for a, v in zip(row, self.v)) for row in rows]
        return [*(a for row in rows for a in row), *map(self.rate, speeds)]

    def rate(self, expression):
        """Return the rate of a function of the coordinates, for constant velocities."""
        return sum(self.sp.diff(expression, q) * v for q, v in zip(self.q, self.v))

    def addresses(self, functions) -> tuple[list[int], list]:
        """Return the addresses of the four compiled functions, which have no parts."""
        result = []
        for name in ("inertia", "loads", "row_terms", "contact_terms"):
            terms = getattr(self, name)()
            if not terms:
                result.append(0)
                continue
            written = self.write(name, terms)
            sizes = (2 * self.n,), (len(terms),)
            result.append(functions.written(written, *sizes, f"an expression ({name})"))
        return result, []

    def write(self, name: str, terms: list):
        """Return ``name(t, x, out)`` as Python code of scalars; common subexpressions are computed once."""
        from sympy.printing.codeprinter import PrintMethodNotImplementedError
        from sympy.printing.pycode import PythonCodePrinter

        sp, printer = self.sp, PythonCodePrinter({"fully_qualified_modules": False})
        x = [sp.Symbol(f"x{i}", real=True) for i in range(2 * self.n)]
        t = sp.Symbol("t", real=True)
        exchange = dict(zip([*self.q, *self.v, self.t], [*x, t]))
        terms = [sp.sympify(term).xreplace(exchange) for term in terms]
        shared, terms = sp.cse(terms, symbols=sp.numbered_symbols("s"), order="none")
        used = set().union(*(e.free_symbols for e in [*terms, *(e for _, e in shared)]))
        lines = [f"def {name}(t, x, out):"]
        lines += [f"    x{i} = x[{i}]" for i in range(2 * self.n) if x[i] in used]
        try:
            lines += [f"    {symbol} = {printer.doprint(e)}" for symbol, e in shared]
            lines += [f"    out[{i}] = {printer.doprint(e)}" for i, e in enumerate(terms)]
        except PrintMethodNotImplementedError as error:
            raise ValueError(
                f"an expression has a function that cannot be compiled, or whose derivative cannot: {error}"
            ) from None
        code = "\n".join(lines)
        space: dict[str, Any] = {"math": math, **{k: getattr(math, k) for k in dir(math)}}
        exec(code, space)
        return space[name]
