"""Going on with a run from its file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path

from carom import arguments, checks
from carom.io.files.kept import KeptRun
from carom.results.solution import Solution
from carom.status import Status


@arguments.known
def resume(
    path: str | os.PathLike,
    *,
    duration: float | None = None,
    functions: Mapping[str, Callable] | None = None,
    save_seconds: float = 60.0,
    progress: bool | Callable[[float, float], None] | None = None,
    throw: bool = True,
) -> Solution:
    """Go on with a run that `simulate` was saving when it was interrupted, or beyond its end.

    With the same version of carom on the same machine the result is that of a run without interruption, bit
    for bit. It is saved to the same file. The state that it goes on from is taken from the file as it is: go on
    with files that are yours, or of somebody whom you trust.

    Parameters
    ----------
    path : str or path
        File of ``simulate(..., save=path)``, or of `Solution.save`.
    duration : float, optional
        Time from the start to go on to [s], beyond what the run was to reach. States are saved as often as
        before. Default: what the run was to reach; if it has, it is returned as it is.
    functions : mapping, optional
        Functions of the user's that the scene has, which the file cannot hold: ``"part.field"`` (as in
        ``"motor.force"``) to function. What they remember themselves between calls is not restored.
    save_seconds, progress, throw
        As of `simulate`.

    Returns
    -------
    Solution

    Raises
    ------
    ValueError
        If the file is not that of a run, holds no checkpoint, or one of another version of carom; if
        `duration` is not beyond that of the run; if functions of the scene are missing, or one is none of it.
    SimulationError
        If the run fails later on and `throw` is True.
    """
    from carom.io.files.keeper import Keeper
    from carom.io.run_to_end import finish
    from carom.stepping.settings import check_handling

    check_handling(progress, throw, save_seconds)

    solution = Solution.load(path, functions=functions)
    kept = solution._run
    assert isinstance(kept, KeptRun)
    if duration is not None:
        duration = checks.number(
            "duration", duration, above=solution.settings["duration"], unit="s"
        )
    elif solution.status.ended:
        return solution
    going_on = solution.status is Status.INTERRUPTED or solution.status.ended
    if not going_on or kept.checkpoint is None:
        why = (
            "it holds no checkpoint, which simulate(save=...) writes"
            if going_on
            else f"it ended by itself: {solution.message}"
        )
        raise ValueError(f"path must be a file of a run to go on with, got {str(path)!r}: {why}")
    if kept.missing:
        names = ", ".join(map(repr, kept.missing))
        raise ValueError(f"functions must be given for {names}, which the file does not hold")
    try:
        run = kept.revived(duration)
    except ValueError as error:
        raise ValueError(f"path must be a run of this carom, got {str(path)!r}: {error}") from error
    return finish(run, progress, Keeper(run, Path(path), save_seconds), throw)


def go_on(solution, duration: float, progress, throw: bool):
    """Return the solution of a run that goes on for `duration` [s] from the end of another one."""
    from carom.io.files.checkpoint import state_at_end
    from carom.io.run_to_end import finish
    from carom.stepping.settings import check_handling

    check_handling(progress, throw, 60.0)
    duration = checks.number("duration", duration, above=0.0, unit="s")
    checkpoint, kept = state_at_end(solution), solution._run
    if hasattr(kept, "history"):
        raise ValueError(
            "the solution must be one of simulate to go on; take a Run on by Run.advance"
        )
    if not solution.status.ended or checkpoint is None:
        raise ValueError(
            "the run must have come to its end to go on from there, got one of which this is said: "
            f"{solution.message}"
        )
    if not isinstance(kept, KeptRun):
        kept = KeptRun(
            kept.scene,
            solution.settings,
            kept.options,
            kept.records,
            checkpoint,
            [],
            {},
            kept.found,
        )
    if kept.missing:
        names = ", ".join(map(repr, kept.missing))
        raise ValueError(f"functions must be given to Solution.load to go on, got none for {names}")
    return finish(kept.revived(solution.settings["duration"] + duration), progress, None, throw)
