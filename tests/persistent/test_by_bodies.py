"""The equations of a large group by the motion of its bodies: the same solutions as with full matrices."""

import numpy as np
import pytest

import carom
from carom._compiled.decorators import entry
from carom.friction.graph import find_order
from carom.impact.workspace import new_equations
from carom.persistent import by_bodies
from carom.persistent.coulomb_stage import bound_arms


@entry
def solve(n, rows, equations, x, q):
    """Write q = (J + D R Y) x, and replace x by (J + eps S + D R Y)^-1 x."""
    by_bodies.factor_by_bodies(n, rows, equations)
    by_bodies.multiply_by_bodies(n, rows, equations, x, q)
    by_bodies.solve_by_bodies(n, rows, equations, x)


@entry
def bound(a, b, slope, normal, grows, equations):
    """Write the Jacobian of friction on its disc."""
    bound_arms((a, b), slope, normal, grows, equations)


@entry
def prepare(k, equations):
    """Find the order of the bodies of k points."""
    equations.bodies[0] = equations.tree.body.shape[0]
    return find_order(equations.bodies[0], k, equations.graph, equations.tree)


@entry
def write_arms(n, rows, slides, softness, equations):
    """Write the equations of n rows: of friction on its disc where it slides."""
    for i in range(n):
        if slides[rows[i]] == 0:
            by_bodies.set_alone(equations, rows[i], softness[rows[i]])
    for i in range(n):
        if slides[rows[i]] == 1:
            other = softness[equations.arms[rows[i]].other]
            by_bodies.set_on_disc(equations, rows[i], (softness[rows[i]], other))


def random_group(bodies, points, rng):
    """Return equations of points between bodies of a ring, or on the ground; and R, Y and eps S."""
    n = 3 * points
    equations = new_equations(points, bodies)
    R, Y, S = np.zeros((n, 6 * bodies)), np.zeros((6 * bodies, n)), np.zeros(n)
    masses = 10.0 ** rng.uniform(-2, 2, bodies)
    for i in range(points):
        a = int(rng.integers(bodies))
        b = -1 if rng.random() < 0.3 else (a + 1) % bodies
        inverse = 1 / masses[a] + (1 / masses[b] if b >= 0 else 0)
        equations.tree.link.body[i] = a, b
        for r in range(3):
            row, arm = 3 * i + r, equations.arms[3 * i + r]
            arm.body[:] = a, b
            S[row] = 1e-5 * inverse * (1 if r == 0 else 1e3)
            for side in (0, 1) if b >= 0 else (0,):
                arm.row[side] = rng.normal(size=6)
                arm.motion[side] = arm.row[side] / masses[arm.body[side]]
                at = slice(6 * arm.body[side], 6 * arm.body[side] + 6)
                R[row, at], Y[at, row] = arm.row[side], arm.motion[side]
    assert prepare(points, equations)
    return equations, R, Y, S


def check(equations, rows, A, S, rng):
    """Compare products and solutions with those of full matrices, of the rows."""
    n = len(rows)
    A, S, x, q = A[np.ix_(rows, rows)], S[rows], rng.normal(size=n), np.zeros(n)
    given = x.copy()
    solve(n, rows, equations, x, q)
    np.testing.assert_allclose(q, A @ given, rtol=1e-13, atol=1e-13 * np.abs(A).max() * n)
    whole = A + np.diag(S)
    exact = np.linalg.solve(whole, given)
    # to the round-off of the matrix, which forces that move nothing magnify by 1/eps
    assert np.abs(x - exact).max() < 1e-8 * np.abs(exact).max()
    solve(n, rows, equations, left := given - whole @ x, q)
    x += left
    assert np.all(np.abs(given - whole @ x) <= 1e-13 * (np.abs(whole) @ np.abs(x)))


SIZES = [(2, 24), (5, 30), (12, 48), (24, 138)]


