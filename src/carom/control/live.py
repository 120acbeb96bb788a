"""A run that users take on themselves, step by step, and its solution at any time: copies of its records."""

from __future__ import annotations

import warnings
from dataclasses import replace

from numpy.typing import ArrayLike

from carom import arguments
from carom.control.applied import Applied, rows_of_forces, values_of_forces
from carom.control.endless import BLOCK, Endless
from carom.dynamics.methods import METHODS
from carom.io.files.kept import KeptRun
from carom.model import records as r
from carom.model.method import IMPLICIT
from carom.options import Options
from carom.results.solution import Solution
from carom.results.state import SystemState
from carom.scene.forces import AppliedForce
from carom.scene.scene import Scene
from carom.status import MistakeWarning, SimulationError, Status
from carom.stepping.settings import check_scene, checked_settings, mistakes


@arguments.attributes()
@arguments.known
class Run:
    """A motion that you take on step by step, in a loop of your own.

    Parameters
    ----------
    scene : Scene
        What moves. It is not changed.
    step, method, rtol, atol, options
        As of `simulate`.
    save_every : int
        Save each `save_every`-th state only: of all steps where the step is given, else of the ends of
        `advance`. Default 1.

    Raises
    ------
    TypeError, ValueError
        As of `simulate`.

    Examples
    --------
    A cart of 2 kg that a controller (gains 8 N/m and 6 N s/m) brings to x = 1 m:

    >>> scene = carom.Scene(gravity=(0, 0, 0))
    >>> cart = scene.add_body(carom.Box(0.4, 0.2, 0.1), mass=2.0, name="cart")
    >>> motor = scene.add_force(carom.forces.Force((0, 0, 0)), cart, name="motor")
    >>> run = carom.Run(scene, step=0.01)
    >>> while run.time < 10.0:
    ...     cart = run.state["cart"]
    ...     run.set_force("motor", (8 * (1 - cart.position[0]) - 6 * cart.velocity[0], 0, 0))
    ...     run.advance()
    >>> print(run.state["cart"].position.round(6) + 0.0)
    [1. 0. 0.]
    >>> run.solution.position.shape
    (1001, 1, 3)
    """

    def __init__(
        self,
        scene: Scene,
        *,
        step: float | str = "auto",
        method: str | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        save_every: int = 1,
        options: Options | None = None,
    ):
        if not isinstance(scene, Scene):
            raise TypeError(f"scene must be a carom.Scene, got {type(scene).__name__}")
        settings = checked_settings(
            1.0,
            step,
            method,
            save_every=save_every,
            rtol=rtol,
            atol=atol,
            options=options,
            scene=scene,
        )
        check_scene(scene, settings)
        if settings.step is not None:
            settings = settings._replace(duration=BLOCK * settings.save_every * settings.step)
        self._run = Endless(scene, settings)
        implicit = METHODS[settings.method].kind == IMPLICIT
        self._applied = Applied(self._run, implicit)
        self._status, self._known = Status.SUCCESS, {}
        for mistake in mistakes(scene, settings):
            warnings.warn(mistake, MistakeWarning, stacklevel=3)

    @property
    def time(self) -> float:
        """Time that the run has come to [s], from 0 on."""
        return self._run.reached

    @property
    def state(self) -> SystemState:
        """The state at this time; it stays as it is when the run goes on."""
        return SystemState(self._run, self._known, self._applied.given)

    @property
    def solution(self) -> Solution:
        """All of the run up to this time; it stays as it is when the run goes on, and `simulate` refuses it."""
        return solution_of(self._run, self._status, self._applied)

    def set_force(self, force: AppliedForce | str, value: ArrayLike) -> None:
        """Set a force of the scene to a new value, which it keeps until it is set again.

        Its work is that of a load, `ledger.loads`.

        Parameters
        ----------
        force : AppliedForce or str
            A `forces.Force`, a `forces.Torque` or a `forces.JointForce` with a number, or its name.
        value : (3,) or float
            What takes the place of `vector` [N], [N m], or of `force` of a `JointForce` [N] or [N m].

        Raises
        ------
        TypeError, ValueError
            If it is no such force of the scene, or the value is not finite.
        """
        self._applied.set(force, value)

    def advance(self, duration: float | None = None) -> None:
        """Go on by so much time.

        Parameters
        ----------
        duration : float, optional
            [s]. Where the step is given: a whole multiple of it, by default one step.

        Raises
        ------
        ValueError
            For another duration.
        SimulationError
            If the run fails; its `solution` holds all up to there.
        """
        run = self._run
        if self._status is Status.SUCCESS:
            until = run.ask(duration)
            try:
                self._status = run.go_on(until)
            except KeyboardInterrupt:
                run.go_back()
                raise
            if self._status is Status.INTERRUPTED:
                self._status = Status.SUCCESS
                run.go_back()
                raise KeyboardInterrupt
        if self._status is not Status.SUCCESS:
            solution = self.solution
            raise SimulationError(solution.message, solution) from run.failure

    def __repr__(self) -> str:
        return f"<Run: {len(self._run.bodies)} bodies at t = {self.time:.9g} s>"


class Frozen(KeptRun):
    """The records of a run up to some time, and the forces that were set until then."""

    def __init__(self, run: Endless, settings: dict, applied: Applied):
        records, past = r.trimmed(run.records, run.clock), {"status": Status.SUCCESS.name}
        super().__init__(run.scene, settings, run.options, records, None, [], past, run.found)
        self.history, self.values = list(applied.history), list(applied.values)

    def rows_of_forces(self, system, saved: int):
        """Go through ranges of saved rows in which forces stay as they are; write them into the system."""
        return rows_of_forces(self.history, system, saved)

    def values_of_forces(self) -> dict:
        """Return the values at saved times of the forces that were set, by index."""
        return values_of_forces(self.scene, self.values, len(self.records.series))


def solution_of(run: Endless, status: Status, applied: Applied) -> Solution:
    """Return the solution of a run up to now; the run may go on, and knows nothing of it."""
    clock = run.clock.copy()
    if run.reached > run.records.series["t"][int(clock["saved"][0]) - 1] and status.ended:
        run.records = r.with_room(run.records, int(clock["saved"][0]))
        run.save_now()
    made = run.solution(status)
    longest = run.how.step or run.controls.interval
    settings = {**made.settings, "duration": max(run.reached, longest)}
    made = replace(made, settings=settings, _run=Frozen(run, settings, applied))
    run.clock[:] = clock
    return made
