"""The contact problem of stacks, towers and walls: iterations and time against the number of contacts."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from carom._compiled.decorators import entry
from carom.friction.layout import ContactProblem, new_contact_work
from carom.friction.solve import solve_cones
from common import clock, report, seconds, spread

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "friction"))
from contact_problems import dense, pile, stack, wall

from references.island_arrays import new_island_work
from references.island_graph import island_graph
from references.solve_island import solve_island

MU = 0.3
US = 1e-6
DENSE_UP_TO = 80


def scenes():
    """Return name and island of each scene."""
    yield "box on a plane", stack(1)
    yield "box, slides", stack(1, slope=0.4)
    for count in (2, 5, 10, 20, 50):
        yield f"stack of {count}", stack(count)
    yield "stack of 5, topples", stack(5, slope=0.5)
    yield "stack of 5, top 1e6 times heavier", stack(5, masses=[1, 1, 1, 1, 1e6])
    yield "wall 10 x 10", wall(10, 10)
    yield "wall 10 x 10, slope 0.3", wall(10, 10, 0.3)
    yield "pile of 56 spheres", pile(6)
    yield "50 towers of 5", stack(5, towers=50)
    yield "100 towers of 5", stack(5, towers=100)


@entry
def many_dense(times, k, problem, start, p, work):
    """Solve `times` times from `start`."""
    for _ in range(times):
        for i in range(3 * k):
            p[i] = start[i]
        found = solve_cones(k, problem, p, work)
    return found


@entry
def many_sparse(times, k, island, mu, kind, heading, start, p, work):
    """Solve `times` times from `start`."""
    for _ in range(times):
        for i in range(3 * k):
            p[i] = start[i]
        found = solve_island(k, island, mu, kind, heading, p, work)
    return found


def measured(solve, k, c):
    """Return iterations, times and residual relative to c: cold, then from the impulses of 1 % less load.

    ``solve(times, part, start)`` solves with velocities ``part * c`` and returns
    ((status, residual, iterations), p).
    """
    times = max(1, 400 // k)
    first, p = solve(1, 0.99, np.zeros(3 * k))
    assert first[0] == 0
    cells = []
    for start in (np.zeros(3 * k), p):
        found, _ = solve(1, 1.0, start)
        assert found[0] == 0
        took = seconds(lambda start=start: solve(times, 1.0, start))
        cells += [str(found[2]), spread([t / times for t in took], US)]
    return [*cells, f"{found[1] / np.abs(c).max():.0e}"]


def by_W(island):
    """Measure with W stored whole."""
    W, c = dense(island)
    k = len(c) // 3
    given = np.full(k, MU), np.zeros(k, dtype=np.int64), np.zeros((k, 2))
    work, p = new_contact_work(k), np.zeros(3 * k)

    def solve(times, part, start):
        problem = ContactProblem(W, part * c, *given)
        return many_dense(times, k, problem, start, p, work), p.copy()

    return measured(solve, k, c)


def by_bodies(island):
    """Measure on the graph of bodies."""
    k = len(island.body)
    given = np.full(k, MU), np.zeros(k, dtype=np.int64), np.zeros((k, 2))
    work = new_island_work(island_graph(len(island.inverse_mass), island.body), island.body)
    p = np.zeros(3 * k)

    def solve(times, part, start):
        loaded = island._replace(c=part * island.c)
        return many_sparse(times, k, loaded, *given, start, p, work), p.copy()

    return measured(solve, k, island.c)


def setup() -> float:
    """Return the time [ms] to find the order of elimination and to make the work arrays of 2000 contacts."""
    for towers in (1, 100):  # the first one loads compiled code
        island = stack(5, towers=towers)
        begin = clock()
        new_island_work(island_graph(len(island.inverse_mass), island.body), island.body)
        took = clock() - begin
    return 1e3 * took


def main() -> None:
    """Measure and report."""
    made, rows = setup(), []
    for name, island in scenes():
        k = len(island.body)
        if k <= DENSE_UP_TO:
            rows.append([name, k, "W", *by_W(island)])
        rows.append([name, k, "bodies", *by_bodies(island)])
    head = ["", "contacts", "by", "iterations, cold", "us, cold", "warm", "us, warm", "residual"]
    report(
        "coulomb", "Contact problem with Coulomb friction", head, rows,
        f"mu = {MU}. Cold: from zero. Warm: from the impulses of 1 % less load. Residual of the warm solve, "
        "relative to the greatest velocity without impulses. By W: stored whole; by bodies: W never formed. "
        f"Without setting up the graph of bodies: {made:.0f} ms for the 2000 contacts, once.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
