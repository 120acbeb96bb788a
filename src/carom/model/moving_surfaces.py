"""Surfaces that move in themselves, as arrays: the velocity field of each contact with one."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom import checks
from carom._compiled.composed import is_compiled, joined, once, plainly
from carom._compiled.record_arrays import Columns, table
from carom._compiled.user_functions import Functions
from carom.model.arrays import MOVING, MovingSurfaces
from carom.scene.bodies import HalfSpace, StaticBody
from carom.scene.moving_surfaces import check_in_plane, is_timed
from carom.scene.scene import Scene

Part = HalfSpace | StaticBody


def _parts(scene: Scene) -> list[Part]:
    return [part for part in (*scene.half_spaces, *scene.statics) if part.moves]


def _axis(part: Part) -> tuple[np.ndarray, Any, np.ndarray]:
    """Return axis, rate and point of the spin of a surface."""
    axis, rate, point = part.surface_spin or (np.zeros(3), 0.0, None)
    own = part.point if isinstance(part, HalfSpace) else part.position
    return axis, rate, own if point is None else point


def _with_rate(motion) -> Any:
    """Return a motion as a function ``t -> (value, its derivative)``; a polynomial is differentiated."""
    if checks.is_polynomial(motion):
        slope = motion.derivative()
        return lambda t: (motion(t), slope(t))
    return motion if callable(motion) else lambda t: (motion, np.zeros_like(motion))


@once
def _of_time(motion, shape: tuple[int, ...]):
    """Return a function of (t, x) whose result is a motion and its rate, an array of this shape."""
    if not is_compiled(motion):
        return lambda t, x: motion(float(t))

    def vectors(t, x):
        out, (value, rate) = np.empty((2, 3)), motion(t)
        out[0, 0], out[0, 1], out[0, 2] = value[0], value[1], value[2]
        out[1, 0], out[1, 1], out[1, 2] = rate[0], rate[1], rate[2]
        return out

    def numbers(t, x):
        out = np.empty(2)
        out[0], out[1] = motion(t)
        return out

    return joined(vectors if len(shape) == 2 else numbers, motion)


def field_at(part: Part, t: float) -> np.ndarray:
    """Return the field of a surface at a time: velocity at the origin and spin, and their rates, (4, 3)."""
    field, velocity, (axis, rate, point) = np.zeros((2, 2, 3)), part.surface_velocity, _axis(part)
    if velocity is not None:
        field[:, 0] = _with_rate(velocity)(t)
    field[:, 1] = np.outer(_with_rate(rate)(t), axis)
    field[:, 0] -= np.cross(field[:, 1], point)
    return field.reshape(4, 3)


def write_fields(rows: np.recarray, scene: Scene, plane: np.ndarray) -> None:
    """Write the field to the rows of contacts; `plane` is the index of the half-space of each, -1 for none.

    Static bodies have the numbers after those of bodies that move.
    """
    timed = 2
    for part in _parts(scene):
        is_plane = isinstance(part, HalfSpace)
        here = plane == part.index if is_plane else rows["other"] == len(scene.bodies) + part.index
        rows["moves"][here] = timed if is_timed(part) else 1
        timed += is_timed(part)
        if not is_timed(part):
            rows["field"][here] = field_at(part, 0.0)


def moving_surfaces(scene: Scene, functions: Functions) -> MovingSurfaces:
    """Return the surfaces that move by functions of time."""
    made = [table(MOVING, 0)]
    for part in filter(is_timed, _parts(scene)):
        row, velocity, (axis, rate, point) = table(MOVING, 1), part.surface_velocity, _axis(part)
        row["axis"], row["point"] = axis, point
        if callable(velocity):
            what, given, shape = (
                f"the surface_velocity of {part.name!r}",
                _with_rate(velocity),
                (2, 3),
            )
            row["velocity_address"] = functions.address(_of_time(given, shape), (1,), shape, what)
            if isinstance(part, HalfSpace):
                start = checks.finite_array(what, plainly(given)(0.0), shape, "m/s")[0]
                check_in_plane(start, None, part.normal)
        elif velocity is not None:
            row["velocity"] = velocity
        if callable(rate):
            what, given = f"the surface_spin of {part.name!r}", _with_rate(rate)
            row["spin_address"] = functions.address(_of_time(given, (2,)), (1,), (2,), what)
        else:
            row["rate"] = rate
        made.append(row)
    return MovingSurfaces(np.concatenate(made).view(Columns), np.zeros(1), np.zeros(8))
