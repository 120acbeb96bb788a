"""Messages about unknown and missing arguments, with the name that is probably meant."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from functools import wraps
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable)

#: other names of arguments: in formulas, and in other engines
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
_MEANT: dict[str, list[str]] = {}
for _ours, _others in ELSEWHERE.items():
    for _other in _others.split():
        _MEANT.setdefault(_other, []).append(_ours)


def known(function: F) -> F:
    """Decorate a function or a class so that its errors name an unknown or missing argument."""
    made: Any = function
    if not isinstance(function, type):
        return _guarded(function, function.__name__)
    made.__init__ = _guarded(made.__init__, made.__name__)
    return made


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
            raise TypeError(_unknown(shown, [n for n in names if n != "self"], kwargs, has))
        missing = [n for n in required if n not in by_place[: len(args)] and n not in kwargs]
        if missing:
            call = f"{shown}({', '.join(name for name in required if name != 'self')})"
            raise TypeError(f"{shown} needs {' and '.join(missing)}: {call}")
        if len(args) > most:
            firsts = ", ".join(name for name in by_place if name != "self")
            rest = f"; give the others by name, for example {by_name[0]}=" if by_name else ""
            raise TypeError(f"{shown} takes only {firsts or 'nothing'} without a name{rest}")
        return function(*args, **kwargs)

    return guarded


def _unknown(shown: str, names: list[str], given, has) -> str:
    unknown = next(name for name in given if name not in has)
    meant = [name for name in _MEANT.get(unknown, ()) if name in has]
    meant = meant or get_close_matches(unknown, names, n=1)
    hint = f"it is called {meant[0]}=" if meant else f"it has {', '.join(names)}"
    return f"{shown} has no argument {unknown}=; {hint}"
