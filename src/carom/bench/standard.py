"""The standard set of ``carom bench``: the measured quantities and their units, with MuJoCo on request."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from carom.bench import measure
from carom.bench.measure import Spread, clock, per_step, seconds, spread
from carom.bench.problems import (
    chain,
    corner_impact,
    four_bar,
    free_step,
    planar_die,
    spatial_die,
    sphere,
    stack,
)  # fmt: skip
from carom.bench.problems.task import Task


class Side(NamedTuple):
    """Time of one tool in the unit of the problem, and its error (None without a reference)."""

    time: Spread
    error: float | None


class Problem(NamedTuple):
    """A problem of the set; `ours(rounds)` and `theirs(module, rounds)` measure it."""

    name: str
    what: str
    unit: str
    ours: Callable[[int], Side]
    theirs: Callable[[Any, int], Side] | None
    error: str = ""


class Row(NamedTuple):
    """The measurement of a problem."""

    problem: Problem
    ours: Side
    theirs: Side | None

    def as_dict(self) -> dict[str, Any]:
        """Return the row as a dict of plain values."""
        facts: dict[str, Any] = {
            "name": self.problem.name, "what": self.problem.what, "unit": self.problem.unit,
            "error_is": self.problem.error,
        }  # fmt: skip
        for name, side in (("carom", self.ours), ("mujoco", self.theirs)):
            if side is not None:
                facts[name] = {**side.time._asdict(), "error": side.error}
        return facts


def _of(module, what: str, step: float, unit: str, of: str, name: str = "", **more) -> Problem:
    """Return a problem of one of the files in `problems`, with the same step for both tools.

    Times are of its steps, if it counts them, otherwise of the whole work.
    """
    scale = {"ms": 1e3, "us": 1e6}[unit]

    def side(task: Task, rounds: int) -> Side:
        times = [scale * t / max(1, task.count) for t in task.times(rounds)]
        return Side(spread(times), task.error())

    return Problem(
        name or module.NAME, what, f"{unit} a {of}",
        lambda rounds: side(module.ours(step, **more), rounds),
        lambda peer, rounds: side(module.mujoco(peer, step, **more), rounds), module.ERROR,
    )  # fmt: skip


def _rate(of: Callable[[int], float], rounds: int) -> Spread:
    """Return the number of throws per second."""
    of(0)
    return spread([of(seed) for seed in range(rounds)])


def _throws() -> Problem:
    def ours(rounds: int) -> Side:
        rate = _rate(lambda seed: spatial_die.rate(40, seed, timer=clock, step=1e-3), rounds)
        return Side(rate, spatial_die.ours(1e-3).error())

    def theirs(module, rounds: int) -> Side:
        rate = _rate(
            lambda seed: spatial_die.mujoco_rate(module, 1e-3, 20, seed, timer=clock), rounds
        )
        return Side(rate, spatial_die.mujoco(module, 1e-3).error())

    what = "spatial die to rest (2 s), h = 1 ms, one thread"
    return Problem(spatial_die.NAME, what, "throws / s", ours, theirs, spatial_die.ERROR)


def _free_step() -> Problem:
    def side(run, rounds: int) -> Side:
        return Side(spread([1e9 * t for t in per_step(run, 1000, 101000, rounds)]), None)

    return Problem(
        free_step.NAME, "free step of a cube, far from the table", "ns a step",
        lambda rounds: side(free_step.ours(), rounds),
        lambda module, rounds: side(free_step.mujoco(module), rounds),
    )  # fmt: skip


def _corner() -> Problem:
    def ours(rounds: int) -> Side:
        times = seconds(corner_impact.ours(), rounds)
        each = [1e6 * t / corner_impact.IMPACTS_TIMED for t in times]
        return Side(spread(each), corner_impact.error())

    return Problem(
        corner_impact.NAME, "impact of a cube on a corner, mu = 0.2", "us an impact", ours, None,
        "velocity after it against -e u_n and u + W P [m/s]",
    )  # fmt: skip


def problems() -> tuple[Problem, ...]:
    """Return the standard set."""
    chains = (
        _of(chain, f"chain of {n} rods, h = 2 ms", 2e-3, "us", "step", f"chain_{n}", links=n)
        for n in (1, 10, 100)
    )
    return (
        _of(sphere, "bouncing ball, e = 1, 60 s, h = 1 ms", 1e-3, "ms", "run"),
        _of(planar_die, "planar die, 0.6 s, h = 1 ms", 1e-3, "ms", "throw"),
        _throws(), _free_step(), _corner(), *chains,
        _of(four_bar, "four-bars (A02), 10 s, h = 2.5 ms", 2.5e-3, "us", "step"),
        _of(stack, "stack of 20 boxes slides, h = 1 ms", 1e-3, "us", "step"),
    )  # fmt: skip


def run(
    wanted: list[str] | None = None, rounds: int = measure.ROUNDS, peer: Any = None,
    tell: Callable[[int, int, str], None] = lambda done, total, name: None,
) -> Iterator[Row]:  # fmt: skip
    """Measure the `wanted` problems (default: all), one by one; also with `peer`, the module of MuJoCo."""
    chosen = [p for p in problems() if not wanted or p.name in wanted]
    for k, problem in enumerate(chosen):
        tell(k, len(chosen), problem.what)
        theirs = problem.theirs(peer, rounds) if peer is not None and problem.theirs else None
        yield Row(problem, problem.ours(rounds), theirs)
