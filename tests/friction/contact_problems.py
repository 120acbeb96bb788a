"""Contact problems: boxes on planes, stacks, walls, random ones; as bodies and rows, or as W and c."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.friction.layout import ContactProblem, new_contact_work
from carom.friction.residual import measure
from carom.friction.solve import solve_cones
from references.island_arrays import Island, new_island_work
from references.island_graph import island_graph
from references.solve_island import solve_island

G = 9.81
STEP = 1e-3  # [s]: gravity acts as a velocity G STEP in one step


class Solved(NamedTuple):
    status: int
    residual: float
    iterations: int
    p: np.ndarray
    w: np.ndarray
    tolerance: float
    penetration: float
    violation: float
    complementarity: float


def hat(r):
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])


def point_rows(r):
    """Rows (n, t1, t2) = (z, x, y) of a point at r from the mass centre: (3, 6)."""
    return np.hstack([np.eye(3), -hat(r)])[[2, 0, 1]]


def island(contacts, masses, inertias, free):
    """Build an Island of (a, r_a, b, r_b), b = -1 for the ground, and velocities `free` (N, 6)."""
    body = np.array([(a, b) for a, _, b, _ in contacts], dtype=np.int64)
    rows = np.zeros((len(contacts), 2, 3, 6))
    c = np.zeros((len(contacts), 3))
    for i, (a, ra, b, rb) in enumerate(contacts):
        rows[i, 0] = point_rows(ra)
        c[i] = rows[i, 0] @ free[a]
        if b >= 0:
            rows[i, 1] = -point_rows(rb)
            c[i] += rows[i, 1] @ free[b]
    inverse = np.array(
        [np.diag([1 / m] * 3 + [1 / j for j in J]) for m, J in zip(masses, inertias)]
    )
    return Island(body, rows, inverse, c.ravel(), np.zeros((2, len(masses), 6)))


def gravity(count, slope=0.0):
    """Velocity that gravity gives in one step, on a plane with this slope (along t1)."""
    free = np.zeros((count, 6))
    free[:, 0], free[:, 2] = G * STEP * np.sin(slope), -G * STEP * np.cos(slope)
    return free


def stack(count, *, slope=0.0, masses=None, towers=1, edge=0.1):
    """Towers of `count` cubes, four contacts an interface; `masses` from the ground up."""
    contacts, half = [], edge / 2
    corners = [(x * half, y * half) for x in (1, -1) for y in (1, -1)]
    for t in range(towers):
        for i in range(count):
            a, b = t * count + i, t * count + i - 1 if i else -1
            contacts += [(a, (x, y, -half), b, (x, y, half)) for x, y in corners]
    masses = np.tile(np.ones(count) if masses is None else masses, towers)
    return island(
        contacts, masses, [[m * edge**2 / 6] * 3 for m in masses], gravity(len(masses), slope)
    )


def wall(columns, rows, slope=0.0, L=0.2, H=0.1):
    """A wall of bricks L x H x H in running bond, m = 1."""
    at, number, contacts = [], {}, []
    for j in range(rows):
        for i in range(columns - j % 2):
            number[j, i] = len(at)
            at.append(np.array([(i + 0.5 * (j % 2)) * L, 0.0, (j + 0.5) * H]))
    for (j, i), a in number.items():
        below = [number.get((j - 1, n)) for n in ((i - 1, i) if j % 2 == 0 else (i, i + 1))]
        for b in [-1] if j == 0 else [b for b in below if b is not None]:
            left = at[a][0] - L / 2 if b < 0 else max(at[a][0], at[b][0]) - L / 2
            right = at[a][0] + L / 2 if b < 0 else min(at[a][0], at[b][0]) + L / 2
            for x in (left, right):
                for y in (-H / 2, H / 2):
                    point = np.array([x, y, at[a][2] - H / 2])
                    contacts.append((a, point - at[a], b, None if b < 0 else point - at[b]))
    inertia = np.array([2 * H * H, L * L + H * H, L * L + H * H]) / 12
    return island(contacts, np.ones(len(at)), [inertia] * len(at), gravity(len(at), slope))


def pile(layers, radius=0.05):
    """A tetrahedron of equal spheres on the ground, each on three, that also touch in their layer."""
    steps = [
        (x, y, z) for z in range(layers) for x in range(layers - z) for y in range(layers - z - x)
    ]
    basis = 2 * radius * np.array(
        [[1, 0, 0], [1 / 2, np.sqrt(3) / 2, 0], [1 / 2, np.sqrt(3) / 6, np.sqrt(2 / 3)]]
    )  # fmt: skip
    at = np.array(steps) @ basis
    body, rows = [], []
    for a, centre in enumerate(at):
        for b in range(-1, a):
            n = np.array([0.0, 0.0, 1.0]) if b < 0 else centre - at[b]
            if (centre[2] if b < 0 else np.linalg.norm(n) - 2 * radius) > 1e-9:
                continue
            n /= np.linalg.norm(n)
            t = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
            t /= np.linalg.norm(t)
            axes = np.array([n, t, np.cross(n, t)])
            own = axes @ np.hstack([np.eye(3), -hat(-radius * n)])
            other = -axes @ np.hstack([np.eye(3), -hat(radius * n)])
            body.append((a, b))
            rows.append([own, np.zeros((3, 6)) if b < 0 else other])
    free, inverse = gravity(len(at)), np.diag([1.0] * 3 + [2.5 / radius**2] * 3)
    c = [
        sum(row @ free[b] for row, b in zip(pair, ends) if b >= 0) for pair, ends in zip(rows, body)
    ]
    return Island(
        np.array(body), np.array(rows), np.tile(inverse, (len(at), 1, 1)), np.concatenate(c),
        np.zeros((2, len(at), 6)),
    )  # fmt: skip


def random_island(seed):
    """Bodies of unequal mass with contacts of random place and normal: some are cages that jam."""
    random = np.random.default_rng(seed)
    bodies, k = random.integers(1, 8), random.integers(4, 25)
    isle = stack(1, towers=1)
    body = np.stack([random.integers(0, bodies, k), random.integers(-1, bodies, k)], axis=1)
    body[body[:, 0] == body[:, 1], 1] = -1
    rows = random.normal(size=(k, 2, 3, 6))
    mass = 10.0 ** random.uniform(-2, 2, size=bodies)
    inverse = np.eye(6) / mass[:, None, None]
    free, c = random.normal(size=(bodies, 6)), np.zeros((k, 3))
    for i, ends in enumerate(body):
        for side, b in enumerate(ends):
            if b >= 0:
                c[i] += rows[i, side] @ free[b]
    motion = np.zeros((2, bodies, 6))
    return isle._replace(body=body, rows=rows, inverse_mass=inverse, c=c.ravel(), motion=motion)


def dense(isle):
    """Return W and c of an island."""
    k, bodies = len(isle.body), len(isle.inverse_mass)
    rows, inverse = np.zeros((3 * k, 6 * bodies)), np.zeros((6 * bodies, 6 * bodies))
    for i, ends in enumerate(isle.body):
        for side, b in enumerate(ends):
            if b >= 0:
                rows[3 * i : 3 * i + 3, 6 * b : 6 * b + 6] = isle.rows[i, side]
    for b in range(bodies):
        inverse[6 * b : 6 * b + 6, 6 * b : 6 * b + 6] = isle.inverse_mass[b]
    return rows @ inverse @ rows.T, isle.c


def random_singular(seed, most=15):
    """W of random rank below 3k, k = 2..most, and c in its range: w = 0 is among the velocities."""
    random = np.random.default_rng(seed)
    k = random.integers(2, most + 1)
    rank = random.integers(3, 3 * k)
    rows = random.normal(size=(3 * k, rank))
    return rows @ rows.T, rows @ random.normal(size=rank)


def solve(W, c, mu, kind=None, heading=None, start=None, spare=0):
    """Solve, with room for `spare` contacts more that hold rubbish."""
    k = len(c) // 3
    n = 3 * (k + spare)
    big, vector, p = np.full((n, n), 1e3), np.full(n, 1e3), np.full(n, 1e3)
    big[: 3 * k, : 3 * k], vector[: 3 * k] = W, c
    p[: 3 * k] = 0.0 if start is None else start
    friction, kinds, directions = (
        np.full(k + spare, -1.0),
        np.full(k + spare, 7),
        np.ones((k + spare, 2)),
    )
    friction[:k] = mu
    kinds[:k] = 0 if kind is None else kind
    directions[:k] = 0.0 if heading is None else heading
    problem = ContactProblem(big, vector, friction, kinds, directions)
    result = solve_cones(k, problem, p, new_contact_work(k + spare))
    _, *rest = measure(k, problem, p)
    assert np.all(p[3 * k :] == 1e3)
    return Solved(*result, p[: 3 * k], W @ p[: 3 * k] + c, *rest)


def solve_sparse(isle, mu, start=None):
    """Solve an island without W; return (status, residual, iterations, p)."""
    k = len(isle.body)
    work = new_island_work(island_graph(len(isle.inverse_mass), isle.body), isle.body)
    p = np.zeros(3 * k) if start is None else start.copy()
    status, residual, iterations = solve_island(
        k, isle, np.full(k, float(mu)), np.zeros(k, dtype=np.int64), np.zeros((k, 2)), p, work
    )
    return status, residual, iterations, p
