"""Surfaces that move in themselves, of half-spaces and static bodies: belts, turntables, rollers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.fields import Value
from carom.scene.values import shown

#: greatest sine of the angle between a velocity and the plane that it is to lie in
IN_PLANE = 1e-9

Velocity = np.ndarray | Callable
Spin = tuple[np.ndarray, float | Callable, np.ndarray | None]
GivenSpin = (
    tuple[ArrayLike, float | Callable] | tuple[ArrayLike, float | Callable, ArrayLike | None]
)


def _of_time(name: str, value, shape: tuple[int, ...]):
    """Return a function; refuse a piecewise polynomial whose values have another shape."""
    if checks.is_polynomial(value) and np.shape(value.c)[2:] != shape:
        raise ValueError(
            f"{name} as a piecewise polynomial must have values of shape {shape}, got coefficients of shape "
            f"{np.shape(value.c)}"
        )
    return value


def velocity_of_surface(name: str, value) -> Velocity:
    """Return a velocity (3,) [m/s], or a function of time."""
    if callable(value):
        return _of_time(name, value, (3,))
    return checks.finite_array(
        name,
        value,
        (3,),
        "m/s, a function t -> (velocity, acceleration), or a piecewise polynomial",
    )


def spin_of_surface(name: str, value) -> Spin:
    """Return axis, rate [rad/s] or a function of time, and point."""
    given = value if isinstance(value, (tuple, list)) else ()
    if len(given) not in (2, 3):
        raise ValueError(
            f"{name} must be (axis, rate) or (axis, rate, point), got {checks.shown(value)}"
        )
    axis, rate, point = (*given, None)[:3]
    axis = checks.unit_vector(f"the axis of {name}", axis)
    if callable(rate):
        rate = _of_time(f"the rate of {name}", rate, ())
    else:
        rate = checks.number(f"the rate of {name}", rate, unit="rad/s")
    if point is not None:
        point = checks.finite_array(f"the point of {name}", point, (3,), "m")
        point.setflags(write=False)
    axis.setflags(write=False)
    return axis, rate, point


SurfaceVelocity = Value[Velocity | None, ArrayLike | Callable | None]
SurfaceSpin = Value[Spin | None, GivenSpin | None]


def is_timed(part: Any) -> bool:
    """Return whether the surface of a half-space or static body moves by a function of time."""
    spin = part.surface_spin
    return callable(part.surface_velocity) or (spin is not None and callable(spin[1]))


def motion_in_words(part: Any) -> str:
    """Return how a surface moves in itself, for the text of its part; nothing if it does not."""
    velocity, spin = part.surface_velocity, part.surface_spin
    text = "" if velocity is None else f", surface_velocity={_in_words(velocity)}"
    if spin is not None:
        text += f", surface_spin=({', '.join(_in_words(one) for one in spin if one is not None)})"
    return text


def _in_words(value: Any) -> str:
    if callable(value):
        return checks.shown(value)
    return f"{value:g}" if isinstance(value, float) else shown(value)


def check_in_plane(velocity, spin: Spin | None, normal: np.ndarray) -> None:
    """Refuse a motion of a plane that is not in the plane.

    Raises
    ------
    ValueError
        If the velocity, unless it is a function, or the spin would move the plane along its normal.
    """
    if checks.is_polynomial(velocity):
        velocity = velocity(velocity.x)
    if velocity is not None and not callable(velocity):
        if np.max(np.abs(velocity @ normal)) > IN_PLANE * np.max(np.linalg.norm(velocity, axis=-1)):
            raise ValueError(
                f"surface_velocity must be in the plane of the half-space, perpendicular to its normal "
                f"{checks.shown(normal)}, got {checks.shown(velocity)}"
            )
    if spin is not None and np.linalg.norm(np.cross(spin[0], normal)) > IN_PLANE:
        raise ValueError(
            "surface_spin must be about the normal of the half-space, because it would leave its plane "
            f"otherwise; the normal is {checks.shown(normal)}, got the axis {checks.shown(spin[0])}"
        )
