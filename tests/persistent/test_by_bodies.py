"""The springs of a large group by the motion of its bodies: the same solutions as with full matrices."""

import numpy as np
import pytest

import carom
from carom._compiled.decorators import entry
from carom.impact.workspace import new_equations
from carom.persistent import by_bodies


@entry
def solve(n, equations, x, q):
    """Write q = R Y x, and replace x by (R Y + D)^-1 x."""
    by_bodies.factor_by_bodies(n, equations)
    by_bodies.multiply_by_bodies(n, equations, x, q)
    by_bodies.solve_by_bodies(n, equations, x)


def random_group(bodies, points, rng):
    """Return equations of points between bodies of a ring, or on the ground, with slip; and R Y and D."""
    n = 3 * points
    equations = new_equations(n, bodies)
    equations.bodies[0] = bodies
    R, Y, D = np.zeros((n, 6 * bodies)), np.zeros((6 * bodies, n)), np.zeros(n)
    masses = 10.0 ** rng.uniform(-2, 2, bodies)
    for i in range(points):
        a = int(rng.integers(bodies))
        b = -1 if rng.random() < 0.3 else (a + 1) % bodies
        inverse = 1 / masses[a] + (1 / masses[b] if b >= 0 else 0)
        d = 0.5 * rng.normal(size=2) * (rng.random() < 0.5)
        for r in range(3):
            arm = equations.arms[3 * i + r]
            arm.body[:] = a, b
            D[3 * i + r] = 1e-5 * inverse * (1 if r == 0 else 1e3)
            arm.stiffness = 1 / D[3 * i + r]
            for side in (0, 1) if b >= 0 else (0,):
                arm.row[side] = rng.normal(size=6)
                arm.motion[side] = arm.row[side] / masses[arm.body[side]]
        for r in range(3):
            arm = equations.arms[3 * i + r]
            for side in (0, 1) if b >= 0 else (0,):
                arm.push[side] = arm.motion[side]
                for t in (1, 2) if r == 0 else ():
                    arm.push[side] -= d[t - 1] * equations.arms[3 * i + t].motion[side]
                at = slice(6 * arm.body[side], 6 * arm.body[side] + 6)
                R[3 * i + r, at], Y[at, 3 * i + r] = arm.row[side], arm.push[side]
    return equations, R @ Y, D


@pytest.mark.parametrize(("bodies", "points"), [(2, 8), (5, 30), (12, 48), (24, 138)])
def test_the_solution_is_that_of_the_full_matrix(bodies, points):
    rng = np.random.default_rng(points)
    equations, A, D = random_group(bodies, points, rng)
    # unknown are all rows but some, in any order
    n = 3 * points - points // 2
    rows = rng.permutation(3 * points)[:n]
    equations.rows[:n] = rows
    A, D, x, q = A[np.ix_(rows, rows)], D[rows], rng.normal(size=n), np.zeros(n)
    given = x.copy()
    solve(n, equations, x, q)
    np.testing.assert_allclose(q, A @ given, rtol=1e-13, atol=1e-13 * np.abs(A).max() * n)
    whole, exact = A + np.diag(D), np.linalg.solve(A + np.diag(D), given)
    for error in (1e-7, 1e-10):  # by the first, and by a correction
        assert np.abs(x - exact).max() < error * np.abs(exact).max()
        left = given - whole @ x
        solve(n, equations, left, q)
        x += left


def wall(rows):
    """A wall of bricks in bond, each on two others, at rest; a lighter one beyond the edge of the last tips."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(restitution=0.0, friction=0.6)
    a, b, c = 0.2, 0.1, 0.1
    for i in range(rows):
        for j in range(rows - i):
            y = (j + 0.5 * i) * (a + 1e-4)
            scene.add_body(carom.Box(b, a, c), mass=3.0, position=(0, y, (i + 0.5) * c))
    edge = 0.5 * (rows - 1) * (a + 1e-4) + 0.5 * a
    top = scene.add_body(carom.Box(b, a, c), mass=1.0, position=(0, edge + 0.02, (rows + 0.5) * c))
    return scene, top


def test_a_wall_stands_while_a_brick_tips():
    scene, top = wall(5)
    s = carom.simulate(scene, 0.02)
    assert s.stats["whole_steps"] == 0
    assert abs(s.angular_velocity[-1, top.index, 0]) > 0.1  # it tips
    others = [b.index for b in scene.bodies if b is not top]
    assert np.abs(s.velocity[:, others]).max() < 1e-12
    # about the edge: m (k^2 + h^2) dw/dt = m g .02
    inertia = 1.0 * ((0.2**2 + 0.1**2) / 12 + 0.02**2 + 0.05**2)
    w0 = 9.81 * 0.02 / inertia
    assert np.isclose(abs(s.angular_velocity[1, top.index, 0]), w0 * s.t[1], rtol=1e-3)
    assert np.abs(s.ledger.residual).max() < 1e-12
