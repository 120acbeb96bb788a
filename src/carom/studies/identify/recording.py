"""Recorded motion: poses of bodies at given times, and the initial state of the simulation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.fields import keep
from carom.geometry import quaternion
from carom.geometry.attitude import quaternions
from carom.geometry.thresholds import UNIT_ERROR


class State(NamedTuple):
    """Poses and velocities of N bodies at one time, in world axes; arrays (3,) and (4,) for one body."""

    position: np.ndarray  #: (N, 3) mass centres [m]
    orientation: np.ndarray  #: (N, 4) unit quaternions (w, x, y, z), body to world
    velocity: np.ndarray  #: (N, 3) velocities of the mass centres [m/s]
    angular_velocity: np.ndarray  #: (N, 3) angular velocities [rad/s]


@dataclass(frozen=True, eq=False, repr=False)
class Recording:
    """The recorded motion of N bodies at n times.

    Parameters
    ----------
    t : (n,)
        Times, increasing [s]; the simulation starts at the first.
    position : (n, 3) or (n, N, 3)
        Positions of the mass centres, world [m].
    orientation : (n, 4) or (n, N, 4), optional
        Quaternions (w, x, y, z), body to world; None (default) if only positions were recorded. They are
        normalised; a length that differs from 1 by more than 1e-3 is refused. A SciPy Rotation, or matrices
        (n, 3, 3) or (n, N, 3, 3), are also allowed.
    start : State, optional
        Initial state of the simulation at ``t[0]``: recorded, or from `fit_free_flight`. Default: the initial
        state of the scene.
    name : str
        Name in messages.

    Raises
    ------
    ValueError
        If the shapes do not agree, a value is not finite, or times do not increase.
    """

    t: np.ndarray
    position: np.ndarray
    orientation: np.ndarray | None = None
    start: State | None = None
    name: str = ""

    def __post_init__(self):
        t = times(self.t)
        x = poses("position", self.position, t.size, 3)
        keep(self, t=t, position=x)
        if self.orientation is not None:
            q = poses("orientation", quaternions("orientation", self.orientation), t.size, 4)
            if x.shape[1] != q.shape[1]:
                raise ValueError(
                    f"orientation must have as many bodies as position, got {q.shape[1]} and {x.shape[1]}"
                )
            keep(self, orientation=unit("orientation", q))
        if not isinstance(self.name, str):
            raise ValueError(f"name must be a string, got {checks.shown(self.name)}")
        if self.start is not None:
            keep(self, start=checked_state(self.start, x.shape[1]))

    def __repr__(self) -> str:
        return (
            f"<Recording {self.name!r}: {self.position.shape[1]} bodies, {self.t.size} samples, "
            f"{self.t[-1] - self.t[0]:g} s>"
        )


def checked_recordings(recordings) -> list[Recording]:
    """Return a list of at least one recording; refuse anything else."""
    found = checks.listed("recordings", recordings, "Recording")
    if not found:
        raise ValueError("recordings must be at least one Recording, got none")
    for k, recording in enumerate(found):
        checks.instance(f"recordings[{k}]", recording, (Recording,))
    return found


def times(t: ArrayLike) -> np.ndarray:
    """Return checked times (n,), at least two, increasing."""
    t = checks.finite_array("t", t, (None,), "s")
    if t.size < 2:
        raise ValueError(f"t must have at least 2 times, got {t.size}")
    if not np.all(np.diff(t) > 0.0):
        k = int(np.argmax(np.diff(t) <= 0.0))
        raise ValueError(f"t must increase, got t[{k}] = {t[k]:g} and t[{k + 1}] = {t[k + 1]:g} s")
    return t


def poses(name: str, value: ArrayLike, n: int, components: int) -> np.ndarray:
    """Return `value` as a finite array (n, N, components)."""
    array = checks.real_array(name, value, f"({n}, {components}) or ({n}, N, {components})")
    shape = array.shape
    if array.ndim == 2:
        array = array[:, None, :]
    if array.ndim != 3 or array.shape[0] != n or array.shape[2] != components:
        raise ValueError(
            f"{name} must have shape ({n}, {components}) or ({n}, N, {components}), as t has {n} times, "
            f"got shape {shape}"
        )
    if not np.all(np.isfinite(array)):
        k = int(np.argmax(~np.all(np.isfinite(array), axis=(1, 2))))
        raise ValueError(f"{name} must be finite, got {array[k].tolist()} at sample {k}")
    return array


def unit(name: str, q: np.ndarray) -> np.ndarray:
    """Return recorded quaternions (..., 4), normalised; refuse an error of their length above 1e-3."""
    length = np.linalg.norm(q, axis=-1)
    if not np.all(np.abs(length - 1.0) <= UNIT_ERROR):
        k = np.unravel_index(np.argmax(np.abs(length - 1.0)), length.shape)
        raise ValueError(
            f"{name} must be unit quaternions (w, x, y, z), got {q[k].tolist()} of length {length[k]:.6g} "
            f"at sample {k[0]}"
        )
    return quaternion.normalize(q)


def checked_state(start, count: int) -> State:
    """Return `start` as a `State` of `count` bodies."""
    if not (isinstance(start, tuple) and len(start) == 4):
        raise TypeError(
            "start must be a State (position, orientation, velocity, angular_velocity), "
            f"got {type(start).__name__}"
        )
    fields = {}
    for name, value, size in zip(State._fields, start, (3, 4, 3, 3)):
        value = quaternions(f"start.{name}", value) if size == 4 else value
        array = checks.real_array(f"start.{name}", value, f"({count}, {size})")
        array = array[None] if array.ndim == 1 else array
        fields[name] = checks.finite_array(f"start.{name}", array, (count, size))
    fields["orientation"] = unit("start.orientation", fields["orientation"])
    return State(**fields)
