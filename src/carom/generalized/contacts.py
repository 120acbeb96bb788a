"""Events of contacts: impacts, new active contacts, stick, slip and opening.

They are handled at one state, in NumPy arrays; the kernels for scenes of bodies solve the impact and the
contact problem.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.generalized.step import project
from carom.generalized.strike import Strike
from carom.impact.laws import NUMBERS
from carom.model.actions import (
    EVENT_CONE,
    EVENT_GAP,
    EVENT_JAM,
    EVENT_REVERSE,
    EVENT_SEPARATE,
    MODE_SLIP,
    MODE_STICK,
)
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.run import GeneralizedRun

STILL = 1e-12  # relative to the speeds of a contact: a relative velocity that is round-off
CONTACT_ROUNDS = 50


class Contacts:
    """The contacts of a run, with their active set and their events."""

    def __init__(self, run: GeneralizedRun):
        contacts = run.user.contacts
        self.run, self.seen = run, run.made.work
        self.restitution = np.array([one.restitution for one in contacts])
        self.friction = np.array([one.friction for one in contacts])
        self.law = np.array([NUMBERS[one.impact_law] for one in contacts], dtype=np.int64)
        self.events: list[tuple[float, str, int]] = []
        self.strike = Strike(self)
        self.light = 0.0  # kinetic energy that the loads give in a step: less is round-off
        self.cones: Any = None  # workspace of the contact problem, made when it is first needed
        # the event that is handled: its kind, its active contact, and what was active before it
        self.kind, self.marked, self.was = 0, -1, {}

    def note(self, what: str, contact: int) -> None:
        """Write an event."""
        self.events.append((self.run.reached, what, contact))

    # --- quantities of the state ---------------------------------------------------------------

    def look(self) -> int:
        """Evaluate the state without forces of contacts; return a status.

        Compute P, the relative velocities u (C, 3), the speeds that count as 0 (C,), and the acceleration.
        """
        run, seen, v = self.run, self.seen, self.run.x[self.run.n :]
        code = run.made.compute(run.x, run.reached)
        P = np.linalg.inv(seen.M)
        push = np.sqrt(max(seen.load @ P @ seen.load, 0.0)) * run.plan.step
        self.light = max(self.light, 0.5 * push**2)
        if len(seen.A):
            Y = P @ seen.A.T
            P = P - Y @ np.linalg.pinv(seen.A @ Y, rcond=run.system.drop, hermitian=True) @ Y.T
        self.P, self.free = 0.5 * (P + P.T), seen.a.copy()
        self.u = seen.G @ v
        self.slip = np.linalg.norm(self.u[:, 1:], axis=1)
        self.W_ii = np.einsum("cin,nm,cim->ci", seen.G, self.P, seen.G)
        size = np.sqrt(np.maximum(self.W_ii.sum(axis=1), 0.0))
        speed = size * max(np.sqrt(max(v @ seen.M @ v, 0.0)), push)
        self.still = STILL * speed
        # at rest in the origin a gap has no terms, but a step has a length
        np.maximum(run.work.gap_scale, speed * run.plan.step, out=run.work.gap_scale)
        return code

    def active(self) -> list[int]:
        """Return the contacts that are active."""
        return self.run.active.contact[: self.run.active.count[0]].tolist()

    def closed(self, struck: int) -> list[int]:
        """Return the closed contacts: active, just located, or with a gap that counts as zero."""
        near = self.seen.gap <= self.run.options.tie_tolerance * self.run.work.gap_scale
        near[[*self.active(), *([struck] if struck >= 0 else [])]] = True
        return np.flatnonzero(near).tolist()

    # --- one event --------------------------------------------------------------------------------

    def resolve(self, kind: int, index: int) -> int:
        """Handle the located event (kind 0: the start of the run); return a status."""
        run, active = self.run, self.run.active
        if run.system.size[3] == 0:
            return 0
        before = run.x.copy()
        struck = index if kind == EVENT_GAP else -1
        self.kind, self.marked = kind, -1 if kind == EVENT_GAP else index
        parts = (
            one[: active.count[0]].copy() for one in (active.mode, active.heading, active.force)
        )
        self.was = dict(zip(self.active(), zip(*parts)))
        code = self.return_to(struck) if struck >= 0 else 0
        if code == 0:
            code = self.look()
        if code == 0:
            closed = self.closed(struck)
            code = self.strike.all(closed, self.marked if kind == EVENT_JAM else -1)
        if code == 0 and run.options.hold:
            code = self.set_active(self.chosen(closed, struck), closed)
        if code == 0:
            self.note_changes()
            run.nodes.append((run.reached, before, run.x.copy()))
        return code

    def project(self) -> int:
        """Project the state to constraints and active contacts; return a status."""
        run = self.run
        return project(run.system, run.active, run.reached, run.x, True, run.work)

    def return_to(self, contact: int) -> int:
        """Remove round-off of the gap of a contact from the located state; return a status."""
        run, active = self.run, self.run.active
        k = int(active.count[0])
        active.contact[k], active.mode[k], active.count[0] = contact, MODE_SLIP, k + 1
        code = project(run.system, active, run.reached, run.x, False, run.work)
        active.count[0] = k
        if code == 0 and (run.system.size[2] > 0 or k > 0):
            code = self.project()
        return Status.RETURN_MAP_FAILED if code == Status.CONSTRAINTS_LOST else code

    def note_changes(self) -> None:
        """Write the events of contacts whose mode has changed."""
        modes = dict(zip(self.active(), self.run.active.mode.tolist()))
        for c in {**self.was, **modes}:
            if c not in modes:
                self.note("opens", c)
            elif c not in self.was:
                self.note("held", c)
            elif modes[c] != self.was[c][0]:
                self.note("sticks" if modes[c] == MODE_STICK else "slips", c)
            elif c == self.marked and self.kind == EVENT_REVERSE:
                self.note("slips", c)

    # --- persistent contacts ----------------------------------------------------------------------

    def activate(self, chosen: list[int], stick=()) -> None:
        """Make contacts active: those in `stick` stick, the others slip without friction."""
        active, k = self.run.active, len(chosen)
        active.count[0], active.contact[:k], active.heading[:k] = k, chosen, 0.0
        active.mode[:k] = [MODE_STICK if c in stick else MODE_SLIP for c in chosen]

    def chosen(self, closed: list[int], struck: int) -> list[int]:
        """Return the closed contacts that stay active or become active."""
        run, seen, size = self.run, self.seen, self.free @ self.seen.M @ self.free
        gone = self.marked if self.kind == EVENT_SEPARATE else -1
        kept = [c for c in self.active() if c != gone and not self.u[c, 0] > 10.0 * self.still[c]]
        for c in sorted(set(closed) - {gone} - set(kept), key=lambda c: abs(self.u[c, 0])):
            self.activate(kept)
            run.made.compute(run.x, run.reached, run.active)
            draw = -(seen.G[c, 0] @ seen.a + seen.G_rate[c, 0])
            # a contact that others keep closed (the fourth leg of a table) was located by round-off
            least = -1e-9 if c == struck and kept else 1e-12
            if draw > least * np.sqrt(size * self.W_ii[c, 0]) and self.stays(c, draw):
                kept.append(c)
        return kept

    def stays(self, c: int, draw: float) -> bool:
        """Return whether the bounces of a contact with the acceleration `draw` end within a step."""
        u, e = (
            float(self.u[c, 0]),
            self.strike.left(c) if self.strike.blows[c] else self.restitution[c],
        )
        if not u >= -10.0 * self.still[c]:
            return False
        return u <= self.still[c] or (
            e < 1.0 and 2.0 * u < draw * (1.0 - e) * self.run.moment(draw)
        )

    def set_active(self, chosen: list[int], closed: list[int]) -> int:
        """Make `chosen` active: find stick or slip of each from the accelerations; return a status."""
        from carom.friction.layout import CONE, SLIDING, SOLVED, new_contact_work
        from carom.friction.solve import solve_cones

        run, seen = self.run, self.seen
        if self.cones is None:
            self.cones = new_contact_work(len(self.friction))
        for _ in range(CONTACT_ROUNDS):
            k = len(chosen)
            code = self.take_out(chosen)
            if k == 0 or code != 0:
                return code
            driven = [c for c in closed if c not in chosen and self.u[c, 0] < -10.0 * self.still[c]]
            if driven:  # by the change of the others
                chosen = chosen + driven
                continue
            G = seen.G[chosen].reshape(3 * k, run.n)
            W = G @ self.P @ G.T
            c0 = G @ self.free + seen.G_rate[chosen].reshape(3 * k)
            mu, p, heading = self.friction[chosen], np.zeros(3 * k), self.headings(chosen)
            kinds = np.where(heading.any(axis=1), SLIDING, CONE)
            status, _, _ = solve_cones(k, W, c0, mu, kinds, heading, p, self.cones)
            if status != SOLVED:
                own = W.reshape(k, 3, k, 3)[range(k), 0, range(k)]
                yields = own[:, 0] - mu * np.sum(heading * own[:, 1:], axis=1)  # W_nn - mu W_nt . e
                jams = [c for c, left in zip(chosen, yields) if left <= 0.0]
                code = self.strike.all(chosen, jams[0]) if jams else Status.NO_CONVERGENCE
                if code != 0:
                    return code
                chosen = [c for c in chosen if not self.u[c, 0] > 10.0 * self.still[c]]
                continue
            p, w = p.reshape(k, 3), W[::3] @ p + c0[::3]
            least = 1e-12 * np.max(np.abs(c0))
            pressed = [c for i, c in enumerate(chosen) if p[i, 0] > 0.0 or abs(w[i]) <= least]
            if len(pressed) == k:
                self.write_held(chosen, p, heading)
                return 0
            chosen = pressed
        return Status.NO_CONVERGENCE

    def take_out(self, chosen: list[int]) -> int:
        """Activate contacts: remove their normal velocities, and slip that has stopped; return a status."""
        run, n, M = self.run, self.run.n, self.seen.M.copy()
        stop = np.where(self.friction > 0.0, 10.0 * self.still, -1.0)
        if self.kind == EVENT_REVERSE:  # speed that friction removes in a thousandth of a step
            c = self.marked
            brake = self.friction[c] * abs(self.was[c][2][0]) * float(self.W_ii[c, 1:].sum())
            stop[c] = max(stop[c], 1e-3 * run.moment(brake) * brake)
        v = run.x[n:].copy()
        self.activate(chosen, np.flatnonzero(self.slip <= stop))
        code = self.project() if chosen else 0
        run.clock[0].bounces += 0.5 * (run.x[n:] - v) @ M @ (run.x[n:] + v)
        return code or self.look()

    def headings(self, chosen: list[int]) -> np.ndarray:
        """Return the directions of slip (k, 2); 0 for a contact that is free to stick or slip."""
        along = np.where((self.slip > 10.0 * self.still)[:, None], self.u[:, 1:], 0.0)
        if self.kind == EVENT_CONE and not along[self.marked].any():
            along[self.marked] = -self.was[self.marked][2][1:]  # stick has just ended
        along[self.friction == 0.0] = 0.0
        return along[chosen] / np.maximum(np.linalg.norm(along[chosen], axis=1), 1e-300)[:, None]

    def write_held(self, chosen: list[int], p: np.ndarray, heading: np.ndarray) -> None:
        """Write forces p (k, 3) of active contacts, and whether each sticks."""
        active, was = self.run.active, self.was
        for i, c in enumerate(chosen):
            active.mode[i], active.force[i], active.heading[i] = MODE_SLIP, p[i], heading[i]
            if heading[i].any() or not self.friction[c] > 0.0:
                continue
            pull, most = float(np.linalg.norm(p[i, 1:])), self.friction[c] * p[i, 0]
            if pull <= most * (1.0 - 1e-10) or (c in was and was[c][0] == MODE_STICK):
                active.mode[i] = MODE_STICK
            elif pull > 0.0:
                active.heading[i] = -p[i, 1:] / pull
            elif c in was:
                active.heading[i] = was[c][1]
