"""Derivatives of a run piece by piece, by differences: for joints, forces and persistent contacts.

From a step k to a later step j the state changes by a map z_j = F(z_k, parameters). With the tangents X_k and
the changes D by a unit of each parameter,

    X_j = d/de F(z_k + e X_k, parameters + e D)  at e = 0,

by central differences with e and e/2, extrapolated: (4 D(e/2) - D(e))/3. A piece ends with the step of an
event, so the growth of tangents by impacts is computed accurately for runs of any length; differences of whole
runs would lose it in round-off, or have another sequence of contact. The derivative is that of the steps of the
method, with impacts located in each run. (Mathematics page, §5.4.)
"""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import Columns
from carom.dynamics.project import project_start
from carom.geometry import quaternion
from carom.io.files.checkpoint import Checkpoint, capture, restore
from carom.model.laws import law_of
from carom.results.solution import Solution
from carom.run import Run
from carom.status import Status
from carom.stepping.grid import make_grid
from carom.stepping.settings import settings_of
from carom.studies.gradient.parameters import Parameters
from carom.studies.gradient.result import Sensitivities
from carom.studies.gradient.tangents import Steps

# changes of the state, relative to its size: if the first one changes the contacts, the second is tried
CHANGES = (3e-4, 1e-5)
LONGEST_PIECE = 100  # greatest number of steps of a piece
CONVERGED = 1e-3  # allowed difference of the two differences, relative to the greatest derivative
ROWS = ("time", "point", "before", "after", "impulse")


def differentiate(solution: Solution, parameters: Parameters) -> Sensitivities:
    """Return the derivatives of a run by differences of pieces.

    Raises
    ------
    ValueError
        If steps vary, there are crowds, or a parameter cannot have values on both sides.
    """
    given, run = solution.settings, solution._run
    if given["step"] == "auto":
        raise ValueError('solution must be of a run with a given step, got step="auto"')
    if isinstance(given.get("save_at"), tuple):
        raise ValueError("solution must be of a run with steps of one length, got times in save_at")
    if solution.stats["whole_steps"]:
        raise ValueError(
            "solution must be without crowds, got a run with time-stepping (Moreau) steps of crowds"
        )
    if np.any(parameters.inertia):
        raise ValueError(
            "with_respect_to must not have the inertia of a body if derivatives are found by differences"
        )
    system = run.compiled.system
    laws = law_of(system, system.contacts)
    for name in ("friction", "restitution"):
        touched = np.any(getattr(parameters, name)[system.contacts.number] != 0.0, axis=1)
        if np.any(touched & (laws[name] == 0.0)):
            raise ValueError(
                f"{name} must be above 0 to differentiate by it: differences need values on both sides"
            )
    return Pieces(solution, parameters).result()


def with_own_laws(run: Run) -> None:
    """Give each contact of a run two laws of its own, after all others, so that one can change alone."""
    compiled = run.compiled
    system, laws = compiled.system, compiled.system.laws
    first, number = len(laws.table), system.contacts.law
    table = np.concatenate([laws.table, laws.table[number.ravel()]]).view(Columns)
    number[...] = first + np.arange(number.size).reshape(-1, 2)
    run.compiled = compiled._replace(system=system._replace(laws=laws._replace(table=table)))


