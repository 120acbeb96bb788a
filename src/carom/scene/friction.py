"""Laws of friction: by the speed of slip (a static and a kinetic coefficient), or by its direction (a cone)."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import REQUIRED, Number, NumberOrNone, Value, Word, number, word
from carom.scene.fitted_law import ACCURACY, FittedLaw, fitted
from carom.scene.speed_law import Curve, SpeedLaw, TableLaw, number_or_law

#: piece of exp(-z) at z = 0 whose polynomial of degree 5 is exact to round-off, and where exp(-z) is round-off
FIRST_PIECE, LAST_PLACE = 0.016, 38.0
#: of exponents of the speed: steeper laws are steps, which `kinetic` states better
EXPONENTS = 0.1, 10.0
#: greatest ratio of `along` and `across`: beyond it forces across lose the digits of those along
MOST_ANISOTROPIC = 1e3
FIXED_TO = ("body", "other", "world")


class Anisotropy(NamedTuple):
    """What is the same of anisotropic friction in impacts and in persistent contact."""

    axis: tuple[float, float, float]
    of: str
    ratio: float  # across / along


@dataclass(frozen=True, repr=False)
class FrictionLaw(SpeedLaw):
    """A coefficient of friction that depends on the speed of slip."""

    @property
    @abstractmethod
    def bound(self) -> float:
        """The coefficient that bounds stick."""


def _axis(name: str, value) -> tuple[float, ...]:
    return tuple(checks.unit_vector(name, value).tolist())  # a law is hashed


def _along(name: str, value) -> float | FrictionLaw:
    """Return a coefficient above 0, or a law of the slip, which is that of slip along an axis."""
    if callable(value) or isinstance(value, FrictionLaw):
        return isotropic(name, value)
    return checks.number(name, value, above=0.0)


@arguments.known
@dataclass(frozen=True, repr=False)
class Friction(FrictionLaw):
    """A law of friction, for ``friction=``: by the speed of slip, or by its direction.

    *By the speed*, ``Friction(static, kinetic)``: a contact sticks while its tangential force is at most
    `static` times its normal force. In slip the coefficient is `kinetic`, or with `speed` that of Stribeck,
    which falls from `static` as the slip s grows: ``kinetic + (static - kinetic) exp(-(s / speed)^exponent)``.
    `Friction.table` makes a law of measured points, `Friction.fit` of a function, and
    ``law(speed)`` is its coefficient in slip.

    *By the direction*, ``Friction(axis=..., along=..., across=...)``, for skates, wheels and grooves: the
    tangential force is within the ellipse ``(F_1 / along)^2 + (F_2 / across)^2 <= N^2``, with F_1 along the
    axis, and in slip it is that force of the ellipse which takes the most power.

    *By both*: `along` is a law of the slip. Then `across` is the coefficient that bounds stick across the axis,
    and the ellipse shrinks with the slip s to the ``along(s) / along(0)``-th part, where slip s_2 across the
    axis counts like slip ``s_2 across / along(0)`` along it: ``s^2 = s_1^2 + (s_2 across / along(0))^2``.

    Parameters
    ----------
    static : float, optional
        Coefficient that bounds stick, at least `kinetic`.
    kinetic : float, optional
        Coefficient in slip, with `speed` that of fast slip, above 0.
    speed : float, optional
        Speed of slip [m/s] at which the excess of `static` over `kinetic` has fallen to 1/e, above 0. Default:
        the coefficient in slip is constant.
    exponent : float
        From 0.1 to 10. Default 1; 2 is common too (Armstrong-Helouvry, Control of Machines with Friction,
        1991).
    axis : (3,) array-like, optional
        Direction of anisotropic friction, not zero. Its projection on the surface counts. Where it is normal to
        the surface within 6 degrees, anisotropy fades out, to the mean ``sqrt(along * across)``.
    along : float or Friction, optional
        Coefficient for slip along the projected axis, above 0, or its law of the slip.
    across : float, optional
        Coefficient across the axis, from 1/1000 to 1000 times `along`; if that is a law, than its static one.
    of : {"body", "other", "world"}
        What the axis is fixed to, whose axes it is given in: the first body of the pair (default), the other
        one, or the world. In a `Material`, "body" is the one with this material. A half-space has world axes.

    Raises
    ------
    TypeError
        If neither `static` and `kinetic` nor `axis`, `along` and `across` are given.
    ValueError
        If both are given, or a value is not allowed.

    Notes
    -----
    Mathematics page, §1.10.

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
    >>> carom.Friction(axis=(1, 0, 0), along=0.02, across=0.6)
    Friction(axis=(1.0, 0.0, 0.0), along=0.02, across=0.6, of='body')
    """

    static: Value[Any, Any] = number(None, above=0)
    kinetic: Value[Any, Any] = number(None, above=0)
    speed: NumberOrNone = number(None, above=0, unit="m/s")
    exponent: Number = number(1.0, least=EXPONENTS[0], most=EXPONENTS[1])
    axis: Value[Any, Any] = Value(_axis, None)
    along: Value[Any, Any] = Value(_along, None)
    across: Value[Any, Any] = number(None, above=0)
    of: Word = word(FIXED_TO, "body")
    _kind = "Friction"

    def __post_init__(self):
        given = {name for name, value in vars(self).items() if value is not None}
        by_slip, by_way = ([one for one in names if one in given] for names in (_BY_SLIP, _BY_WAY))
        if by_slip and by_way:
            raise ValueError(
                f"{by_way[0]} must not be given with {by_slip[0]}: friction depends on the speed of slip, "
                f"or on its direction, got {self!r}"
            )
        missing = [one for one in (_BY_WAY if by_way else _BY_SLIP[:2]) if one not in given]
        if missing:
            raise TypeError(
                f"Friction needs {' and '.join(missing)}: Friction(static=..., kinetic=...), or "
                "Friction(axis=..., along=..., across=...)"
            )
        if by_way:
            along = bound_of(self.along)
            if not along / MOST_ANISOTROPIC <= self.across <= MOST_ANISOTROPIC * along:
                raise ValueError(
                    f"across must be from 1/{MOST_ANISOTROPIC:g} to {MOST_ANISOTROPIC:g} times along, "
                    f"{along:g}, got {self.across:g}"
                )
        elif self.static < self.kinetic:
            raise ValueError(
                f"static must be at least kinetic, {self.kinetic:g}, because what just sticks may not slip, "
                f"got {self.static:g}"
            )

    def __repr__(self) -> str:
        names = (*_BY_WAY, "of") if self.axis is not None else (*_BY_SLIP, "exponent")
        return f"Friction({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

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

    @staticmethod
    @arguments.known
    def fit(
        function: Callable[[float], float],
        speeds: ArrayLike | None = None,
        accuracy: float = ACCURACY,
    ) -> FrictionLaw:
        """Return the law of a function of the speed of slip; ``friction=function`` makes it too.

        The function is called now, and not in a run: it is fitted by polynomials in pieces. They are what files
        and copies have. Its value at 0 bounds stick, and may be above that of the slowest slip.

        Parameters
        ----------
        function : callable
            ``function(speed)`` is the coefficient, at least 0, at a speed [m/s]. It must be continuous above 0,
            smooth but for a few kinks.
        speeds : (2,) array-like, optional
            Lowest and highest speed [m/s]; beyond them the values at these ends count. Default: all speeds.
        accuracy : float
            Greatest error of the fit, relative to the values there. Default 1e-10.

        Examples
        --------
        >>> law = carom.Friction.fit(lambda v: 0.3 + 0.1 / (1 + v))
        >>> [round(float(mu), 9) for mu in law([0.0, 1.0, 4.0])]
        [0.4, 0.35, 0.32]
        """
        made = fitted(function, speeds, accuracy, (0.0, np.inf))
        static = FittedFriction(**made, static=0.0).bound
        if speeds is None or np.min(np.asarray(speeds)) == 0.0:
            static = max(
                static, checks.number("the value of function at 0", function(0.0), least=0.0)
            )
        return FittedFriction(**made, static=static)

    @property
    def bound(self) -> float:
        """The static coefficient; of anisotropic friction the geometric mean of both."""
        return self.static if self.axis is None else math.sqrt(bound_of(self.along) * self.across)

    @property
    def by_speed(self) -> bool:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Whether there is more than an axis and two numbers."""
        return self.axis is None or isinstance(self.along, FrictionLaw)

    @property
    def curve(self) -> Curve:
        """One constant piece, or the exponential in z = (s / speed)^exponent by quintics in s^exponent.

        A quintic has value and two derivatives of the exponential at both ends. Its error falls with it, so the
        pieces grow as exp(z/6). Anisotropic friction has its mean, r^1/2 along(r^1/2 s) with
        r = across / along, where s is the slip in the stretched tangents: s_1 r^-1/2, s_2 r^1/2
        (`carom.kinematics.anisotropy`).
        """
        if self.axis is not None and not isinstance(self.along, FrictionLaw):
            return Curve(1.0, np.array([[self.bound]]), np.array([0.0, 1.0]))
        if self.axis is not None:
            stretch = math.sqrt(self.across / self.along.bound)
            mean = self.along.curve.scaled(1.0 / stretch)
            return mean._replace(c=stretch * mean.c)
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


