"""Coefficients given as functions of the speed: fitted once by polynomials in pieces, to a stated accuracy.

A function is looked at in octaves of the speed. Where the quintic through six points of a piece misses it
between them, the piece is halved; then neighbours that one quintic fits are joined. So a kink is found to the
last digits, and a jump is refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.fields import Value
from carom.scene.speed_law import Curve, SpeedLaw

OCTAVES = 100  # of speeds below and above 1 m/s, where no speeds are given
TINY = 2.0**-180  # speed up to which a function is what it is there; at 0 itself it may jump
ACCURACY = 1e-10  # of a fit, relative to the greatest value up to there
LEAST_ACCURACY = 1e-13  # round-off of a quintic through six points
MOST_QUINTICS = 5000  # of one function
NARROWEST = 8.0 * np.finfo(float).eps  # width of a piece relative to its end: a jump
#: places in a piece, from 0 to 1, at which a quintic is exact, and between them
NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(6) / 5)
BETWEEN = np.array([0.02, 0.2, 0.35, 0.5, 0.65, 0.8, 0.98])
FIT = np.linalg.inv(np.vander(NODES, 6, increasing=True))


class Fit(NamedTuple):
    """A quintic c_0 + c_1 s + ..., s = v - begin, and the points where the function was looked at."""

    begin: float
    end: float
    c: np.ndarray  # (6,)
    v: np.ndarray
    values: np.ndarray

    def misses(self, v: np.ndarray, values: np.ndarray) -> float:
        """Return the greatest error at points."""
        return float(np.max(np.abs(np.polyval(self.c[::-1], v - self.begin) - values)))


@dataclass(frozen=True, repr=False)
class FittedLaw(SpeedLaw):
    """Quintics through a function of the speed."""

    function: Value[str, Any] = Value(checks.text)  #: its name
    ends: Value[tuple[float, ...], Any] = Value(lambda name, value: _numbers(name, value))
    coefficients: Value[tuple[float, ...], Any] = Value(lambda name, value: _numbers(name, value))

    def __post_init__(self):
        """Refuse pieces that are not one after the other, or have not six coefficients each."""
        pieces = len(self.ends) - 1
        if not (pieces > 0 and self.ends[0] >= 0.0 and np.all(np.diff(self.ends) > 0.0)):
            raise ValueError("ends must be two speeds or more, each above the one before")
        if len(self.coefficients) != 6 * pieces:
            raise ValueError(f"coefficients must be six for each of {pieces} pieces")

    def __hash__(self) -> int:
        return hash((self.function, self.ends[-1], self.coefficients[:6], len(self.ends)))

    def __repr__(self) -> str:
        return f"{self._kind}({self.function}, <{len(self.ends) - 1} pieces>)"

    @property
    def curve(self) -> Curve:
        """The quintics."""
        c = np.array(self.coefficients).reshape(-1, 6)
        return Curve(1.0, c.T[::-1].copy(), np.array(self.ends))


def _numbers(name: str, value) -> tuple[float, ...]:
    return tuple(checks.finite_array(name, value, (None,)).tolist())


def fitted(
    function: Callable, speeds: ArrayLike | None, accuracy: float, bounds: tuple[float, float]
) -> dict[str, Any]:
    """Return the fields of a `FittedLaw` for a function, all values of which must be within `bounds`.

    Raises
    ------
    ValueError
        If a value is not within the bounds, the function jumps, or it needs too many pieces.
    """
    checks.function("function", function)
    accuracy = checks.number("accuracy", accuracy, least=LEAST_ACCURACY, most=0.1)
    name = getattr(function, "__name__", type(function).__name__)
    if speeds is None:
        edges = [0.0, *(2.0 ** np.arange(-OCTAVES, OCTAVES + 1)).tolist()]
    else:
        low, high = checks.finite_array("speeds", speeds, (2,), "m/s").tolist()
        if not 0.0 <= low < high:
            raise ValueError(
                "speeds must be the lowest, at least 0, and a higher one [m/s], got "
                f"{checks.shown(speeds)}"
            )
        halves = high * 2.0 ** -np.arange(OCTAVES, 0, -1.0)
        edges = [low, *halves[halves > low].tolist(), high]

    def at(v: np.ndarray) -> np.ndarray:
        return np.array([_value(function, max(x, TINY), bounds) for x in v.tolist()])

    with np.errstate(all="ignore"):  # of a fit that is no good
        joined = _pieces(at, edges, accuracy, name)
    return {
        "function": name,
        "ends": (joined[0].begin, *(one.end for one in joined)),
        "coefficients": np.concatenate([one.c for one in joined]),
    }


def _pieces(at: Callable, edges: list[float], accuracy: float, name: str) -> list[Fit]:
    """Return the pieces of a function from edge to edge, halved and joined."""
    pieces, most = [], 0.0
    todo = list(pairwise(edges))[::-1]
    while todo:
        begin, end = todo.pop()
        one = _fit(at, begin, end)
        most = max(most, float(np.max(one.values)))
        if end <= TINY or one.misses(one.v[6:], one.values[6:]) <= accuracy * most:
            pieces.append(one)
        elif end - begin <= NARROWEST * end:
            raise ValueError(
                f"function must be continuous above 0, got {name}, which jumps by "
                f"{np.ptp(one.values):.3g} at {end:.6g} m/s"
            )
        else:
            middle = 0.5 * (begin + end)
            todo += [(middle, end), (begin, middle)]
        if len(pieces) + len(todo) > MOST_QUINTICS:
            raise ValueError(
                f"function must be smooth but for a few kinks, got {name}, which needs more than "
                f"{MOST_QUINTICS} polynomials for accuracy={accuracy:g}; give a larger one"
            )
    joined = [pieces[0]]
    for one in pieces[1:]:
        most = max(float(np.max(one.values)), *(float(np.max(p.values)) for p in joined[-1:]))
        both = _both(at, joined[-1], one, accuracy * most)
        if both is None:
            joined.append(one)
        else:
            joined[-1] = both
    return joined


def _fit(at: Callable, begin: float, end: float) -> Fit:
    v = begin + (end - begin) * np.concatenate([NODES, BETWEEN])
    v[5] = end
    values = at(v)
    if end <= TINY:
        return Fit(begin, end, np.array([values[0], 0.0, 0.0, 0.0, 0.0, 0.0]), v, values)
    c = FIT @ values[:6] / (end - begin) ** np.arange(6.0)
    return Fit(begin, end, c, v, values)


def _both(at: Callable, one: Fit, two: Fit, error: float) -> Fit | None:
    """Return one quintic for two pieces, if it fits all points of both."""
    v, values = (np.concatenate(pair) for pair in ((one.v, two.v), (one.values, two.values)))
    both = _fit(at, one.begin, two.end)
    if not both.misses(np.append(v, both.v), np.append(values, both.values)) <= error:
        return None
    return both._replace(v=v, values=values)


def _value(function: Callable, v: float, bounds: tuple[float, float]) -> float:
    try:
        value = checks.number("its value", function(v))
    except (ArithmeticError, ValueError, TypeError) as error:
        raise ValueError(f"function must return a finite number at {v:.6g} m/s: {error}") from error
    low, high = bounds
    if not low <= value <= high:
        allowed = f"from {low:g} to {high:g}" if math.isfinite(high) else "at least 0"
        raise ValueError(
            f"function must be {allowed} at all speeds, got {value:.6g} at {v:.6g} m/s; speeds=(lowest, "
            "highest) of Restitution.fit and Friction.fit keep the values at their ends beyond them"
        )
    return value
