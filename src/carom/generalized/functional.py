"""A `GeneralizedSystem` from user-defined functions, with given derivatives or central differences."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from carom import checks
from carom._compiled.composed import is_compiled, joined, once, plainly


@once
def of_position(function: Callable) -> Any:
    """Return ``f(t, q)`` of a function of the coordinates; a plain one may keep its argument."""
    if is_compiled(function):
        return joined(lambda t, q: function(q), function)
    return lambda t, q: function(q.copy())


@once
def of_state(function: Callable) -> Any:
    """Return ``f(t, x)``, x = (q, v), of a function of time, coordinates and velocities."""

    def force(t, x):
        n = x.size // 2
        return function(t, x[:n].copy(), x[n:].copy())

    return joined(force, function)


def result_of(name: str, function: Callable, shape: tuple, *arguments) -> np.ndarray:
    """Return the result of a function at the start; raise an error for a shape other than `shape`."""
    given = [np.copy(a) if np.ndim(a) else a for a in arguments]
    return checks.finite_array(name, checks.call(name, plainly(function), *given), shape)


class FunctionalModel:
    """Functions of a system with their shapes, checked at the start (q, v)."""

    kind = "function"

    def __init__(self, q: np.ndarray, v: np.ndarray, given: dict[str, Callable | None]):
        self.n, self.start, self.contacts = len(q), q, 0
        self.names = [str(k) for k in range(self.n)]
        for name, of in (("metric_derivative", "metric"), ("potential_gradient", "potential"),
                         ("constraint_jacobian", "constraint")):  # fmt: skip
            if given[name] is not None and given[of] is None:
                raise ValueError(
                    f"{name} must be left out without {of}, got {checks.shown(given[name])}"
                )
        n, phi, rows = self.n, given["constraint"], given["rows"]
        h = 0 if phi is None else result_of("constraint(q)", phi, (None,), q).size
        k = 0 if rows is None else len(result_of("rows(q)", rows, (None, n), q))
        self.holonomic, self.rows = h, h + k
        shapes = {
            "metric": (n, n), "potential": (), "constraint": (h,), "rows": (k, n), "force": (n,),
            "metric_derivative": (n, n, n), "potential_gradient": (n,), "constraint_jacobian": (h, n),
        }  # fmt: skip
        for name, function in given.items():
            arguments = ("t, q, v", 0.0, q, v) if name == "force" else ("q", q)
            if function is not None:
                result_of(f"{name}({arguments[0]})", function, shapes[name], *arguments[1:])
        self.given = {name: (given[name], shape) for name, shape in shapes.items()}

    def add_contact(self, gap, gradient, tangent) -> None:
        """Store the functions of a contact, if their results have the right shapes."""
        n, q, shape = self.n, self.start, (0, self.n)
        for what, one in (("gap", gap), ("gap_gradient", gradient), ("tangent", tangent)):
            checks.function(what, one, optional=what != "gap")
        result_of("gap(q)", gap, (), q)
        if gradient is not None:
            result_of("gap_gradient(q)", gradient, (n,), q)
        if tangent is not None:
            rows = checks.call("tangent(q)", plainly(tangent), q.copy())
            rows = checks.real_array("tangent(q)", rows, f"({n},) or (2, {n})")
            if rows.shape not in ((n,), (1, n), (2, n)):
                raise ValueError(
                    f"tangent(q) must have shape ({n},) or (2, {n}), got shape {rows.shape}"
                )
            shape = checks.finite_array("tangent(q)", rows, rows.shape).shape
        own = {"gap": (gap, ()), "gap_gradient": (gradient, (n,)), "tangent": (tangent, shape)}
        self.given |= {f"{name} of contact {self.contacts}": one for name, one in own.items()}
        self.contacts += 1

    def marks(self, mark_of: Callable) -> list[str]:
        """Return a mark of the code of each function."""
        return [f"{name}: {one and mark_of(one)}" for name, (one, _) in self.given.items()]

    def has_tangent(self, contact: int) -> bool:
        """Return whether a contact has a tangent."""
        return self.given[f"tangent of contact {contact}"][0] is not None

    def metric_at(self, q) -> np.ndarray:
        """Return M (n, n) at numbers."""
        metric: Any = self.given["metric"][0]
        return np.array(plainly(metric)(q.copy()), dtype=float)

    def addresses(self, functions) -> tuple[list[int], list[tuple[int, int, int]]]:
        """Return no address for the four functions, and those of the parts of which they are made."""
        pairs = [
            ("metric", "metric_derivative"), ("potential", "potential_gradient"), ("force", ""),
            ("constraint", "constraint_jacobian"), ("", "rows"),
        ]  # fmt: skip
        for c in range(self.contacts):
            pairs += [
                (f"gap of contact {c}", f"gap_gradient of contact {c}"),
                ("", f"tangent of contact {c}"),
            ]
        return [0] * 4, [self.part(functions, *pair) for pair in pairs]

    def part(self, functions, value: str, slope: str) -> tuple[int, int, int]:
        """Return the addresses of a function and of its derivative, 0 for none, and the number of results."""
        at = []
        for name in (value, slope):
            function, shape = self.given.get(name, (None, ()))
            made = of_state if name == "force" else of_position
            inside = (2 * self.n if name == "force" else self.n,)
            at.append(0 if function is None else functions.address(
                made(function), inside, shape or (1,), f"the function {name!r}"
            ))  # fmt: skip
        count = math.prod(self.given[value or slope][1])
        return at[0], at[1], count if value else count // self.n
