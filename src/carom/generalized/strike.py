"""Impacts at one state: of one contact, or of all closed contacts together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.generalized.solution import CoordinateImpact
from carom.impact import layout as o
from carom.impact.laws import GAINING
from carom.impact.resolve import resolve
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.contacts import Contacts

BLOWS = 200  # impacts at one instant
SEED = 1e-7  # approach of a contact that jams, relative to its slip (mathematics page, §3.6)
SPENT = 1e-6  # relative to the first impact of a step: slower ones have no restitution


class Strike:
    """Solver of the impacts of a run, with their records."""

    def __init__(self, contacts: Contacts):
        self.contacts = contacts
        self.records: list[CoordinateImpact] = []
        self.blows = np.zeros(len(contacts.law), dtype=np.int64)
        self.struck = np.zeros(len(contacts.law))  # time of the last impact
        self.room: Any = None  # workspace for several contacts, made when it is first needed

    def all(self, closed: list[int], jams: int = -1) -> int:
        """Resolve impacts until no closed contact approaches; return a status."""
        here = self.contacts
        for _ in range(BLOWS):
            approach = [c for c in closed if here.u[c, 0] < -here.still[c]]
            if not approach and jams < 0:
                return 0
            if not self.together(closed, jams if not approach else -1):
                return Status.IMPACT_FAILED
            code, jams = here.look(), -1
            if code != 0:
                return code
        return Status.TOO_MANY_IMPACTS

    def restitution(self, c: int) -> float:
        """Return e of the next impact; 0 if hardly any speed is left after many impacts in one step.

        With tolerances it is many impacts in a row, each after a bounce lower than these.
        """
        here, plan = self.contacts, self.contacts.run.plan
        bounce = -float(here.u[c, 0]) * (here.run.reached - self.struck[c])
        if plan.order > 0 and bounce > plan.atol + plan.rtol:
            self.blows[c] = 0
        self.struck[c] = here.run.reached
        e = self.left(c)
        self.blows[c] += 1
        return e

    def left(self, c: int) -> float:
        """Return e of a contact, or 0 if its impacts have left hardly any speed."""
        e = float(self.contacts.restitution[c])
        return 0.0 if e < 1.0 and e ** float(self.blows[c]) <= SPENT else e

    def together(self, closed: list[int], jams: int) -> bool:
        """Change the velocities by the impact of closed contacts; return whether it was solved."""
        here, run, k = self.contacts, self.contacts.run, len(closed)
        M, v = here.seen.M, run.x[run.n :].copy()
        G = here.seen.G[closed].reshape(3 * k, run.n)
        W = G @ here.P @ G.T
        W = np.ascontiguousarray(0.5 * (W + W.T))
        u = here.u[closed].copy()
        u[np.abs(u[:, 0]) <= here.still[closed], 0] = 0.0
        if jams >= 0:
            i = closed.index(jams)
            u[i, 0] = -SEED * np.linalg.norm(u[i, 1:])
        mu, e = here.friction[closed], np.array([self.restitution(c) for c in closed])
        solve = self.alone if k == 1 else self.several
        found = solve(W, u, mu, e, closed)
        if found is None:
            return False
        after, p, works, wedged = found
        run.x[run.n :] += here.P @ (G.T @ p.ravel())
        run.clock[0].impacts += 0.5 * (run.x[run.n :] - v) @ M @ (run.x[run.n :] + v)
        for i in np.flatnonzero(np.any(p != 0.0, axis=1)):
            own, parts = slice(3 * i, 3 * i + 3), [float(one[i]) for one in works]
            change = parts[0] + parts[1] - parts[2]
            if here.law[closed[i]] in GAINING and mu[i] > 0.0:
                run.clock[0].given += max(change, 0.0)
            here.note("impact", closed[i])
            self.records.append(CoordinateImpact(
                run.reached, closed[i], run.x[: run.n].copy(), u[i], after[i], p[i],
                change, run.user.contacts[closed[i]].impact_law, W[own, own],
                float(e[i]), float(mu[i]), *parts, together=k, wedged=int(wedged[i]),
            ))  # fmt: skip
        return True

    def alone(self, W, u, mu, e, closed):
        """Return velocity, impulse, works and wedged of an impact of one contact; None without a solution."""
        out, (c,) = np.zeros(o.SIZE), closed
        out[o.STILL] = self.contacts.still[c]
        if resolve(W, u[0].copy(), mu[0], e[0], self.contacts.law[c], out) != o.OK:
            return None
        works = out[[o.WORK_C, o.WORK_R, o.FRICTION_LOSS], None]
        wedged = [int(out[o.PHASES]) & o.WEDGED != 0]
        return (
            out[None, o.VELOCITY : o.VELOCITY + 3],
            out[None, o.IMPULSE : o.IMPULSE + 3],
            works,
            wedged,
        )

    def several(self, W, u, mu, e, closed):
        """Return the same of the multiple impact of several contacts (mathematics page, part 2)."""
        from carom.impact.multiple.api import solve
        from carom.impact.multiple.layout import multiple_settings, new_multiple_workspace

        here, k = self.contacts, len(closed)
        if self.room is None:
            self.room = new_multiple_workspace(len(here.law))
        settings = multiple_settings(here.run.options, 1.0)
        code, out = solve(W, u, mu, e, here.law[closed], np.ones(k), settings, self.room)
        if code != o.OK:
            return None
        works = out.compression, out.restitution, out.friction
        return out.velocity.reshape(k, 3), out.impulse.reshape(k, 3), works, out.wedged
