"""Messages about unknown and missing arguments and attributes, with the name that is probably meant."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from difflib import get_close_matches
from functools import wraps
from inspect import CO_VARKEYWORDS
from typing import Any, TypeVar, cast

from carom.hints import ALIKE, MEANT, PLACE, ending, of_argument, of_member

F = TypeVar("F", bound=Callable)
T = TypeVar("T")

#: arguments that have two names: an impact by itself has a law, a contact of a scene has an impact law
_TWINS = {"law": "impact_law", "impact_law": "law"}
#: units in names such as ``angular_velocity_deg``: carom's own unit, and how to convert
_RADIANS, _PER_SECOND = ("radians", "np.radians(...)"), ("rad/s", "... * math.pi / 30")
_UNITS = {
    **dict.fromkeys(("deg", "degs", "degree", "degrees", "dps"), _RADIANS), "rpm": _PER_SECOND,
    "mm": ("m", "... * 1e-3"), "cm": ("m", "... * 1e-2"), "km": ("m", "... * 1e3"),
    "inch": ("m", "... * 0.0254"), "kmh": ("m/s", "... / 3.6"), "mph": ("m/s", "... * 0.44704"),
    "g": ("kg", "... * 1e-3"), "gram": ("kg", "... * 1e-3"), "grams": ("kg", "... * 1e-3"),
    "ms": ("s", "... * 1e-3"), "us": ("s", "... * 1e-6"), "minutes": ("s", "... * 60"),
}  # fmt: skip
_IN_DEGREES = ("angle", "angles", "view")  # arguments of carom


def known(function: F) -> F:
    """Decorate a function or a class so that its errors name an unknown or missing argument.

    An argument with two names is taken by both.
    """
    made: Any = function
    if not isinstance(function, type):
        return _guarded(function, function.__name__)
    made.__init__ = _guarded(made.__init__, made.__name__)
    return made


def formerly(**names: str) -> Callable[[F], F]:
    """Return a decorator of a function whose arguments had other names, ``old="new"``, which it still takes."""

    def decorate(function: F) -> F:
        @wraps(function)
        def taking(*args, **kwargs):
            for old, new in names.items():
                if old in kwargs:
                    warnings.warn(
                        f"{function.__name__}({old}=) is called {new}=; the old name will go",
                        DeprecationWarning,
                        stacklevel=2,
                    )
                    kwargs = {new if name == old else name: value for name, value in kwargs.items()}
            return function(*args, **kwargs)

        return cast(F, taking)

    return decorate


def _guarded(function: Any, shown: str) -> Any:
    code = function.__code__
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    by_place, by_name = names[: code.co_argcount], names[code.co_argcount :]
    has, most = frozenset(names), len(by_place)
    open_ended = bool(code.co_flags & CO_VARKEYWORDS)
    required = [*by_place[: most - len(function.__defaults__ or ())]]
    required += [name for name in by_name if name not in (function.__kwdefaults__ or {})]

    @wraps(function)
    def guarded(*args, **kwargs):
        if not kwargs.keys() <= has and not open_ended:
            kwargs = _by_own_names(shown, kwargs, has, by_place[: len(args)])
        if not kwargs.keys() <= has and not open_ended:
            raise TypeError(
                _unknown(shown, [n for n in names if n not in ("self", "cls")], kwargs, has)
            )
        missing = [n for n in required if n not in by_place[: len(args)] and n not in kwargs]
        if missing:
            own = [name for name in required if name not in ("self", "cls")]
            call = f"{shown}({', '.join(n if n in by_place else f'{n}=...' for n in own)})"
            raise TypeError(f"{shown} needs {' and '.join(missing)}: {call}")
        if len(args) > most:
            firsts = ", ".join(name for name in by_place if name not in ("self", "cls"))
            rest = f", for example {by_name[0]}=" if by_name else ""
            rest = f"; give the others by name{rest}" if by_name or open_ended else ""
            if not firsts:
                raise TypeError(f"{shown} takes its arguments by name, for example {by_name[0]}=")
            raise TypeError(f"{shown} takes only {firsts} without a name{rest}")
        return function(*args, **kwargs)

    return guarded


def _by_own_names(shown: str, given: dict, has, placed: tuple[str, ...]) -> dict:
    """Return arguments by the names that a function has, where they are given by their other name."""
    found = {}
    for name, value in given.items():
        twin = _TWINS.get(name) if name not in has else None
        own = twin if twin in has else name
        if own != name and (own in given or own in placed):
            raise TypeError(f"{shown} takes {own}= or {name}=, which are the same, got both")
        found[own] = value
    return found


def check_known(shown: str, names: list[str], given) -> None:
    """Refuse arguments, for a function that takes them as ``**given``, that are not among `names`."""
    if not given.keys() <= set(names):
        raise TypeError(_unknown(shown, names, given, names))


def _unknown(shown: str, names: list[str], given, has) -> str:
    unknown = next(name for name in given if name not in has)
    meant = [name for name in MEANT.get(unknown, ()) if name in has]
    if said := of_argument(shown, unknown):
        return f"{shown} has no argument {unknown}=; {said}"
    if not meant and unknown in PLACE:
        return f"{shown} has no argument {unknown}=; {PLACE[unknown]}"
    word, unit = _without_unit(unknown)
    meant = meant or [name for name in (word, *MEANT.get(word, ())) if name in has]
    meant = meant or get_close_matches(word, names, n=1, cutoff=ALIKE)
    hint = f"it is called {meant[0]}=" if meant else f"it has {', '.join(names)}"
    if meant == ["orientation"] and unit == _RADIANS:
        hint += "; carom.euler and carom.axis_angle make one from angles in degrees"
    elif meant and unit and not (unit == _RADIANS and meant[0] in _IN_DEGREES):
        hint += f" and is in {unit[0]}: {meant[0]}={unit[1]}"
    return f"{shown} has no argument {unknown}=; {hint}"


def _without_unit(name: str) -> tuple[str, tuple[str, str] | None]:
    """Return a name without the unit at its end, as in ``omega_deg_s``, and carom's unit for that one."""
    words = name.split("_")
    k = next((k for k in range(1, len(words)) if words[k] in _UNITS), len(words))
    return "_".join(words[:k]), _UNITS[words[k]] if k < len(words) else None


