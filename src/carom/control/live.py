"""A run that users take on themselves, step by step, and its solution at any time: copies of its records."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.control.applied import Applied
from carom.control.commands import Controls
from carom.control.endless import BLOCK, Endless, Start
from carom.io.files.checkpoint import capture, state_at_end
from carom.io.files.kept import KeptRun
from carom.io.models.model import Model
from carom.model import records as r
from carom.model.compile import attitudes
from carom.options import Options
from carom.results.robot import Robot
from carom.results.set_forces import History
from carom.results.solution import Solution
from carom.results.state import SystemState
from carom.scene.forces import AppliedForce
from carom.scene.scene import Scene
from carom.scene.switches import check_on, each
from carom.status import MistakeWarning, SimulationError, Status
from carom.stepping.settings import (
    Settings,
    check_scene,
    checked_settings,
    mistakes,
    settings_of,
)
from carom.watch.switching import switch
from carom.watch.watched import watched


@arguments.attributes()
@arguments.known
class Run:
    """A motion that you take on step by step, in a loop of your own.

    Parameters
    ----------
    scene : Scene, models.Model or Solution
        What moves. It is not changed. A solution, also one from a file, is taken on from its end, with its
        settings, its forces and all its records.
    step, method, rtol, atol, options
        As of `simulate`. Left out with a solution.
    save_every : int
        Save each `save_every`-th state only: of all steps where the step is given, else of the ends of
        `advance`. Default 1.

    Raises
    ------
    TypeError, ValueError
        As of `simulate`; or if a run of this solution cannot go on, because it failed or its file has no
        checkpoint.

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
        scene: Scene | Model | Solution,
        *,
        step: float | str = "auto",
        method: str | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        save_every: int = 1,
        options: Options | None = None,
    ):
        if isinstance(scene, Solution):
            given = {"step": step, "method": method, "rtol": rtol, "atol": atol, "options": options}
            for name, value in {**given, "save_every": save_every}.items():
                if value != {"step": "auto", "save_every": 1}.get(name):
                    raise ValueError(
                        f"{name} must be left out with a solution, which has its own, got {checks.shown(value)}"
                    )
            self._start = None
            self._take_on(scene)
            return
        scene = scene.scene if isinstance(scene, Model) else scene
        if not isinstance(scene, Scene):
            raise TypeError(
                f"scene must be a carom.Scene, a Model or a Solution, got {checks.shown(scene)}"
                + ("; a model is read by carom.load_model" if isinstance(scene, str) else "")
            )
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
        self._begin(scene, settings)
        self._start: Start | None = None
        for mistake in mistakes(scene, settings):
            warnings.warn(mistake, MistakeWarning, stacklevel=3)

    def _begin(self, scene: Scene, settings: Settings) -> None:
        """Stand at the start of a scene."""
        if settings.step is not None:
            settings = settings._replace(duration=BLOCK * settings.save_every * settings.step)
        self._stand(Endless(scene, settings))

    def _stand(self, run: Endless, history: History | None = None) -> None:
        """Be this run, whose forces were set so."""
        self._run, self._applied = run, Applied(run, history)
        self._watched: Any = watched(run)
        self._status, self._known = Status.SUCCESS, {}

    def _take_on(self, solution: Solution) -> None:
        """Stand at the end of a solution."""
        kept: Any = solution._run
        checkpoint, ended = state_at_end(solution), solution.status.ended
        if checkpoint is None or not (ended or solution.status is Status.INTERRUPTED):
            why = "its run has gone on since, or its file has no checkpoint"
            raise ValueError(
                f"scene must be a solution whose run can go on: {why if ended else solution.message}"
            )
        if isinstance(kept, KeptRun):
            kept.need_functions("by Solution.load to go on")
        settings = settings_of(solution.settings, kept.options)
        self._begin(kept.scene, settings._replace(duration=1.0, save_at=None, earlier=()))
        self._run.stand(kept, checkpoint)
        self._stand(self._run, getattr(kept, "history", None))

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
        return solution_of(self._run, self._status, self._applied.history)

    @property
    def ctrl(self) -> Controls:
        """Controls of the actuators: ``run.ctrl["hip"] = 0.5``, or ``run.ctrl = [0.5, 0.0]`` for all.

        A control stays until it is set again. It is not clipped; a value outside the range of its actuator acts
        as the nearest inside. An actuator is a `forces.Actuator` of the scene, or one of a model.
        """
        return Controls(lambda: self._applied)

    @ctrl.setter
    def ctrl(self, values: ArrayLike) -> None:
        self.ctrl[:] = checks.finite_array("ctrl", values, (len(self._applied.ctrl),))

    @arguments.known
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

    @arguments.known
    def switch(self, part, *, off: bool = True) -> None:
        """Take a part out of the motion now, or put it into it, as a switch of the scene does.

        Parameters
        ----------
        part
            A joint, force, constraint, stop or contact of a switch (`Scene.switch`), its name, or a tuple of
            them.
        off : bool
            True (default): the part is taken out. False: it is put in.

        Raises
        ------
        TypeError, ValueError
            If no switch of the scene has this part.
        """
        scene, off = self._run.scene, checks.flag("off", off)
        named = {one.name: one for switch in scene.switches for one in switch.parts}
        for given in each(part):
            one = scene._parts.named("part", given)
            if one.name not in named:
                raise ValueError(
                    f"part must be that of a switch, got {one.name!r}; state one: scene.switch({one.name!r})"
                )
            if not off:
                check_on(one)
            switch(self._run, one, not off)
        self._watched, self._known = watched(self._run), {}

    @arguments.known
    def reset(
        self,
        state: SystemState | None = None,
        *,
        keyframe: str | None = None,
        qpos: ArrayLike | None = None,
        qvel: ArrayLike | None = None,
    ) -> None:
        """Begin again at time 0, with new records and the forces of the scene.

        Parameters
        ----------
        state : SystemState, optional
            Where to begin, such as `state` of this run or of another one of the same scene. Default: the
            initial state of the scene.
        keyframe : str, optional
            Name of a keyframe of the model in place of a state.
        qpos : (nq,), optional
            Coordinates of the model in place of those of the state.
        qvel : (nv,), optional
            Velocities of the model in place of those of the state; 0 if only `qpos` is given.

        Raises
        ------
        TypeError, ValueError
            If it is no state of this scene, or violates its joints or stops; if the scene has no model, or
            `qpos` or `qvel` the wrong length.
        KeyError
            If the model has no such keyframe.
        """
        key = None
        if keyframe is not None:
            if state is not None or qpos is not None or qvel is not None:
                raise ValueError("keyframe must be given alone, got a state, qpos or qvel with it")
            name = checks.text("keyframe", keyframe)
            key = _robot(self._run.scene, "keyframe").keyframes[name]
            qpos, qvel = key.qpos, key.qvel
        if self._start is None:
            self._start = Start(Endless(self._run.scene, self._run.how))
        fresh = self._start.again()
        if state is not None or qpos is not None or qvel is not None:
            begin = SystemState(fresh) if state is None else state
            if qpos is not None and qvel is None:
                qvel = np.zeros(_robot(fresh.scene, "qpos").nv)
            place(fresh, begin, qpos, qvel)
            fresh.clock["saved"] = 0
            fresh.save_now()
        self._stand(fresh)
        if key is not None and len(key.ctrl):
            self.ctrl[: len(key.ctrl)] = key.ctrl

    @arguments.known
    def set_state(
        self,
        state: SystemState | None = None,
        *,
        qpos: ArrayLike | None = None,
        qvel: ArrayLike | None = None,
    ) -> None:
        """Move the bodies into another state, at the present time.

        The run forgets its contacts, and finds those of the new state. The last saved state is replaced where
        it is of this time; what `Solution.evaluate` returns since the saved state before is a cubic. The change
        of energy is in `ledger.loads`.

        Parameters
        ----------
        state : SystemState, optional
            The new state, as of `reset`; its time does not count. Default: the present one.
        qpos : (nq,), optional
            Coordinates of the model in place of those of the state.
        qvel : (nv,), optional
            Velocities of the model in place of those of the state.

        Raises
        ------
        TypeError, ValueError
            As of `reset`.
        """
        old, begin = self._run, self.state if state is None else state
        new = Endless(old.scene, old.how)
        if old.steps_done == 0:
            place(new, begin, qpos, qvel)
            new.clock["saved"] = 0
            new.save_now()
        else:
            new.move(old, lambda: place(new, begin, qpos, qvel))
        self._stand(new, self._applied.history)

    @arguments.known
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
            if run is not self._watched:  # which counts the steps that were planned
                until -= self._watched.more
            try:
                self._status = self._watched.go_on(until)
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


