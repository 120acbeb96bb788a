"""The main job: from a scene to its motion."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from typing import overload

from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.control.conditions import Event, conditions
from carom.dynamics.methods import EXPLICIT
from carom.generalized.solution import GeneralizedSolution
from carom.generalized.system import GeneralizedSystem
from carom.io.run_to_end import finish
from carom.options import Options
from carom.results.coarse import too_long
from carom.results.solution import Solution
from carom.scene.scene import Scene
from carom.status import MistakeWarning
from carom.stepping.settings import (
    LOCATIONS,
    Settings,
    check_handling,
    check_scene,
    checked_settings,
    mistakes,
)


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
        What moves. It is not changed. A system in coordinates takes the explicit methods, and "locate".
    duration : float
        Time to simulate [s].
    step : float or "auto"
        ``"auto"`` (default): steps as long as `rtol` and `atol` allow. A number h [s]: steps of this length,
        the last one shorter where `duration` is not a multiple of it. A system in coordinates needs a number.
    method : {"rk4", "rk5", "rk8", "rattle", "rattle4", "rattle6", "implicit", "paper", "paper-ode"}
        How free motion is stepped. Default: with tolerances ``"rk5"``, or ``"rk8"`` from ``rtol=1e-9`` on; with
        a given step ``"rk4"``. The methods other than ``"rk5"`` and ``"rk8"`` need a given step. ``"rk4"``:
        explicit, order 4, constraints exact, free flight in closed form, impacts solved to round-off.
        ``"rk5"``, ``"rk8"``: the same with order 5 (6 stages) and 8 (12 stages), for joints, loads and contact
        held at one point. ``"rattle"``, ``"rattle4"``, ``"rattle6"``: symplectic, of order 2, 4 and 6, for
        joints and loads over long times: no trend in energy, momenta of floating systems kept; persistent
        contacts go by ``"rk4"`` (``"rattle6"``:
        ``"rk8"``), and so do steps across a singular position. ``"implicit"``: of order 2 and L-stable for
        springs and dampers of any stiffness, which are rows of the solve. ``"paper"``: the paper's chain,
        three fields of order 2 with exact constraints, impacts through the boundary layer by
        cubic splines. ``"paper-ode"``: the same with the paper's second-order equations of the multipliers
        instead of exact constraints.
    rtol, atol : float, optional
        How exact the motion is to be, for steps that are not given: in the end no body should miss its place by
        more than about ``atol + rtol * size`` [m]. `size` is the body's; errors of angles count at that
        distance. Defaults: 1e-8, and `rtol` times the size of the smallest body. What flies freely, and times
        of impacts, are exact to round-off. Errors grow in chaotic motion; contact of several or of joined
        bodies at several points is of order 2. (Mathematics page, §1.3; page "Choose an accuracy".)
    impact_location : {"locate", "project", "work"}
        ``"locate"`` (default): the time of an impact is found inside the step, the return map is its last
        polish. ``"project"``: the paper literally, the step is kept and the return map brings the system back
        to the boundary. ``"work"``: as ``"project"``, with the energy of the return made good.
    save_every : int
        Save each `save_every`-th state only, of those that are saved without it: of all steps where the step is
        given, else of 200. The first and the last are always saved. Default 1.
    save_at : float or (n,), optional
        Which states are saved: a spacing [s], or rising times [s] within the run. Steps end there, so that the
        states are those of the motion, not of a curve through others. The first and the last are saved too.
        Default: 200 states at equal times; each step where the step is given.
    events : callable, str, or a list of these, optional
        What to look for, as in SciPy's `solve_ivp`: functions ``f(t, state) -> float`` of the time and the
        `SystemState`, whose zeros are found wherever the sign differs from that of the step before. One with
        the attribute ``terminal = True`` ends the run (a number n: the n-th time); with ``direction`` above 0
        only rises count, below 0 only falls. ``"at rest"`` ends the run when nothing moves any more: from then
        on all velocities are 0. ``"first impact of A and B"``, two parts by their names, ends it right after
        that impact. Times are exact to round-off, and states are those of the motion. What comes and goes
        within a step is not seen (with tolerances: take a shorter `Options.max_step`); what is 0 at the start
        has not happened. See `Solution.t_events`, `Solution.state_events`. (How to: stop a run, or control it.)
    progress : bool or callable, optional
        True shows a progress bar (of tqdm, or plain text without it); a function is called with (steps done,
        steps in all).
    options : Options, optional
        Tolerances, boundary layer, limits.
    throw : bool
        True (default): a run that fails raises `SimulationError`, whose `solution` holds all up to
        there. False: the solution is returned, with its `status` and `message`.
    save : str or path, optional
        File that the run is saved to at its end and as it goes (needs ``carom[files]``): whoever kills the run
        finds in it what was computed until then, and where `resume` goes on. Where that fails on the way, as on
        a full disk, a `RuntimeWarning` says so and the run goes on. Not for a system in coordinates.
    save_seconds : float
        How often it is saved [s of real time]. Default 60; at least ten times what one saving takes.

    Returns
    -------
    Solution
        Of a `GeneralizedSystem` a `generalized.solution.GeneralizedSolution`.

    Raises
    ------
    TypeError
        If `scene`, `events`, `options` or `progress` is of another type.
    ValueError
        For an argument outside its range, a body inside a half-space at the start, or an initial
        velocity that breaks a joint. Nothing has run then.
    ImportError
        For `save` without its packages.
    SimulationError
        If the run fails part-way, or cannot be saved at its end, and `throw` is True.

    Warns
    -----
    MistakeWarning
        Of what is nearly always a mistake: a free body that nothing can touch where others touch something, a
        contact of which neither restitution nor friction is stated, a step longer than the run or far too long
        for the motion.
    AccuracyWarning
        Where energy comes or goes without a name, or a body gets into what it touches.

    Examples
    --------
    A ball that falls 0.4 m strikes after sqrt(2 h / g), to the last digit:

    >>> scene = carom.Scene(gravity=(0, 0, -9.81))
    >>> floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5))
    >>> contact = scene.add_contact(ball, floor, restitution=0.8)
    >>> solution = carom.simulate(scene, duration=0.5)
    >>> bool(abs(solution.impacts.time[0] - (2 * 0.4 / 9.81) ** 0.5) < 1e-14)
    True
    """
    if not isinstance(scene, (Scene, GeneralizedSystem)):
        raise TypeError(
            f"scene must be a carom.Scene or a carom.GeneralizedSystem, got {type(scene).__name__}"
        )
    check_handling(progress, throw, save_seconds)
    settings = checked_settings(
        duration, step, method, impact_location, save_every=save_every, save_at=save_at, rtol=rtol,
        atol=atol, options=options,
    )  # fmt: skip
    if isinstance(scene, GeneralizedSystem):
        if settings.adapts:
            raise ValueError('step of a system in coordinates must be a number [s], got "auto"')
        if save is not None:
            raise ValueError(
                f"save must be left out with a system in coordinates, got {checks.shown(save)}"
            )
        checks.choice("method of a system in coordinates", settings.method, EXPLICIT)
        checks.choice("impact_location of a system in coordinates", impact_location, LOCATIONS[:1])
        if events is not None:
            raise ValueError(
                f"events must be left out with a system in coordinates, got {checks.shown(events)}"
            )

        from carom.generalized.run import GeneralizedRun

        run = GeneralizedRun(scene, settings)
    else:
        check_scene(scene, settings)
        found = None if events is None else conditions(events, scene)
        if found is not None and save is not None:
            raise ValueError(
                f"save must be left out with events, which no file holds, got {checks.shown(save)}; save the "
                "solution: solution.save(path)"
            )

        from carom.run import Run

        run = Run(scene, settings)
        if found is not None:
            from carom.control.watched import Watched

            run = Watched(run, found)
    keeper = None
    if save is not None:
        from carom.io.files.keeper import Keeper

        keeper = Keeper(run, save, save_seconds)
    for mistake in mistakes(scene, settings):
        warnings.warn(mistake, MistakeWarning, stacklevel=3)
    solution = finish(run, progress, keeper, throw)
    for mistake in after(solution, settings):
        warnings.warn(mistake, MistakeWarning, stacklevel=3)
    return solution


def after(solution, settings: Settings) -> tuple[str, ...]:
    """Return a sentence about a step that was far too long for the motion, if it was."""
    if settings.step is None or settings.save_every != 1 or settings.save_at is not None:
        return ()  # not each step is saved
    if settings.method == "implicit" or not isinstance(solution, Solution) or not solution.success:
        return ()
    return too_long(solution, solution._run.bodies, settings.step, settings.method)
