"""The steps of a run: their ends, and the ends at which states are saved.

A step of a run is the time between two searches for islands. Within it each island moves from event to event,
and, if tolerances are given, in its own steps (`carom.dynamics.adapt`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom._compiled.decorators import inlined
from carom.geometry.frames import length
from carom.geometry.thresholds import ROUND_OFF
from carom.model.arrays import System
from carom.stepping.thresholds import FALL_OF_MANY, FALL_OF_ONE, LONGEST_PART, STEPS_BY_SPEED

if TYPE_CHECKING:
    from carom.stepping.settings import Settings

STATES = 200  # default number of saved states after the first


class Grid(NamedTuple):
    """The ends of steps: multiples of `interval`, except the last; or `ends`, if times to save were given."""

    interval: float  # length of a step, or of the longest step
    last: int  # number of steps
    save_every: int  # without `ends`: steps between saved states; the last state is always saved
    ends: np.ndarray  # (last + 1,) from 0, or (0,)
    saves: np.ndarray  # (last + 1,) 1 where the state is saved, or (0,)

    @property
    def rows(self) -> int:
        """Number of states that are saved, including the first."""
        if len(self.saves):
            return int(np.sum(self.saves))
        return -(-self.last // self.save_every) + 1


_NONE = np.zeros(0), np.zeros(0, dtype=np.int64)


def make_grid(
    duration: float, longest: float, save_every: int, save_at: float | tuple[float, ...] | None
) -> Grid:
    """Return the steps of a run: `longest` long, or at most that long if times to save at are given.

    Steps between two saved times are equal.
    """
    if isinstance(save_at, tuple):
        return _grid_of_times(np.array(save_at), duration, longest)
    interval = longest
    if save_at is not None:
        parts = count(save_at, longest)
        interval, save_every = save_at / parts, parts * save_every
    return Grid(interval, count(duration, interval), save_every, *_NONE)


def planned_grid(settings: Settings, duration: float, longest: float) -> Grid:
    """Return the steps that the arguments of a run ask for; `longest` is their step, or limits it.

    Without a step and times to save, 200 states are saved.
    """
    at, every = settings.save_at, settings.save_every
    if settings.step is not None or at is not None:
        return make_grid(duration, longest, every if settings.step is not None else 1, at)
    grid = make_grid(duration, longest, 1, duration / STATES)
    return grid._replace(save_every=grid.save_every * every)


def count(whole: float, part: float) -> int:
    """Return the number of parts of a whole, if the last part may be shorter."""
    return max(1, math.ceil(whole / part * (1.0 - ROUND_OFF)))


def _grid_of_times(times: np.ndarray, duration: float, longest: float) -> Grid:
    """Return steps that end at these times, and at the end."""
    marks = np.unique(np.concatenate([[0.0], times, [duration]]))
    parts = [count(wait, longest) for wait in np.diff(marks)]
    pieces = [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(marks, marks[1:], parts)]
    ends = np.concatenate([[0.0], *pieces])
    saves = np.zeros(len(ends), dtype=np.int64)
    saves[np.concatenate([[0], np.cumsum(parts)])] = 1
    return Grid(float(np.max(np.diff(ends))), len(ends) - 1, 0, ends, saves)


def longer_grid(grid: Grid, duration: float, end: float) -> Grid:
    """Return the steps of a run that continues from `duration` to `end`: its old steps, and similar new ones.

    If the last old step had full length and its end is saved anyway, these are the steps of one longer run.
    """
    whole = grid.last * grid.interval == duration and grid.last % max(1, grid.save_every) == 0
    if whole and not len(grid.ends):
        return grid._replace(last=count(end, grid.interval))
    ends, saves = grid.ends, grid.saves
    if not len(ends):
        steps = np.arange(grid.last + 1)
        ends = np.append(steps[:-1] * grid.interval, duration)
        saves = np.where((steps % grid.save_every == 0) | (steps == grid.last), 1, 0)
    more = np.arange(1, count(end - duration, grid.interval) + 1)
    every = max(1, grid.save_every)  # it is 0 with given times: then all new steps are saved
    ends = np.append(ends, duration + more * grid.interval)
    ends[-1] = end
    saves = np.append(saves, (more % every == 0) | (more == more[-1])).astype(np.int64)
    return Grid(grid.interval, len(ends) - 1, grid.save_every, ends, saves)


def cut_grid(grid: Grid, step: int, end: float) -> Grid:
    """Return the steps of a run that ends at this time, within a step or at its end."""
    if not len(grid.ends):
        return grid._replace(last=step)
    ends, saves = np.append(grid.ends[:step], end), np.append(grid.saves[:step], 1)
    return grid._replace(last=step, ends=ends, saves=saves)


def with_end(grid: Grid, t: float, duration: float) -> Grid:
    """Return the steps of a run that ends at `duration`, of which one ends at time t; its state is saved."""
    ends, saves = grid.ends, grid.saves
    if not len(ends):
        steps = np.arange(grid.last + 1)
        ends = np.append(steps[:-1] * grid.interval, duration)
        saves = np.where((steps % grid.save_every == 0) | (steps == grid.last), 1, 0)
    k = int(np.searchsorted(ends, t))
    near = [i for i in (k - 1, k) if 0 < i < len(ends) and abs(ends[i] - t) <= ROUND_OFF * t]
    if near:
        saves = saves.copy()
        saves[near[0]] = 1
    else:
        ends, saves = np.insert(ends, k, t), np.insert(saves, k, 1)
    return grid._replace(last=len(ends) - 1, ends=ends, saves=saves.astype(np.int64))


def step_at(grid: Grid, end: float) -> int:
    """Return the number of the step, from 1 on, in which a run reaches this time."""
    if len(grid.ends):
        return int(np.searchsorted(grid.ends, end))
    step = max(1, math.ceil(end / grid.interval))
    while step > 1 and (step - 1) * grid.interval >= end:
        step -= 1
    return min(grid.last, step if step * grid.interval >= end else step + 1)


def longest_step(
    system: System, start: np.recarray, duration: float, most: float | None, more: bool
) -> float:
    """Return the longest step of a run with tolerances: `most`, or a bound by the time until bodies may meet.

    `more` means that contacts of any of the bodies may appear later. With contacts a step is a part of the run,
    even if only its end is saved: a step with too much work is replaced by one of order 1.
    """
    if most is not None or not (system.contacts.size or more):
        return min(duration, most or duration)
    longest = LONGEST_PART * duration
    extent = system.bodies.extent
    size = float((extent if more else extent[system.contacts["body"]]).min())
    several, g = len(system.bodies) > 1, length(system.gravity)
    if g > 0.0:
        part = FALL_OF_MANY if several else FALL_OF_ONE
        return min(longest, part * math.sqrt(2.0 * size / g))
    speed = float(
        np.max(np.linalg.norm(start.v, axis=-1) + extent * np.linalg.norm(start.w, axis=-1))
    )
    if not several or speed == 0.0:
        return longest
    return min(longest, max(0.5 * size / speed, duration / STEPS_BY_SPEED))


def part_of_grid(grid: Grid, begin: float, end: float) -> Grid:
    """Return the steps from a time `begin` to a time `end`; none of their states is saved."""
    if len(grid.ends):
        inside = np.searchsorted(grid.ends, begin, "right"), np.searchsorted(grid.ends, end, "left")
        between = grid.ends[inside[0] : inside[1]]
    else:
        number = np.arange(count(begin, grid.interval), math.ceil(end / grid.interval))
        between = number * grid.interval
        between = between[(between > begin) & (between < end)]
    ends = np.concatenate([[begin], between, [end]])
    saves = np.zeros(len(ends), dtype=np.int64)
    return Grid(float(np.max(np.diff(ends))), len(ends) - 1, 0, ends, saves)


@inlined
def begin_and_length(grid, duration, step):
    """Return the time at the beginning of a step, and its length."""
    if grid.ends.shape[0] > 0:
        return grid.ends[step], grid.ends[step + 1] - grid.ends[step]
    begin = step * grid.interval
    return begin, min(grid.interval, duration - begin)


@inlined
def end_of(grid, duration, step):
    """Return the time after this number of steps, without round-off at the end of the run."""
    if grid.ends.shape[0] > 0:
        return grid.ends[step]
    return duration if step == grid.last else step * grid.interval


@inlined
def is_saved(grid, step):
    """Return whether the state after this number of steps is saved."""
    if grid.ends.shape[0] > 0:
        return grid.saves[step] == 1
    return step == grid.last or step % grid.save_every == 0
