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
        self.run = run
        self.restitution = np.array([one.restitution for one in contacts])
        self.friction = np.array([one.friction for one in contacts])
        self.law = np.array([NUMBERS[one.impact_law] for one in contacts], dtype=np.int64)
        self.blows = np.zeros(len(contacts), dtype=np.int64)
        self.struck = np.zeros(len(contacts))  # time of the last impact
        self.events: list[tuple[float, str, int]] = []
        self.strike = Strike(self)
        self.cones: Any = None  # workspace of the contact problem, made when it is first needed

    def new_step(self) -> None:
        """Forget the impacts of the last step, if its length was given."""
        if self.run.plan.order == 0:
            self.blows[:] = 0

    # --- quantities of the state ---------------------------------------------------------------

    def look(self) -> None:
        """Evaluate the state: P, the relative velocities u (C, 3), and the speeds that count as 0 (C,)."""
        run, n = self.run, self.run.n
        self.seen = run.made.look(run.x[:n], run.x[n:], float(run.clock[0].now), run.active)
        M, A = self.seen.M, self.seen.A
        P = np.linalg.inv(M)
        if len(A):
            Y = P @ A.T
            P = P - Y @ np.linalg.pinv(A @ Y, rcond=run.system.drop, hermitian=True) @ Y.T
        self.P = 0.5 * (P + P.T)
        self.u = self.seen.G @ run.x[n:]
        W = np.einsum("cin,nm,cjm->cij", self.seen.G, self.P, self.seen.G)
        self.W_nn = W[:, 0, 0]
        size = np.sqrt(np.maximum(np.trace(W, axis1=1, axis2=2), 0.0))
        speed = np.sqrt(max(run.x[n:] @ M @ run.x[n:], 0.0))
        push = (
            np.sqrt(max(self.seen.load @ np.linalg.solve(M, self.seen.load), 0.0)) * run.plan.step
        )
        self.still = STILL * size * max(speed, push)

    def active(self) -> list[int]:
        """Return the contacts that are active."""
        active = self.run.active
        return [int(c) for c in active.contact[: active.count[0]]]

    def closed(self, struck: int) -> list[int]:
        """Return the closed contacts: active, just located, or with a gap that counts as zero."""
        scale = self.run.options.tie_tolerance * self.run.work.gap_scale
        gap = self.seen.gap
        active = self.active()
        return [c for c in range(len(gap)) if c in active or c == struck or gap[c] <= scale[c]]

    # --- one event --------------------------------------------------------------------------------

    def resolve(self, kind: int, index: int) -> int:
        """Handle the located event (kind 0: the start of the run); return a status."""
        run = self.run
        if run.system.size[3] == 0:
            return 0
        now = float(run.clock[0].now)
        before = run.x.copy()
        struck = index if kind == EVENT_GAP else -1
        of_active = kind in (EVENT_SEPARATE, EVENT_CONE, EVENT_REVERSE, EVENT_JAM)
        marked = int(run.active.contact[index]) if of_active else -1
        if struck >= 0:
            code = self.return_to(struck)
            if code != 0:
                return code
        self.look()
        if self.seen.status != 0:
            return self.seen.status
        was = {c: int(run.active.mode[i]) for i, c in enumerate(self.active())}
        closed = self.closed(struck)
        if kind == EVENT_SEPARATE:
            self.let_go(marked)
        code = self.strike.all(closed, now, marked if kind == EVENT_JAM else -1)
        if code != 0:
            return code
        if run.options.hold:
            code = self.choose_active(closed, kind, marked, struck)
            if code != 0:
                return code
        self.note_changes(was, kind, marked, now)
        run.nodes.append((now, before, run.x.copy()))
        return 0

    def return_to(self, contact: int) -> int:
        """Remove round-off of the gap of a contact from the located state; return a status."""
        run, active, now = self.run, self.run.active, float(self.run.clock[0].now)
        k = int(active.count[0])
        active.contact[k], active.mode[k], active.count[0] = contact, MODE_SLIP, k + 1
        code = project(run.system, active, now, run.x, False, run.work)
        active.count[0] = k
        if code == 0 and (run.system.size[2] > 0 or k > 0):
            code = project(run.system, active, now, run.x, True, run.work)
        return Status.RETURN_MAP_FAILED if code == Status.CONSTRAINTS_LOST else code

    def let_go(self, contact: int) -> None:
        """Remove a contact from the active ones."""
        active = self.run.active
        keep = [i for i, c in enumerate(self.active()) if c != contact]
        for array in (active.contact, active.mode, active.heading, active.force, active.yields):
            array[: len(keep)] = array[keep]
        active.count[0] = len(keep)

    def note_changes(self, was: dict, kind: int, marked: int, now: float) -> None:
        """Write the events of contacts whose mode has changed."""
        active = self.run.active
        modes = {c: int(active.mode[i]) for i, c in enumerate(self.active())}
        for c in {**was, **modes}:
            if c not in modes:
                self.events.append((now, "opens", c))
            elif c not in was:
                self.run.counts["holds"] += 1
                self.events.append((now, "held", c))
            elif modes[c] != was[c]:
                self.events.append((now, "sticks" if modes[c] == MODE_STICK else "slips", c))
            elif c == marked and kind == EVENT_REVERSE:
                self.events.append((now, "slips", c))

    # --- persistent contacts ----------------------------------------------------------------------

    def bilateral(self, rows: np.ndarray, rates: np.ndarray, free: np.ndarray) -> np.ndarray:
        """Return the acceleration with additional rows ``rows a = -rates``."""
        if not len(rows):
            return free
        Y = self.P @ rows.T
        S = rows @ Y
        return free - Y @ np.linalg.lstsq(S, rows @ free + rates, rcond=1e-12)[0]

    def free_acceleration(self) -> np.ndarray:
        """Return the acceleration with the constraints, without contacts."""
        seen = self.seen
        Minv_f = np.linalg.solve(seen.M, seen.load - seen.c)
        if not len(seen.A):
            return Minv_f
        Y = np.linalg.solve(seen.M, seen.A.T)
        S = seen.A @ Y
        lam = np.linalg.lstsq(S, -seen.A_rate - seen.A @ Minv_f, rcond=self.run.system.drop)[0]
        return Minv_f + Y @ lam

    def choose_active(self, closed: list[int], kind: int, marked: int, struck: int) -> int:
        """Choose the closed contacts that become active, and their modes; return a status."""
        skip = marked if kind == EVENT_SEPARATE else -1
        self.look()
        for c in self.active():
            if self.u[c, 0] > 10.0 * self.still[c]:
                self.let_go(c)
        active = self.active()
        free = self.free_acceleration()
        chosen = list(active)
        for c in sorted(set(closed) - {skip} - set(active), key=lambda c: abs(self.u[c, 0])):
            rows, rates = self.seen.G[chosen, 0], self.seen.G_rate[chosen, 0]
            a = self.bilateral(rows, rates, free)
            draw = -(self.seen.G[c, 0] @ a + self.seen.G_rate[c, 0])
            size = float(np.sqrt(free @ self.seen.M @ free * self.W_nn[c]))
            # a contact that others keep closed (the fourth leg of a table) was located by round-off
            least = -1e-9 if c == struck and chosen else 1e-12
            if draw > least * size and self.stays(c, draw):
                chosen.append(c)
        return self.set_active(chosen, closed, kind, marked, free)

    def stays(self, c: int, draw: float) -> bool:
        """Return whether the bounces of a contact with the acceleration `draw` end within a step."""
        u, e = float(self.u[c, 0]), self.restitution[c]
        if self.blows[c] > 0 and e < 1.0 and e ** float(self.blows[c]) <= 1e-6:
            e = 0.0
        if not u >= -10.0 * self.still[c]:
            return False
        return u <= self.still[c] or (
            e < 1.0 and 2.0 * u < draw * (1.0 - e) * self.run.moment(draw)
        )

    def set_active(self, chosen, closed, kind: int, marked: int, free: np.ndarray) -> int:
        """Make `chosen` active: find stick or slip of each from the accelerations; return a status."""
        from carom.friction.layout import SOLVED, new_contact_work
        from carom.friction.solve import solve_cones

        run, n, active = self.run, self.run.n, self.run.active
        was = {
            c: (int(active.mode[i]), active.heading[i].copy(), active.force[i].copy())
            for i, c in enumerate(self.active())
        }
        if self.cones is None:
            self.cones = new_contact_work(len(self.friction))
        for _ in range(CONTACT_ROUNDS):
            k = len(chosen)
            active.count[0] = k
            if k == 0:
                return 0
            self.take_out(chosen, kind, marked, was)
            driven = [c for c in closed if c not in chosen and self.u[c, 0] < -10.0 * self.still[c]]
            if driven:  # by the change of the others
                chosen = chosen + driven
                continue
            G = self.seen.G[chosen].reshape(3 * k, n)
            W = G @ self.P @ G.T
            c0 = G @ free + self.seen.G_rate[chosen].reshape(3 * k)
            mu, p = self.friction[chosen], np.zeros(3 * k)
            kinds, heading = self.slips(chosen, kind, marked, was)
            status, _, _ = solve_cones(k, W, c0, mu, kinds, heading, p, self.cones)
            if status != SOLVED:
                jam = self.jam(chosen, W, mu, heading)
                if jam < 0:
                    return Status.NO_CONVERGENCE
                code = self.strike.all(chosen, float(run.clock[0].now), jam)
                if code != 0:
                    return code
                self.look()
                chosen = [c for c in chosen if not self.u[c, 0] > 10.0 * self.still[c]]
                free = self.free_acceleration()
                continue
            p = p.reshape(k, 3)
            w = (W @ p.ravel() + c0).reshape(k, 3)
            least = 1e-12 * np.max(np.abs(c0))
            pressed = [c for i, c in enumerate(chosen) if p[i, 0] > 0.0 or abs(w[i, 0]) <= least]
            if len(pressed) < k:
                chosen = pressed
                continue
            self.write_held(chosen, p, heading, was)
            return project(run.system, active, float(run.clock[0].now), run.x, True, run.work)
        return Status.NO_CONVERGENCE

    def slips(self, chosen, kind: int, marked: int, was: dict):
        """Return kinds (k,) and directions (k, 2) for the solver: sliding, or free to stick or slip."""
        from carom.friction.layout import CONE as FREE
        from carom.friction.layout import SLIDING

        kinds, heading = np.full(len(chosen), FREE), np.zeros((len(chosen), 2))
        for i, c in enumerate(chosen):
            slip = self.u[c, 1:]
            size = float(np.linalg.norm(slip))
            if self.friction[c] > 0.0 and size > 10.0 * self.still[c]:
                kinds[i], heading[i] = SLIDING, slip / size
            elif c == marked and kind == EVENT_CONE and self.friction[c] > 0.0:
                pull = was[c][2][1:]  # stick has just ended
                kinds[i], heading[i] = SLIDING, -pull / np.linalg.norm(pull)
        return kinds, heading

    @staticmethod
    def jam(chosen, W: np.ndarray, mu: np.ndarray, heading: np.ndarray) -> int:
        """Return the first contact that jams, because friction outweighs W_nn in slip; -1 if there is none."""
        for i, c in enumerate(chosen):
            if heading[i].any():
                pressing = mu[i] * heading[i] @ W[3 * i, 3 * i + 1 : 3 * i + 3]
                if W[3 * i, 3 * i] - pressing <= 0.0:
                    return c
        return -1

    def write_held(self, chosen, p: np.ndarray, heading: np.ndarray, was: dict) -> None:
        """Write the new active contacts, with forces p (k, 3), and whether each sticks."""
        active = self.run.active
        for i, c in enumerate(chosen):
            active.contact[i], active.mode[i], active.force[i] = c, MODE_SLIP, p[i]
            active.heading[i] = heading[i]
            if heading[i].any() or not self.friction[c] > 0.0:
                continue
            pull, most = float(np.linalg.norm(p[i, 1:])), self.friction[c] * p[i, 0]
            if pull <= most * (1.0 - 1e-10) or (c in was and was[c][0] == MODE_STICK):
                active.mode[i] = MODE_STICK
            elif pull > 0.0:
                active.heading[i] = -p[i, 1:] / pull
            elif c in was:
                active.heading[i] = was[c][1]

    def take_out(self, chosen, kind: int, marked: int, was: dict) -> None:
        """Remove the normal velocities of contacts that become active, and slip that has stopped."""
        run, n = self.run, self.run.n
        rows = []
        for c in chosen:
            rows.append(self.seen.G[c, 0])
            if self.friction[c] > 0.0:
                slip = float(np.linalg.norm(self.u[c, 1:]))
                stop = 10.0 * self.still[c]
                if c == marked and kind == EVENT_REVERSE:
                    # speed that friction removes in a thousandth of a step
                    W_tt = np.einsum("in,nm,im->", self.seen.G[c, 1:], self.P, self.seen.G[c, 1:])
                    brake = self.friction[c] * abs(was[c][2][0]) * float(W_tt)
                    stop = max(stop, 1e-3 * run.moment(brake) * brake)
                if slip <= stop:
                    rows.extend(self.seen.G[c, 1:])
        R = np.array(rows)
        v, M = run.x[n:].copy(), self.seen.M
        after = self.bilateral(R, np.zeros(len(R)), v)
        run.x[n:] = after
        run.clock[0].bounces += 0.5 * (after @ M @ after - v @ M @ v)
        self.look()
