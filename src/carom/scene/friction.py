"""Laws of friction: the static coefficient bounds stick, the kinetic one acts in slip and may fall with it."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import REQUIRED, Number, NumberOrNone, Value, number
from carom.scene.speed_law import Curve, SpeedLaw, TableLaw, number_or_law

#: piece of exp(-z) at z = 0 whose polynomial of degree 5 is exact to round-off, and where exp(-z) is round-off
FIRST_PIECE, LAST_PLACE = 0.016, 38.0
#: of exponents of the speed: steeper laws are steps, which `kinetic` states better
EXPONENTS = 0.1, 10.0


@dataclass(frozen=True, repr=False)
class FrictionLaw(SpeedLaw):
    """A coefficient of friction that depends on the speed of slip."""

    @property
    @abstractmethod
    def bound(self) -> float:
        """The coefficient that bounds stick."""


@arguments.known
@dataclass(frozen=True, repr=False)
class Friction(FrictionLaw):
    """A law of friction with a static and a kinetic coefficient, for ``friction=``.

    A contact sticks while its tangential force is at most `static` times its normal force. In slip the
    coefficient is `kinetic`, or with `speed` that of Stribeck, which falls from `static` as the slip s grows:
    ``kinetic + (static - kinetic) exp(-(s / speed)^exponent)``. `Friction.table` makes a law of measured
    points, and ``law(speed)`` is its coefficient in slip.

    Parameters
    ----------
    static : float
        Coefficient that bounds stick, at least `kinetic`.
    kinetic : float
        Coefficient in slip, with `speed` that of fast slip, above 0.
    speed : float, optional
        Speed of slip [m/s] at which the excess of `static` over `kinetic` has fallen to 1/e, above 0. Default:
        the coefficient in slip is constant.
    exponent : float
        From 0.1 to 10. Default 1; 2 is common too (Armstrong-Helouvry, Control of Machines with Friction,
        1991).

    Examples
    --------
    >>> law = carom.Friction(static=0.4, kinetic=0.3, speed=0.1)
    >>> [round(float(mu), 3) for mu in law([0.0, 0.1, 1.0])]
    [0.4, 0.337, 0.3]
    >>> scene = carom.Scene()
    >>> floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    >>> block = scene.add_body(carom.Box(0.2, 0.2, 0.1), mass=1, position=(0, 0, 0.05), name="block")
    >>> scene.add_contact(block, floor, friction=carom.Friction(static=0.4, kinetic=0.3))
    Contact('block-floor', restitution=0.5, friction=Friction(static=0.4, kinetic=0.3, speed=None, \
exponent=1.0), impact_law='newton')
    """

    static: Number = number(above=0)
    kinetic: Number = number(above=0)
    speed: NumberOrNone = number(None, above=0, unit="m/s")
    exponent: Number = number(1.0, least=EXPONENTS[0], most=EXPONENTS[1])
    _kind = "Friction"

    def __post_init__(self):
        if self.static < self.kinetic:
            raise ValueError(
                f"static must be at least kinetic, {self.kinetic:g}, because what just sticks may not slip, "
                f"got {self.static:g}"
            )

    @staticmethod
    @arguments.known
    def table(speeds: ArrayLike, values: ArrayLike) -> FrictionLaw:
        """Return a law through measured points.

        Between the points it is a monotone cubic (`scipy.interpolate.PchipInterpolator`), which has no values
        beyond those of its neighbours. Slower slip has the first value, which also bounds stick, and faster
        slip the last.

        Parameters
        ----------
        speeds : (n,) array-like
            Speeds of slip [m/s], at least 0, each above the one before; two or more.
        values : (n,) array-like
            Coefficients at these speeds, above 0.
        """
        return TableFriction(speeds, values)  # pyright: ignore[reportArgumentType]

    @property
    def bound(self) -> float:
        """The static coefficient."""
        return self.static

    @property
    def curve(self) -> Curve:
        """One constant piece, or the exponential in z = (s / speed)^exponent by quintics in s^exponent.

        A quintic has value and two derivatives of the exponential at both ends. Its error falls with it, so the
        pieces grow as exp(z/6).
        """
        fall = self.static - self.kinetic
        if self.speed is None or fall == 0.0:
            return Curve(1.0, np.array([[self.kinetic]]), np.array([0.0, 1.0]))
        z = [0.0]
        while z[-1] < LAST_PLACE:
            z.append(z[-1] + FIRST_PIECE * np.exp(z[-1] / 6.0))
        ends = np.array(z)
        width, left = np.diff(ends), np.exp(-ends[:-1])
        right = left * np.exp(-width)
        # c_0 + c_1 s + c_2 s^2 as at the left end, and c_3 to c_5 by what is left at the right end
        low = np.array([left, -left, 0.5 * left])
        own = low[0] + width * (low[1] + width * low[2])
        rest = np.array(
            [right - own, -right - low[1] - 2.0 * width * low[2], right - 2.0 * low[2]]
        ) * np.array([np.ones_like(width), width, width**2])  # fmt: skip
        high = np.array([[10.0, -4.0, 0.5], [-15.0, 7.0, -1.0], [6.0, -3.0, 0.5]]) @ rest
        c = np.concatenate([low, high / width ** np.arange(3, 6)[:, None]])
        c = fall * c
        c[0] += self.kinetic
        unit = self.speed**self.exponent
        return Curve(self.exponent, (c / unit ** np.arange(6)[:, None])[::-1], ends * unit)


@dataclass(frozen=True, repr=False)
class TableFriction(TableLaw, FrictionLaw):
    """A monotone cubic through measured points: `Friction.table`."""

    _kind = "Friction.table"

    def __post_init__(self):
        super().__post_init__()
        if not min(self.values) > 0.0:
            raise ValueError(f"values must be above 0, got {checks.shown(self.values)}")

    @property
    def bound(self) -> float:
        """The first value."""
        return self.values[0]


FRICTION_LAWS = (Friction, TableFriction)
checked_friction = partial(
    number_or_law, law=FrictionLaw, example="carom.Friction(static=0.4, kinetic=0.3)", least=0
)


def friction(default: Any = REQUIRED) -> Value[Any, Any]:
    """Return a field for a coefficient of friction: a number at least 0, or a law."""
    return Value(checked_friction, default)


def bound_of(mu: float | SpeedLaw) -> float:
    """Return the coefficient that bounds stick."""
    return mu.bound if isinstance(mu, FrictionLaw) else mu  # pyright: ignore[reportReturnType]