@dataclass(frozen=True, repr=False, kw_only=True)
class FittedFriction(FittedLaw, FrictionLaw):
    """A function of the speed of slip: `Friction.fit`."""

    static: Number = number(least=0)
    _kind = "Friction.fit"
    __hash__ = FittedLaw.__hash__

    @property
    def bound(self) -> float:
        """Its value at 0, or that of the slowest slip."""
        return max(self.static, self.coefficients[0])


_BY_SLIP, _BY_WAY = ("static", "kinetic", "speed"), ("axis", "along", "across")
checked_friction = partial(
    number_or_law, law=FrictionLaw, of=Friction.fit, example="carom.Friction(static=0.4, kinetic=0.3)",
    least=0,
)  # fmt: skip


def isotropic(name: str, value) -> Any:
    """Return a coefficient that does not depend on the direction."""
    found = checked_friction(name, value)
    if anisotropy_of(found) is not None:
        raise ValueError(f"{name} must not depend on the direction here, got {found!r}")
    return found


def friction(default: Any = REQUIRED, *, axis: bool = True) -> Value[Any, Any]:
    """Return a field for a coefficient of friction: a number at least 0, a function, or a law."""
    return Value(checked_friction if axis else isotropic, default)


def bound_of(mu: Any) -> float:
    """Return the coefficient that bounds stick."""
    return mu.bound if isinstance(mu, FrictionLaw) else mu


