"""`resume`: continue a run from its file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from carom import arguments, checks
from carom.generalized.solution import GeneralizedSolution
from carom.generalized.system import GeneralizedSystem
from carom.io.files.kept import KeptRun
from carom.results.solution import Solution
from carom.status import Status
from carom.stepping.thresholds import MOST_STEPS


@arguments.formerly(duration="until")
@arguments.known
def resume(
    path: str | os.PathLike,
    *,
    until: float | None = None,
    functions: Mapping[str, Callable] | None = None,
    system: GeneralizedSystem | None = None,
    save_seconds: float = 60.0,
    progress: bool | Callable[[float, float], None] | None = None,
    throw: bool = True,
) -> Any:
    """Continue a run from its file: an interrupted run to its end, or a finished run beyond its end.

    With the same version of carom on the same machine, the result is bit for bit that of a run without
    interruption. It is saved to the same file. The state of the run in the file is used without checks, so
    continue only files that are your own or come from somebody whom you trust.

    Parameters
    ----------
    path : str or path
        File of ``simulate(..., save=path)`` or of `Solution.save`.
    until : float, optional
        Time at which the run ends, counted from its start [s], later than its last state in the file;
        `Solution.simulate` takes the duration after its end instead. States are saved as often as before.
        Default: the end that the run was to have; a run that has reached it is returned unchanged.
    functions : mapping, optional
        User-defined functions of the scene, which the file cannot contain: ``"part.field"`` (for example
        ``"motor.force"``) to function. Data that a function itself stores between calls are not restored.
    system : GeneralizedSystem, optional
        The system of the run, as it was at its start, for the file of a system in coordinates.
    save_seconds, progress, throw
        As for `simulate`.

    Returns
    -------
    Solution or GeneralizedSolution
        Solution for the whole time, from the start.

    Raises
    ------
    ValueError
        If the file is not a file of a run, or has no checkpoint of this version of carom; if `until` is not
        later than the end of the run; if functions of the scene are missing, or the scene does not have a given
        function.
    SimulationError
        If the run fails and `throw` is True.
    """
    from carom.io.files.keeper import Keeper
    from carom.io.run_to_end import finish
    from carom.stepping.settings import check_handling
    from carom.watch.watched import watched

    check_handling(progress, throw, save_seconds)

    if system is None:
        solution = Solution.load(path, functions=functions)
    else:
        solution = GeneralizedSolution.load(path, system)
    kept = solution._run
    assert isinstance(kept, KeptRun)
    if until is not None:
        refuse_steps(kept)
        most = longest(solution.settings)
        # an interrupted run has not reached the end that it was to have
        on_the_way = solution.status is Status.INTERRUPTED
        least = float(solution.t[-1]) if on_the_way else solution.settings["duration"]
        until = checks.number("until", until, above=least, most=most, unit="s")
    elif solution.status.ended:
        return solution
    can_continue = solution.status is Status.INTERRUPTED or solution.status.ended
    if not can_continue or kept.checkpoint is None:
        why = (
            "it has no checkpoint, which simulate(save=...) writes"
            if can_continue
            else f"it ended by itself: {solution.message}"
        )
        raise ValueError(
            f"path must be a file of a run that can continue, got {str(path)!r}: {why}"
        )
    kept.need_functions("which the file does not have")
    try:
        run = kept.revived(until)
    except ValueError as error:
        raise ValueError(
            f"path must be a run of this version of carom, got {str(path)!r}: {error}"
        ) from error
    now = float(run.clock["now"][0])
    if until is not None and not until > now:  # the last state is not always a saved one
        raise ValueError(f"until must be above {now:.17g} s, where the run stands, got {until!r}")
    return finish(watched(run), progress, Keeper(run, Path(path), save_seconds), throw)


def go_on(solution, duration: float, progress, throw: bool):
    """Return the solution of a run that continues another one from its end for `duration` [s]."""
    from carom.io.files.checkpoint import state_at_end
    from carom.io.run_to_end import finish
    from carom.stepping.settings import check_handling
    from carom.watch.watched import watched

    check_handling(progress, throw, 60.0)
    before, most = solution.settings["duration"], longest(solution.settings)
    duration = checks.number("duration", duration, above=0.0, most=most, unit="s")
    if not before < before + duration <= most:
        raise ValueError(
            f"duration must be between round-off of the time reached, {before:g} s, and "
            f"{most - before:g} s, got {duration:g} s"
        )
    checkpoint, kept = state_at_end(solution), solution._run
    refuse_steps(kept)
    if not solution.status.ended or checkpoint is None:
        raise ValueError(
            "the run must have reached its end to continue from there, got a run with the message: "
            f"{solution.message}"
        )
    if not isinstance(kept, KeptRun):
        given = kept.scene, solution.settings, kept.options, kept.records, checkpoint
        kept = KeptRun(*given, missing=[], attributes={}, found=kept.found, switched=kept.switched)
    kept.need_functions("by Solution.load to continue")
    return finish(watched(kept.revived(before + duration)), progress, None, throw)


def longest(settings: Mapping) -> float:
    """Return the greatest duration of a run with these settings, whose steps still have numbers [s]."""
    step = settings["step"] if isinstance(settings["step"], float) else settings["duration"]
    return MOST_STEPS * step


def refuse_steps(kept) -> None:
    """Refuse the solution of a `carom.Run`, whose steps and forces are those that its user asks for."""
    if getattr(kept, "history", None) is not None:
        raise ValueError(
            "the solution must be one of simulate, got that of a Run: take it on with carom.Run(solution)"
        )
