"""Checks of input: each raises an error that has the argument, its value and the allowed values.

Numbers are all values that Python accepts as numbers, except truth values, strings, dates and masked values.
A value of a wrong type or out of range raises a `ValueError`; if an object of a class of carom or a function is
expected, other objects raise a `TypeError`.
"""

from __future__ import annotations

import importlib
import math
import os
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np

from carom import hints

#: [m] least and greatest length whose powers up to the fifth (inertia of a solid) are finite and not 0
LENGTHS = (1e-60, 1e60)
#: [kg] least and greatest mass that has, with such lengths, a finite inertia
MASSES = (1e-180, 1e180)
LONGEST = 300  # characters of a value in a message
_NO_NUMBERS = (bool, np.bool_, str, bytes, bytearray, np.datetime64, np.timedelta64)
_ERRORS = (TypeError, ValueError, OverflowError, AttributeError, RecursionError)


def finite_array(name: str, value, shape: tuple[int | None, ...], unit: str = "") -> np.ndarray:
    """Return `value` as a float array of `shape` (``None`` is any length); refuse NaN and inf."""
    array = real_array(name, value, _shape(shape))
    same = array.ndim == len(shape) and all(s is None or s == n for s, n in zip(shape, array.shape))
    if not same:
        raise ValueError(
            f"{name} must have shape {_shape(shape)}{_in(unit)}, got shape {array.shape}"
        )
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} must be finite, got {shown(value)}")
    return array


def vectors(name: str, value, components: int) -> np.ndarray:
    """Return `value` as a finite float array (..., components)."""
    array = real_array(name, value, f"(..., {components})")
    if array.shape[-1:] != (components,):
        raise ValueError(f"{name} must have shape (..., {components}), got shape {array.shape}")
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} must be finite, got {shown(value)}")
    return array


def real_array(name: str, value, shape: str) -> np.ndarray:
    """Return `value` as a new float array of any shape, NaN and inf included; `shape` is for the message."""
    try:
        if _no_number(value) or np.iscomplexobj(value):
            raise TypeError
        return np.array(value, dtype=np.float64)
    except OverflowError:  # a whole number beyond all floats
        raise ValueError(f"{name} must be finite, got {shown(value)}") from None
    except _ERRORS:
        raise ValueError(
            f"{name} must be numbers of shape {shape}, got {shown(value)}{_text(value)}"
        ) from None


def number(
    name: str,
    value,
    *,
    above: float | None = None,
    least: float | None = None,
    below: float | None = None,
    most: float | None = None,
    unit: str = "",
) -> float:
    """Return `value` as a float inside the given bounds (`above`, `below` exclude the bound)."""
    try:
        if type(value) not in (float, int) and (
            _no_number(value) or np.iscomplexobj(value) or np.ndim(value) != 0
        ):
            raise TypeError
        result = float(value)
    except OverflowError:  # a whole number beyond all floats
        result = math.inf
    except _ERRORS:
        raise ValueError(
            f"{name} must be a number{_in(unit)}, got {shown(value)}{_text(value)}"
        ) from None
    inside = (
        math.isfinite(result)
        and (above is None or result > above)
        and (least is None or result >= least)
        and (below is None or result < below)
        and (most is None or result <= most)
    )
    if not inside:
        bounds = [
            f"{word} {bound:g}"
            for word, bound in (
                ("above", above), ("at least", least), ("below", below), ("at most", most),
            )
            if bound is not None
        ]  # fmt: skip
        allowed = " and ".join(["finite", *bounds])
        raise ValueError(f"{name} must be {allowed}{_in(unit)}, got {shown(value)}")
    return result


def length(name: str, value, *, zero: bool = False) -> float:
    """Return a length [m] within `LENGTHS`; with `zero`, 0 is also allowed."""
    return _within(name, value, LENGTHS, "m", zero)


def mass(name: str, value, *, zero: bool = False) -> float:
    """Return a mass [kg] within `MASSES`; with `zero`, 0 is also allowed."""
    return _within(name, value, MASSES, "kg", zero)


def scale(name: str, value, unit: str = "") -> float:
    """Return a number within `LENGTHS`, so that its square and quotients of such numbers are finite."""
    result = number(name, value, above=0.0, unit=unit)
    if not LENGTHS[0] <= result <= LENGTHS[1]:
        raise ValueError(
            f"{name} must be from {LENGTHS[0]:g} to {LENGTHS[1]:g}{_in(unit)}, got {shown(value)}"
        )
    return result


