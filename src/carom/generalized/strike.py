"""Impacts at one state: of one contact, or of all closed contacts together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.generalized.solution import CoordinateImpact
from carom.impact import layout as o
from carom.impact.laws import GAINING
from carom.impact.resolve import resolve
from carom.impact.thresholds import GROUP_SEED, NO_RESTITUTION
from carom.scene.restitution import Restitution
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.contacts import Contacts

BLOWS = 200  # impacts at one instant


def rows_of(contacts: list[int]) -> np.ndarray:
    """Return the rows (3 k,) of contacts among those of all contacts."""
    return np.add.outer(3 * np.array(contacts, dtype=int), range(3)).ravel()


class Strike:
    """Solver of the impacts of a run, with their records."""

    def __init__(self, contacts: Contacts):
        self.contacts, self.run = contacts, contacts.run
        self.records: list[CoordinateImpact] = []
        self.blows = np.zeros(len(contacts.law), dtype=np.int64)
        self.struck = np.zeros(len(contacts.law))  # time of the last impact
        self.room: Any = None  # workspace for several contacts, made when it is first needed

    def all(self, closed: list[int], jams: int = -1) -> int:
        """Resolve impacts until no closed contact approaches; return a status."""
        here = self.contacts
        for _ in range(BLOWS):
            approach = any(here.u[c, 0] < -here.still[c] for c in closed)
            if not approach and jams < 0:
                return 0
            code, jams = self.together(closed, -1 if approach else jams), -1
            if code != 0:
                return code
        return Status.TOO_MANY_IMPACTS

    def count(self, closed: list[int]) -> None:
        """Count blows: in a row are those after a bounce below the tolerances, or shorter than a given step."""
        here, plan, since = self.contacts, self.run.plan, self.run.reached - self.struck[closed]
        fallen = -here.u[closed, 0] * since
        high = fallen > plan.atol + plan.rtol if plan.order else since > plan.step
        self.blows[closed] = np.where(high, 0, self.blows[closed]) + 1
        self.struck[closed] = self.run.reached

    def restitution(self, closed: list[int], before, approach):
        """Return e of contacts after a number of blows in a row; 0 if these have left hardly any speed."""
        given = [self.contacts.restitution[c] for c in closed]
        e = np.array(
            [float(one(max(v, 0.0))) if isinstance(one, Restitution) else one
             for one, v in zip(given, approach)]
        )  # fmt: skip
        return np.where((e < 1.0) & (e**before <= NO_RESTITUTION), 0.0, e)

    def together(self, closed: list[int], jams: int) -> int:
        """Change the velocities by the impact of closed contacts; return a status."""
        here, run, k, rows = self.contacts, self.run, len(closed), rows_of(closed)
        M, v, W = here.seen.M, run.x[run.n :].copy(), here.W[np.ix_(rows, rows)]
        u = here.u[closed]
        u[np.abs(u[:, 0]) <= here.still[closed], 0] = 0.0
        if jams >= 0:
            i = closed.index(jams)
            u[i, 0] = -GROUP_SEED * np.linalg.norm(u[i, 1:])
        self.count(closed)
        mu, e = here.friction[closed], self.restitution(closed, self.blows[closed] - 1.0, -u[:, 0])
        code, after, p, works, wedged = self.solve(W, u, mu, e, closed)
        if code != o.OK:
            return Status.IMPACT_FAILED
        run.x[run.n :] += here.P @ (here.G[rows].T @ p.ravel())
        run.clock[0].impacts += 0.5 * (run.x[run.n :] - v) @ M @ (run.x[run.n :] + v)
        for i in np.flatnonzero(np.any(p != 0.0, axis=1)):
            own, parts = slice(3 * i, 3 * i + 3), works[:, i].tolist()
            change = parts[0] + parts[1] - parts[2]
            if here.law[closed[i]] in GAINING and mu[i] > 0.0:
                run.clock[0].given += max(change, 0.0)
            here.note("impact", closed[i])
            self.records.append(CoordinateImpact(
                run.reached, closed[i], run.x[: run.n].copy(), u[i], after[i], p[i],
                change, run.user.contacts[closed[i]].impact_law, W[own, own],
                float(e[i]), float(mu[i]), *parts, together=k, wedged=int(wedged[i] != 0),
            ))  # fmt: skip
        return here.look()

    def solve(self, W, u, mu, e, closed):
        """Return code, velocities (k, 3), impulses (k, 3), works (3, k) and wedged (k,) of an impact.

        Of several contacts it is a multiple impact (mathematics page, part 2).
        """
        law = self.contacts.law[closed]
        if len(closed) == 1:
            out = np.zeros((o.SIZE, 1))
            out[o.STILL] = self.contacts.still[closed]
            code = resolve(W, u[0].copy(), mu[0], e[0], law[0], out[:, 0])
            after, p = (out[at : at + 3].T for at in (o.VELOCITY, o.IMPULSE))
            works, phases = out[[o.WORK_C, o.WORK_R, o.FRICTION_LOSS]], out[o.PHASES].astype(int)
            return code, after, p, works, phases & o.WEDGED
        from carom.impact.multiple import api
        from carom.impact.multiple.layout import multiple_settings, new_multiple_workspace

        if self.room is None:
            self.room = new_multiple_workspace(len(self.blows))
        settings = multiple_settings(self.run.options, 1.0)
        code, found = api.solve(W, u, mu, e, law, np.ones(len(u)), settings, self.room)
        after, p = found.velocity.reshape(-1, 3), found.impulse.reshape(-1, 3)
        works = np.array([found.compression, found.restitution, found.friction])
        return code, after, p, works, found.wedged
