"""Laws of restitution: the coefficient e of an impact as a function of its speed of approach."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import REQUIRED, Number, Value, number
from carom.scene.fitted_law import ACCURACY, FittedLaw, fitted
from carom.scene.speed_law import SLOWEST, Curve, SpeedLaw, TableLaw, number_or_law, numbers


@dataclass(frozen=True, repr=False)
class Restitution(SpeedLaw):
    """A coefficient of restitution e that depends on the speed of approach v, for ``restitution=``.

    Each contact of each impact has the e of its own speed of approach at the start of the impact, by each law
    of impact. `Restitution.power`, `Restitution.viscoelastic`, `Restitution.table` and `Restitution.fit` make
    such a law, and ``law(speed)`` is its e.

    Examples
    --------
    >>> law = carom.Restitution.power(0.6, speed=1.0)
    >>> [round(float(e), 3) for e in law([0.1, 1.0, 10.0])]
    [1.0, 0.6, 0.337]
    >>> scene = carom.Scene()
    >>> floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 1), name="ball")
    >>> scene.add_contact(ball, floor, restitution=law)
    Contact('ball-floor', restitution=Restitution.power(value=0.6, speed=1.0, exponent=-0.25, maximum=1.0), \
friction=0, impact_law='newton')
    """

    #: speed [m/s] up to which the law is stated; faster impacts have the e of this speed
    fastest: ClassVar[Any] = np.inf
    #: speed [m/s] below which e is 1, so that bounces never end
    elastic: ClassVar[Any] = 0.0
    _most = 1.0

    def __new__(cls, *values, **named):
        """Refuse a law of no kind."""
        if cls is Restitution:
            raise TypeError(
                "Restitution is made by Restitution.power(value), Restitution.viscoelastic(c), "
                "Restitution.table(speeds, values) or Restitution.fit(function)"
            )
        return super().__new__(cls)

    @staticmethod
    @arguments.known
    def power(
        value: float, speed: float = 1.0, exponent: float = -0.25, maximum: float = 1.0
    ) -> Restitution:
        """Return the law ``e = value (v / speed)^exponent``, at most `maximum`.

        Parameters
        ----------
        value : float
            e at `speed`, at least 0. It may be above 1, because e is capped.
        speed : float
            Speed of approach [m/s] at which e is `value`, above 0. Default 1.
        exponent : float
            From -1 to 1. Default -1/4, of plastic deformation (Johnson, Contact Mechanics, 1985, section 11.4).
        maximum : float
            Greatest e, from 0 to 1. Default 1: slow impacts are elastic then, and a ball ends bouncing for ever
            at the speed at which e is 1, ``speed * value**4`` with the default exponent. A run says so.
        """
        return PowerRestitution(value, speed, exponent, maximum)

    @staticmethod
    @arguments.known
    def viscoelastic(c: float) -> Restitution:
        """Return the law ``e = 1 - c v^(1/5) + 0.6 c^2 v^(2/5)`` of viscoelastic spheres.

        These are the first terms of a series (Schwager and Poeschel 1998, Physical Review E 57, 650). Their
        least value is 7/12, at c v^(1/5) = 5/6: faster impacts have this e, and a run with some says so.

        Parameters
        ----------
        c : float
            [(s/m)^(1/5)], at least 0.
        """
        return ViscoelasticRestitution(c)

    @staticmethod
    @arguments.known
    def table(speeds: ArrayLike, values: ArrayLike) -> Restitution:
        """Return a law through measured points.

        Between the points it is a monotone cubic (`scipy.interpolate.PchipInterpolator`), which has no values
        beyond those of its neighbours. Slower impacts have the first value and faster ones the last, and a run
        with faster ones says so.

        Parameters
        ----------
        speeds : (n,) array-like
            Speeds of approach [m/s], at least 0, each above the one before; two or more.
        values : (n,) array-like
            e at these speeds, from 0 to 1.
        """
        return TableRestitution(speeds, values)  # pyright: ignore[reportArgumentType]

    @staticmethod
    @arguments.known
    def fit(
        function: Callable[[float], float],
        speeds: ArrayLike | None = None,
        accuracy: float = ACCURACY,
    ) -> Restitution:
        """Return the law of a function of the speed of approach; ``restitution=function`` makes it too.

        The function is called now, and not in a run: it is fitted by polynomials in pieces. They are what files
        and copies have.

        Parameters
        ----------
        function : callable
            ``function(speed)`` is e, from 0 to 1, at a speed [m/s]. It must be continuous above 0, smooth but
            for a few kinks.
        speeds : (2,) array-like, optional
            Lowest and highest speed [m/s]. Slower impacts have the value at the first and faster ones that at
            the last, and a run with faster ones says so. Default: all speeds.
        accuracy : float
            Greatest error of the fit, relative to the values there. Default 1e-10.

        Examples
        --------
        >>> law = carom.Restitution.fit(lambda v: 0.9 / (1 + 0.1 * v))
        >>> [round(float(e), 9) for e in law([0.0, 1.0, 5.0])]
        [0.9, 0.818181818, 0.6]
        """
        made = fitted(function, speeds, accuracy, (0.0, 1.0))
        return FittedRestitution(**made, stated=np.inf if speeds is None else made["ends"][-1])


@dataclass(frozen=True, repr=False)
class PowerRestitution(Restitution):
    """A power of the speed, capped: `Restitution.power`."""

    value: Number = number(least=0)
    speed: Number = number(1.0, above=0, unit="m/s")
    exponent: Number = number(-0.25, least=-1, most=1)
    maximum: Number = number(1.0, least=0, most=1)
    _kind = "Restitution.power"

    @property
    def elastic(self) -> float:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Speed at which a power that falls with the speed is 1."""
        if self.maximum < 1.0 or self.exponent >= 0.0 or self.value == 0.0:
            return 0.0
        return float(self.speed * np.float64(self.value) ** (-1.0 / self.exponent))

    @property
    def curve(self) -> Curve:
        """One piece, linear in v^q, which ends at `maximum`."""
        with np.errstate(over="ignore"):
            factor = float(self.value * np.float64(self.speed) ** -self.exponent)
        end = self.maximum / factor if factor > 0.0 else 1.0
        if not 0.0 < end < np.inf:  # e = 0, or `maximum` at every speed
            return Curve(1.0, np.array([[min(self.maximum, factor)]]), np.array([0.0, 1.0]))
        return Curve(self.exponent, np.array([[factor], [0.0]]), np.array([0.0, end]))


