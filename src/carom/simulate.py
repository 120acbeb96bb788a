"""The main job: from a scene to its motion."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom import check
from carom.options import Options
from carom.scene.limits import check_location
from carom.scene.scene import Scene
from carom.solution import Solution
from carom.status import SimulationError, Status

METHODS = ("rk4", "rk5", "rk8", "rattle", "rattle4", "rattle6", "paper", "paper-ode")
LOCATIONS = ("locate", "project", "work")
CHUNKS = 100  # calls of the compiled loop in one run, for progress and for Ctrl-C


def simulate(
    scene: Scene,
    duration: float,
    *,
    step: float,
    method: str = "rk4",
    impact_location: str = "locate",
    save_every: int = 1,
    progress: bool | Callable[[int, int], None] | None = None,
    options: Options | None = None,
    throw: bool = True,
) -> Solution:
    """Simulate the motion of a scene with its impacts.

    Parameters
    ----------
    scene : Scene
        What moves. It is not changed.
    duration : float
        Time to simulate [s].
    step : float
        Time step h [s]. The last step is shorter where `duration` is not a multiple of it.
    method : {"rk4", "rk5", "rk8", "paper", "paper-ode"}
        How free motion is stepped. ``"rk4"`` (default): explicit, order 4, constraints exact, free bodies
        exact in energy and momentum, impacts solved to round-off. ``"rk5"``, ``"rk8"``: the same with order
        5 (6 stages) and 8 (12 stages), for joints, loads and contact held at one point; bodies of unequal
        moments fly with order 4 all the same. ``"paper"``: the paper's chain,
        three fields of order 2 with exact constraints, impacts through the boundary layer by
        cubic splines. ``"paper-ode"``: the same with the paper's second-order equations of the multipliers
        instead of exact constraints.
    impact_location : {"locate", "project", "work"}
        ``"locate"`` (default): the time of an impact is found inside the step, the return map is its last
        polish. ``"project"``: the paper literally, the step is kept and the return map brings the system back
        to the boundary. ``"work"``: as ``"project"``, with the energy of the return made good.
    save_every : int
        Save each `save_every`-th step (the first and the last always). Default 1.
    progress : bool or callable, optional
        True shows a progress bar (needs tqdm); a function is called with (steps done, steps in all).
    options : Options, optional
        Tolerances, boundary layer, limits.
    throw : bool
        True (default): a run that fails raises `SimulationError`, whose `solution` holds all up to
        there. False: the solution is returned, with its `status` and `message`.

    Returns
    -------
    Solution

    Raises
    ------
    TypeError
        If `scene`, `options` or `progress` is of another type.
    ValueError
        For an argument outside its range, a body inside a half-space at the start, or an initial
        velocity that breaks a joint. Nothing has run then.
    SimulationError
        If the run fails part-way and `throw` is True.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene must be a carom.Scene, got {type(scene).__name__}")
    duration = check.number("duration", duration, above=0.0, unit="s")
    step = check.number("step", step, above=0.0, unit="s")
    check.choice("method", method, METHODS)
    check.choice("impact_location", impact_location, LOCATIONS)
    check.integer("save_every", save_every, least=1)
    if not isinstance(throw, bool):
        raise TypeError(f"throw must be True or False, got {throw!r}")
    options = Options() if options is None else options
    if not isinstance(options, Options):
        raise TypeError(f"options must be carom.Options, got {type(options).__name__}")
    if not duration / step < 1e12:
        raise ValueError(
            f"step must be above duration / 1e12 = {duration / 1e12:g} s, got {step!r}"
        )
    scene.validate()
    check_location(scene, impact_location)

    from carom.run import Run

    steps = max(1, int(np.ceil(duration / step * (1.0 - 1e-12))))
    run = Run(scene, duration, step, steps, method, impact_location, save_every, options)
    status = Status.SUCCESS
    report = _reporter(progress, steps)
    chunk = max(1, -(-steps // CHUNKS)) if report is not None else steps
    try:
        for until in (*range(chunk, steps, chunk), steps):
            status = run.go_on(until)
            if report is not None:
                report(int(run.steps_done), steps)
            if status is not Status.SUCCESS:
                break
    except KeyboardInterrupt:
        status = Status.INTERRUPTED
    finally:
        close = getattr(report, "close", None)
        if close is not None:
            close()
    solution = run.solution(status)
    if throw and not solution.success:
        raise SimulationError(solution.message, solution)
    return solution


class _Bar:
    """A tqdm bar as a progress function."""

    def __init__(self, total: int):
        from tqdm import tqdm

        self.bar = tqdm(total=total, unit="step")

    def __call__(self, done: int, total: int) -> None:
        self.bar.update(done - self.bar.n)

    def close(self) -> None:
        self.bar.close()


def _reporter(progress, steps: int):
    if progress is None or progress is False:
        return None
    if progress is True:
        return _Bar(steps)
    if callable(progress):
        return progress
    raise TypeError(f"progress must be True, False or a function, got {progress!r}")
