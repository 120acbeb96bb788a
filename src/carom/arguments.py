"""Messages about unknown and missing arguments and attributes, with the name that is probably meant."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from difflib import get_close_matches
from functools import wraps
from typing import Any, TypeVar, cast

F = TypeVar("F", bound=Callable)
T = TypeVar("T")

#: other names of arguments and attributes: in formulas, and in other engines
ELSEWHERE = {
    "friction": "mu mu_s mus friction_coefficient coefficient_of_friction lateralFriction",
    "friction_held": "mu_held",
    "restitution": "e eps cor bounce bounciness elasticity restitution_coefficient",
    "rolling_friction": "mu_r rollingFriction",
    "pivoting_friction": "spinningFriction torsional_friction",
    "impact_law": "law model",
    "stiffness": "k ke",
    "mass": "m weight",
    "density": "rho",
    "inertia": "I J moi inertia_tensor",
    "position": "pos x xyz origin location translation p",
    "orientation": "quat q quaternion rotation rot rpy attitude R pose",
    "velocity": "vel v linear_velocity v0 lin_vel",
    "angular_velocity": "omega w angvel ang_vel angular",
    "shape": "geom geometry size box",
    "gravity": "g",
    "point": "anchor origin position offset",
    "normal": "n axis up direction",
    "name": "label id",
    "t": "time times",
    "time": "t",
    "total_energy": "energy",
    "duration": "T time t tf t_end t_final end tspan t_span",
    "step": "dt h timestep time_step step_size stepsize max_step",
    "save_at": "t_eval saveat output_times",
    "method": "integrator solver scheme",
    "rtol": "reltol tol tolerance",
    "atol": "abstol",
    "progress": "verbose progress_bar",
    "save": "path filename file output",
    "lower": "low minimum min",
    "upper": "high maximum max",
    "parent": "body1 body_a bodyA base",
    "child": "body2 body_b bodyB body",
    "other": "other_body ground plane",
    "definition": "joint force constraint",
    "law": "impact_law model",
    "inverse_mass": "W delassus",
    "radius": "r R",
    "length": "height h L",
}
#: arguments that have two names: an impact by itself has a law, a contact of a scene has an impact law
_TWINS = {"law": "impact_law", "impact_law": "law"}
#: what is stated in another place
_OTHER_PLACE = {
    "friction": "state it for a contact, add_contact(..., friction=) or set_contact_default(friction=), "
                "or in a Material",
    "restitution": "state it for a contact, add_contact(..., restitution=) or "
                   "set_contact_default(restitution=), or in a Material",
    "rtol": "it is an argument of carom.simulate",
    "atol": "it is an argument of carom.simulate",
    "fixed": "a body that never moves is made by add_static",
    "static": "a body that never moves is made by add_static",
}  # fmt: skip
#: what other engines have a method for
_OTHER_METHOD = {
    "add_motor": "a motor is made by add_constraint(carom.constraints.Driver(...)), which prescribes the "
                 "motion of a joint, or by add_force(carom.forces.JointForce(...)), which applies a force",
    "add_spring": "a spring is made by add_force(carom.forces.Spring(...))",
    "add_gear": "a gear is made by add_constraint(carom.constraints.Gear(...))",
    "add_limit": "a limit of a joint is made by add_stop",
    **dict.fromkeys(("add_floor", "add_ground", "add_plane"), "a floor is made by add_half_space"),
    **dict.fromkeys(("add_box", "add_sphere", "add_cylinder", "add_capsule"),
                    "a body with a shape is made by add_body(carom.Box(...), mass=...)"),
    **dict.fromkeys(("simulate", "run", "step"),
                    "a scene is simulated by carom.simulate(scene, duration), a carom.Run by advance()"),
}  # fmt: skip
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
ALIKE = 0.7  # of two names, from 0 to 1, where one may be a slip for the other
_MEANT: dict[str, list[str]] = {}
for _ours, _others in ELSEWHERE.items():
    for _other in _others.split():
        _MEANT.setdefault(_other, []).append(_ours)


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
    required = [*by_place[: most - len(function.__defaults__ or ())]]
    required += [name for name in by_name if name not in (function.__kwdefaults__ or {})]

    @wraps(function)
    def guarded(*args, **kwargs):
        if not kwargs.keys() <= has:
            kwargs = _by_own_names(shown, kwargs, has, by_place[: len(args)])
        if not kwargs.keys() <= has:
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
            rest = f"; give the others by name, for example {by_name[0]}=" if by_name else ""
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
    meant = [name for name in _MEANT.get(unknown, ()) if name in has]
    if not meant and unknown in _OTHER_PLACE:
        return f"{shown} has no argument {unknown}=; {_OTHER_PLACE[unknown]}"
    word, unit = _without_unit(unknown)
    meant = meant or [name for name in (word, *_MEANT.get(word, ())) if name in has]
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
    near = [one for one in _MEANT.get(name, ()) if one in has]
    word, unit = _without_unit(name)
    near = near or [one for one in (word, *_MEANT.get(word, ())) if one in has]
    near = near or get_close_matches(word, has, n=1, cutoff=ALIKE)
    suggested = f"did you mean {near[0]!r}{f', in {unit[0]}' if unit else ''}?" if near else ""
    hint = _OTHER_METHOD.get(name) or _OTHER_PLACE.get(name) or suggested
    return f"{type(thing).__name__} has no attribute {name!r}" + (f"; {hint}" if hint else "")


def unknown_member(module: str, name: str, members, elsewhere: dict[str, str]) -> AttributeError:
    """Return the error for a name that a module does not have; `elsewhere` has names from other engines."""
    meant = elsewhere.get(name.lower())
    near = [meant] if meant else get_close_matches(name, members, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"it has {', '.join(members)}"
    return AttributeError(f"{module} has no {name!r}; {hint}")
