"""`carom.ensemble`: many runs of a scene with varied values."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, suppress
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from carom import arguments, checks
from carom.generalized.system import GeneralizedSystem
from carom.io.models.model import Model
from carom.io.progress import Bar, reporter
from carom.io.run_to_end import interruption
from carom.options import Options
from carom.scene.scene import Scene
from carom.status import MistakeWarning
from carom.stepping.settings import (
    check_handling,
    checked_settings,
    mistakes,
)
from carom.studies.ensembles.engines import check_engine, check_processes
from carom.studies.ensembles.outcome import PENDING
from carom.studies.ensembles.result import Ensemble
from carom.studies.ensembles.sampling import as_mapping, draw, on_grid

if TYPE_CHECKING:
    import pandas as pd

CHUNK = 64  # default number of runs in a part
NEVER = 10**15  # `save_every` of runs that save only the first and the last state


@arguments.known
def ensemble(
    scene: Scene | Model | GeneralizedSystem | Callable[..., Scene | GeneralizedSystem],
    duration: float,
    *,
    step: float | str = "auto",
    vary: Mapping | pd.DataFrame,
    runs: int | None = None,
    seed: int | np.random.Generator = 0,
    sampling: str = "random",
    method: str | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    options: Options | None = None,
    observe: Callable | None = None,
    executor="threads",
    workers: int | None = None,
    save=None,
    chunk: int = CHUNK,
    progress=None,
) -> Ensemble:
    """Run a scene many times with varied values, and collect the state at the end of each run.

    The results do not depend on the executor, the number of workers and the order of the runs: they are bit for
    bit those of `simulate` for each run. A run that fails is stored with its status and message, and the other
    runs continue.

    Parameters
    ----------
    scene : Scene, models.Model, GeneralizedSystem, or function
        A scene, or that of a model, or a system in coordinates, whose values are varied; or a function that
        takes the names in `vary` as keyword arguments and returns the `Scene` or `GeneralizedSystem` of a run.
        All must have the same number of bodies or coordinates.
    duration : float
        Duration of each run [s].
    step, method, rtol, atol, options
        As for `simulate`.
    vary : mapping or pandas.DataFrame
        The values for each name: an array whose first axis is over the runs, a SciPy distribution, a `Grid`, a
        list of distributions, grids and numbers (for a vector), or `UniformOrientation()`; or a table with a
        column for each name and a row for each run. If `scene` is a Scene, a name is that of a part and of one
        of its numbers or words: ``"die.position"``, ``orientation``, ``velocity``, ``angular_velocity``,
        ``mass``, ``inertia`` of a body with the name "die", and the sizes of its shape (``"die.radius"``);
        ``"die-ground.restitution"``, ``friction``, ``impact_law`` ... of a contact; the arguments of a joint
        (``"hinge.anchor"``), of a force (``"spring.stiffness"``), of a motor (``"motor.rate"``), of a stop
        (``"stop.upper"``), of a half-space or a static body. Also ``"gravity"``; one component
        (``"die.velocity.x"``, ``"gravity.z"``); and ``"restitution"``, ``"friction"``, ... of all contacts.
        What is computed from other values by default follows them, unless it is varied itself: inertia the mass
        and the shape, whose mass stays; `friction_held` the friction; `rest_length` the ends of a spring.
        Orientations may also be a SciPy Rotation or matrices.
        Of a model of `load_model` also ``"qpos"`` (runs, nq), ``"qvel"`` (runs, nv) and ``"ctrl"`` (runs, nu),
        as in MuJoCo, and ``"elbow.coordinate"`` and ``"elbow.rate"`` of a hinge or slide with the name "elbow".
        Of a system in coordinates ``"position"`` and ``"velocity"`` (runs, n), or one of them by its name,
        ``"position.theta"`` (`GeneralizedSystem.coordinate_names`), and ``"wall.friction"``, ``restitution``,
        ... of its contacts.
    runs : int, optional
        Number of runs; not needed if `vary` has an array or a grid. A grid has all combinations of its values.
    seed : int or numpy.random.Generator
        Seed of the random numbers, or a generator, which goes on from its state. Default 0.
    sampling : {"random", "sobol", "halton", "latin"}
        Independent random numbers (``"random"``, default), or evenly spread ones (quasi-Monte Carlo or Latin
        hypercube).
    observe : function, optional
        Function that is called with the `Solution` of each run, which has every step, and returns a dict of
        numbers or arrays; these are collected in `Ensemble.observed`. It makes each run slower, because a
        Solution has to be made. For processes and clusters the function must be importable. If it fails in the
        first run that reaches its end, its error is raised; errors in later runs are in `Ensemble.failures`.
    executor : {"threads", "processes", "serial"}, Executor or Client
        Executor of the runs: threads of this process (default), processes, or one run after another; or a
        `concurrent.futures.Executor`, or a client of dask.distributed for many machines.
    workers : int, optional
        Number of workers. Default: all processors, or all workers of the cluster.
    save : path, optional
        A folder (Zarr) to which outcomes are written during the run, so that the needed memory is bounded. If
        it has a part of the same ensemble already, only the other runs are made.
    chunk : int
        Number of runs that a worker makes, and that are written, together. Default 64.
    progress : True or function, optional
        True shows a progress bar with the remaining time. A function is called with (number of runs made,
        number of all runs).

    Returns
    -------
    Ensemble
        The values and the outcome of each run.

    Raises
    ------
    OSError
        If `save` cannot be written, for example on a full disk. All that was written stays valid: repeat the
        same call to continue.
    TypeError, ValueError
        If an argument has a wrong type or is outside its range, a name is unknown, a scene cannot start, or
        `save` has another ensemble. No run has started then.
    KeyboardInterrupt
        If the call is interrupted (Ctrl-C); its `solution` is the `Ensemble` of the runs that were made.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> scene = carom.Scene(gravity=(0, 0, -9.81))
    >>> ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    >>> die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.1), name="die")
    >>> contact = scene.add_contact(die, ground, restitution=0.5, friction=0.2)
    >>> thrown = carom.ensemble(scene, 2.0, step=2e-3, runs=8, vary={
    ...     "die.orientation": carom.UniformOrientation(), "die-ground.friction": uniform(0.1, 0.3)})
    >>> thrown
    <Ensemble of 8 runs: 8 success>
    >>> thrown.position.shape, bool(np.all(thrown.velocity == 0))  # each die is at rest
    ((8, 1, 3), True)
    """
    scene = scene.scene if isinstance(scene, Model) else scene
    if not isinstance(scene, (Scene, GeneralizedSystem)) and not callable(scene):
        raise TypeError(
            "scene must be a carom.Scene, a Model, a GeneralizedSystem or a function that returns one, got "
            f"{type(scene).__name__}"
        )
    vary = as_mapping(vary)
    if not isinstance(vary, Mapping) or not vary:
        raise ValueError(
            f"vary must have at least one name and its values, got {checks.shown(vary)}"
        )
    for name in vary:
        if not isinstance(name, str):
            raise ValueError(f"vary must have names as its keys, got {checks.shown(name)}")
    if observe is not None and not callable(observe):
        raise TypeError(f"observe must be a function of a Solution, got {checks.shown(observe)}")
    check_engine(executor)
    check_processes(executor, scene=scene, observe=observe)
    check_handling(progress, True, 0.0)
    if save is not None:
        save = checks.path("save", save)
        from carom.studies.ensembles.files import check_folder

        check_folder(save)
    chunk = checks.integer("chunk", chunk, least=1)
    if workers is not None:
        workers = checks.integer("workers", workers, least=1)
    settings = checked_settings(
        duration, step, method, rtol=rtol, atol=atol, options=options, scene=scene
    )
    if observe is None:  # only the end is read
        settings = settings._replace(save_every=NEVER)
    from carom.studies.ensembles.plan import facts, join, plan_of

    vary, grid, runs = on_grid(vary, runs)
    inputs = draw(vary, runs, checks.seed("seed", seed), sampling)
    plan, values = plan_of(scene, settings, inputs, grid, observe)
    for mistake in mistakes(scene, settings):
        warnings.warn(mistake, MistakeWarning, stacklevel=3)
    count = len(next(iter(inputs.values())))
    store = _store(save, plan, inputs, chunk) if save is not None else None
    chunk = store.chunk if store is not None else chunk
    parts: list = []
    done = (
        np.zeros(count, dtype=bool) if store is None else store.read().outcomes["status"] != PENDING
    )
    report = reporter(progress, "runs")
    stopped = None
    try:
        _go(plan, values, done, chunk, executor, workers, store, parts, report)
    except KeyboardInterrupt as error:
        stopped = error
    finally:
        if isinstance(report, Bar):
            report.close()
    if store is not None:
        whole, about = store.read(), store.about
    else:
        whole, about = join(parts, count, plan.varied.layout), facts(plan)
    found = Ensemble(inputs, whole.outcomes, whole.observed, whole.failures, about, plan)
    if stopped is not None:
        more = "; call again with the same arguments to continue" if store is not None else ""
        message = f"interrupted after {int(found.done.sum())} of {count} runs{more}"
        raise interruption(message, found, stopped)
    return found


def _store(save, plan, inputs, chunk):
    from carom.studies.ensembles.mark import digest
    from carom.studies.ensembles.plan import facts
    from carom.studies.ensembles.store import Store, is_begun

    mark = digest(plan, inputs)
    if is_begun(save):
        try:
            store = Store.open(save)
        except ValueError as error:
            raise ValueError(f"save: {error}") from None
        if store.about.get("digest") != mark:
            raise ValueError(
                f"save: {save} has another ensemble (other scene, settings or inputs); give another path, or "
                "remove it"
            )
        return store
    return Store.make(save, inputs, plan.varied.layout, chunk, {"digest": mark, **facts(plan)})


def _go(plan, values, done, chunk, executor, workers, store, parts, report) -> None:
    """Make the remaining runs, part by part."""
    from carom.studies.ensembles.engines import each
    from carom.studies.ensembles.plan import STOPPED, do

    def tasks() -> Iterator[tuple]:
        for first in range(0, len(done), chunk):
            if not np.all(done[first : first + chunk]):
                yield plan, first, {k: a[first : first + chunk] for k, a in values.items()}

    def take(part) -> None:
        if store is not None:
            store.write(part)
        else:
            parts.append(part)
        made = part.outcomes["status"] != PENDING
        done[part.first : part.first + len(made)] = made
        if not np.all(made):
            raise KeyboardInterrupt

    if report is not None:
        report(int(done.sum()), len(done))
    late: list = []
    stop = partial(STOPPED.add, plan.token)
    try:
        with closing(each(tasks(), do, executor, workers, stop, late)) as found:
            for part in found:
                take(part)
                if report is not None:
                    report(int(done.sum()), len(done))
    finally:
        for part in late:
            with suppress(KeyboardInterrupt):
                take(part)
