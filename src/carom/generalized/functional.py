"""A `GeneralizedSystem` from user-defined functions, with given derivatives or central differences."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from carom._compiled.composed import joined, once


@once
def of_position(function: Callable) -> Any:
    """Return ``f(t, q)`` of a function of the coordinates, which gets an array of its own."""
    return joined(lambda t, q: function(q.copy()), function)


@once
def of_state(function: Callable) -> Any:
    """Return ``f(t, x)``, x = (q, v), of a function of time, coordinates and velocities."""

    def force(t, x):
        n = x.size // 2
        return function(t, x[:n].copy(), x[n:].copy())

    return joined(force, function)


class FunctionalModel:
    """Functions of a system of n coordinates, with `holonomic` constraints and `rows` further ones."""

    kind = "function"

    def __init__(self, n: int, given: dict[str, tuple[Callable | None, tuple[int, ...]]]):
        self.n, self.given, self.contacts = n, dict(given), 0
        self.holonomic, more = (given[name][1][0] for name in ("constraint", "rows"))
        self.rows = self.holonomic + more

    def add_contact(self, gap, gradient, tangent, shape: tuple[int, ...]) -> None:
        """Store the functions of a contact; `shape` is that of its tangents."""
        own = {"gap": (gap, ()), "gap_gradient": (gradient, (self.n,)), "tangent": (tangent, shape)}
        self.given |= {f"{name} of contact {self.contacts}": one for name, one in own.items()}
        self.contacts += 1

    def metric_at(self, q) -> np.ndarray:
        """Return M (n, n) at numbers."""
        metric: Any = self.given["metric"][0]
        return np.array(metric(q.copy()), dtype=float)

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
