"""Time of one impact at a corner: steps at three tolerances, laws, blow by blow."""

from __future__ import annotations

import numpy as np

from common import report, seconds

US = 1e-6
RTOL = (1e-4, 1e-6, 1e-8)
EXACT = 1e-11
NEWTON, POISSON, STRONGE = 0, 1, 2


def rows(point):
    """Rows (n, t1, t2) of a contact of a free body, normal z."""
    return np.array([np.r_[a, np.cross(point, a)] for a in np.eye(3)[[2, 0, 1]]])


def die(velocity, corners=4):
    """W and u of the paper's die on `corners` of its lower face."""
    m, a = 0.016, 0.02
    h = a / 2
    points = [(-h, -h, -h), (-h, h, -h), (h, -h, -h), (h, h, -h)][:corners]
    G = np.vstack([rows(p) for p in points])
    W = G @ np.diag([1 / m] * 3 + [6 / (m * a * a)] * 3) @ G.T
    return W, G @ np.asarray(velocity, float)


def cradle(n):
    """W and u of a row of n balls struck at one end."""
    G = np.zeros((3 * (n - 1), n))
    for i in range(n - 1):
        G[3 * i, i], G[3 * i, i + 1] = -1, 1
    return G @ G.T, G[:, 0].copy()


def stack(n):
    """W and u of a box striking a stack of n boxes in all (edge .1 m, 1 kg, four contacts each)."""
    a, out = 0.1, []
    for i in range(n):
        for x in (-a / 2, a / 2):
            for y in (-a / 2, a / 2):
                upper, lower = rows((x, y, -a / 2)), rows((x, y, a / 2))
                block = np.zeros((3, 6 * n))
                block[:, 6 * i : 6 * i + 6] = upper
                if i + 1 < n:
                    block[:, 6 * i + 6 : 6 * i + 12] = -lower
                out.append(block)
    G = np.vstack(out)
    v = np.zeros(6 * n)
    v[:3] = 0.2, 0, -1
    return G @ np.diag(([1.0] * 3 + [6 / (a * a)] * 3) * n) @ G.T, G @ v


def one_twice():
    """W and u of the fixed problem V4, its contact split into two of unequal stiffness."""
    W = np.array([[1.6, 0.5, -0.3], [0.5, 2.4, 0.4], [-0.3, 0.4, 1.9]])
    return np.tile(W, (2, 2)), np.tile([-1.0, 0.8, 0.5], 2)


class Case:
    """One impact, with workspace, called in a compiled loop."""

    def __init__(self, problem, mu=0.0, e=0.5, law=STRONGE, kappa=None, repeat=200, **settings):
        from carom.impact.multiple.api import stated_contacts, stated_laws
        from carom.impact.multiple.layout import SIMULTANEOUS, MultipleSettings, new_multiple_result
        from carom.impact.multiple.workspace import new_multiple_workspace

        W, u = problem
        k = len(u) // 3
        ones = np.ones(k)
        kappa = ones if kappa is None else np.array(kappa, float)
        self.k, self.laws = k, stated_laws(mu * ones, e * ones, [law] * k, 0 * ones, kappa)
        W, u = np.ascontiguousarray(W), np.ascontiguousarray(u).reshape(k, 3)
        self.contacts = stated_contacts(W, u, self.laws, SIMULTANEOUS)
        self.settings, self.repeat, self.given = MultipleSettings, repeat, settings
        self.workspace, self.out = new_multiple_workspace(k), new_multiple_result(k)

    def run(self, loop, rtol, **more):
        """Return microseconds, steps, rounds, velocities after."""
        settings = self.settings(rtol=rtol, **{**self.given, **more})
        arguments = (self.k, self.contacts, self.laws, settings, self.workspace, self.out)
        code = loop(1, *arguments)
        assert code == 0
        times = seconds(lambda: loop(self.repeat, *arguments), rounds=3)
        summary = self.out.summary[0]
        after = self.out.velocity[: 3 * self.k].copy()
        return min(times) / self.repeat / US, int(summary["steps"]), int(summary["rounds"]), after


def compiled_loop():
    """Return a compiled loop over one impact."""
    from carom._compiled.decorators import entry
    from carom.impact.multiple.resolve import resolve_multiple

    @entry
    def loop(count, k, contacts, laws, settings, workspace, out):
        code = 0
        for _ in range(count):
            code = max(code, resolve_multiple(k, contacts, laws, settings, workspace, out))
        return code

    return loop


FALL = (0.3, 0.1, -2, 3, 1, 5)
CASES = {
    "k=1, slip (split in two)": lambda: Case(one_twice(), 0.2, kappa=(1, 3)),
    "cradle n=2": lambda: Case(cradle(2), e=1.0),
    "cradle n=3": lambda: Case(cradle(3), e=1.0),
    "cradle n=5": lambda: Case(cradle(5), e=1.0),
    "cradle n=5, e=.5": lambda: Case(cradle(5)),
    "box, 4 corners, vertical (alike)": lambda: Case(die((0, 0, -2, 0, 0, 0)), 0.3),
    "box, 4 corners, vertical, in full": lambda: Case(
        die((0, 0, -2, 0, 0, 0)), 0.3, kappa=1 + 1e-9 * np.arange(4)
    ),
    "box, 4 corners, slip (mu=.05)": lambda: Case(die(FALL), 0.05),
    "box, 4 corners, stick (mu=1)": lambda: Case(die(FALL), 1.0),
    "box, 4 corners, stick and slip (mu=.3)": lambda: Case(die(FALL), 0.3),
    "the same, Poisson, mu=.05": lambda: Case(die(FALL), 0.05, law=POISSON),
    "the same, Newton, mu=.05": lambda: Case(die(FALL), 0.05, law=NEWTON),
    "the same, Newton, mu=1": lambda: Case(die(FALL), 1.0, law=NEWTON),
    "the same, Newton, mu=.3": lambda: Case(die(FALL), 0.3, law=NEWTON, repeat=50),
}


def table() -> None:
    """Adaptive steps."""
    loop, lines = compiled_loop(), []
    for name, make in CASES.items():
        case = make()
        exact = case.run(loop, EXACT)[3]
        cells = [name]
        for rtol in RTOL:
            us, steps, rounds, after = case.run(loop, rtol)
            error = np.abs(after - exact).max()
            more = f", {rounds + 1} passes" if rounds else ""
            cells.append(f"{steps} / {us:.3g} / {error:.0e}{more}")
        lines.append(cells)
    report(
        "corner", "One impact of several contacts: steps / microseconds / error",
        ["", *(f"rtol {r:.0e}" for r in RTOL)], lines,
        f"Error: greatest of the velocities [m/s] against rtol {EXACT:.0e}. Steps count all passes.",
    )  # fmt: skip


if __name__ == "__main__":
    table()
