"""Second-order multipliers: the reaction h_R is Lagrange's; (lambda, mu) code its history."""

import numpy as np
import pytest
from dense_reference import solve
from mechanism_scenes import G, chain, four_bar, matrix, orders, pendulum
from multipliers import second_order_multipliers
from random_forests import MORE, build, plan

import carom
from carom import GROUND, Options, Scene, forces, joints

#: methods of order 2 miss the energy by 1e-4 to 1e-3 of it at these steps, and say so
pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")


def wrenches(solution, m):
    """Sum of h_R a^R for each joint on its child (T, J, 6): force, and torque about its anchor."""
    scene, out = solution.scene, np.zeros((len(solution.t), len(solution.scene.joints), 6))
    for k, j in enumerate(m.joint):
        joint = scene.joints[j]
        b = joint.child.index
        f = m.reaction[:, k, None] * m.rows[:, k, b, :3]
        inside = m.reaction[:, k, None] * m.rows[:, k, b, 3:]
        d = joint.definition
        anchor = getattr(d, "anchor_child", getattr(d, "anchor", None))
        arm = np.zeros(3) if anchor is None else anchor - joint.child.position
        for t, q in enumerate(solution.orientation[:, b]):
            turned = matrix(q) @ matrix(joint.child.orientation).T @ arm
            torque = matrix(q) @ inside[t] - np.cross(turned, f[t])
            out[t, j] += [*f[t], *torque]
    return out


def mechanisms():
    rng = np.random.default_rng(3)
    rows = plan(rng, 4)
    more = plan(rng, len(MORE), floating=0.0, kinds=MORE, each=True)
    for row in [*rows, *more]:  # principal axes are the body's: rows are then in the body's axes
        row["inertia"] = np.diag(np.linalg.eigvalsh(row["inertia"]))
    sleigh = Scene(gravity=(0, 0, 0))
    body = sleigh.add_body(
        mass=1,
        inertia=[1, 1, 1],
        position=(1, 0, 0),
        velocity=(0, 1, 0),
        angular_velocity=(0, 0, 1),
    )
    sleigh.add_joint(joints.KnifeEdge((0, 0, 0), (1, 0, 0)), GROUND, body)
    return dict(
        pendulum=pendulum(), hinge=pendulum("Revolute"), ball=pendulum("Spherical"),
        chain=chain(3, angles=[0.2, 1.0, -0.3]), forest=build(rows), blade=sleigh, more=build(more),
        four_bar=four_bar(2, angle=0.4),
    )  # fmt: skip


@pytest.mark.parametrize("name", mechanisms())
def test_reaction_is_the_classical_multiplier(name):
    solution = carom.simulate(mechanisms()[name], 0.1, step=0.01)
    m = second_order_multipliers(solution)
    scale = np.max(np.abs(solution.joint_reactions)) + 1.0
    np.testing.assert_allclose(
        wrenches(solution, m), solution.joint_reactions, rtol=0, atol=1e-7 * scale
    )  # fmt: skip


def test_reaction_against_a_dense_solve_of_other_rows():
    scene = mechanisms()["four_bar"]
    solution = carom.simulate(scene, 0.01, step=0.01)
    found = wrenches(solution, second_order_multipliers(solution))[0, :, :3]
    np.testing.assert_allclose(found, solve(scene)[1][:, 0, :3], rtol=0, atol=1e-5)


@pytest.mark.parametrize("name", mechanisms())
def test_directions_and_the_law_along_them(name):
    solution = carom.simulate(mechanisms()[name], 0.1, step=0.01)
    m = second_order_multipliers(solution)
    across = np.einsum("tknc,tlnc->tkl", m.directions, m.rows)  # a^S(c_R)
    np.testing.assert_allclose(np.einsum("tkk->tk", across), 1.0, rtol=1e-12)
    assert np.all(m.mass > 0.0)
    if name != "four_bar":  # with redundant rows the law holds in their span only
        balance = np.einsum("tkl,tl->tk", across, m.reaction) + m.force + m.affinity
        np.testing.assert_allclose(balance, 0.0, rtol=0, atol=1e-9 * np.max(np.abs(m.reaction)))


