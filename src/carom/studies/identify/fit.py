"""Parameters of a scene from recorded motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from carom import arguments, checks
from carom.options import Options
from carom.scene.scene import Scene
from carom.studies.identify.curvature import curvature
from carom.studies.identify.evaluate import Evaluator
from carom.studies.identify.parameters import Space
from carom.studies.identify.recording import Recording, checked_recordings
from carom.studies.identify.result import Identification
from carom.studies.identify.search import search
from carom.studies.identify.uncertainty import FEWEST, bootstrap

SEARCHES = 4
LEAST_GAIN = 0.02
METHODS = ("Nelder-Mead", "Powell", "COBYQA", "L-BFGS-B")


@arguments.formerly(threads="workers")
@arguments.known
def identify(
    scene: Scene | Callable[[dict, Recording], Scene],
    recordings: Sequence[Recording],
    parameters: Mapping,
    objective: Callable,
    *,
    method: str = "Nelder-Mead",
    restarts: int = 2,
    tolerance: float = 1e-3,
    max_evaluations: int = 400,
    resamples: int = 200,
    seed: int | np.random.Generator = 0,
    step: float | None = None,
    options: Options | None = None,
    workers: int | None = None,
    progress: Callable[[int, dict, float], None] | None = None,
) -> Identification:
    """Fit parameters of a scene to recorded motion.

    Each recording is simulated from its own initial state and compared over its whole length. The search
    minimises the mean of the objective over the recordings.

    Parameters
    ----------
    scene : Scene or callable
        A scene whose first N bodies are the recorded ones; `varied` copies it with the initial state of each
        recording. Or a function of (parameters, recording) that returns a scene.
    recordings : sequence of Recording
        The recorded motions.
    parameters : dict
        A `Parameter`, or (start, step), for each name. For a `Scene` the names are ``restitution``,
        ``friction``, ``friction_held``, ``inertia_factor`` and ``corner_radius`` of `varied`, and each number
        that `carom.ensemble` varies: ``"ball-table.friction"``, ``"spring.stiffness"``, ``"gravity.z"``. For a
        function they are free.
    objective : callable
        Function of (`RollOut`, `Recording`) that returns a number, such as ``mean_error(length, angle)`` or
        ``squared_error(length, angle)``.
    method : {"Nelder-Mead", "Powell", "COBYQA", "L-BFGS-B"}
        Method of `scipy.optimize.minimize`. Default ``"Nelder-Mead"``, for motion with many impacts, whose
        objective is rough. ``"L-BFGS-B"`` uses finite differences and needs a smooth objective.
    restarts : int
        Maximum number of restarts of the search from its best point. Default 2. The search ends earlier if a
        restart gains less than `tolerance`.
    tolerance : float
        The search ends when parameters change by less than this fraction of their steps, and the objective by
        less than this fraction of its first value. Default 1e-3.
    max_evaluations : int
        Maximum number of evaluations before the search stops; each evaluation simulates all recordings. Default
        400.
    resamples : int
        Number of bootstrap samples of the recordings for the uncertainty, at most 100 000; 0 for no
        uncertainty. Default 200. They need 2 p^2 + 1 more evaluations, at most six times. If one of these is
        better than the best point by 2 %, the search continues from there. Fewer than six recordings are not
        resampled: their uncertainty is that of the curvature of the sum of squares.
    seed : int or numpy.random.Generator
        Seed of the bootstrap samples. Default 0.
    step, options, workers
        As for `roll_outs`.
    progress : callable, optional
        Function that is called after each evaluation with (number, parameters, objective).

    Returns
    -------
    Identification
        The fitted parameters, their uncertainty, and the simulated motions.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid, the parameters do not give a valid scene, or the objective is not a finite
        number.
    """
    if not isinstance(scene, Scene) and not callable(scene):
        raise TypeError(
            f"scene must be a carom.Scene or a function that makes one, got {type(scene).__name__}"
        )
    recordings = checked_recordings(recordings)
    checks.function("objective", objective)
    checks.function("progress", progress, optional=True)
    checks.choice("method", method, METHODS)
    restarts = checks.integer("restarts", restarts, least=0)
    tolerance = checks.number("tolerance", tolerance, above=0.0, below=1.0)
    max_evaluations = checks.integer("max_evaluations", max_evaluations, least=1)
    resamples = checks.integer("resamples", resamples, least=0, most=100_000)
    seed = checks.seed("seed", seed)
    space = Space(parameters, scene if isinstance(scene, Scene) else None)
    settings = {"step": step, "options": options, "workers": workers}
    evaluate = Evaluator(scene, recordings, space, objective, progress, **settings)
    evaluate.scene_of(space.start, recordings[0])  # an error of the scene comes before all runs
    uncertainty = curved = None
    for _ in range(SEARCHES):
        converged, message = search(evaluate, method, restarts, tolerance, max_evaluations)
        before = evaluate.mean(evaluate.best)
        if resamples > 0:
            curved = curvature(evaluate)
            uncertainty = None if len(recordings) < FEWEST else bootstrap(evaluate, resamples, seed)
            evaluate.number((uncertainty or curved).centre)
        best = evaluate.best
        # if points around the best one are better, the search had stopped on a plateau or a rough surface
        if not converged or before - evaluate.mean(best) <= LEAST_GAIN * before:
            break
    return Identification(
        parameters=space.named(evaluate.points[best]),
        objective=evaluate.mean(best),
        objective_at_start=evaluate.mean(0),
        objectives=evaluate.values[best],
        runs=evaluate.runs(evaluate.points[best]),
        recordings=recordings,
        points=np.array(evaluate.points),
        values=np.array(evaluate.values),
        failed=np.array(evaluate.failed),
        converged=converged,
        message=message,
        uncertainty=uncertainty,
        curvature=curved,
    )
