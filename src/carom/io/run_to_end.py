"""Running a simulation to its end, in parts between which progress is shown and files are saved."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING

from carom import checks
from carom.status import AccuracyWarning, Remark, SimulationError, Status

if TYPE_CHECKING:
    from carom.io.files.keeper import Keeper

CHUNKS = 100  # reports of a run
CALLER = 4  # frames up: `finish`, `simulate` or `resume`, its guard, and who called it
PATIENCE = 2.0  # seconds until a bar appears by itself
LOOKS = 4  # parts in the time between two savings, about


def finish(run, progress, keeper: Keeper | None, throw: bool):
    """Run to the end and return the solution; with `throw` a run that failed raises `SimulationError`.

    With `throw` a run that was interrupted raises `KeyboardInterrupt`, with the same attribute `solution`.
    """
    total = run.steps
    report = reporter(progress, total, "step")
    if isinstance(report, _Shown):
        from carom.results.costs import costs

        report.costs = partial(costs, run)
    late, wish = isinstance(report, _Late), None
    if keeper is not None:
        wish = keeper.interval / LOOKS
    elif late:
        wish = PATIENCE / LOOKS
    most = max(1, -(-total // CHUNKS)) if report is not None and not late else total
    status, stopped = Status.SUCCESS, KeyboardInterrupt()
    try:
        for until in goals(lambda: run.steps_done, total, most, wish):
            status = run.go_on(until)
            if report is not None:
                report(run.steps_done, total)
            if status is not Status.SUCCESS:
                break
            if keeper is not None and run.steps_done < total:
                keeper.look()
    except KeyboardInterrupt as error:
        status, stopped = Status.INTERRUPTED, error
    finally:
        close = getattr(report, "close", None)
        if close is not None:
            close()
    if status is Status.INTERRUPTED:
        run.go_back()
    if keeper is not None:
        keeper.stop()
    solution = run.solution(status)
    lost = None if keeper is None else keeper.finish(solution)
    if lost is not None:
        what = f"The run ended, but its result could not be saved: {lost}"
        if throw and solution.success:
            raise SimulationError(what, solution) from lost
        warnings.warn(what, RuntimeWarning, stacklevel=CALLER)
    if throw and status is Status.INTERRUPTED:
        raise interruption(solution.message, solution, stopped)
    if throw and not solution.success:
        raise SimulationError(solution.message, solution) from run.failure
    said = [sentence for sentence in solution.warnings if not isinstance(sentence, Remark)]
    if said and solution.success:
        warnings.warn(" ".join(said), AccuracyWarning, stacklevel=CALLER)
    return solution


def interruption(message: str, solution, error: KeyboardInterrupt) -> KeyboardInterrupt:
    """Return the error of an interruption, with what was computed until then as its `solution`."""
    error.args, error.solution = error.args or (message,), solution  # pyright: ignore[reportAttributeAccessIssue]
    return error


def goals(done, total: int, most: int, wish: float | None):
    """Yield the numbers of steps at which a run pauses, up to `total`, after parts of at most `most` steps.

    With `wish` [s] the length of parts is doubled and halved so that each takes about this time: a short run
    that is saved, or that may come to show a bar, pauses a few times only.
    """
    part = 1 if wish is not None else most
    while done() < total:
        begin = perf_counter()
        yield min(total, done() + part)
        if wish is not None:
            took = perf_counter() - begin
            part = min(most, 2 * part) if took < 0.5 * wish else part
            part = max(1, part // 2) if took > wish else part


class _Shown:
    """Progress that is shown, with what has cost time so far."""

    costs: Callable[[], str] = staticmethod(lambda: "")

    def __call__(self, done: float, total: float) -> None:
        """Show it; nothing by default."""


class _Text(_Shown):
    """Progress as plain text: one line, written over."""

    def __init__(self, unit: str):
        self.unit, self.width = unit, 0

    def __call__(self, done: float, total: float) -> None:
        more = self.costs()
        said = f"{self.unit} {done:g} of {total:g}{more and ': '}{more}".ljust(self.width)
        self.width = len(said.rstrip())
        print(f"\r{said}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        print(file=sys.stderr)


class _Bar(_Shown):
    """A tqdm bar as a progress function."""

    def __init__(self, total: float, unit: str):
        from tqdm import tqdm

        self.bar = tqdm(total=total, unit=unit)

    def __call__(self, done: float, total: float) -> None:
        self.bar.set_postfix_str(self.costs(), refresh=False)
        self.bar.update(done - self.bar.n)

    def close(self) -> None:
        self.bar.close()


def _shown(total: float, unit: str):
    try:
        return _Bar(total, unit)
    except ImportError:  # tqdm belongs to extras
        return _Text(unit)


class _Late(_Shown):
    """A bar that appears when a run has taken longer than `PATIENCE`."""

    def __init__(self, total: float, unit: str):
        self.what, self.begin, self.bar = (total, unit), perf_counter(), None

    def __call__(self, done: float, total: float) -> None:
        if self.bar is None and perf_counter() - self.begin > PATIENCE and done < total:
            self.bar = _shown(*self.what)
            self.bar.costs = self.costs
        if self.bar is not None:
            self.bar(done, total)

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()


def is_watched() -> bool:
    """Return whether somebody reads stderr as it is written: a terminal, or a notebook."""
    if getattr(sys.stderr, "closed", True):
        return False
    return sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel")


def reporter(progress, total: float, unit: str):
    """Return a function of (done, total) that shows progress, or None."""
    if progress is None and is_watched():
        return _Late(total, unit)
    if progress is None or progress is False:
        return None
    if progress is True:
        return _shown(total, unit)
    if callable(progress):
        return lambda done, total: checks.call("progress", progress, done, total)
    raise TypeError(f"progress must be True, False or a function, got {checks.shown(progress)}")
