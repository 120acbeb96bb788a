"""Laws of friction along impacts of several contacts: by `solve_ivp`, for one contact, and by their energy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from carom import Friction

LAWS = {
    "kinetic": Friction(0.6, 0.2),
    "stribeck": Friction(0.6, 0.2, speed=0.5),
    "gaussian": Friction(0.5, 0.3, speed=1.0, exponent=2.0),
    "rising": Friction.table([0.0, 0.5, 2.0, 4.0], [0.2, 0.5, 0.3, 0.25]),
}
OPEN, LOAD, UNLOAD = range(3)
REST, SMALL = 1e-10, 1e-13


class Passage:
    """The layer of k contacts with Stronge's law and linear forces, integrated from event to event.

    Depths and impulses are unknowns; normal forces are those of mathematics page, §2.2, for p = 1.
    """

    def __init__(self, W, u, laws, e):
        self.W, self.u0, self.laws, self.e, self.k = W, u.ravel(), laws, e, len(u)
        self.mode, self.sticks = [LOAD] * self.k, [False] * self.k
        self.d0, self.most = np.zeros(self.k), np.zeros(self.k)

    def velocity(self, y):
        return (self.u0 + self.W @ y[self.k :]).reshape(-1, 3)

    def normal(self, i, d):
        if self.mode[i] == OPEN:
            return 0.0
        s = d[i] - self.d0[i]
        if self.mode[i] == UNLOAD:
            s = (s - (1.0 - self.e**2) * self.most[i]) / self.e**2
        return max(0.0, s)

    def forces(self, t, y):
        """Return the forces (k, 3): friction of slip, then that which keeps others at rest."""
        u, f = self.velocity(y), np.zeros((self.k, 3))
        for i in range(self.k):
            f[i, 0] = self.normal(i, y)
            slip = np.hypot(*u[i, 1:])
            if not self.sticks[i] and slip > 0.0:
                f[i, 1:] = -float(self.laws[i](slip)) * f[i, 0] * u[i, 1:] / slip
        held = [3 * i + r for i in range(self.k) if self.sticks[i] for r in (1, 2)]
        if held:
            W = self.W[held]
            f.ravel()[held] = np.linalg.solve(W[:, held], -(W @ f.ravel()))
        return f

    def rates(self, t, y):
        return np.append(-self.velocity(y)[:, 0], self.forces(t, y).ravel())

    def gauges(self, t, y):
        """Return for each contact what becomes positive where its mode changes, then for its friction."""
        u, f, out = self.velocity(y), self.forces(t, y), []
        for i in range(self.k):
            s = y[i] - self.d0[i]
            if self.mode[i] == OPEN:
                out.append(s)
            elif self.mode[i] == LOAD:
                out.append(u[i, 0])
            else:
                out.append(max((1.0 - self.e**2) * self.most[i] - s, s - self.most[i]))
        for i in range(self.k):
            out.append(
                np.hypot(*f[i, 1:]) - self.laws[i].bound * f[i, 0]
                if self.sticks[i] else REST - np.hypot(*u[i, 1:])
            )  # fmt: skip
        return np.array(out)

    def change(self, j, t, y):
        """Change the mode or the friction of a contact; return the state."""
        i, kind = j % self.k, j // self.k
        if kind == 0:
            if self.mode[i] == LOAD:
                self.mode[i], self.most[i] = UNLOAD, y[i] - self.d0[i]
            elif self.mode[i] == UNLOAD and y[i] - self.d0[i] < 0.9 * self.most[i]:
                self.mode[i], self.d0[i], self.sticks[i] = OPEN, y[i], False
            else:
                self.mode[i] = LOAD
            return y
        if self.sticks[i]:
            return self.break_away(i, t, y)
        self.sticks[i] = True  # a law may hold it above its coefficient of slip
        f = self.forces(t, y)[i]
        if np.hypot(*f[1:]) > self.laws[i].bound * f[0]:
            return self.break_away(i, t, y)
        return self.push(i, y, np.zeros(2))

    def push(self, i, y, slip):
        """Return the state with a given slip of contact i."""
        rows, y = [3 * i + 1, 3 * i + 2], y.copy()
        need = slip - self.velocity(y)[i, 1:]
        y[self.k + np.array(rows)] += np.linalg.solve(self.W[np.ix_(rows, rows)], need)
        return y

    def break_away(self, i, t, y):
        """Return the state with a first slip, in the direction of its own acceleration."""
        f = self.forces(t, y)
        self.sticks[i] = False
        way = -f[i, 1:] / np.hypot(*f[i, 1:])
        for _ in range(200):
            y = self.push(i, y, 10.0 * REST * way)
            a = (self.W @ self.forces(t, y).ravel())[3 * i + 1 : 3 * i + 3]
            way = a / np.hypot(*a)
        return y

    def run(self):
        """Return the velocities after, or None after too many events."""
        y, t = np.zeros(4 * self.k), 0.0
        for _ in range(40):
            u = self.velocity(y)
            if all(m == OPEN for m in self.mode) and (u[:, 0] >= -SMALL).all():
                return u
            live = [j for j in range(2 * self.k) if j < self.k or self.mode[j - self.k] != OPEN]

            def event(j):
                def g(t, y):
                    return self.gauges(t, y)[j] - SMALL

                g.terminal, g.direction = True, 1.0
                return g

            found = solve_ivp(
                self.rates, (t, t + 50.0), y, method="DOP853", rtol=1e-12, atol=1e-14,
                events=[event(j) for j in live],
            )  # fmt: skip
            t, y = found.t[-1], found.y[:, -1]
            hit = [j for j, times in zip(live, found.t_events) if len(times)]
            if found.status == -1 or not hit:
                return None
            for j in hit:
                y = self.change(j, t, y)
        return None


def case(seed, k=2, slip=1.0):
    rng = np.random.default_rng([46, seed])
    A = rng.normal(size=(3 * k, 5 * k))
    u = slip * rng.normal(size=(k, 3))
    u[:, 0] = -rng.uniform(0.3, 1.0, size=k)
    return A @ A.T / (5 * k), u, rng.uniform(0.3, 0.9)