@dataclass(frozen=True, repr=False)
class ViscoelasticRestitution(Restitution):
    """The first terms of the series of viscoelastic spheres: `Restitution.viscoelastic`."""

    c: Number = number(least=0, most=checks.LENGTHS[1])
    _kind = "Restitution.viscoelastic"

    @property
    def fastest(self) -> float:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Speed of the least value."""
        return self._end**5 if self._end < sys.float_info.max**0.2 else np.inf

    @property
    def _end(self) -> float:
        return 5.0 / (6.0 * self.c) if self.c > sys.float_info.min else np.inf

    @property
    def curve(self) -> Curve:
        """One piece, a parabola in v^(1/5), which ends at its least value."""
        end = min(self._end, SLOWEST**-0.2)
        return Curve(0.2, np.array([[0.6 * self.c**2], [-self.c], [1.0]]), np.array([0.0, end]))


@dataclass(frozen=True, repr=False)
class TableRestitution(TableLaw, Restitution):
    """A monotone cubic through measured points: `Restitution.table`."""

    values: Value[tuple[float, ...], Any] = Value(partial(numbers, most=1.0))
    _kind = "Restitution.table"

    @property
    def fastest(self) -> float:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Last speed of the table."""
        return self.speeds[-1]

    @property
    def elastic(self) -> float:  # pyright: ignore[reportIncompatibleVariableOverride]
        """First speed of a table that begins with 1."""
        return self.speeds[0] if self.values[0] == 1.0 else 0.0


@dataclass(frozen=True, repr=False, kw_only=True)
class FittedRestitution(FittedLaw, Restitution):
    """A function of the speed of approach: `Restitution.fit`."""

    stated: Value[float, Any] = Value(lambda _, value: float(value))
    _kind = "Restitution.fit"
    __hash__ = FittedLaw.__hash__

    @property
    def fastest(self) -> float:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Last speed of those that were given."""
        return self.stated

    @property
    def elastic(self) -> float:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Greatest speed up to which e is 1, as far as its pieces show."""
        speeds = np.array(self.ends)
        below = np.flatnonzero(self(speeds) < 1.0 - ACCURACY)
        return float(speeds[below[0] - 1]) if len(below) and below[0] > 0 else 0.0


def restitution(default: Any = REQUIRED) -> Value[Any, Any]:
    """Return a field for a coefficient of restitution: a number from 0 to 1, a function, or a law."""
    check = partial(
        number_or_law, law=Restitution, of=Restitution.fit, example="carom.Restitution.power(0.6)",
        least=0, most=1,
    )  # fmt: skip
    return Value(check, default)
