"""`carom.ensemble`: many runs of a scene with some of its values varied."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from carom import arguments, checks
from carom.io.run_to_end import reporter
from carom.options import Options
from carom.scene.scene import Scene
from carom.status import MistakeWarning
from carom.stepping.settings import (
    Settings,
    check_handling,
    check_scene,
    checked_settings,
    mistakes,
)
from carom.studies.ensembles.engines import check_engine
from carom.studies.ensembles.outcome import PENDING
from carom.studies.ensembles.result import Ensemble
from carom.studies.ensembles.sampling import draw

CHUNK = 64  # runs in a part
NEVER = 10**15  # states of a run that are saved: only the last


@arguments.known
def ensemble(
    scene: Scene | Callable[..., Scene],
    duration: float,
    *,
    step: float | str = "auto",
    vary: Mapping,
    runs: int | None = None,
    seed: int = 0,
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
    """Run a scene many times, with some values varied, and keep how each run ended.

    Results are the same, bit for bit, for any executor, number of workers and order, and those of `simulate`
    for each run by itself. A run that fails is kept with its status and message, and stops nothing.

    Parameters
    ----------
    scene : Scene, or function
        Of which values are varied; or what makes the scene of a run from them: a function that takes the
        names in `vary` as keywords and returns a `Scene`. All must have as many bodies.
    duration : float
        Of each run [s].
    step, method, rtol, atol, options
        As of `simulate`.
    vary : mapping
        For each name the values: an array whose first axis is over the runs, a SciPy distribution, a list of
        distributions and numbers (a vector), or `UniformOrientation()`. Names of a Scene: ``"gravity"``;
        ``"die.position"``, ``orientation``, ``velocity``, ``angular_velocity``, ``mass``, ``inertia`` of a
        body called die; ``"die-ground.restitution"``, ``friction``, ``friction_held``, ``rolling_friction``,
        ``pivoting_friction`` of a contact. Inertia goes with the mass unless it is varied, and
        `friction_held` with `friction` where the two were the same. Orientations may be a SciPy Rotation or
        matrices, too.
    runs : int, optional
        How many; not needed where an array says so.
    seed : int
        Of what is drawn. Default 0.
    sampling : {"random", "sobol", "halton", "latin"}
        How: independent, or evenly spread (quasi-Monte Carlo, Latin hypercube).
    observe : function, optional
        Of the `Solution` of a run; returns a dict of numbers or arrays that are kept as `Ensemble.observed`. It
        sees every step, and costs the making of a Solution. Must be importable for processes and clusters.
    executor : {"threads", "processes", "serial"}, Executor or Client
        Who does it. Default threads of this process; or a `concurrent.futures.Executor`, or a client of
        dask.distributed for many machines.
    workers : int, optional
        How many. Default: all processors, or what the cluster has.
    save : path, optional
        A folder (Zarr) that outcomes are written to as they come, so that memory stays bounded while runs go
        on. If it holds part of the same ensemble, only the rest is run.
    chunk : int
        Runs that are handed out, and written, together. Default 64.
    progress : True or function, optional
        A bar with the remaining time; or called with (runs made, runs).

    Returns
    -------
    Ensemble

    Raises
    ------
    OSError
        If `save` cannot be written, as on a full disk. What was written is kept: the same call goes on with it.
    TypeError, ValueError
        For an argument of another type or outside its range, a name that is not known, a scene that cannot
        start, or a `save` that holds another ensemble. Nothing has run then.

    Warns
    -----
    RuntimeWarning
        If it was interrupted (Ctrl-C): what was done is returned.

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
    >>> thrown.position.shape, bool(np.all(thrown.velocity == 0))  # where each came to rest
    ((8, 1, 3), True)
    """
    if not isinstance(scene, Scene) and not callable(scene):
        raise TypeError(
            f"scene must be a carom.Scene or a function that returns one, got {type(scene).__name__}"
        )
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
    check_handling(progress, True, 0.0)
    save = None if save is None else checks.path("save", save)
    chunk = checks.integer("chunk", chunk, least=1)
    if workers is not None:
        workers = checks.integer("workers", workers, least=1)
    settings = checked_settings(duration, step, method, rtol=rtol, atol=atol, options=options)
    if observe is None:  # nothing is read but the end
        settings = settings._replace(save_every=NEVER)
    inputs = draw(vary, runs, checks.integer("seed", seed, least=0), sampling)
    plan = _plan(scene, settings, inputs, observe)
    for mistake in mistakes(scene, settings):
        warnings.warn(mistake, MistakeWarning, stacklevel=3)
    count = len(next(iter(inputs.values())))
    store = _store(save, plan, inputs, chunk) if save is not None else None
    chunk = store.chunk if store is not None else chunk
    parts: list = []
    done = (
        np.zeros(count, dtype=bool) if store is None else store.read().outcomes["status"] != PENDING
    )
    report = reporter(progress, count, "run")
    try:
        _go(plan, inputs, done, chunk, executor, workers, store, parts, report)
    except KeyboardInterrupt:
        more = "; call again with the same arguments to go on" if store is not None else ""
        warnings.warn(
            f"interrupted after {int(done.sum())} of {count} runs{more}",
            RuntimeWarning,
            stacklevel=3,
        )
    finally:
        close = getattr(report, "close", None)
        if close is not None:
            close()
    if store is not None:
        whole = store.read()
        return Ensemble(inputs, whole.outcomes, whole.observed, whole.failures, store.about, plan)
    return _collect(plan, inputs, parts, count)


def _plan(scene, settings: Settings, inputs: dict[str, np.ndarray], observe):
    from carom.studies.ensembles.plan import Plan
    from carom.studies.ensembles.targets import find_targets

    if isinstance(scene, Scene):
        check_scene(scene, settings)
        return Plan(scene, settings, find_targets(scene, inputs), len(scene.bodies), observe)
    values = {name: array[0] for name, array in inputs.items()}
    plain = {name: float(v) if np.ndim(v) == 0 else v for name, v in values.items()}
    first = checks.call("scene", lambda: scene(**plain))
    checks.instance("what scene returns", first, (Scene,))
    return Plan(scene, settings, [], len(first.bodies), observe)


def _store(save, plan, inputs, chunk):
    from carom import __version__
    from carom.studies.ensembles.mark import digest
    from carom.studies.ensembles.store import Store, is_begun

    mark = digest(plan, inputs)
    if is_begun(save):
        try:
            store = Store.open(save)
        except ValueError as error:
            raise ValueError(f"save: {error}") from None
        if store.about.get("digest") != mark:
            raise ValueError(
                f"save: {save} holds another ensemble (other scene, settings or inputs); give another path, or "
                "remove it"
            )
        return store
    about = {"digest": mark, "carom": __version__, "settings": repr(plan.settings)}
    return Store.make(save, inputs, plan.bodies, chunk, about)


def _go(plan, inputs, done, chunk, executor, workers, store, parts, report) -> None:
    """Do what is left, part by part."""
    from carom.studies.ensembles.engines import each
    from carom.studies.ensembles.plan import do

    def tasks() -> Iterator[tuple]:
        for first in range(0, len(done), chunk):
            if not np.all(done[first : first + chunk]):
                yield plan, first, {k: a[first : first + chunk] for k, a in inputs.items()}

    if report is not None:
        report(int(done.sum()), len(done))
    for part in each(tasks(), do, executor, workers):
        if store is not None:
            store.write(part)
        else:
            parts.append(part)
        done[part.first : part.first + len(part.outcomes)] = True
        if report is not None:
            report(int(done.sum()), len(done))


def _collect(plan, inputs, parts, count) -> Ensemble:
    """Put the parts together, in the order of the runs."""
    from carom import __version__
    from carom.studies.ensembles.outcome import no_outcomes

    outcomes, observed, failures = no_outcomes(count, plan.bodies), {}, {}
    for part in sorted(parts, key=lambda part: part.first):
        rows = slice(part.first, part.first + len(part.outcomes))
        outcomes[rows] = part.outcomes
        failures.update(part.failures)
        for name, values in part.observed.items():
            if name not in observed:
                fill = np.nan if values.dtype.kind == "f" else 0
                observed[name] = np.full((count, *values.shape[1:]), fill, values.dtype)
            observed[name][rows] = values
    about = {"carom": __version__, "settings": repr(plan.settings)}
    return Ensemble(inputs, outcomes, observed, failures, about, plan)