def anisotropy_of(mu: Any) -> Anisotropy | None:
    """Return axis and ratio of anisotropic friction; None if it is not anisotropic."""
    if not isinstance(mu, Friction) or mu.axis is None:
        return None
    return Anisotropy(mu.axis, mu.of, mu.across / bound_of(mu.along))


def check_anisotropy(friction: Any, held: Any) -> None:
    """Refuse anisotropic friction that differs in more than its size in impacts and in persistent contact."""
    one, two = anisotropy_of(friction), anisotropy_of(held)
    if one is None and two is None:
        return
    if one is None or two is None or one[:2] != two[:2] or not math.isclose(one.ratio, two.ratio):
        raise ValueError(
            "friction_held must have the axis of friction and its ratio of across to along where one of them "
            f"is anisotropic, got friction {friction:g} and friction_held {held:g}"
        )


def combined_anisotropy(
    name: str, first: Any, second: Any, rule: Callable[[float, float], float] | None
) -> float | FrictionLaw | None:
    """Return the friction of two materials, one of which is anisotropic; None if no rule says it.

    `rule` combines the coefficients along and across with the number of the other material.
    """
    if anisotropy_of(first) is not None and anisotropy_of(second) is not None:
        if first == second and first.of == "world":
            return first
        raise ValueError(
            f"{name} must be given for a pair of materials that are both anisotropic, got {first:g} and "
            f"{second:g}; pass {name} of this pair to add_contact"
        )
    flip = anisotropy_of(first) is None
    law, mu = (second, first) if flip else (first, second)
    if rule is None or isinstance(mu, FrictionLaw) or law.by_speed:
        return None
    along, across = rule(law.along, mu), rule(law.across, mu)
    if along == across:
        return along
    of = {"body": "other", "other": "body", "world": "world"}[law.of] if flip else law.of
    return Friction(axis=law.axis, along=along, across=across, of=of)