def attributes(setting: str = "") -> Callable[[type[T]], type[T]]:
    """Return a decorator of classes whose errors about attributes say what to do.

    The message about an unknown attribute has the name that is probably meant; `setting` is the end of the
    message about an attribute that cannot be set.
    """

    def decorate(made: type[T]) -> type[T]:
        refuse = made.__setattr__

        def set_attribute(self, name: str, value) -> None:
            try:
                refuse(self, name, value)
            except AttributeError as error:
                raise type(error)(f"{error}; {setting}") from None

        def get_attribute(self, name: str):
            # a property may have raised an AttributeError
            if name[:1] == "_" or hasattr(type(self), name):
                return object.__getattribute__(self, name)
            raise AttributeError(_no_attribute(self, name))

        if setting:
            made.__setattr__ = set_attribute
        made.__getattr__ = get_attribute  # pyright: ignore[reportAttributeAccessIssue]
        return made

    return decorate


def _no_attribute(thing, name: str) -> str:
    has = [one for one in dir(thing) if one[:1] != "_"]
    near = [one for one in MEANT.get(name, ()) if one in has]
    word, unit = _without_unit(name)
    near = near or [one for one in (word, *MEANT.get(word, ())) if one in has]
    near = near or get_close_matches(word, has, n=1, cutoff=ALIKE)
    suggested = f"did you mean {near[0]!r}{f', in {unit[0]}' if unit else ''}?" if near else ""
    known = [of_member(kind.__name__, name) for kind in type(thing).__mro__]
    hint = next(filter(None, known), "") or PLACE.get(name) or suggested
    hint = f"did you mean {hint!r}?" if hint.isidentifier() else hint
    return f"{type(thing).__name__} has no attribute {name!r}" + (f"; {hint}" if hint else "")


def members_of(module: str, names: Iterable[str]) -> Callable[[str], Any]:
    """Return the ``__getattr__`` of a module: an error that names what is probably meant."""

    def get(name: str):
        if name[:1] == "_":
            raise AttributeError(name)
        hint = ending(module, name, names) or f"; it has {', '.join(names)}"
        raise AttributeError(f"{module} has no {name!r}{hint}")

    return get
