"""Impacts at one state: of one contact, or of all closed contacts together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom._compiled.record_arrays import Columns
from carom.generalized.solution import CoordinateImpact
from carom.generalized.thresholds import STILL_COORDINATE
from carom.impact import layout as o
from carom.impact.resolve import resolve
from carom.impact.tangential import return_slip
from carom.impact.thresholds import GROUP_SEED, NO_RESTITUTION
from carom.law.impact_laws import GAINING
from carom.model.laws import with_slip
from carom.scene.restitution import Restitution
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.run import GeneralizedRun

BLOWS = 200  # impacts at one instant


def rows_of(contacts: list[int]) -> np.ndarray:
    """Return the rows (3 k,) of contacts among those of all contacts."""
    return np.add.outer(3 * np.array(contacts, dtype=int), range(3)).ravel()


class Strike:
    """The contacts of a run at one state, the solver of their impacts, and its records."""

    def __init__(self, run: GeneralizedRun):
        contacts = run.user.contacts
        self.run, self.seen = run, run.made.work
        self.restitution = [one.restitution for one in contacts]
        self.laws = run.made.system.laws
        self.friction = self.laws.table.friction
        self.by_law = with_slip(self.laws.table).view(np.ndarray)
        self.events: list[tuple[float, str, int]] = []
        self.light = 0.0  # kinetic energy that the loads give in a step: less is round-off
        self.records: list[CoordinateImpact] = []
        self.blows = np.zeros(len(contacts), dtype=np.int64)
        self.struck = np.zeros(len(contacts))  # time of the last impact
        self.room: Any = None  # workspace for several contacts, made when it is first needed

    def note(self, what: str, contact: int) -> None:
        """Write an event."""
        self.events.append((self.run.reached, what, contact))

    def look(self) -> int:
        """Evaluate the state without forces of contacts, and the speeds that count as 0; return a status."""
        run, seen, v = self.run, self.seen, self.run.x[self.run.n :]
        code = run.made.compute(run.x, run.reached)
        P = np.linalg.inv(seen.M)
        push = np.sqrt(max(seen.load @ P @ seen.load, 0.0)) * run.plan.step
        self.light = max(self.light, 0.5 * push**2)
        if len(seen.A):
            Y = P @ seen.A.T
            P = P - Y @ np.linalg.pinv(seen.A @ Y, rcond=run.system.drop, hermitian=True) @ Y.T
        self.G, self.P = seen.G.reshape(-1, run.n).copy(), 0.5 * (P + P.T)
        W = self.G @ self.P @ self.G.T
        self.W, self.c = 0.5 * (W + W.T), self.G @ seen.a + seen.G_rate.ravel()
        self.u, self.free = (self.G @ v).reshape(-1, 3), seen.a.copy()
        self.slip = np.linalg.norm(self.u[:, 1:], axis=1)
        self.W_ii = np.diag(self.W).reshape(-1, 3)
        size = np.sqrt(np.maximum(self.W_ii.sum(axis=1), 0.0))
        self.still = STILL_COORDINATE * size * max(np.sqrt(max(v @ seen.M @ v, 0.0)), push)
        return code

    def strike(self, closed: list[int], jams: int = -1) -> int:
        """Resolve impacts until no closed contact approaches; return a status."""
        for _ in range(BLOWS):
            approach = any(self.u[c, 0] < -self.still[c] for c in closed)
            if not approach and jams < 0:
                return 0
            code, jams = self.together(closed, -1 if approach else jams), -1
            if code != 0:
                return code
        return Status.TOO_MANY_IMPACTS

    def count(self, closed: list[int]) -> None:
        """Count blows: in a row are those after a bounce below the tolerances, or shorter than a given step."""
        plan, since = self.run.plan, self.run.reached - self.struck[closed]
        fallen = -self.u[closed, 0] * since
        high = fallen > plan.atol + plan.rtol if plan.order else since > plan.step
        self.blows[closed] = np.where(high, 0, self.blows[closed]) + 1
        self.struck[closed] = self.run.reached

    def restitution_after(self, closed: list[int], before, approach):
        """Return e of contacts after a number of blows in a row; 0 if these have left hardly any speed."""
        given = [self.restitution[c] for c in closed]
        e = np.array(
            [float(one(max(v, 0.0))) if isinstance(one, Restitution) else one
             for one, v in zip(given, approach)]
        )  # fmt: skip
        return np.where((e < 1.0) & (e**before <= NO_RESTITUTION), 0.0, e)

    def together(self, closed: list[int], jams: int) -> int:
        """Change the velocities by the impact of closed contacts; return a status."""
        run, k, rows = self.run, len(closed), rows_of(closed)
        M, v, W = self.seen.M, run.x[run.n :].copy(), self.W[np.ix_(rows, rows)]
        u = self.u[closed]
        u[np.abs(u[:, 0]) <= self.still[closed], 0] = 0.0
        if jams >= 0:
            i = closed.index(jams)
            u[i, 0] = -GROUP_SEED * np.linalg.norm(u[i, 1:])
        self.count(closed)
        mu, e = (
            self.friction[closed],
            self.restitution_after(closed, self.blows[closed] - 1.0, -u[:, 0]),
        )
        code, after, p, works, wedged = self.solve(W, u, mu, e, closed)
        if code != o.OK:
            return Status.IMPACT_FAILED
        run.x[run.n :] += self.P @ (self.G[rows].T @ p.ravel())
        run.clock[0].impacts += 0.5 * (run.x[run.n :] - v) @ M @ (run.x[run.n :] + v)
        for i in np.flatnonzero(np.any(p != 0.0, axis=1)):
            own, parts = slice(3 * i, 3 * i + 3), works[:, i].tolist()
            change = parts[0] + parts[1] - parts[2]
            if self.laws.table.impact_law[closed[i]] in GAINING and mu[i] > 0.0:
                run.clock[0].given += max(change, 0.0)
            self.note("impact", closed[i])
            self.records.append(CoordinateImpact(
                run.reached, closed[i], run.x[: run.n].copy(), u[i], after[i], p[i],
                change, run.user.contacts[closed[i]].impact_law, W[own, own],
                float(e[i]), float(mu[i]), *parts, together=k, wedged=int(wedged[i] != 0),
            ))  # fmt: skip
        return self.look()

    def solve(self, W, u, mu, e, closed):
        """Return code, velocities (k, 3), impulses (k, 3), works (3, k) and wedged (k,) of an impact.

        Of several contacts, or with a law of friction, it is a multiple impact (mathematics page, part 2).
        """
        table = self.laws.table[closed].view(Columns)
        if len(closed) == 1 and not self.by_law[closed[0]]:
            out = np.zeros((o.SIZE, 1))
            out[o.STILL] = self.still[closed]
            code = resolve(W, u[0].copy(), mu[0], e[0], table.impact_law[0], out[:, 0])
            if code == o.OK and (e_t := table.tangential_restitution[0]) != 0.0:
                return_slip(W, u[0].copy(), mu[0], e_t, out[:, 0])
            after, p = (out[at : at + 3].T for at in (o.VELOCITY, o.IMPULSE))
            works, phases = out[[o.WORK_C, o.WORK_R, o.FRICTION_LOSS]], out[o.PHASES].astype(int)
            return code, after, p, works, phases & o.WEDGED
        from carom.impact.multiple import api
        from carom.impact.multiple.layout import multiple_settings
        from carom.impact.multiple.workspace import new_multiple_workspace

        if self.room is None:
            self.room = new_multiple_workspace(len(self.blows))
        settings = multiple_settings(self.run.options, 1.0)
        table["restitution"] = e
        laws = self.laws._replace(table=table)
        code, found = api.solve(W, u, laws, settings, self.room)
        after, p = found.velocity.reshape(-1, 3), found.impulse.reshape(-1, 3)
        works = np.array([found.compression, found.restitution, found.friction])
        return code, after, p, works, found.wedged