def test_pendulum_numbers():
    """Unit row: m_RR = m, f_R = m g along the rod, no stiffness, h = -3 m g cos(theta)."""
    solution = carom.simulate(pendulum(), 2.0, step=0.0025)
    m, x = second_order_multipliers(solution), solution.position[:, 0]
    np.testing.assert_allclose(m.mass, 1.0, rtol=1e-12)
    np.testing.assert_allclose(m.force[:, 0], -G * x[:, 1], rtol=0, atol=1e-10)
    np.testing.assert_allclose(m.damping, 0.0, rtol=0, atol=1e-9)
    np.testing.assert_allclose(m.stiffness, 0.0, rtol=0, atol=1e-9)
    np.testing.assert_allclose(m.reaction[:, 0], 3.0 * G * x[:, 1], rtol=0, atol=1e-7)
    # lambda'' = h + f = -2 g cos(theta) = -v^2: twice integrated along the motion
    rate = -np.sum(solution.velocity[:, 0] ** 2, axis=1)
    mu = np.concatenate([[0.0], np.cumsum(0.0025 * 0.5 * (rate[1:] + rate[:-1]))])
    np.testing.assert_allclose(m.velocity[:, 0], mu, rtol=0, atol=1e-6)
    # and back: the reaction from (lambda, mu), by the same update
    sigma = m.mass * m.velocity
    back = np.diff(sigma, axis=0) / 0.0025 - 0.5 * (m.force[1:] + m.force[:-1])
    middle = 0.5 * (m.reaction[1:] + m.reaction[:-1])
    np.testing.assert_allclose(back, middle, rtol=0, atol=1e-9)


def test_spring_and_damper_along_the_row():
    """A spring across the joint: k_RR and c_RR are its stiffness and damping at the centre."""
    scene = Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=2.0, inertia=[1, 1, 1], position=(1, 0, 0))
    scene.add_joint(joints.Distance((0, 0, 0), (1, 0, 0)), GROUND, body)
    scene.add_force(forces.Spring(7.0, (0, 0, 0), (1, 0, 0), damping=3.0), body)
    m = second_order_multipliers(carom.simulate(scene, 0.1, step=0.01))
    np.testing.assert_allclose(m.mass, 2.0)
    np.testing.assert_allclose(m.stiffness, 7.0, rtol=1e-6)
    np.testing.assert_allclose(m.damping, 3.0, rtol=1e-6)
    np.testing.assert_allclose(m.velocity, 0.0, rtol=0, atol=1e-12)


def mean_reaction(step):
    """h_R of each step of the ODE form, row a = grad of (|x|^2 - l^2)/2 at the middle of the arc.

    From the momentum balance p1 - p0 = h (f + h_R a); beta = 1/2, so k_s = m_RR/(4 h^2).
    """
    options = Options(natural_frequency=0.5)
    s = carom.simulate(pendulum(), 10.0, step=step, method="paper-ode", options=options)
    x, v = s.position[:, 0], s.velocity[:, 0]
    a = 0.5 * (x[1:] + x[:-1])
    force = np.diff(v, axis=0) / step - [0.0, -G, 0.0]
    return np.sum(force * a, axis=1) / np.sum(a * a, axis=1), a


@pytest.mark.parametrize(("step", "error"), [(0.01, 2.4e-2), (0.005, 3.6e-3), (0.0025, 6.1e-4)])
def test_mean_reaction_of_the_ode_form(step, error):
    """h_R -> -3 m g cos(theta)/l from the horizontal; errors of an independent program at 10 s."""
    h, a = mean_reaction(step)
    assert np.max(np.abs(h - 3.0 * G * a[:, 1])) == pytest.approx(error, rel=0.03)


def test_mean_reaction_of_the_exact_form_has_order_two():
    errors = []
    for step in (0.01, 0.005, 0.0025):
        s = carom.simulate(pendulum(), 2.0, step=step, method="paper")
        m = second_order_multipliers(s)
        errors.append(np.max(np.abs(m.reaction[:, 0] - 3.0 * G * s.position[:, 0, 1])))
    np.testing.assert_allclose(orders(errors), 2.0, rtol=0, atol=0.1)


def test_refuses_what_it_cannot_say():
    scene = Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.1))
    scene.add_contact(ball, ground, restitution=0)
    with pytest.raises(ValueError, match="with joints, got none"):
        second_order_multipliers(carom.simulate(scene, 0.01, step=0.01))
    other = scene.add_body(mass=1, inertia=[1, 1, 1], position=(5, 0, 0))
    scene.add_joint(joints.Distance((5, 0, 1), (5, 0, 0)), GROUND, other)
    with pytest.raises(ValueError, match="without persistent contacts"):
        second_order_multipliers(carom.simulate(scene, 0.02, step=0.01))