class Pieces:
    """A repeated run, piece by piece, and neighbouring runs on both sides for each parameter."""

    def __init__(self, solution: Solution, parameters: Parameters):
        run = solution._run
        settings = settings_of(solution.settings, run.options)
        assert settings.step is not None
        grid = make_grid(settings.duration, settings.step, 1, settings.save_at)
        settings = settings._replace(step=grid.interval, save_at=None, save_every=1)
        self.labels, self.parameters = parameters.labels, parameters
        self.base, self.near = Run(solution.scene, settings), Run(solution.scene, settings)
        if run.found is not None:  # so that contacts have the same numbers as in the run
            for again in (self.base, self.near):
                again.add_pairs(run.found)
        for again in (self.base, self.near):
            with_own_laws(again)
        system = self.near.compiled.system
        table, number = system.laws.table, np.repeat(system.contacts.number, 2)
        self.numbers = [
            (system.bodies.mass, parameters.mass),
            (system.gravity, parameters.gravity),
            (table.restitution[-len(number) :], parameters.restitution[number]),
            (table.friction[-len(number) :], parameters.friction[number]),
        ]
        self.given = [array.copy() for array, _ in self.numbers]
        self.fresh = [
            (array, array.copy()) for array in system.solver if isinstance(array, np.ndarray)
        ]
        self.size = system.bodies.extent.copy()
        self.notes: list[str] = []
        self.error = 0.0
        steps, P = solution._run.steps_done, len(self.labels)
        self.X = np.full((steps + 1, len(self.size), 12, P), np.nan)
        self.X[0] = parameters.start
        self.rows: dict[str, list] = {name: [] for name in ROWS}
        self.errors: list[float] = []
        self.alive = np.ones(P, dtype=bool)
        self.ends = ends_of(solution, self.base.grid.interval, steps)
        if len(solution.scene.joints) + len(solution.scene.constraints):
            self.bring_to_joints()
        for first, last in zip([0, *self.ends], self.ends):
            self.pass_piece(first, last)

    def result(self) -> Sensitivities:
        """Return the derivatives."""
        clock, records, P = self.base.clock[0], self.base.records, len(self.labels)
        order = np.argsort(records.impact.time[: clock.struck], kind="stable")
        times = records.series.t[: clock.saved].copy()
        point = {
            name: np.array(self.rows[name], dtype=float).reshape(
                (clock.struck, P) if name == "time" else (clock.struck, 3, P)
            )[order]
            for name in ROWS
        }
        return Sensitivities(
            labels=self.labels, columns=self.parameters.columns, impact_time=point["time"],
            impact_point=point["point"], velocity_before=point["before"],
            velocity_after=point["after"], impulse=point["impulse"],
            impact_error=np.array(self.errors, dtype=float)[order], notes=tuple(self.notes),
            margins=(), defect=self.error, by="differences",
            _motion=Steps(float(times[0]), float(times[-1]), times, self.X),
        )  # fmt: skip

    def bring_to_joints(self) -> None:
        """Project the changes of the start onto the joints, in the kinetic metric."""
        start = capture(self.base)
        assert start is not None
        for p in range(len(self.labels)):
            e = CHANGES[-1] * self.scale(self.X[0, :, :, p], p)
            one, other = (self.begin(start, sign * e, p).now.copy() for sign in (1.0, -1.0))
            self.X[0, :, :, p] = between(one, other) / (2.0 * e)

    def pass_piece(self, first: int, last: int) -> None:
        """Find the tangents of steps `first` to `last`, and the derivatives of the impacts between."""
        start = capture(self.base)
        assert start is not None
        struck, event = self.base.clock[0].struck, self.base.clock[0].event
        self.base.go_on(last)
        rows = self.base.records.impact[struck : self.base.clock[0].struck]
        what = self.happened(self.base, struck, event)
        P = len(self.labels)
        found = {name: np.full((len(rows), *rows[name].shape[1:], P), np.nan) for name in ROWS}
        errors = np.zeros(len(rows))
        for p in np.flatnonzero(self.alive).tolist():
            direction = self.X[first, :, :, p]
            if not np.any(direction) and not any(np.any(D[..., p]) for _, D in self.numbers):
                self.X[first + 1 : last + 1, :, :, p] = 0.0
                for name in ROWS:
                    found[name][..., p] = 0.0
                continue
            for change in CHANGES:
                e = change * self.scale(direction, p)
                one, half = (self.pair(start, e / n, p, last, what, struck, event) for n in (1, 2))
                if one is not None and half is not None:
                    break
            else:
                self.lose(p, first, last, "another sequence of contact is too near")
                continue
            (X1, rows1), (X2, rows2) = one, half
            if not self.converged(X1, X2):
                self.lose(
                    p,
                    first,
                    last,
                    "differences do not converge: an impact or a contact mode is about to change",
                )
                continue
            self.X[first + 1 : last + 1, :, :, p] = (4.0 * X2 - X1) / 3.0
            for name in ROWS:
                found[name][..., p] = (4.0 * rows2[name] - rows1[name]) / 3.0
            if len(rows):
                off = np.abs(rows2["impulse"] - rows1["impulse"]).max(axis=1) / 3.0
                size = np.abs(rows2["impulse"]).max(axis=1)
                errors = np.fmax(errors, off / np.where(size > 0.0, size, 1.0))
        for name in ROWS:
            self.rows[name].extend(found[name])
        self.errors.extend(errors)

    def converged(self, X1: np.ndarray, X2: np.ndarray) -> bool:
        """Return whether two differences agree; store the error of their extrapolation."""
        unit = self.units()
        most = np.max(np.abs(X2) / unit, initial=0.0)
        worst = float(np.max(np.abs(X2 - X1) / unit, initial=0.0) / most) if most > 0.0 else 0.0
        self.error = max(self.error, worst / 15.0 if worst <= CONVERGED else 0.0)
        return worst <= CONVERGED

    def scale(self, direction: np.ndarray, p: int) -> float:
        """Return the change of a parameter that changes the state by its size, or a number by its value."""
        parts = [direction / self.units()]
        for (_, D), given in zip(self.numbers, self.given):
            size = np.max(np.abs(given), initial=0.0) or 1.0
            parts.append(D[..., p] / (size if D.shape[0] and size > 1e-12 else 1.0))
        most = max(float(np.max(np.abs(part), initial=0.0)) for part in parts)
        return 1.0 / most if most > 0.0 else 1.0

    def units(self) -> np.ndarray:
        """Return (N, 12): sizes of the bodies, one radian, and speeds of the present state or of a fall."""
        now, L = self.base.now, self.size[:, None]
        speed = max(float(np.max(np.abs(now.v))), float(np.max(np.abs(now.w) * L)))
        fall = float(np.sqrt(np.linalg.norm(self.base.compiled.system.gravity) * np.max(L)))
        speed = max(speed, fall) or 1.0
        one = np.ones((len(L), 3))
        return np.concatenate([L * one, one, speed * one, speed / L * one], axis=1)

    def begin(self, start: Checkpoint, e: float, p: int) -> Run:
        """Return the neighbouring run, ready to continue from `start` with parameter p increased by e."""
        run = self.near
        if len(run.pairs.body) != len(self.base.pairs.body):
            raise ValueError(
                "solution must be of a run whose contacts are also those of neighbouring runs, got one where "
                "other bodies come near each other there"
            )
        restore(run, start, self.base.records)
        for array, kept in self.fresh:  # its data for earlier poses belong to other values
            array[...] = kept
        for (array, D), given in zip(self.numbers, self.given):
            array[...] = given + e * D[..., p]
        now, X = run.now, e * self.X[self.base_step(start), :, :, p]
        now.x += X[:, :3]
        now.Q[:] = quaternion.normalize(quaternion.multiply(quaternion.exp(X[:, 3:6]), now.Q))
        now.v += X[:, 6:9]
        now.w += X[:, 9:]
        if len(run.compiled.system.joints):
            project_start(run.compiled.system, now, run.work)
        return run

    def base_step(self, start: Checkpoint) -> int:
        """Return the number of the step that a checkpoint was taken after."""
        return int(np.asarray(start.arrays["clock"])["step"][0])

    def pair(self, start: Checkpoint, e: float, p: int, last: int, what, struck: int, event: int):
        """Return central differences of states and impacts of a piece; None if the contacts differ."""
        sides = []
        first = self.base_step(start)
        for sign in (1.0, -1.0):
            run = self.begin(start, sign * e, p)
            if run.go_on(last) is not Status.SUCCESS or self.happened(run, struck, event) != what:
                return None
            rows = run.records.impact[struck : run.clock[0].struck]
            states = run.records.state[first + 1 : last + 1]
            sides.append((states.copy(), {name: rows[name].copy() for name in ROWS}))
        (one, rows), (other, others) = sides
        return between(one, other) / (2.0 * e), {n: (rows[n] - others[n]) / (2.0 * e) for n in ROWS}

    def happened(self, run: Run, struck: int, event: int) -> list[tuple]:
        """Return the records from these rows on, without their numerical values."""
        rec, clock = run.records, run.clock[0]
        rows = rec.impact[struck : clock.struck]
        events = rec.event[event : clock.event]
        return [
            *zip(rows["contact"].tolist(), rows["together"].tolist(), rows["phases"].tolist()),
            *zip(events["kind"].tolist(), events["contact"].tolist(), events["feature"].tolist()),
        ]

    def lose(self, p: int, first: int, last: int, why: str) -> None:
        """Record that there is no derivative by a parameter from a piece on."""
        self.alive[p] = False
        t = self.base.records.series.t
        self.notes.append(
            f"the derivative by {self.labels[p]} ends at t = {t[first]:.6g} .. {t[last]:.6g} s: {why}"
        )


def ends_of(solution: Solution, step: float, steps: int) -> list[int]:
    """Return the last steps of the pieces: steps of events, and others so that no piece is too long."""
    events = solution._run.records.event[: solution._run.clock[0].event]
    after = np.floor(events["time"] / step * (1.0 - 1e-12)).astype(int) + 1
    ends: list[int] = []
    for end in [*np.unique(after[(after > 0) & (after < steps)]).tolist(), steps]:
        while end - (ends[-1] if ends else 0) > LONGEST_PIECE:
            ends.append((ends[-1] if ends else 0) + LONGEST_PIECE)
        ends.append(end)
    return ends


def between(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the tangents (..., N, 12) that lead from states (..., N) to others, world axes."""
    turn = quaternion.multiply(one["Q"], quaternion.conjugate(other["Q"]))
    parts = (
        one["x"] - other["x"], quaternion.log(turn), one["v"] - other["v"], one["w"] - other["w"],
    )  # fmt: skip
    return np.concatenate(parts, axis=-1)
