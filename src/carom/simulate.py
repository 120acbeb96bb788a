"""`simulate`: compute the motion of a scene."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from typing import overload

from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.generalized.solution import GeneralizedSolution
from carom.generalized.system import GeneralizedSystem
from carom.io.run_to_end import finish
from carom.options import Options
from carom.results.solution import Solution
from carom.scene.scene import Scene
from carom.status import Advice, MistakeWarning
from carom.stepping.settings import (
    Settings,
    check_coordinates,
    check_handling,
    check_scene,
    checked_settings,
    mistakes,
)
from carom.watch.conditions import Event, conditions


@overload
def simulate(
    scene: Scene, duration: float, *, step: float | str = ..., method: str | None = ...,
    rtol: float | None = ..., atol: float | None = ..., impact_location: str = ..., save_every: int = ...,
    save_at: float | ArrayLike | None = ..., events: Event | Sequence[Event] | None = ...,
    progress: bool | Callable[[float, float], None] | None = ..., options: Options | None = ...,
    throw: bool = ..., save: str | os.PathLike | None = ..., save_seconds: float = ...,
) -> Solution: ...  # fmt: skip


@overload
def simulate(
    scene: GeneralizedSystem, duration: float, *, step: float | str = ..., method: str | None = ...,
    rtol: float | None = ..., atol: float | None = ..., impact_location: str = ..., save_every: int = ...,
    save_at: float | ArrayLike | None = ..., progress: bool | Callable[[float, float], None] | None = ...,
    options: Options | None = ..., throw: bool = ..., save: str | os.PathLike | None = ...,
    save_seconds: float = ...,
) -> GeneralizedSolution: ...  # fmt: skip


@arguments.known
def simulate(
    scene: Scene | GeneralizedSystem,
    duration: float,
    *,
    step: float | str = "auto",
    method: str | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    impact_location: str = "locate",
    save_every: int = 1,
    save_at: float | ArrayLike | None = None,
    events: Event | Sequence[Event] | None = None,
    progress: bool | Callable[[float, float], None] | None = None,
    options: Options | None = None,
    throw: bool = True,
    save: str | os.PathLike | None = None,
    save_seconds: float = 60.0,
) -> Solution | GeneralizedSolution:
    """Simulate the motion of a scene with its impacts.

    Parameters
    ----------
    scene : Scene or GeneralizedSystem
        The system to simulate. It is not changed. A `GeneralizedSystem` works only with the explicit methods
        and ``impact_location="locate"``.
    duration : float
        Time to simulate [s].
    step : float or "auto"
        ``"auto"`` (default): each step is as long as `rtol` and `atol` allow. A number h [s]: every step has
        this length, except that the last one is shorter if `duration` is not a multiple of it.
    method : {"rk4", "rk5", "rk8", "rattle", "rattle4", "rattle6", "implicit", "paper", "paper-ode"}
        Time integrator of the smooth motion. Default: ``"rk4"`` if `step` is a number; otherwise ``"rk5"``, or
        ``"rk8"`` if `rtol` is at most 1e-9 (1e-6 in scenes without contacts, stops and dry friction in joints).
        All methods except ``"rk5"`` and ``"rk8"`` need a number as `step`. ``"rk4"``: explicit, order 4;
        constraints are exact, free flight is in closed form, impacts are solved to round-off. ``"rk5"``,
        ``"rk8"``: the same with order 5 (6 stages) and order 8 (12 stages), for joints, loads and persistent
        contact at one point. ``"rattle"``, ``"rattle4"``, ``"rattle6"``: symplectic, order 2, 4 and 6, for
        joints and loads over long times: the energy has no trend, and the momenta of floating systems are
        conserved. Steps with persistent contacts or across a singular position then use ``"rk4"`` (with
        ``"rattle6"``: ``"rk8"``). ``"implicit"``: order 2 and L-stable, for springs and dampers of any
        stiffness, which are rows of the linear system. ``"paper"``: the method of the paper, with three fields
        of order 2, exact constraints, and impacts integrated through the boundary layer by cubic splines.
        ``"paper-ode"``: the same, with the paper's second-order equations for the multipliers instead of exact
        constraints.
    rtol, atol : float, optional
        Relative and absolute tolerance, for ``step="auto"``: at the end of the run the position error of each
        body should be at most about ``atol + rtol * size`` [m], where `size` is the size of the body; an error
        of an angle is multiplied by `size`. Defaults: 1e-8, and `rtol` times the size of the smallest body.
        Free flight and times of impacts are exact to round-off. Errors grow in chaotic motion.
        Time-stepping steps do not follow the tolerance. Both are in sizes of the coordinates of a
        `GeneralizedSystem`, its `scale`. (Mathematics page, §1.3; "Choose an accuracy".)
    impact_location : {"locate", "project", "work"}
        ``"locate"`` (default): the time of an impact is located inside the step (event detection); the return
        map only refines the position. ``"project"``: as in the paper, the step keeps its length and the return
        map brings the system back to the boundary. ``"work"``: as ``"project"``, and the energy that the
        return adds or removes is corrected.
    save_every : int
        Save only every `save_every`-th state: of all steps if `step` is a number, otherwise of 200 states at
        equal times. The first and the last state are always saved. Default 1.
    save_at : float or (n,), optional
        Times at which states are saved: a spacing [s], or increasing times [s] within the run. Steps end at
        these times, so the states are computed, not interpolated. The first and the last state are saved too.
        Default: every step if `step` is a number, otherwise 200 states at equal times.
    events : callable, str, or a list of these, optional
        Events to detect, as in SciPy's `solve_ivp`: functions ``f(t, state) -> float`` of the time and the
        `SystemState`. An event is a time at which the value crosses zero. A function with the attribute
        ``terminal = True`` ends the run (with a number n: at the n-th event); with the attribute ``direction``
        above 0 only rising crossings count, below 0 only falling ones. ``"at rest"`` ends the run when all
        velocities are and stay 0. ``"first impact of A and B"``, with the names of two parts, ends it right
        after that impact. Times are exact to round-off, and states are computed, not interpolated. Two
        crossings within one step are not detected (with tolerances: take a shorter `Options.max_step`), and a
        value that is 0 at the start is no event. See `Solution.t_events`, `Solution.state_events`. (How to:
        stop a run, or control it.)
    progress : bool or callable, optional
        True shows a progress bar; False shows none. By default it appears on a terminal and in a notebook after
        2 s. A function is called with (number of steps done, total number of steps).
    options : Options, optional
        Tolerances, boundary layer, and limits of the run.
    throw : bool
        True (default): a run that fails raises `SimulationError`, whose `solution` has all results up to the
        failure; Ctrl-C raises `KeyboardInterrupt` with the same attribute. False: this solution is returned,
        with its `status` and `message`.
    save : str or path, optional
        File to which the run is saved, repeatedly and at its end (needs ``carom[files]``). If the process is
        killed, the file has the results up to the last saving, and `resume` continues the run from there. If a
        saving before the end fails, for example on a full disk, a `RuntimeWarning` says so and the run
        continues.
    save_seconds : float
        Interval between two savings [s of real time]; at least ten times as long as one saving takes.
        Default 60.

    Returns
    -------
    Solution
        The motion, the impacts, and the energy balance; for a `GeneralizedSystem` a
        `generalized.solution.GeneralizedSolution`.

    Raises
    ------
    TypeError
        If `scene`, `events`, `options` or `progress` is of another type.
    ValueError
        If an argument is outside its range, a body is inside a half-space at the start, or an initial
        velocity violates a joint. The run has not started then.
    ImportError
        If `save` is given and a package that it needs is missing.
    SimulationError
        If the run fails part-way, or cannot be saved at its end, and `throw` is True.
    KeyboardInterrupt
        If the run is interrupted (Ctrl-C) and `throw` is True; its `solution` has all results up to then.

    Warns
    -----
    MistakeWarning
        If the stiffness of a force, not the motion, has limited the steps; and
        for an input that is nearly always a mistake: a free body that cannot touch anything although other
        bodies can, a contact without a stated restitution and friction, gravity that points away from the only
        half-space, a stop at an angle that is probably in degrees, a step that is longer than the run or far
        too long for the motion, and a belt whose strand pushes.
    AccuracyWarning
        If the energy changes without an explanation in the ledger, or a body penetrates another body or a
        half-space.

    Examples
    --------
    A ball that falls from h = 0.4 m strikes the floor at t = sqrt(2 h / g), to the last digit:

    >>> scene = carom.Scene(gravity=(0, 0, -9.81))
    >>> floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5))
    >>> contact = scene.add_contact(ball, floor, restitution=0.8)
    >>> solution = carom.simulate(scene, duration=0.5)
    >>> bool(abs(solution.impacts.time[0] - (2 * 0.4 / 9.81) ** 0.5) < 1e-14)
    True
    """
    if not isinstance(scene, (Scene, GeneralizedSystem)):
        meant = {
            "Model": "; give its scene, model.scene",
            "Solution": "; it goes on by solution.simulate or carom.Run(solution)",
            "Run": "; it goes on by its advance()",
        }
        raise TypeError(
            f"scene must be a carom.Scene or a carom.GeneralizedSystem, got {type(scene).__name__}"
            + meant.get(type(scene).__name__, "")
        )
    check_handling(progress, throw, save_seconds)
    settings = checked_settings(
        duration, step, method, impact_location, save_every=save_every, save_at=save_at, rtol=rtol,
        atol=atol, options=options, scene=scene,
    )  # fmt: skip
    if isinstance(scene, GeneralizedSystem):
        check_coordinates(settings)
        from carom.generalized.run import CoordinateRun as Run
        from carom.generalized.scene import CoordinateScene

        moved = CoordinateScene(scene)
    else:
        from carom.run import Run

        moved = scene
        check_scene(scene, settings)
    found = None if events is None else conditions(events, moved)
    if found is not None and save is not None:
        raise ValueError(
            "save must be left out with events, because such a run cannot be resumed, got "
            f"{checks.shown(save)}; save the solution at its end: solution.save(path)"
        )
    run, keeper = Run(moved, settings), None
    if save is not None:
        from carom.io.files.keeper import Keeper

        keeper = Keeper(run, save, save_seconds)
    if found is not None or moved.switches:
        from carom.watch.watched import watched

        run = watched(run, found)
    for mistake in mistakes(scene, settings):
        warnings.warn(mistake, MistakeWarning, stacklevel=3)
    solution = finish(run, progress, keeper, throw)
    for mistake in after(solution, settings):
        warnings.warn(mistake, MistakeWarning, stacklevel=3)
    return solution


def after(solution, settings: Settings) -> tuple[str, ...]:
    """Return sentences about belts that push, stiff forces, and a step that was far too long for the motion."""
    if isinstance(solution, Solution) and solution.scene.constraints and solution.status.ended:
        from carom.results.belts import pushing_belts

        if said := pushing_belts(solution):
            return said
    stiff = tuple(said for said in getattr(solution, "warnings", ()) if isinstance(said, Advice))
    if stiff:  # with tolerances only
        return stiff
    if settings.step is None or settings.save_every != 1 or settings.save_at is not None:
        return ()  # not each step is saved
    if settings.method == "implicit" or not isinstance(solution, Solution) or not solution.success:
        return ()
    from carom.results.accuracy import too_long

    return too_long(solution, solution._run.bodies, settings.step, settings.method)
