"""One run of a `GeneralizedSystem`: the compiled loop, and Python code for events, at which the loop stops."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom._compiled.record_arrays import table
from carom.dynamics.methods import METHODS, make_method
from carom.dynamics.thresholds import FIRST_STEP
from carom.generalized import layout as o
from carom.generalized.contacts import Contacts
from carom.generalized.evaluate import Evaluation
from carom.generalized.loop import save_now, time_loop
from carom.generalized.step import project
from carom.generalized.thresholds import AT_ONE_INSTANT, INSIDE
from carom.geometry.thresholds import SMALLEST
from carom.model.kept import Kept
from carom.status import Status
from carom.stepping.grid import STATES, Grid, part_of_grid, planned_grid
from carom.stepping.running import Running

if TYPE_CHECKING:
    from carom.generalized.system import GeneralizedSystem
    from carom.stepping.settings import Settings

EVENTS_AT_ONCE = 200  # events at one instant


class GeneralizedRun(Running):
    """A run of a `GeneralizedSystem`: state, records and workspace.

    It begins at the initial state of the system, or at `start`: a time, and the state (q, v) and the active
    contacts of a run at this time.
    """

    def __init__(
        self, system: GeneralizedSystem, settings: Settings,
        start: tuple[float, np.ndarray, np.recarray] | None = None,
    ):  # fmt: skip
        options, made = settings.options, system.evaluation()
        atol = settings.rtol if settings.atol is None else settings.atol
        settings = settings._replace(atol=atol)
        self.user = system = system._as_it_is()
        self.options, self.how = options, settings
        self.settings = {**settings.as_dict(), "options": options.as_dict()}
        # a gap that closes and opens within a step is detected from both ends of the step
        between = settings.duration / (STATES if system.contacts else 1)
        longest = settings.step or options.max_step or between
        grid = planned_grid(settings, settings.duration, longest)
        order = METHODS[settings.method].order if settings.adapts else 0
        self.plan = o.Plan(settings.duration, grid.interval, grid, order, settings.rtol, atol)
        same = made.system.drop == options.drop_tolerance
        self.made: Evaluation = made if same else Evaluation(system, options.drop_tolerance)
        self.functions = self.made.functions
        self.functions.forget()
        self.system = self.made.system
        n = self.n = self.system.n
        self.method = make_method(settings.method, options, settings.adapts, kinks=True)
        self.work = o.new_work(self.system, len(self.method.b))
        x = np.concatenate([system.position, system.velocity])
        begin, x, active = start or (0.0, x, table(o.CONTACT, self.system.contacts))
        self.x, self.active = x.copy(), active.copy()
        self.motion = o.Motion(self.system, self.method, self.active, self.work)
        self.clock = table(o.CLOCK, 1)
        self.clock["now"] = begin
        self.clock["ahead"] = FIRST_STEP * grid.interval
        self.series = table(o.CLOCK, grid.rows + 2)
        self.states = np.zeros((grid.rows + 2, 2 * n))
        self.record = o.Record(self.clock, self.series, self.states)
        # of the events: time, state before and after, contacts
        self.nodes: list[tuple[float, np.ndarray, np.ndarray, np.recarray]] = []
        self.contacts = Contacts(self)
        self.reason = ""  # of a failure, beyond its status
        self.located: list[float] = []  # times of events
        self.code = 0
        if start is None:
            self.check_start()
            self.code = self.contacts.resolve(0, -1)
            self.save_now()

    def again(self, begin: float, x: np.ndarray, active: np.recarray, end: float) -> GeneralizedRun:
        """Return a run between two times that starts at a state (q, v) of this one."""
        run = GeneralizedRun(self.user, self.how, (begin, x, active))
        run.plan = self.plan._replace(grid=part_of_grid(self.plan.grid, begin, end))
        return run

    def check_start(self) -> None:
        """Raise an error if the start violates constraints or contacts; `project_start` projects velocities."""
        tolerance, x, n = self.options.constraint_tolerance, self.x, self.n
        seen = self.made.look(x)
        A, rates = seen.A, seen.A @ x[n:]
        sizes, speeds = np.abs(A[: len(seen.phi)]) @ np.abs(x[:n]), np.abs(A) @ np.abs(x[n:])
        if not np.all(np.abs(seen.phi) <= tolerance * np.maximum(sizes, 1.0)):
            raise ValueError(
                f"position must satisfy the constraints, got phi(q) = {seen.phi.tolist()} at the start"
            )
        right = np.all(np.abs(rates) <= tolerance * np.maximum(speeds, SMALLEST))
        if not (right or self.options.project_start):
            raise ValueError(
                f"velocity must satisfy the constraints, got A v = {rates.tolist()} at the start; use "
                "Options(project_start=True)"
            )
        sizes = np.abs(seen.G[:, 0]) @ np.abs(x[:n])
        for contact in np.flatnonzero(seen.gap < -INSIDE * sizes):
            name = self.user.contacts[contact].name
            raise ValueError(
                f"position must not be inside a contact, got the gap {seen.gap[contact]:.6g} of {name!r}"
            )
        if len(A):
            project(self.system, self.active, 0.0, x, True, self.work)

    @property
    def grid(self) -> Grid:
        """The steps of the run."""
        return self.plan.grid

    def moment(self, acceleration: float) -> float:
        """Return a time that counts as zero: a step, or with tolerances that of a bounce as high as these."""
        plan = self.plan
        if plan.order == 0 or not acceleration > 0.0:
            return plan.step
        return min(plan.step, float(np.sqrt(8.0 * (plan.atol + plan.rtol) / acceleration)))

    def save_now(self) -> None:
        """Write the present state into the records."""
        save_now(self.system, self.x, self.record, self.work)

    def take_steps(self, until: int) -> int:
        """Continue to step number `until`; return a status, or PAUSE."""
        while self.code == 0:
            code = time_loop(self.motion, self.x, self.plan, until, self.record)
            if code != o.EVENT:
                return code
            self.code = self.event()
        code, self.code = self.code, 0
        return code

    def blame_compiled(self) -> None:
        """Take the failed step once more, with compiled functions called from Python, which notes faults."""
        place = Kept((self.motion, self.x, self.clock))
        self.functions.call_from_python([self.system.address, *self.system.part[:, :2].T])
        time_loop(self.motion, self.x, self.plan, self.steps_done + 1, self.record)
        place.restore()

    def costs(self) -> str:
        """Return what the run has done so far, for the progress bar."""
        counts = list(self.counted().items())[3:]
        counts.append(("calls of Python functions", self.functions.calls))
        return "; ".join(f"{count} {name}" for name, count in counts if count)

    def counted(self) -> dict[str, int]:
        """Return the numbers of steps, of trial steps, of those that were rejected, and of events."""
        clock, kinds = self.clock[0], [kind for _, kind, _ in self.contacts.events]
        return {
            "steps": int(clock.step), "trial_steps": int(clock.trials), "rejected": int(clock.rejected),
            "located events": len(self.located), "impacts": kinds.count("impact"),
            "holds": kinds.count("held"),
        }  # fmt: skip

    def go_back(self) -> None:
        """Do nothing: a run is only interrupted where it can be continued."""

    def event(self) -> int:
        """Handle the event at which the loop has stopped; return a status."""
        clock, times = self.clock[0], self.located
        times.append(float(clock.now))
        before = times[-EVENTS_AT_ONCE] if len(times) >= EVENTS_AT_ONCE else -np.inf
        if times[-1] - before <= AT_ONE_INSTANT * self.plan.step:
            return Status.TOO_MANY_IMPACTS
        return self.contacts.resolve(int(clock.kind), int(clock.index))

    def solution(self, status: Status):
        """Return the solution; after a failure it ends with the last state."""
        from carom.generalized.solution import GeneralizedSolution

        clock = self.clock[0]
        self.reason = self.functions.reason if status is Status.FUNCTION_FAILED else ""
        if status is not Status.SUCCESS and clock.now > self.series.now[clock.saved - 1]:
            self.save_now()
        return GeneralizedSolution._from_run(self, status)