@pytest.mark.parametrize(("bodies", "points"), SIZES)
def test_the_forces_of_springs_are_those_of_the_full_matrix(bodies, points):
    rng = np.random.default_rng(points)
    equations, R, Y, S = random_group(bodies, points, rng)
    rows = rng.permutation(3 * points)[: 3 * points - points // 2]  # all but some, in any order
    write_arms(len(rows), rows, np.zeros(3 * points, int), S, equations)
    for row in rows[rows % 3 == 0]:  # slip that follows a normal force
        d, arm = 0.5 * rng.normal(size=2), equations.arms[row]
        for side in (0, 1) if arm.body[1] >= 0 else (0,):
            at = slice(6 * arm.body[side], 6 * arm.body[side] + 6)
            for t in (0, 1):
                arm.push[side] -= d[t] * equations.arms[row + 1 + t].motion[side]
            Y[at, row] = arm.push[side]
    check(equations, rows, R @ Y, S, rng)


@pytest.mark.parametrize(("bodies", "points"), SIZES)
def test_a_step_of_newtons_method_with_discs_is_that_of_the_full_matrix(bodies, points):
    rng = np.random.default_rng(points)
    equations, R, Y, S = random_group(bodies, points, rng)
    W, n = R @ Y, 3 * points
    slides, A = np.zeros(n, int), W.copy()
    rows = np.flatnonzero((np.arange(n) % 3 < 2) | (rng.random(n) < 0.8))
    for i in np.flatnonzero(rng.random(points) < 0.6):
        a, b = 3 * i + 1, 3 * i + 2 if 3 * i + 2 in rows else 3 * i + 1
        angle, part, grows = 2 * np.pi * rng.random(), rng.random(), 0.6 * (rng.random() < 0.8)
        e = np.array([np.cos(angle), np.sin(angle)]) if b > a else np.array([1.0, 0.0])
        scale = 0.5 * (W[a, a] + W[b, b])
        bound(a, b, (e[0], e[1], part, scale), 3 * i, grows, equations)
        own = [a, b] if b > a else [a]
        across = np.eye(len(own)) - np.outer(e, e)[: len(own), : len(own)]
        A[own] = part * across @ W[own]
        A[np.ix_(own, own)] += scale * (np.eye(len(own)) - part * across)
        A[own, 3 * i] -= scale * grows * e[: len(own)]
        slides[own] = 1
    write_arms(len(rows), rows, slides, S, equations)
    check(equations, rows, A, S, rng)


def wall(rows, base=None):
    """A wall of bricks in bond, each on two others, at rest; a lighter one beyond the edge of the last tips."""
    base = rows if base is None else base
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(restitution=0.0, friction=0.6)
    a, b, c = 0.2, 0.1, 0.1
    for i in range(rows):
        for j in range(base - i):
            y = (j + 0.5 * i) * (a + 1e-4)
            scene.add_body(carom.Box(b, a, c), mass=3.0, position=(0, y, (i + 0.5) * c))
    edge = (base - rows + 0.5 * (rows - 1)) * (a + 1e-4) + 0.5 * a
    top = scene.add_body(carom.Box(b, a, c), mass=1.0, position=(0, edge + 0.02, (rows + 0.5) * c))
    return scene, top


@pytest.mark.parametrize(("rows", "base"), [(5, 5), (3, 17)])
def test_a_wall_stands_while_a_brick_tips(rows, base):
    """The second has 318 points, more than full matrices have room for."""
    scene, top = wall(rows, base)
    s = carom.simulate(scene, 0.02, save_at=0.002)
    assert s.stats["whole_steps"] == 0
    assert abs(s.angular_velocity[-1, top.index, 0]) > 0.1  # it tips
    others = [b.index for b in scene.bodies if b is not top]
    assert np.abs(s.velocity[:, others]).max() < 1e-12
    # about the edge: m (k^2 + h^2) dw/dt = m g .02
    inertia = 1.0 * ((0.2**2 + 0.1**2) / 12 + 0.02**2 + 0.05**2)
    w0 = 9.81 * 0.02 / inertia
    assert np.isclose(abs(s.angular_velocity[1, top.index, 0]), w0 * s.t[1], rtol=1e-3)
    assert np.abs(s.ledger.residual).max() < 1e-12
