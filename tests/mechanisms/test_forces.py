"""Springs, dampers, constant forces and torques; their places in the energy ledger."""

import numpy as np
import pytest
from mechanism_scenes import orders, run

import carom
from carom import GROUND, Scene, forces, joints
from verified import agree, verifies

M, K = 2.0, 50.0
OMEGA = np.sqrt(K / M)


def oscillator(damping=0.0, slider=False):
    """A mass on a spring along x, 0.1 m beyond the rest length 1 m."""
    scene = Scene(gravity=(0, 0, 0))
    scene.add_body(mass=M, inertia=[1, 1, 1], position=(1.1, 0, 0), name="mass")
    spring = forces.Spring(K, (0, 0, 0), (1.1, 0, 0), rest_length=1.0, damping=damping)
    scene.add_force(spring, scene["mass"], name="spring")
    if slider:
        scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, scene["mass"])
    return scene


def stretch(t, damping=0.0):
    """x - 1 of m x'' + d x' + k (x - 1) = 0 from 0.1 at rest."""
    a = 0.5 * damping / M
    w = np.sqrt(OMEGA**2 - a * a)
    return 0.1 * np.exp(-a * t) * (np.cos(w * t) + a / w * np.sin(w * t))


@pytest.mark.few(4)
@pytest.mark.parametrize("slider", [False, True])
@pytest.mark.parametrize("damping", [0.0, 3.0])
@pytest.mark.parametrize(("method", "order", "h"), [("rk4", 4, 0.02), ("paper", 2, 0.01)])
def test_oscillator(method, order, h, damping, slider):
    ends = [run(oscillator(damping, slider), 2.0, h / n, method=method) for n in (1, 2, 4)]
    errors = [abs(s.position[-1, 0, 0] - 1.0 - stretch(2.0, damping)) for s in ends]
    np.testing.assert_allclose(orders(errors), order, rtol=0, atol=0.15)
    assert np.max(np.abs(ends[-1].position[-1, 0, 1:])) < 1e-15


@verifies("forces.Spring", "the work of the damper is what the energy loses", "invariant")
def test_damper_takes_the_energy():
    s = carom.simulate(oscillator(3.0), 2.0, step=0.005)
    start = 0.5 * K * 0.1**2
    agree(s.total_energy[0], start, rtol=1e-14)
    lost = s.total_energy - start
    agree(s.ledger.loads, lost, atol=1e-8 * start)
    assert np.all(np.diff(s.ledger.loads) <= 0.0)
    assert s.ledger.loads[-1] < -0.9 * start
    agree(s.ledger.residual, 0.0, atol=1e-8 * start)


@verifies(
    "forces.Spring", r"$s = s_0 \cos\sqrt{k/\mu}\,t$, $\mu = m_1 m_2/(m_1 + m_2)$", "closed form"
)
def test_spring_between_two_bodies_moves_them_about_their_centre():
    """Reduced mass m1 m2/(m1 + m2); momentum stays zero."""
    scene = Scene(gravity=(0, 0, 0))
    for k, (m, x) in enumerate(((1.0, 0.0), (3.0, 1.2))):
        scene.add_body(mass=m, inertia=[1, 1, 1], position=(x, 0, 0), name=f"b{k}")
    spring = forces.Spring(30.0, (0, 0, 0), (1.2, 0, 0), rest_length=1.0)
    scene.add_force(spring, scene["b0"], scene["b1"])
    s = carom.simulate(scene, 1.0, step=0.005)
    w = np.sqrt(30.0 / 0.75)
    gap = s.position[:, 1, 0] - s.position[:, 0, 0]
    agree(gap, 1.0 + 0.2 * np.cos(w * s.t), atol=1e-7)
    momentum = s.velocity[:, 0] + 3.0 * s.velocity[:, 1]
    agree(momentum, 0.0, atol=1e-14)


