"""Derivatives of a run from event to event, with the tangents of all bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from carom.geometry import quaternion
from carom.model.contact_kinds import has_vertices, is_found
from carom.model.laws import law_of
from carom.results.names import restitution_of
from carom.results.solution import Solution
from carom.scene.restitution import Restitution
from carom.studies.gradient import margins as near
from carom.studies.gradient.blow import BY_NORMAL, BY_RESTITUTION, blow
from carom.studies.gradient.body import Moving, cross, fly
from carom.studies.gradient.parameters import Parameters
from carom.studies.gradient.place import found_place, vertex_place
from carom.studies.gradient.result import Sensitivities
from carom.studies.gradient.saltation import Strike, inverse_mass, relative_velocity, strike
from carom.studies.gradient.sequence import Step, steps_of
from carom.studies.gradient.tangents import Flights

SAME = 1e-8  # allowed relative difference of the recorded impact from the differentiated one
TIED = 1e-9  # smaller relative changes of the distance of joined points are round-off
SURE = 1e-5  # greatest error of an accepted derivative of an impact
WHY = {
    "held": "begins a persistent contact",
    "slips": "changes from stick to slip in a persistent contact",
    "sticks": "changes from slip to stick in a persistent contact",
    "opens": "ends a persistent contact",
    "jams": "jams",
}


class Walk:
    """The derivatives of a run by `parameters`, computed from its first event to its last."""

    def __init__(self, solution: Solution, parameters: Parameters):
        self.solution, self.parameters = solution, parameters
        self.scene, self.system = solution.scene, solution._run.compiled.system
        self.tie = solution._run.options.tie_tolerance
        self.notes: list[str] = []
        self.margins: list[near.Margin] = []
        self.defect = 0.0
        self.bodies = self.start()
        self.free = [True] * len(self.bodies)
        self.knots = [[b] for b in self.bodies]
        self.flies = [[True] for _ in self.bodies]
        K, P = len(solution.impacts), len(parameters.labels)
        self.times, self.errors = np.full((K, P), np.nan), np.full(K, np.nan)
        self.vectors = [np.full((K, 3, P), np.nan) for _ in range(4)]
        if solution.stats["whole_steps"]:
            for b in range(len(self.bodies)):
                self.lose(b, 0.0, "took time-stepping (Moreau) steps in a crowd", stays_free=False)
        for step in steps_of(solution):
            self.pass_event(step)
        end = float(solution.t[-1])
        for b, body in enumerate(self.bodies):
            if self.free[b]:
                self.look_between(b, body, end)
        if K:
            self.margins += near.of_end(
                K - 1, self.times[-1], float(solution.impacts.time[-1]), end
            )

    def start(self) -> list[Moving]:
        """Return all bodies at the start."""
        compiled, p = self.solution._run.compiled, self.parameters
        first = self.solution._run.records.state[0]
        return [
            Moving(
                float(self.solution.t[0]), first.x[b].copy(), quaternion.matrix(first.Q[b]),
                first.v[b].copy(), first.w[b].copy(), p.start[b], float(body.mass),
                body.inertia.copy(), compiled.system.gravity, p.mass[b], p.inertia[b], p.gravity,
            )
            for b, body in enumerate(compiled.system.bodies)
        ]  # fmt: skip

    def result(self) -> Sensitivities:
        """Return the derivatives."""
        margins = sorted(self.margins, key=lambda m: m.relative)
        point, before, after, impulse = self.vectors
        t = self.solution.t
        return Sensitivities(
            labels=self.parameters.labels, columns=self.parameters.columns,
            impact_time=self.times, impact_point=point, velocity_before=before,
            velocity_after=after, impulse=impulse, impact_error=self.errors,
            notes=tuple(self.notes), margins=tuple(margins), defect=self.defect, by="saltation",
            _motion=Flights(float(t[0]), float(t[-1]), self.knots, self.flies),
        )  # fmt: skip

    def lose(
        self, b: int, time: float, why: str, columns: np.ndarray | bool = True, stays_free=True
    ) -> None:
        """Record that from now on the motion of a body has no derivative by the parameters that change it."""
        body, rows = self.bodies[b], self.system.contacts
        own = np.unique(rows.number[(rows.body == b) | (rows.other == b)])
        p = self.parameters
        known = np.concatenate(
            [body.X, body.dm[None], body.dJ.reshape(9, -1), body.dg, p.friction[own],
             p.restitution[own]]
        )  # fmt: skip
        lost = np.any(known != 0.0, axis=0) & columns
        self.free[b] = self.free[b] and stays_free
        fresh = lost & ~np.any(np.isnan(body.X), axis=0)
        self.bodies[b] = replace(body, X=np.where(lost, np.nan, body.X))
        if np.any(fresh):
            which = "" if np.all(lost) else " (by " + _names(p.labels, fresh) + ")"
            self.notes.append(f"{self.scene.bodies[b].name!r} {why} at t = {time:.6g} s{which}")

    def pass_event(self, step: Step) -> None:
        """Move the bodies of an event to its time and through the event."""
        time = float(step.event.time)
        if len(step.shots) == 0:
            return  # an event of a crowd, which has no derivatives
        for shot in step.shots:
            self.meet(int(shot.body), shot, time)
        struck = step.kind == "impact" and self.pass_impact(step, time)
        for shot in step.shots:
            b = int(shot.body)
            if not struck:
                why = WHY.get(step.kind, "takes part in an impact with several points")
                self.lose(b, time, why, stays_free=step.kind == "impact")
            self.bodies[b] = replace(self.bodies[b], v=shot.v1.copy(), w=shot.w1.copy())
            self.knots[b].append(self.bodies[b])
            self.flies[b].append(self.free[b])

    def meet(self, b: int, shot, time: float) -> None:
        """Move a body in free flight to an event, and continue from its recorded state."""
        body = self.bodies[b]
        if self.free[b]:
            self.look_between(b, body, time)
            body = fly(body, time)
            size = float(self.system.bodies.extent[b])
            turn = body.R.T @ quaternion.matrix(shot.Q) - np.eye(3)
            off = max(np.max(np.abs(body.x - shot.x)) / size, np.max(np.abs(turn)))
            self.defect = max(self.defect, float(off))
        self.bodies[b] = replace(
            body, t=time, x=shot.x.copy(), R=quaternion.matrix(shot.Q), v=shot.v0.copy(),
            w=shot.w0.copy(),
        )  # fmt: skip

    def pass_impact(self, step: Step, time: float) -> bool:
        """Pass an impact of one point; return False for other events, or if there is no derivative at all."""
        if step.row is None or step.row.together != 1:
            return False
        found = self.place_of(step)
        if found is None:
            return False
        row, place, tied = found
        which = [int(row.body)] + ([int(row.other)] if row.other >= 0 else [])
        bodies = [self.bodies[b] for b in which]
        W, u = inverse_mass(place, bodies), relative_velocity(place, bodies)
        stated = law_of(self.system, row)
        law = restitution_of(self.scene, self.solution.pairs, int(row.number))
        e = float(law(-u[0])) if isinstance(law, Restitution) else float(stated.restitution)
        hit = blow(W, u, float(stated.friction), e, int(stated.impact_law))
        if hit is not None and isinstance(law, Restitution):  # de/du_n = -e'(v)
            hit.d[:, BY_NORMAL] -= hit.d[:, BY_RESTITUTION] * law.slope(-u[0])
        if hit is None or not _same(hit.impulse, step.row.impulse):
            for b in which:
                self.lose(b, time, "has an impact that does not follow the law of the contact")
            return True
        if hit.kink or not hit.error <= SURE:
            why = hit.kink or f"the error of the derivative is {hit.error:.1g}"
            for b in which:
                self.lose(b, time, f"has an impact without a derivative ({why})")
            return True
        p, number = self.parameters, int(row.number)
        done = strike(place, bodies, hit, p.friction[number], p.restitution[number])
        self.write(step.impact, done, hit)
        self.margins += near.of_impact(
            self.system, row, place, tied, bodies, done, hit, u, W, step.impact, p.friction[number]
        )
        parted = self.parted(row, tied, bodies[0], done)
        for b, body in zip(which, done.bodies):
            self.bodies[b] = body
        for b in which:
            self.lose(b, time, "strikes with several points, which do not stay together", parted)
        for a in (self.times, *self.vectors):
            a[step.impact][..., parted] = np.nan
        return True

    def write(self, k: int, done: Strike, hit) -> None:
        """Write the derivatives of an impact."""
        self.times[k], self.errors[k] = done.time, hit.error
        for a, value in zip(self.vectors, (done.point, done.before, done.after, done.impulse)):
            a[k] = value

    def place_of(self, step: Step):
        """Return (row, place, tied vertices) of the point that struck; None if there is not exactly one."""
        contacts = self.system.contacts
        rows = contacts[contacts.number == step.event.contact]
        candidates = []
        for row in rows:
            body = self.bodies[int(row.body)]
            if has_vertices(row):
                gaps = near.vertex_gaps(self.system, row, body)
                closed = np.flatnonzero(gaps <= max(gaps.min(), 0.0) + self.tie * row.extent)
                if gaps.min() <= self.tie * row.extent:
                    tied = self.system.vertices[row.first + closed]
                    candidates.append((row, vertex_place(row, tied.mean(axis=0), body), tied))
            elif is_found(row):
                pair = [body] + ([self.bodies[int(row.other)]] if row.other >= 0 else [])
                place = found_place(self.system, row, pair)
                point = None if place is None else pair[0].x + place.arms[0]
                if point is not None and np.allclose(
                    point, step.row.point, rtol=0.0, atol=1e-6 * float(row.extent)
                ):
                    candidates.append((row, place, np.zeros((1, 3))))
        return candidates[0] if len(candidates) == 1 else None

    def parted(self, row, tied: np.ndarray, body: Moving, done: Strike) -> np.ndarray:
        """Return which parameters (P,) separate points that strike together, by gaps or velocities."""
        P = done.time.size
        apart = np.zeros(P, dtype=bool)
        turn, after = done.poses[3:6], done.bodies[0]
        spin = np.outer(after.spin_rate, done.time) + after.X[9:]
        for core in tied - tied.mean(axis=0) if len(tied) > 1 else ():
            arm = body.R @ core
            shift = cross(turn, arm)
            length = float(np.linalg.norm(arm))
            if not length > 0.0:
                continue  # two pieces of the shape share the vertex
            size = np.linalg.norm(turn, axis=0) + np.linalg.norm(done.poses[:3], axis=0) / length
            apart |= ~(np.abs(row.axes[0] @ shift) <= TIED * length * size)
            for w, dw in ((body.w, done.velocities[0][3:]), (after.w, spin)):
                speed = cross(dw, arm) + cross(w, shift)
                scale = np.linalg.norm(dw, axis=0) + np.linalg.norm(w) * size
                scale = scale + np.linalg.norm(done.velocities[0][:3], axis=0) / length
                apart |= ~(np.linalg.norm(speed, axis=0) <= TIED * length * scale)
        return apart

    def look_between(self, b: int, body: Moving, until: float) -> None:
        """Find the least gaps of a body above half-spaces between impacts."""
        self.margins += near.of_flight(
            self.system, b, body, until, until == float(self.solution.t[-1])
        )


def _same(impulse: np.ndarray, written: np.ndarray) -> bool:
    return bool(np.linalg.norm(impulse - written) <= SAME * np.linalg.norm(written))


def _names(labels, which: np.ndarray) -> str:
    names = [label for label, lost in zip(labels, which) if lost]
    return ", ".join(names[:6]) + (", ..." if len(names) > 6 else "")
