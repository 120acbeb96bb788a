"""Events of contacts: impacts, new active contacts, stick, slip and opening.

They are handled at one state, in NumPy arrays; the kernels for scenes of bodies solve the impact and the
contact problem. With P = M^-1 less its part along the constraints, and rows (n, t1, t2) of all contacts,

    u = G v,    W = G P G^T,    du/dt = W p + c,    c = G a + (dG/dt) v,    a without forces of contacts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.friction.layout import CONE, SLIDING, SOLVED, ContactProblem, new_contact_work
from carom.friction.solve import solve_cones
from carom.generalized.step import project
from carom.generalized.strike import Strike, rows_of
from carom.generalized.thresholds import (
    CLOSED_DRAW,
    CONE_ERROR,
    CONE_PART,
    DRAW,
    PRESSED,
    REVERSED_PART,
)
from carom.geometry.thresholds import SMALLEST
from carom.model import actions as a
from carom.persistent.thresholds import MOST_BOUNCES
from carom.scene.restitution import Restitution
from carom.status import Status

if TYPE_CHECKING:
    from carom.generalized.run import GeneralizedRun

CONTACT_ROUNDS = 50


class Contacts(Strike):
    """The contacts of a run, with their active set and their events."""

    def __init__(self, run: GeneralizedRun):
        super().__init__(run)
        self.cones: Any = None  # workspace of the contact problem, made when it is first needed
        # the event that is handled: its kind, its persistent contact, and the contacts before it
        self.kind, self.marked, self.was = 0, -1, run.active

    def closed(self, struck: int) -> list[int]:
        """Return the closed contacts: persistent, just located, or with a gap that counts as zero."""
        near = self.seen.gap <= self.run.options.tie_tolerance * self.run.work.gap_scale
        near |= (self.run.active.mode != a.MODE_OPEN) | (np.arange(len(near)) == struck)
        return np.flatnonzero(near).tolist()

    # --- one event --------------------------------------------------------------------------------

    def resolve(self, kind: int, index: int) -> int:
        """Handle the located event (kind 0: the start of the run); return a status."""
        run = self.run
        if run.system.contacts == 0:
            return 0
        before, self.kind, self.was = run.x.copy(), kind, run.active.copy()
        struck, self.marked = (index, -1) if kind == a.EVENT_GAP else (-1, index)
        code = (self.return_to(struck) if struck >= 0 else 0) or self.look()
        if code != 0:
            return code
        closed = self.closed(struck)
        code = self.strike(closed, self.marked if kind == a.EVENT_JAM else -1)
        if code == 0 and run.options.hold:
            code = self.set_active(self.chosen(closed, struck), closed)
        if code == 0:
            self.note_changes()
            run.nodes.append((run.reached, before, run.x.copy(), run.active.copy()))
        return code

    def project(self) -> int:
        """Project the state to constraints and active contacts; return a status."""
        run = self.run
        return project(run.system, run.active, run.reached, run.x, True, run.work)

    def return_to(self, contact: int) -> int:
        """Remove round-off of the gap of a contact from the located state; return a status.

        An approach of round-off would close it again at once.
        """
        run, active = self.run, self.run.active
        active.mode[contact] = a.MODE_SLIP
        code = project(run.system, active, run.reached, run.x, False, run.work)
        active.mode[contact] = a.MODE_OPEN
        code = code or self.project()
        return Status.RETURN_MAP_FAILED if code == Status.CONSTRAINTS_LOST else code

    def note_changes(self) -> None:
        """Write the events of contacts whose mode has changed."""
        for c, (was, mode) in enumerate(zip(self.was.mode, self.run.active.mode)):
            if mode != was and a.MODE_OPEN in (mode, was):
                self.note("opens" if mode == a.MODE_OPEN else "held", c)
            elif mode != was or (c == self.marked and self.kind == a.EVENT_REVERSE):
                self.note("sticks" if mode == a.MODE_STICK else "slips", c)

    # --- persistent contacts ----------------------------------------------------------------------

    def chosen(self, closed: list[int], struck: int) -> list[int]:
        """Return the closed contacts that stay active or become active."""
        W, size = self.W, self.free @ self.seen.M @ self.free
        gone = self.marked if self.kind == a.EVENT_SEPARATE else -1
        held = np.flatnonzero(self.run.active.mode).tolist()
        kept = [c for c in held if c != gone and not self.u[c, 0] > 10.0 * self.still[c]]
        for c in sorted(set(closed) - {gone} - set(kept), key=lambda c: abs(self.u[c, 0])):
            normal = 3 * np.array(kept, dtype=int)  # others keep their normal velocities
            press = np.linalg.pinv(W[np.ix_(normal, normal)], rcond=self.run.system.drop)
            draw = W[3 * c, normal] @ press @ self.c[normal] - self.c[3 * c]
            # a contact that others keep closed (the fourth leg of a table) was located by round-off
            least = -CLOSED_DRAW if c == struck and kept else DRAW
            if draw > least * np.sqrt(size * self.W_ii[c, 0]) and self.stays(c, draw):
                kept.append(c)
        return sorted(kept)

    def stays(self, c: int, draw: float) -> bool:
        """Return whether the bounces of a contact with the acceleration `draw` end within a step."""
        u, still = float(self.u[c, 0]), self.still[c]
        e = float(self.restitution_after([c], self.blows[c], [u])[0])
        rest, time = u, 0.0
        if isinstance(law := self.restitution[c], Restitution) and u > still:
            for _ in range(MOST_BOUNCES):  # as `carom.persistent.bounces` adds them up
                time, rest = time + 2.0 * rest / draw, rest * e
                e = float(law(rest))
        ends = e < 1.0 and 2.0 * rest < draw * (1.0 - e) * (self.run.moment(draw) - time)
        return -10.0 * still <= u and (u <= still or ends)

    def set_active(self, chosen: list[int], closed: list[int]) -> int:
        """Make `chosen` active: find stick or slip of each from the accelerations; return a status."""
        if self.cones is None:
            self.cones = new_contact_work(len(self.friction))
        self.loose = np.zeros((len(self.friction), 2))
        for _ in range(CONTACT_ROUNDS):
            k = len(chosen)
            code = self.remove_contacts(chosen)
            if k == 0 or code != 0:
                return code
            driven = [c for c in closed if c not in chosen and self.u[c, 0] < -10.0 * self.still[c]]
            if driven:  # by the change of the others
                chosen = sorted(chosen + driven)
                continue
            rows = rows_of(chosen)
            W, c0, p = self.W[np.ix_(rows, rows)], self.c[rows], np.zeros(3 * k)
            heading = self.headings(chosen)
            mu = self.friction_along(chosen, heading)
            kinds = np.where(heading.any(axis=1), SLIDING, CONE)
            status, _, _ = solve_cones(k, ContactProblem(W, c0, mu, kinds, heading), p, self.cones)
            if status != SOLVED:
                own = W.reshape(k, 3, k, 3)[range(k), 0, range(k)]
                yields = own[:, 0] - mu * np.sum(heading * own[:, 1:], axis=1)  # W_nn - mu W_nt . e
                jams = [c for c, left in zip(chosen, yields) if left <= 0.0]
                code = self.strike(chosen, jams[0]) if jams else Status.NO_CONVERGENCE
                if code != 0:
                    return code
                chosen = [c for c in chosen if not self.u[c, 0] > 10.0 * self.still[c]]
                continue
            p, w = p.reshape(k, 3), W[::3] @ p + c0[::3]
            least = PRESSED * np.max(np.abs(c0))
            pressed = [c for i, c in enumerate(chosen) if p[i, 0] > 0.0 or abs(w[i]) <= least]
            if len(pressed) == k:
                if self.breaks_away(chosen, p, heading):
                    continue
                self.write_held(chosen, p, heading)
                return 0
            chosen = pressed
        return Status.NO_CONVERGENCE

    def remove_contacts(self, chosen: list[int]) -> int:
        """Activate contacts: remove their normal velocities, and slip that has stopped; return a status."""
        run, active, M = self.run, self.run.active, self.seen.M.copy()
        stop = np.where(self.friction > 0.0, 10.0 * self.still, -1.0)
        if self.kind == a.EVENT_REVERSE:  # speed that all friction removes in .001 of a step
            c, friction = self.marked, self.friction @ np.abs(self.was.force[:, 0])
            brake = float(friction * self.W_ii[c, 1:].sum())
            stop[c] = max(stop[c], REVERSED_PART * run.moment(brake) * brake)
        v = run.x[run.n :].copy()
        active["mode"], active["heading"], active["force"] = a.MODE_OPEN, 0.0, 0.0
        active.mode[chosen] = np.where((self.slip <= stop)[chosen], a.MODE_STICK, a.MODE_SLIP)
        code = self.project() if chosen else 0
        run.clock[0].bounces += 0.5 * (run.x[run.n :] - v) @ M @ (run.x[run.n :] + v)
        return code or self.look()

    def headings(self, chosen: list[int]) -> np.ndarray:
        """Return the directions of slip (k, 2); 0 for a contact that is free to stick or slip."""
        along = np.where((self.slip > 10.0 * self.still)[:, None], self.u[:, 1:], 0.0)
        if self.kind == a.EVENT_CONE and not along[self.marked].any():
            along[self.marked] = -self.was.force[self.marked, 1:]  # stick has just ended
        along[self.loose.any(axis=1)] = self.loose[self.loose.any(axis=1)]
        along[self.friction == 0.0] = 0.0
        return along[chosen] / np.maximum(np.linalg.norm(along[chosen], axis=1), SMALLEST)[:, None]

    def friction_along(self, chosen: list[int], heading: np.ndarray) -> np.ndarray:
        """Return mu (k,) of contacts: by laws that of their slip, and where they may stick its bound."""
        mu, laws = self.friction[chosen], self.run.user.contacts
        for i, c in enumerate(chosen):
            if self.by_law[c] and heading[i].any():
                mu[i] = laws[c].friction(self.slip[c])
        return mu

    def breaks_away(self, chosen: list[int], p: np.ndarray, heading: np.ndarray) -> bool:
        """Note contacts with laws that cannot stick, and their directions of slip; return whether there are."""
        pull = np.linalg.norm(p[:, 1:], axis=1)
        fails = self.by_law[chosen] & ~heading.any(axis=1) & (self.was.mode[chosen] != a.MODE_STICK)
        fails &= pull > (1.0 - CONE_PART) * self.friction[chosen] * p[:, 0]
        fails &= pull > CONE_ERROR * np.max(p[:, 0])
        self.loose[np.array(chosen)[fails]] = -p[fails, 1:] / pull[fails, None]
        return bool(fails.any())

    def write_held(self, chosen: list[int], p: np.ndarray, heading: np.ndarray) -> None:
        """Write forces p (k, 3) of active contacts, and whether each sticks; so does what others hold alone."""
        active, was, mu = self.run.active, self.was, self.friction[chosen]
        pull, most = np.linalg.norm(p[:, 1:], axis=1), mu * p[:, 0]
        free = (mu > 0.0) & ~heading.any(axis=1)
        within = pull <= np.maximum(most * (1.0 - CONE_PART), CONE_ERROR * np.max(p[:, 0]))
        sticks = free & (within | (was.mode[chosen] == a.MODE_STICK))
        turned = np.where(
            pull > 0.0, -p[:, 1:].T / np.maximum(pull, SMALLEST), was.heading[chosen].T
        )
        active.mode[chosen] = np.where(sticks, a.MODE_STICK, a.MODE_SLIP)
        active.heading[chosen] = np.where(free & ~sticks, turned, heading.T).T
        active.force[chosen] = p
