"""One run: the compiled scene, its workspace and records, and the calls of the compiled loop."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from carom._compiled.template import Template, arrays_of
from carom._compiled.units import Entries
from carom._compiled.user_functions import Functions
from carom.dynamics.adapt import complete, time_of_bounces
from carom.dynamics.methods import EXPLICIT, METHODS, make_method
from carom.dynamics.project import project_start
from carom.dynamics.thresholds import FIRST_STEP
from carom.geometry.frames import length
from carom.impact.multiple.layout import multiple_settings
from carom.impact.workspace import new_group, new_multiple, no_multiple
from carom.model import records as r
from carom.model.compile import Compiled, compiled_once, uses_functions, with_pairs
from carom.model.controls import LOCATE, PROJECT, WORK, Controls
from carom.model.data import Data, Model
from carom.model.kept import Snapshot
from carom.model.method import IMPLICIT, THREE_FIELD
from carom.model.switched import NOTHING_SWITCHED, Stands, first_stand, go_on_from, stands_of
from carom.model.user_results import check_results
from carom.results.accuracy import inaccurate
from carom.results.costs import costs
from carom.results.solution import Solution
from carom.results.state import SystemState
from carom.scene.all_pairs import PairTable
from carom.scene.more_forces import has_kinks
from carom.scene.scene import Scene
from carom.status import Status
from carom.stepping import load_limits, record, time_loop
from carom.stepping.crowd.layout import SPOTS, new_crowd, no_crowd, roomier_crowd
from carom.stepping.energy_balance import new_watch
from carom.stepping.first_state import check_joints, check_stops
from carom.stepping.grid import (
    Grid,
    cut_grid,
    longer_grid,
    longest_step,
    planned_grid,
    step_at,
    with_end,
)
from carom.stepping.islands.layout import (
    has_events,
    new_islands,
    no_islands,
    roomier,
    together,
    with_partners,
    with_united,
)
from carom.stepping.settings import Settings
from carom.stepping.thresholds import STEP_SHARE

ROOM_AT_FIRST = 8  # points of an impact for which there is room at first
LOCATIONS = {"locate": LOCATE, "project": PROJECT, "work": WORK}


class Run:
    """A run that can be continued step by step; `solution` may be taken at any time."""

    #: is asked at pauses; True interrupts the run
    to_stop: Callable[[], bool] = staticmethod(lambda: False)
    #: loads of joints at which the loop is left (`carom.watch`)
    limits: load_limits.LoadLimits | None = None
    #: what a run passes to compiled code has one type, whatever its scene and method
    call = Entries()
    costs = costs  # for the progress bar

    def __init__(self, scene: Scene, settings: Settings):
        # from the third run with the same settings on, all but the records is made from a template
        known = scene._derived.get(Run, (None, None, (), None))
        again = known[:2] == (type(self), settings)
        if again and known[3] is not None:
            vars(self).update(zip(known[2], known[3].make()))
            self.compiled = self.compiled._replace(functions=Functions())
        else:
            self.make(scene, settings)
            check_results(scene)
            if scene._off is None:  # else the start of another run
                self.check(self.stands.view(scene))
            if not uses_functions(self.compiled):
                shared = together(), self.crowd, self.multiple, self.method
                template = Template(tuple(vars(self).values()), shared) if again else None
                scene._derived[Run] = type(self), settings, tuple(vars(self)), template
        self.at_start, system = self.compiled, self.compiled.system
        self.scene = scene._as_it_is()  # the user may edit it afterwards
        self.records = r.new_records(system, self.grid.rows, 512, len(self.active.points))
        self.save_now()

    def make(self, scene: Scene, settings: Settings) -> None:
        """Make all that the run needs besides the scene and the records."""
        self.options, self.how = settings.options, settings
        options, definition = settings.options, METHODS[settings.method]
        kind, adapts = definition.kind, settings.adapts
        self.apart = settings.impact_location == "locate" and kind != THREE_FIELD
        self.ways = kind == THREE_FIELD, kind == IMPLICIT, self.apart
        self.stands, self.switched = first_stand(scene), NOTHING_SWITCHED
        self.compiled = compiled_once(self.stands.view(scene), options, *self.ways)
        system = self.compiled.system
        kinks = adapts and has_kinks(scene)
        self.method = make_method(settings.method, options, adapts, kinks)
        self.tolerances = complete(settings.rtol, settings.atol, system) if adapts else None
        self.grid = self.make_grid()
        step, tolerances = self.grid.interval, self.tolerances or (0.0, 0.0)
        if adapts:
            step = time_of_bounces(system, tolerances, step)
        self.controls = Controls(
            step=step, pull=length(system.gravity), interval=self.grid.interval,
            duration=settings.duration, location=LOCATIONS[settings.impact_location],
            gap=options.gap_tolerance, tie=options.tie_tolerance, hold=int(options.hold),
            rest=options.rest_tolerance, layer_steps=options.layer_steps,
            layer_time=int(options.add_layer_time), max_impacts=options.max_impacts_per_step,
            max_cuts=options.max_cuts, retry=0, order=definition.order if adapts else 0,
            rtol=tolerances[0], atol=tolerances[1],
        )  # fmt: skip
        self.make_arrays()

    def make_grid(self) -> Grid:
        """Return the steps of the run; a resumed run has the steps that it had, and then more."""
        first, *later = *self.how.earlier, self.how.duration
        grid = self.first_grid(first)
        for begin, end in zip((first, *later), later):
            if end < begin:  # an event has stopped it
                grid = cut_grid(grid, step_at(grid, end), end)
            else:
                grid = longer_grid(grid, begin, end)
        return grid

    def first_grid(self, duration: float) -> Grid:
        """Return the steps of a run with this duration, without the parts that were run before."""
        system, later = self.compiled.system, self.compiled.later is not None
        longest = self.how.step or longest_step(
            system, self.compiled.start, duration, self.options.max_step, later
        )
        return planned_grid(self.how, duration, longest)

    def make_arrays(self) -> None:
        """Make all arrays that the run changes, except the records."""
        options, system = self.options, self.compiled.system
        self.now = self.compiled.start
        self.make_workspace()
        self.multiple = no_multiple(multiple_settings(options))  # and this
        self.clock = r.new_clock()
        share = STEP_SHARE * options.energy_tolerance if self.how.method in EXPLICIT else np.inf
        self.watch = new_watch(options.energy_tolerance, share)
        flies = system.bodies["ballistic"] == 1  # in closed form: any step is good
        self.work.body["ahead"] = np.where(flies, 1.0, FIRST_STEP) * self.grid.interval
        self.project()
        self.work.body["label"] = np.where(flies, system.bodies["component"], system.bodies.size)

    def make_workspace(self) -> None:
        """Make the arrays that depend on which joints, forces and contacts there are."""
        system, later = self.compiled.system, self.compiled.later
        self.active = r.new_active_set(system)
        self.work = r.new_work(system, self.method.b.size)
        of = system, self.active
        self.islands = new_islands(*of, later) if self.apart else no_islands(*of)
        self.group = new_group(system, later is not None)
        again = self.apart and self.options.hold and has_events(system, later is not None)
        self.controls = self.controls._replace(retry=int(again))
        self.crowd = no_crowd()  # made when there is one

    def stand_as(self, stands: Stands) -> None:
        """Go on from the present state with other parts than before: those that are not off."""
        old, active, ahead = self.compiled, self.active, self.work.body["ahead"]
        self.stands = stands
        self.compiled = compiled_once(stands.view(self.scene), self.options, *self.ways)
        self.make_workspace()
        system, bodies = self.compiled.system, self.work.body
        bodies["ahead"] = np.minimum(ahead, FIRST_STEP * self.grid.interval)
        flies = system.bodies["ballistic"] == 1
        bodies["label"] = np.where(flies, system.bodies["component"], system.bodies.size)
        self.work.step["begin"], self.clock["still"] = self.clock["now"], np.inf
        go_on_from(old, active, self.compiled, self.active)

    def stand_at_end_of(self, switched: np.ndarray) -> None:
        """Go on with the parts that there are after all of this was switched in another run of the scene."""
        if len(switched):
            self.switched = switched
            self.stand_as(stands_of(self.scene, switched)[-1][1])

    def divide_as_before(self) -> int:
        """Let steps end where parts were switched before this run goes on; return how many more there are."""
        return sum(self.divide(t) for t in dict.fromkeys(self.switched["time"].tolist()))

    def step_at(self, t: float) -> int:
        """Return the number of the step in which the run reaches a time."""
        return step_at(self.grid, t)

    def divide(self, t: float) -> bool:
        """Let a step end at a time t to come, and its state be saved; return whether there is one step more."""
        last = self.grid.last
        self.grid = with_end(self.grid, t, self.controls.duration)
        self.records = r.with_room(self.records, int(self.clock["saved"][0]), self.grid.rows)
        return self.grid.last > last

    def project(self) -> None:
        """Move the bodies into positions that satisfy the joints, where `Options.project_start` says so."""
        system = self.compiled.system
        if not (self.options.project_start and len(system.joints)):
            return
        error = project_start(system, self.now, self.work)
        if not error <= self.options.constraint_tolerance:
            raise ValueError(
                "the initial positions must be near positions that satisfy the joints, got positions from "
                f"which Newton's method leaves an error of {error:.3g}; start nearer"
            )

    def check(self, scene: Scene) -> None:
        """Check the initial state."""
        initial = scene, self.compiled, self.now, self.work, self.options
        check_joints(*initial)
        check_stops(*initial)

    @property
    def steps(self) -> int:
        """Number of steps to the end."""
        return self.grid.last

    @property
    def steps_done(self) -> int:
        """Number of finished steps."""
        return int(self.clock["step"][0])

    @property
    def reached(self) -> float:
        """Time that the run has reached [s]."""
        return float(self.clock["now"][0])

    @property
    def failure(self) -> BaseException | None:
        """The error that a user-defined function has raised, or None."""
        return self.functions.failed

    @property
    def settings(self) -> dict:
        """The arguments of the run, by name."""
        known = self.how.as_dict()
        if self.tolerances is not None:
            known["rtol"], known["atol"] = self.tolerances
        return known

    @property
    def model(self) -> Model:
        """The compiled scene, and the settings of the run (docs/development/arrays.md)."""
        return Model(self.compiled.system, self.controls)

    @property
    def data(self) -> Data:
        """The data that kernels change."""
        return Data(
            state=self.now, active=self.active, work=self.work, group=self.group, multiple=self.multiple,
            crowd=self.crowd, clocks=self.clock, records=self.records, watch=self.watch,
        )  # fmt: skip

    @property
    def memory(self) -> tuple:
        """All that a step goes on from.

        Not the records, which are written from the top in a new run, nor the workspace of impacts, groups and
        crowds, which a step writes before it reads it.
        """
        system = self.compiled.system
        return self.now, self.active, self.work, self.islands, self.clock, system, self.watch

    def save_now(self) -> None:
        """Write the present state into the records."""
        self.call(record.save_now, self.model, self.data)

    def grow(self, what: int) -> None:
        """Lengthen arrays that are full; `what` is their number."""
        if what == r.FULL_EVENTS:
            more = len(self.group.closed) - self.group.idle.shape[1]
            self.records = r.longer(self.records, self.clock, more)
        elif what == r.FULL_PAIRS:
            self.islands = roomier(self.islands)
        elif what == r.FULL_MULTIPLE:
            points = max(
                ROOM_AT_FIRST, 2 * len(self.multiple.contact), 2 * int(self.work.hit["closed"][0])
            )
            self.multiple = new_multiple(
                min(self.group.idle.shape[1], points), self.multiple.settings
            )
        elif what == r.NEW_PAIRS:
            noted = self.islands.pair[0, : self.islands.plan[0].noted]
            self.add_pairs(noted[np.lexsort(noted.T[::-1])])
        elif what in (r.CLUSTERS_MEET, r.CLUSTERS_PART):
            self.wake()
            part = what == r.CLUSTERS_PART
            self.islands = with_united(self.islands, self.compiled.system, part)
        elif self.has_crowd:
            self.crowd = roomier_crowd(self.crowd)
        else:
            bodies = len(self.compiled.system.bodies)
            joined = int(np.sum(self.compiled.system.bodies.isolated == 0))
            self.crowd = new_crowd(bodies, len(self.active.points), SPOTS * bodies, joined)

    def wake(self) -> None:
        """Let joined and loaded bodies that rest move: what acts on them, or which they are, has changed."""
        points = self.active.points[: self.active.count[0]]
        loaded = self.compiled.system.bodies["ballistic"] == 0
        pair = (points["other"] >= 0) & loaded[points["other"]]
        points["rest"][loaded[points["body"]] | pair] = 0

    def add_pairs(self, found: np.ndarray) -> None:
        """Make contacts of pairs (K, 2) of bodies that have come near each other, in this order."""
        later = self.compiled.later
        assert later is not None
        self.compiled = with_pairs(self.compiled, self.scene, self.options, found)
        system = self.compiled.system
        self.active = r.with_contacts(self.active, len(system.contacts))
        self.islands = with_partners(self.islands, system, later)

    @property
    def pairs(self) -> PairTable:
        """The pairs of the contacts, by number of the contact; stops of joints come after them."""
        return self.compiled.pairs

    @property
    def found(self) -> np.ndarray | None:
        """Pairs (K, 2) of bodies that got contacts as they came near; None where all had them at the start."""
        if self.compiled.later is None:
            return None
        first = len(self.at_start.pairs.body)
        return np.stack([self.pairs.body[first:], self.pairs.other[first:]], axis=1)

    @property
    def has_crowd(self) -> bool:
        """Whether a crowd has taken a time-stepping (Moreau) step."""
        return len(self.crowd.closed) >= SPOTS

    @property
    def bodies(self):
        """The records of the bodies in the kernels, (N,) BODY."""
        return self.compiled.system.bodies

    @property
    def to_principal(self) -> np.ndarray:
        """Quaternions (N, 4) from principal axes to the scene's body axes."""
        return self.compiled.to_principal

    @property
    def everything(self) -> Compiled:
        """The compiled scene with all its contacts, also those that are switched off."""
        scene = self.scene
        return compiled_once(scene, self.options, *self.ways) if scene.switches else self.compiled

    @property
    def functions(self) -> Functions:
        """The user-defined functions."""
        return self.compiled.functions

    def take_steps(self, until: int) -> int:
        """Continue to step number `until`; return a status, or PAUSE."""
        while True:
            state = (self.model, self.data, self.method, self.islands, self.grid)
            if self.limits is None:
                code = self.call(time_loop.run, *state, until)
            else:
                self.limits.place["until"] = until
                code = self.call(load_limits.run_within, *state, self.limits)
            if code != r.GROW:
                return code
            self.grow(self.work.step[0].grow)

    def go_on(self, until: int) -> Status:
        """Continue to step number `until`, or to a failure."""
        while True:
            code = self.take_steps(int(until))
            if code == r.PAUSE and self.failure is None:
                if self.to_stop():  # here Ctrl-C is raised
                    return Status.INTERRUPTED
            elif isinstance(self.failure, KeyboardInterrupt):  # while a plain function ran
                self.functions.forget()
                return Status.INTERRUPTED
            elif self.failure is not None or self.is_to_blame(code):
                return Status.FUNCTION_FAILED
            else:
                return Status(code)

    def is_to_blame(self, code: int) -> bool:
        """Return whether a user-defined function without a finite result has ended the run."""
        functions, begin = self.functions, self.begin()
        if code == Status.SUCCESS or functions.blame(begin) or not functions.has_compiled:
            return self.failure is not None
        self.blame_compiled()
        return functions.blame(begin)

    def begin(self) -> float:
        """Return the start of the step: a trial step of it has failed."""
        return float(self.work.step["begin"][0])

    def blame_compiled(self) -> None:
        """Take the failed step once more, with compiled functions called from Python, which notes faults."""
        functions, place = self.functions, Snapshot(self)
        self.go_back()
        system = self.compiled.system, self.islands
        fields = [(one, name) for one in arrays_of(system) for name in one.dtype.names or ()]
        functions.call_from_python(one[name] for one, name in fields if name.endswith("address"))
        self.records = r.with_room(self.records, int(self.clock["saved"][0]))
        self.save_now()  # the energy of the state that was reached
        if not functions.blame(self.begin()):
            state = (self.model, self.data, self.method, self.islands, self.grid)
            self.call(time_loop.run, *state, self.steps_done + 1)
        place.put_back()

    def judged(self, status: Status) -> Status:
        """Return the status at the end of the run, after the check of energy, gaps and contact problems."""
        bad = status is Status.SUCCESS and inaccurate(r.as_numbers(self.watch))
        return Status.INACCURATE if bad else status

    def go_back(self) -> None:
        """Return to the start of the step, or of the piece of one, in which the run was interrupted."""
        islands, active, step, search = self.islands, self.active, self.work.step, self.work.search
        start = islands.single
        if islands.apart:
            if islands.plan[0].planned == 0:
                return
            islands.plan["planned"], islands.plan["entered"] = 0, 0
            islands.carried[0] = 0
        elif start.begun[0] == 1:
            self.now[:], active.contact_states[:] = start.state, start.contact_states
            active.count[0] = start.count[0]
            active.points[: active.count[0]] = start.points[: active.count[0]]
            start.begun[0] = 0
            memory = self.compiled.system.relations.memory
            memory.coordinates[:], memory.frictions[:] = start.turns, start.frictions
        else:
            return
        self.clock[:] = (islands if islands.apart else start).clock
        step["spent"], step["paused"], search["pending"], active.carries[:] = 0.0, 0, 0, 0
        points = active.points[: active.count[0]]
        active.carries[points["feature"][points["fixed"] == 1]] = 1

    def state(self, known: dict | None = None) -> Any:
        """Return the present state, for user-defined functions; `known` keeps what states share."""
        return SystemState(self, known)

    def ending(self, status: Status) -> Status:
        """Return a status with its reason, if this run knows one."""
        return status

    def solution(self, status: Status, **watched) -> Any:
        """Return the solution; after a failure it ends with the last state, saved or not.

        `watched` are its fields that a watch for events has found.
        """
        status = self.ending(status)
        if status is Status.SUCCESS:
            status = self.judged(status)
        else:
            clock = self.clock[0]
            further = clock.now > self.records.series.t[clock.saved - 1]
            whole = all(np.all(np.isfinite(self.now[name])) for name in ("x", "Q", "v", "w"))
            if further and whole:
                self.records = r.with_room(self.records, clock.saved)
                self.save_now()
        return Solution._from_run(self, status, **watched)
