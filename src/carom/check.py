"""Checks of input: each raises at once, naming the argument, what it was and what is allowed."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

import numpy as np


def finite_array(name: str, value, shape: tuple[int | None, ...], unit: str = "") -> np.ndarray:
    """Return `value` as a float array of `shape` (``None`` is any length); refuse NaN and inf."""
    try:
        if np.iscomplexobj(value):
            raise TypeError
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(
            f"{name} must be numbers of shape {_shape(shape)}, got {value!r}"
        ) from None
    same = array.ndim == len(shape) and all(s is None or s == n for s, n in zip(shape, array.shape))
    if not same:
        raise ValueError(
            f"{name} must have shape {_shape(shape)}{_in(unit)}, got shape {array.shape}"
        )
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} must be finite, got {value!r}")
    return array


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
        result = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be a number{_in(unit)}, got {value!r}") from None
    inside = (
        np.isfinite(result)
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
        raise ValueError(f"{name} must be {allowed}{_in(unit)}, got {value!r}")
    return result


def integer(name: str, value, *, least: int | None = None, most: int | None = None) -> int:
    """Return `value` as an int inside the given bounds."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise ValueError(f"{name} must be a whole number, got {value!r}")
    number(name, value, least=least, most=most)
    return int(value)


def choice(name: str, value, allowed: Iterable[str]) -> str:
    """Return `value` if it is one of `allowed`; suggest the nearest one otherwise."""
    options = sorted(allowed)
    if value in options:
        return value
    near = get_close_matches(str(value), options, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise ValueError(f"{name} must be one of {', '.join(map(repr, options))}, got {value!r}{hint}")


def flag(name: str, value) -> bool:
    """Return True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} must be True or False, got {value!r}")
    return bool(value)


def unit_vector(name: str, value) -> np.ndarray:
    """Return `value` (3,) divided by its length; refuse a zero vector."""
    vector = finite_array(name, value, (3,))
    largest = float(np.max(np.abs(vector)))
    if not largest > 0.0:
        raise ValueError(f"{name} must not be the zero vector, got {value!r}")
    vector /= largest  # so that neither a tiny nor a huge vector under- or overflows its square
    return vector / np.linalg.norm(vector)


def unit_quaternion(name: str, value) -> np.ndarray:
    """Return `value` (4,) normalised; refuse one that is not a unit quaternion to 1e-6."""
    quaternion = finite_array(name, value, (4,))
    length = float(np.linalg.norm(quaternion))
    if not abs(length - 1.0) <= 1e-6:
        raise ValueError(
            f"{name} must be a unit quaternion (w, x, y, z), got {value!r} of length {length:.9g}"
        )
    return quaternion / length


def instance(name: str, value, kinds: tuple[type, ...], hint: str = "") -> None:
    """Refuse, by a `TypeError`, a `value` that is of none of `kinds`."""
    if isinstance(value, kinds):
        return
    allowed = " or ".join(kind.__name__ for kind in kinds)
    raise TypeError(f"{name} must be a {allowed}, got {value!r}{hint}")


def _shape(shape) -> str:
    return (
        "("
        + ", ".join("n" if s is None else str(s) for s in shape)
        + ("," if len(shape) == 1 else "")
        + ")"
    )


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""
