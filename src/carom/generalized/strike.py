"""Impacts at one state: of one contact, or of all closed contacts together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.generalized.solution import CoordinateImpact
from carom.impact import layout as o
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
        self.room: Any = None  # workspace for several contacts, made when it is first needed

    def all(self, closed: list[int], now: float, jams: int) -> int:
        """Resolve impacts until no closed contact approaches; return a status."""
        here = self.contacts
        for _ in range(BLOWS):
            here.look()
            if here.seen.status != 0:
                return here.seen.status
            approach = [c for c in closed if here.u[c, 0] < -here.still[c]]
            if not approach and jams < 0:
                return 0
            if len(closed) == 1:
                code = self.one(closed[0], now, jams >= 0 and not approach)
            else:
                code = self.several(closed, now, jams if not approach else -1)
            if code != 0:
                return code
            jams = -1
        return Status.TOO_MANY_IMPACTS

    def restitution(self, c: int) -> float:
        """Return e of the next impact; 0 if hardly any speed is left after many impacts in one step.

        With tolerances it is many impacts in a row, each after a bounce lower than these.
        """
        here, plan = self.contacts, self.contacts.run.plan
        now = float(here.run.clock[0].now)
        bounce = -float(here.u[c, 0]) * (now - here.struck[c])
        if plan.order > 0 and bounce > plan.atol + plan.rtol:
            here.blows[c] = 0
        here.struck[c] = now
        e, count = float(here.restitution[c]), float(here.blows[c])
        here.blows[c] += 1
        return 0.0 if e < 1.0 and e**count <= SPENT else e

    def one(self, c: int, now: float, jams: bool) -> int:
        """Solve the impact of one contact."""
        here = self.contacts
        G = here.seen.G[c]
        W, u, out = G @ here.P @ G.T, here.u[c].copy(), np.zeros(o.SIZE)
        W = np.ascontiguousarray(0.5 * (W + W.T))
        if jams:
            u[0] = -SEED * np.linalg.norm(u[1:])
        out[o.STILL] = here.still[c]
        mu, e, law = float(here.friction[c]), self.restitution(c), int(here.law[c])
        code = resolve(W, u, mu, e, law, out)
        if code != o.OK:
            return Status.IMPACT_FAILED
        impulse = out[o.IMPULSE : o.IMPULSE + 3].copy()
        self.apply(G, impulse)
        after, works = out[o.VELOCITY : o.VELOCITY + 3], out[[o.WORK_C, o.WORK_R, o.FRICTION_LOSS]]
        wedged = int(out[o.PHASES]) & o.WEDGED != 0
        self.write(c, now, u, after, impulse, W, e, float(out[o.ENERGY_CHANGE]), works, 1, wedged)
        return 0

    def several(self, closed: list[int], now: float, jams: int) -> int:
        """Solve the multiple impact of all closed contacts (mathematics page, part 2)."""
        from carom.impact.layout import OK
        from carom.impact.multiple.layout import (
            MULTIPLE,
            CornerContacts,
            MultipleSettings,
            new_multiple_result,
            new_multiple_workspace,
        )
        from carom.impact.multiple.resolve import resolve_multiple

        here, k = self.contacts, len(closed)
        options, n = here.run.options, here.run.n
        G = here.seen.G[closed].reshape(3 * k, n)
        W = G @ here.P @ G.T
        W = np.ascontiguousarray(0.5 * (W + W.T))
        u = here.u[closed].copy()
        u[np.abs(u[:, 0]) <= here.still[closed], 0] = 0.0
        if jams >= 0:
            i = closed.index(jams)
            u[i, 0] = -SEED * np.linalg.norm(u[i, 1:])
        e = np.array([self.restitution(c) for c in closed])
        settings = MultipleSettings(
            multiple=MULTIPLE[options.multiple], rtol=options.corner_tolerance,
            exponent=options.corner_exponent or 1.0,
        )  # fmt: skip
        if self.room is None:
            self.room = new_multiple_workspace(len(here.friction))
        out = new_multiple_result(k)
        apart = options.multiple == "sequential"
        pair = np.arange(k) if apart else np.zeros(k, dtype=np.int64)
        contacts = CornerContacts(
            k, 0, W, u.reshape(-1), here.friction[closed], e, here.law[closed], np.ones(k), pair
        )
        code = resolve_multiple(contacts, settings, self.room, out)
        if code != OK:
            return Status.IMPACT_FAILED
        p = out.impulse.reshape(k, 3)
        after = out.velocity.reshape(k, 3)
        self.apply(G, out.impulse)
        changes = out.compression + out.restitution - out.friction
        for i, c in enumerate(closed):
            if np.any(p[i] != 0.0):
                own, works = (
                    slice(3 * i, 3 * i + 3),
                    (out.compression[i], out.restitution[i], out.friction[i]),
                )
                self.write(
                    c, now, u[i], after[i], p[i], W[own, own], float(e[i]), float(changes[i]), works, k,
                    out.wedged[i] != 0,
                )  # fmt: skip
        return 0

    def apply(self, G: np.ndarray, impulse: np.ndarray) -> None:
        """Change the velocities by impulses along rows."""
        run = self.contacts.run
        n, M = run.n, self.contacts.seen.M
        v = run.x[n:].copy()
        run.x[n:] += self.contacts.P @ (G.T @ impulse)
        run.clock[0].impacts += 0.5 * (run.x[n:] - v) @ M @ (run.x[n:] + v)

    def write(self, c, now, before, after, impulse, W, e, change, works, together, wedged) -> None:
        """Store the record of an impact; `works`: of compression, of restitution, lost by friction."""
        here = self.contacts
        here.run.counts["impacts"] += 1
        here.events.append((now, "impact", c))
        x, law = here.run.x[: here.run.n].copy(), here.run.user.contacts[c].impact_law
        mu, works = float(here.friction[c]), map(float, works)
        self.records.append(CoordinateImpact(
            now, c, x, before, after, impulse, change, law, W, e, mu, *works,
            together=together, wedged=int(wedged),
        ))  # fmt: skip