def steps(duration: float, step: float, most: float) -> int:
    """Return the number of steps of a duration, at least one; refuse a step that gives more than `most`."""
    if not duration <= most * step:
        raise ValueError(
            f"step must be at least duration / {most:g} = {duration / most:g} s, got step {step!r} and "
            f"duration {duration!r}"
        )
    return int(np.ceil(duration / step * (1.0 - 1e-12)))


def call(name: str, function: Callable, *arguments):
    """Call a user-defined function; add its name to an error that it raises."""
    try:
        return function(*arguments)
    except Exception as error:
        error.add_note(f"The error was raised by {name}, a function that was passed to carom.")
        raise


def _within(name: str, value, bounds: tuple[float, float], unit: str, zero: bool) -> float:
    result = number(name, value, **{"least" if zero else "above": 0.0}, unit=unit)
    if not (zero or bounds[0] <= result) or not result <= bounds[1]:
        raise ValueError(
            f"{name} must be from {bounds[0]:g} to {bounds[1]:g} [{unit}], so that volume and inertia are "
            f"finite, got {shown(value)}"
        )
    return result


def integer(name: str, value, *, least: int | None = None, most: int | None = None) -> int:
    """Return `value` as an int of 64 bits inside the given bounds."""
    try:
        if isinstance(value, _NO_NUMBERS) or not hasattr(value, "__index__"):
            raise TypeError
        result = value.__index__()
    except TypeError:
        raise ValueError(f"{name} must be a whole number, got {shown(value)}") from None
    greatest = 2**63 - 1 if most is None else most
    if not (least is None or result >= least) or not -(2**63) <= result <= greatest:
        bounds = [] if least is None else [f"at least {least}"]
        if most is not None or result > greatest:
            bounds.append(f"at most {greatest}")
        raise ValueError(
            f"{name} must be a whole number of {' and '.join(bounds) or '64 bits'}, got {shown(value)}"
        )
    return result


def seed(name: str, value) -> int | np.random.Generator:
    """Return a seed of random numbers: a whole number, or a generator of NumPy, which goes on from there."""
    if isinstance(value, np.random.Generator):
        return value
    if isinstance(value, (float, type(None), np.random.RandomState)):
        raise ValueError(
            f"{name} must be a whole number of at least 0 or a numpy.random.Generator, got {shown(value)}"
        )
    return integer(name, value, least=0)


def choice(name: str, value, allowed: Iterable[str]) -> str:
    """Return `value` if it is one of `allowed`; suggest the nearest one otherwise."""
    options = sorted(allowed)
    if not isinstance(value, str):
        raise ValueError(
            f"{name} must be one of {', '.join(map(repr, options))}, got {shown(value)}"
        )
    if value in options:
        return value
    raise ValueError(
        f"{name} must be one of {', '.join(map(repr, options))}, got {shown(value)}"
        f"{elsewhere(name, value) or nearest(value, options)}"
    )


def elsewhere(name: str, value: str) -> str:
    """Return the end of a message about a value that is one of another argument, or nothing."""
    said = hints.of_word(name, value)
    return f"; {said}" if said else ""


def nearest(value: str, options: Iterable[str]) -> str:
    """Return the end of a message that suggests the nearest of some words, or nothing."""
    near = get_close_matches(value, options, n=1)
    return f"; did you mean {near[0]!r}?" if near else ""


def flag(name: str, value) -> bool:
    """Return True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} must be True or False, got {shown(value)}")
    return bool(value)


def text(name: str, value) -> str:
    """Return a text that is not empty."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError(f"{name} must be a non-empty string, got {shown(value)}")
    return value


def function(name: str, value, *, optional: bool = False) -> Any:
    """Return a value that can be called; refuse others by a `TypeError`. If `optional`, None is allowed."""
    if not (callable(value) or (optional and value is None)):
        raise TypeError(f"{name} must be a function, got {shown(value)}")
    return value


def path(name: str, value) -> Path:
    """Return the path of a file or folder, which need not exist."""
    try:
        if not isinstance(value, (str, os.PathLike)) or not os.fspath(value):
            raise TypeError
        where = Path(value)
        where.exists()
        if "\0" in str(where):
            raise TypeError
    except (TypeError, ValueError, OSError):  # bytes, a null character, a name that is too long
        raise ValueError(f"{name} must be a path, got {shown(value)}") from None
    return where


def file_to_write(name: str, value) -> Path:
    """Return the path of a file in a folder that exists."""
    where = path(name, value)
    if where.is_dir() or not where.parent.is_dir():
        raise ValueError(
            f"{name} must be the path of a file in a folder that exists, got {shown(str(where))}"
        )
    return where