def _robot(scene: Scene, name: str) -> Robot:
    """Return the model of a scene, or say that an argument needs one."""
    if scene.robot is None:
        raise ValueError(
            f"{name} must be left out: only a scene of load_model has coordinates of a model"
        )
    return scene.robot


def place(run: Endless, state: SystemState, qpos, qvel) -> None:
    """Write a state, or coordinates of the model in place of its own, into a run before its first step."""
    hint = "; a keyframe is given by keyframe=, and a solution goes on in carom.Run(solution)"
    checks.instance("state", state, (SystemState,), hint)
    if [b.name for b in state._scene.bodies] != [b.name for b in run.scene.bodies]:
        raise ValueError(f"state must be of the scene of this run, got {state!r}")
    motion = state
    if qpos is not None or qvel is not None:
        robot = _robot(run.scene, "qpos" if qpos is not None else "qvel")
        motion = robot._placed(state, qpos, qvel)
    now = run.now
    now["x"], now["Q"] = motion.position, attitudes(motion.orientation, run.to_principal)
    now["v"], now["w"] = motion.velocity, motion.angular_velocity
    turns = motion.turns
    if turns is not None:
        run.compiled.system.relations.memory.coordinates["reference"] = turns
    run.project()
    run.check(run.scene)


def solution_of(run: Endless, status: Status, history: History) -> Solution:
    """Return the solution of a run up to now; the run may go on, and knows nothing of it."""
    clock = run.clock.copy()
    if run.reached > run.records.series["t"][int(clock["saved"][0]) - 1] and status.ended:
        run.records = r.with_room(run.records, int(clock["saved"][0]))
        run.save_now()
    made = run.solution(status)
    longest = run.how.step or run.controls.interval
    settings = {**made.settings, "duration": max(run.reached, longest)}
    records, past = r.trimmed(run.records, run.clock), {"status": Status.SUCCESS.name}
    run.clock[:] = clock
    known = run.scene, settings, run.options, records, capture(run), [], past, run.found
    kept = KeptRun(*known, list(history))
    kept.switched = run.switched
    return replace(made, settings=settings, _run=kept)
