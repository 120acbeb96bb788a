"""Coefficients that depend on a speed: of restitution on that of approach, of friction on that of slip.

Each law compiles to one form, a polynomial in pieces of x = v^q. Beyond the pieces the coefficient keeps the
value at their end, so that a law holds at every speed.
"""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cache
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.fields import Value

SLOWEST = sys.float_info.min  # [m/s] so that a negative power of the speed is finite


class Curve(NamedTuple):
    """A coefficient as a polynomial in pieces of x = v^exponent, in the order of `scipy.interpolate.PPoly`."""

    exponent: float
    c: np.ndarray  # (D+1, K) coefficients of (x - start of the piece), highest power first
    x: np.ndarray  # (K+1,) ends of the pieces

    def scaled(self, length: float) -> Curve:
        """Return the curve of the speed v of a coordinate, as a function of length times v."""
        s = length**self.exponent
        powers = np.arange(len(self.c) - 1, -1, -1)
        return Curve(self.exponent, self.c * s ** -powers[:, None].astype(float), self.x * s)


@dataclass(frozen=True)
class SpeedLaw(ABC):
    """A coefficient that depends on a speed."""

    _kind: ClassVar[str]
    _most: ClassVar[float] = np.inf  # greatest value

    #: whether it is more than numbers: friction may depend on the direction alone
    by_speed: ClassVar[Any] = True

    @property
    @abstractmethod
    def curve(self) -> Curve:
        """The law as a function of the speed, as kernels have it."""

    def __call__(self, speed: ArrayLike) -> np.ndarray:
        """Return the coefficient at speeds [m/s], at least 0, of any shape."""
        v = checks.real_array("speed", speed, "any")
        if not np.all(v >= 0.0):
            raise ValueError(f"speed must be at least 0 [m/s], got {checks.shown(speed)}")
        q, c, ends = curve_of(self)
        x = np.clip(np.maximum(v, SLOWEST) ** q, ends[0], ends[-1])
        k = np.clip(np.searchsorted(ends, x, side="right") - 1, 0, len(ends) - 2)
        e = np.zeros_like(x)
        for row in c:
            e = e * (x - ends[k]) + row[k]
        return np.clip(e, 0.0, self._most)

    def slope(self, speed: float) -> float:
        """Return the derivative [s/m] at a speed [m/s] above 0; 0 where the value at an end is kept."""
        q, c, ends = curve_of(self)
        v = checks.number("speed", speed, above=0.0, unit="m/s")
        x = v**q
        if not ends[0] < x < ends[-1]:
            return 0.0
        k = int(np.searchsorted(ends, x, side="right")) - 1
        return float(np.polyval(np.polyder(c[:, k]), x - ends[k]) * q * v ** (q - 1.0))

    def __repr__(self) -> str:
        shown = ", ".join(f"{f.name}={getattr(self, f.name)!r}" for f in fields(self))
        return f"{self._kind}({shown})"

    def __format__(self, form: str) -> str:
        """Return the law as text, where a number would have `form`."""
        return repr(self)


@cache
def curve_of(law: SpeedLaw) -> Curve:
    """Return the curve of a law, made once."""
    return law.curve


def numbers(name: str, value, most: float = np.inf) -> tuple[float, ...]:
    """Return two or more numbers, at least 0, as a tuple."""
    made = checks.finite_array(name, value, (None,))
    if len(made) < 2 or not (made.min() >= 0.0 and made.max() <= most):
        bounds = "at least 0" if most == np.inf else f"from 0 to {most:g}"
        raise ValueError(f"{name} must be two numbers or more, {bounds}, got {checks.shown(value)}")
    return tuple(made.tolist())


@dataclass(frozen=True, repr=False)
class TableLaw(SpeedLaw):
    """A monotone cubic through measured points."""

    speeds: Value[tuple[float, ...], Any] = Value(numbers)
    values: Value[tuple[float, ...], Any] = Value(numbers)

    def __post_init__(self):
        """Refuse a table whose columns differ in length, or whose speeds do not rise."""
        speeds, values = self.speeds, self.values
        if len(speeds) != len(values):
            raise ValueError(
                f"speeds and values must have the same length, got {len(speeds)} and {len(values)}"
            )
        if not np.all(np.diff(speeds) > 0.0):
            raise ValueError(
                f"speeds must rise, each above the one before, got {checks.shown(speeds)}"
            )

    @property
    def curve(self) -> Curve:
        """A cubic in v for each two points."""
        from scipy.interpolate import PchipInterpolator

        made = PchipInterpolator(self.speeds, self.values)
        return Curve(1.0, made.c, made.x)


def number_or_law(
    name: str, value, law: type[SpeedLaw], of: Callable[[Any], SpeedLaw], example: str, **bounds
) -> float | SpeedLaw:
    """Return a coefficient: a number within `bounds`, or a law of the kind `law`, as in the `example`.

    ``of(function)`` makes a law of a function of the speed.
    """
    if isinstance(value, law):
        return value
    if isinstance(value, (type, SpeedLaw)):
        raise ValueError(
            f"{name} must be a number, a law, such as {example}, or a function of the speed, got "
            f"{checks.shown(value)}"
        )
    if callable(value):
        try:
            return of(value)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error
    return checks.number(name, value, **bounds)