def listed(name: str, value, what: str) -> list:
    """Return the members of a sequence; refuse other values, and strings."""
    if isinstance(value, Sequence) and not isinstance(value, (str, bytes, bytearray)):
        return list(value)
    if isinstance(value, np.ndarray) and value.ndim > 0:
        return list(value)
    raise ValueError(f"{name} must be a sequence of {what}, got {shown(value)}")


def times(name: str, value, first: float, last: float) -> np.ndarray:
    """Return one or several times [s] within a run, as an array (n,)."""
    array = np.atleast_1d(real_array(name, value, "() or (n,)"))
    if array.ndim != 1:
        raise ValueError(f"{name} must have shape () or (n,) [s], got shape {array.shape}")
    if not np.all((array >= first) & (array <= last)):
        raise ValueError(f"{name} must be within [{first:g}, {last:g}] s, got {shown(value)}")
    return array


def unit_vector(name: str, value) -> np.ndarray:
    """Return `value` (3,) divided by its length; refuse a zero vector."""
    vector = finite_array(name, value, (3,))
    largest = float(np.max(np.abs(vector)))
    if not largest > 0.0:
        raise ValueError(f"{name} must not be the zero vector, got {shown(value)}")
    vector /= largest  # so that neither a tiny nor a huge vector under- or overflows its square
    return vector / np.linalg.norm(vector)


def unit_quaternion(name: str, value) -> np.ndarray:
    """Return `value` (4,) normalised; refuse one that is not a unit quaternion to 1e-6."""
    quaternion = finite_array(name, value, (4,))
    length = float(np.linalg.norm(quaternion))
    if not abs(length - 1.0) <= 1e-6:
        raise ValueError(
            f"{name} must be a unit quaternion (w, x, y, z), got {shown(value)} of length {length:.9g}"
        )
    return quaternion / length


def instance(name: str, value, kinds: tuple[type, ...], hint: str = "") -> Any:
    """Return `value`; refuse, by a `TypeError`, one that is of none of `kinds`."""
    if isinstance(value, kinds):
        return value
    allowed = " or ".join(kind.__name__ for kind in kinds)
    if isinstance(value, type) and issubclass(value, kinds):
        hint = f"; this is the class, make an object with {value.__name__}(...)"
    raise TypeError(f"{name} must be a {allowed}, got {shown(value)}{hint}")


def shown(value) -> str:
    """Return the text of a value in a message, cut if it is long."""
    try:
        words = repr(value.item() if isinstance(value, np.generic) else value)
    except Exception:  # a whole number of more digits than Python writes, or a __repr__ that fails
        return f"a value of type {type(value).__name__}"
    return words if len(words) <= LONGEST else f"{words[: LONGEST // 2]} ... {words[-40:]}"


def is_polynomial(value) -> bool:
    """Return whether a value is a piecewise polynomial, as `scipy.interpolate.PPoly` is one."""
    return hasattr(value, "c") and hasattr(value, "x") and not isinstance(value, type)


def _no_number(value) -> bool:
    """Return whether a value, or a member of nested lists, only looks like a number."""
    if isinstance(value, (list, tuple)):
        return any(map(_no_number, value))
    if hasattr(value, "__array__") and not isinstance(value, np.generic):
        value = np.asanyarray(value)
        if value.dtype.kind == "O":
            return any(map(_no_number, value.flat))
        # of a masked array; NumPy loads those when they are named
        return value.dtype.kind not in "iufc" or bool(np.any(getattr(value, "mask", False)))
    return value is None or isinstance(value, _NO_NUMBERS)


def _text(value) -> str:
    """Return that a value is a string, or has some, where it looks like a number."""
    if isinstance(value, (list, tuple)) and any(isinstance(one, str) for one in value):
        return ", which has strings"
    return ", a string" if isinstance(value, str) and value.strip("+-. ")[:1].isdigit() else ""


def need(module: str, what: str, extra: str, package: str = "") -> Any:
    """Return a module of an optional `package` of an `extra` of carom, which `what` needs.

    Raises
    ------
    ImportError
        If it is not installed; the last line of the message has the command that installs it.
    """
    top = module.split(".")[0]
    try:
        importlib.import_module(top)
        return importlib.import_module(module)
    except ImportError as error:
        if error.name is not None and error.name.split(".")[0] != top:
            raise  # it is there, and lacks something itself
        message = f"{what} needs the package {package or top}; install it with"
        raise ModuleNotFoundError(
            f'{message}\n\n    pip install "carom[{extra}]"\n', name=top
        ) from None


def _shape(shape) -> str:
    return (
        "("
        + ", ".join("n" if s is None else str(s) for s in shape)
        + ("," if len(shape) == 1 else "")
        + ")"
    )


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""
