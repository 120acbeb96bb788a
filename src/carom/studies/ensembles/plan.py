"""The plan of an ensemble, and the runs of a part of it; results are independent of worker and order."""

from __future__ import annotations

import json
import threading
import uuid
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

import carom
from carom import checks
from carom.run import Run
from carom.status import Status
from carom.stepping.settings import Settings
from carom.studies.ensembles.outcome import REFUSED, End, Layout, end_of, no_outcomes, write
from carom.studies.ensembles.varied import Varied, varied_of
from carom.watch.watched import watched


@dataclass(frozen=True)
class Plan:
    """The plan of an ensemble: what is varied, and the settings of its runs."""

    varied: Varied
    settings: Settings
    grid: dict[str, np.ndarray]  # its axes by name; empty if there is none
    observe: Callable | None
    token: str = field(default_factory=lambda: uuid.uuid4().hex)

    def one(self, inputs: dict[str, np.ndarray], run: int) -> tuple[Varied, dict[str, np.ndarray]]:
        """Return the varied scene, system or function, and the values of a single run."""
        rows = {name: array[run : run + 1] for name, array in inputs.items()}
        return varied_of(self.varied.source, self.settings, rows)


def plan_of(source, settings: Settings, inputs: dict[str, np.ndarray], grid, observe):
    """Return the plan, and the values of the runs as it takes them."""
    varied, values = varied_of(source, settings, inputs)
    return Plan(varied, settings, grid, observe), values


def facts(plan: Plan) -> dict[str, str]:
    """Return version, settings, names and grid, for `Ensemble.about`."""
    found = {"carom": carom.__version__, "settings": repr(plan.settings)}
    found |= plan.varied.layout.fact
    if plan.grid:
        found["grid"] = json.dumps({name: axis.tolist() for name, axis in plan.grid.items()})
    return found


class Part(NamedTuple):
    """Outcomes of some consecutive runs."""

    first: int
    outcomes: np.ndarray
    failures: dict[int, str]  # message of each run that failed, or was not observed
    observed: dict[str, np.ndarray]


_here = threading.local()
#: tokens of plans that were interrupted: their parts end early, with runs that are pending
STOPPED: set[str] = set()


def do(plan: Plan, first: int, values: dict[str, np.ndarray]) -> Part:
    """Make the runs with the given values; the first of them has the number `first`.

    After an interruption the remaining runs of the part are pending.
    """
    runs = len(next(iter(values.values())))
    part, ends, failures = Part(first, no_outcomes(runs, plan.varied.layout), {}, {}), {}, {}
    for k in range(runs):
        try:
            found = one(plan, values, k, part)
        except KeyboardInterrupt:
            STOPPED.add(plan.token)
            break
        except ObserveError as error:
            if first == 0 and not part.observed and error.end.status.ended:
                raise error.reason from error.reason.__cause__  # the first run that ends decides
            found, failures[k] = error.end, f"observe: {_said(error.reason)}"
        except Exception as error:  # after any error the other runs continue
            part.outcomes["status"][k], failures[k] = REFUSED, _said(error)
            continue
        ends[k] = found
    if ends:
        failures.update(write(ends, part.outcomes))
    part.failures.update({first + k: failures[k] for k in sorted(failures)})
    return part


class ObserveError(Exception):
    """An error of `observe`, the reason, after a run with this end."""

    def __init__(self, end: End, reason: Exception):
        super().__init__()
        self.end, self.reason = end, reason


def one(plan: Plan, values: dict[str, np.ndarray], k: int, part: Part) -> End:
    """Make run k of a part, and write what is observed of it."""
    if plan.token in STOPPED:
        raise KeyboardInterrupt
    run = begin(plan, values, k)
    run.to_stop = lambda: plan.token in STOPPED
    moves = watched(run)
    status = moves.go_on(moves.steps)
    if status is Status.INTERRUPTED:
        raise KeyboardInterrupt
    end = end_of(run, status)
    if plan.observe is not None:
        try:
            see(plan.observe, run.solution(status), k, part)
        except Exception as error:
            raise ObserveError(end, error) from error
    return end


def _said(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"


def see(observe: Callable, solution, k: int, part: Part) -> None:
    """Store the result of `observe` for run k of a part."""
    found = checks.call("observe", observe, solution)
    if not isinstance(found, Mapping) or not all(isinstance(name, str) for name in found):
        raise TypeError(
            "observe must return a dict of numbers or arrays by name, such as "
            f'{{"height": 0.3}}, got {checks.shown(found)}'
        )
    for name, value in found.items():
        value = np.asarray(value)
        if value.dtype.kind not in "biufc":
            raise TypeError(
                f"observe must return numbers or arrays, got {checks.shown(found[name])} for {name!r}"
            )
        old = part.observed.get(name)
        if old is None:
            old = column(len(part.outcomes), value)
        elif old.shape[1:] != value.shape:
            raise ValueError(
                f"observe must return arrays of one shape for {name!r}: {old.shape[1:]} as in an earlier run, "
                f"got {value.shape}"
            )
        part.observed[name] = old.astype(np.result_type(old, value), copy=False)
        part.observed[name][k] = value


def column(runs: int, value: np.ndarray) -> np.ndarray:
    """Return an array for a value of each run: NaN, or 0 where the value has no NaN."""
    empty = np.nan if value.dtype.kind == "f" else np.zeros((), value.dtype)
    return np.full((runs, *value.shape), empty, value.dtype)


def join(parts: Iterable[Part], runs: int, layout: Layout) -> Part:
    """Return the parts of an ensemble as one, in the order of its runs; rows of other runs are pending."""
    whole = Part(0, no_outcomes(runs, layout), {}, {})
    for part in sorted(parts, key=lambda part: part.first):
        rows = slice(part.first, part.first + len(part.outcomes))
        whole.outcomes[rows] = part.outcomes
        whole.failures.update(part.failures)
        for name, values in part.observed.items():
            old = whole.observed.get(name)
            old = column(runs, values[0]) if old is None else old
            whole.observed[name] = old.astype(np.result_type(old, values), copy=False)
            whole.observed[name][rows] = values
    return whole


def begin(plan: Plan, values: dict[str, np.ndarray], k: int) -> Run:
    """Return a run that is ready to start with the values of run k of a part."""
    if getattr(_here, "token", None) != plan.token:
        _here.starter, _here.token = plan.varied.starter(plan.settings), plan.token
    return _here.starter.start(values, k)