def test_spring_off_the_centre_turns_the_body():
    """A hinge with a torsional effect: small swing of a bar, held by a spring at its end."""
    scene = Scene(gravity=(0, 0, 0))
    scene.add_body(mass=1.0, inertia=[1 / 12] * 3, position=(0.5, 0, 0), name="bar")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, scene["bar"])
    far = 1e4  # a spring so long that it stays parallel to y: k y at the end of the bar
    scene.add_force(
        forces.Spring(4.0, (1, -far, 0), (1, 0, 0), rest_length=far - 1e-3), scene["bar"]
    )
    s = run(scene, 1.0, 0.005)
    w = np.sqrt(4.0 / (1 / 3))  # k l^2/(m l^2/3), pulled towards y = -1 mm
    angle = 2.0 * s.orientation[-1, 0, 3]
    assert angle == pytest.approx(-1e-3 * (1.0 - np.cos(w)), rel=1e-5)


@verifies("forces.Torque", r"$\omega = M t/J$, work $M\varphi$", "closed form")
def test_torque_on_a_free_body_and_its_work():
    scene = Scene(gravity=(0, 0, 0))
    body = scene.add_body(mass=1.0, inertia=[0.5] * 3)
    scene.add_force(forces.Torque((0, 0, 2.0)), body)
    s = carom.simulate(scene, 1.5, step=0.01)
    agree(s.angular_velocity[:, 0, 2], 4.0 * s.t, atol=1e-12)
    agree(s.ledger.loads, 2.0 * 2.0 * s.t**2, atol=1e-9)  # angle 2 t^2
    agree(s.ledger.residual, 0.0, atol=1e-9)


def test_torque_between_bodies_keeps_angular_momentum():
    scene = Scene(gravity=(0, 0, 0))
    for k, x in enumerate((-1.0, 1.0)):
        scene.add_body(mass=1.0, inertia=[0.2 + 0.1 * k] * 3, position=(x, 0, 0), name=f"b{k}")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), scene["b0"], scene["b1"])
    scene.add_force(forces.Torque((0, 0, 1.0)), scene["b0"], scene["b1"])
    s = carom.simulate(scene, 1.0, step=0.01)
    spin = sum(
        (0.2 + 0.1 * k) * s.angular_velocity[:, k] + np.cross(s.position[:, k], s.velocity[:, k])
        for k in (0, 1)
    )
    np.testing.assert_allclose(spin, 0.0, rtol=0, atol=1e-8)
    assert s.kinetic_energy[-1] > 0.5
    np.testing.assert_allclose(s.ledger.residual, 0.0, rtol=0, atol=1e-7)


@verifies("joints.Prismatic", "$x = F t^2/2m$; reactions by the balance of forces", "closed form")
@verifies("forces.Force", "$x = F t^2/2m$, work $F x$", "closed form")
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_constant_force_on_a_slider(method):
    scene = Scene(gravity=(0, 0, -9.81))
    body = scene.add_body(mass=2.0, inertia=[1, 1, 1])
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body)
    scene.add_force(forces.Force((3.0, 5.0, 0), anchor=(0, 0, 0.2)), body)
    s = carom.simulate(scene, 1.0, step=0.02, method=method)
    agree(s.position[:, 0], s.t[:, None] ** 2 * [0.75, 0, 0], atol=1e-12)
    agree(s.ledger.loads, 3.0 * 0.75 * s.t**2, atol=1e-11)
    f = s.joint_reactions[:, 0]
    agree(f[:, :3], np.tile([0, -5.0, 2 * 9.81], (len(f), 1)), atol=1e-9)
    # torque of the guide: against r x F = (0, 0, .2) x (3, 5, 0) = (-1, .6, 0)
    agree(f[:, 3:], np.tile([1.0, -0.6, 0], (len(f), 1)), atol=1e-9)


def test_equilibrium_stays():
    """A bar at rest on a hinge and a spring: all methods keep it where it is."""
    scene = Scene()
    bar = scene.add_body(mass=1.0, inertia=[0.01, 1 / 12, 1 / 12], position=(0.5, 0, 0))
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, bar)
    # the spring at the end carries half the weight: 9.81/2 N over 0.5 m beyond rest
    scene.add_force(forces.Spring(9.81, (1, 0, 1), (1, 0, 0), rest_length=0.5), bar)
    for method in ("rk4", "paper", "paper-ode"):
        s = run(scene, 1.0, 0.01, method=method)
        np.testing.assert_allclose(s.position[-1], s.position[0], rtol=0, atol=1e-12)
        np.testing.assert_allclose(
            s.joint_reactions[-1, 0, :3], [0, 0, 0.5 * 9.81], rtol=0, atol=1e-9
        )
