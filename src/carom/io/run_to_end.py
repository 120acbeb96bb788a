"""Running a simulation to its end, in parts between which progress is shown and files are saved."""

from __future__ import annotations

import warnings
from time import perf_counter
from typing import TYPE_CHECKING

from carom.io.progress import PATIENCE, Bar, reporter
from carom.status import AccuracyWarning, Remark, SimulationError, Status

if TYPE_CHECKING:
    from carom.io.files.keeper import Keeper

CHUNKS = 100  # reports of a run
CALLER = 4  # frames up: `finish`, `simulate` or `resume`, its guard, and who called it
LOOKS = 4  # parts in the time between two savings, about


def finish(run, progress, keeper: Keeper | None, throw: bool):
    """Run to the end and return the solution; with `throw` a run that failed raises `SimulationError`.

    With `throw` a run that was interrupted raises `KeyboardInterrupt`, with the same attribute `solution`.
    """
    total = run.steps
    report, late, wish = reporter(progress, "steps"), False, None
    if isinstance(report, Bar):
        report.costs, late = run.costs, report.patience > 0.0
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
        if isinstance(report, Bar):
            report.close()
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
