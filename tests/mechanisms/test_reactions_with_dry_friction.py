"""Reactions and forces where dry friction acts in joints: against the change of momenta, and at rest."""

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints

G = 9.81


def rod(bound):
    """A rod of 2 kg and 1 m on a hinge with dry friction, from the horizontal."""
    scene = carom.Scene()
    scene.add_body(carom.Box(1, 0.1, 0.1), mass=2, position=(0.5, 0, 0), name="rod")
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "rod", name="hinge")
    scene.add_force(forces.JointFriction("hinge", bound), name="dry")
    return scene


def test_a_rod_that_slips():
    """m a = m g + F, and the friction has its bound against the motion."""
    h = 1e-3
    run = carom.simulate(rod(3.0), 0.3, step=h)
    a = (run["rod"].velocity[2:] - run["rod"].velocity[:-2]) / (2 * h)
    force = 2 * a + [0, 0, 2 * G]
    np.testing.assert_allclose(run["hinge"].force[2:-1], force[1:], atol=1e-3)
    np.testing.assert_allclose(run["dry"].torque[1:], -3.0, rtol=1e-12)
    np.testing.assert_allclose(run["dry"].power, run["dry"].torque * run["hinge"].rate, atol=1e-12)
    assert run["dry"].torque[0] == pytest.approx(-3.0)  # it is about to slip


def test_a_rod_that_sticks():
    """The friction carries the moment of the weight, and the hinge the weight."""
    live = carom.Run(rod(12.0), step=0.01)
    live.advance(0.1)
    for one, k in ((live.solution, -1), (live.state, ...)):
        assert one["dry"].torque[k] == pytest.approx(-2 * G * 0.5, rel=1e-9)
        np.testing.assert_allclose(one["hinge"].force[k, :] if k == -1 else one["hinge"].force,
                                   [0, 0, 2 * G], atol=1e-9)  # fmt: skip


def test_a_slide(tmp_path):
    """A block on a rail: mu stands for a constant bound, so m a = F - bound, and then it is held."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(
        carom.Box(1, 1, 1), mass=2.0, position=(0, 0, 1), velocity=(1, 0, 0), name="block"
    )
    scene.add_joint(joints.Prismatic((1, 0, 0), (0, 0, 0)), GROUND, "block", name="rail")
    scene.add_force(forces.JointFriction("rail", 4.0), name="dry")
    scene.add_force(forces.Force((1.0, 0, 0)), "block", name="wind")
    run = carom.simulate(scene, 1.0, step=0.01)
    slips = run["rail"].rate > 1e-6
    np.testing.assert_allclose(run["dry"].force[slips], -4.0)
    np.testing.assert_allclose(run["dry"].force[-5:], -1.0, rtol=1e-9)
    # the rail carries the weight; the friction acts a metre below the centre of the block
    np.testing.assert_allclose(run["rail"].force[:, 2], 2 * G, rtol=1e-9)
    run.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(loaded["dry"].force, run["dry"].force)


def test_a_brake_that_holds_on_moving_bodies_gives_what_it_must_not_its_bound():
    # a torque M turns two bars that a brake keeps straight: a = M/J of both together, and the brake gives
    # the second bar J2 a and the moment of the pin force m2 a r2 at the distance s2 from its centre
    m1, m2, J1, J2, d, s2, M = 1.0, 0.7, 0.02, 0.01, 0.4, 0.2, 0.5
    scene = carom.Scene(gravity=(0, 0, 0))
    first = scene.add_body(mass=m1, inertia=(J1,) * 3, angular_velocity=(0, 0, 2))
    second = scene.add_body(
        mass=m2,
        inertia=(J2,) * 3,
        position=(d, 0, 0),
        velocity=(0, 2 * d, 0),
        angular_velocity=(0, 0, 2),
    )
    scene.add_joint(carom.joints.Revolute((d - s2, 0, 0), (0, 0, 1)), first, second, name="pin")
    scene.add_force(carom.forces.JointFriction("pin", 50.0), name="brake")
    scene.add_force(carom.forces.Torque((0, 0, M)), first)
    a = M / (J1 + J2 + m1 * m2 / (m1 + m2) * d**2)
    exact = J2 * a + s2 * m2 * a * d * m1 / (m1 + m2)
    solution = carom.simulate(scene, 0.1, step=0.01)
    assert np.abs(solution["brake"].torque - exact).max() < 1e-9 * exact
    assert "brake" in solution
    assert second in solution
    assert "brakes" not in solution
    live = carom.Run(scene, step=0.01)
    live.advance(0.1)
    assert abs(live.state["brake"].torque - exact) < 1e-9 * exact


def test_a_state_has_the_loads_of_other_joints_where_a_brake_sticks():
    # two bars that a brake keeps straight are one: gravity and a motor at the shoulder accelerate it by a
    scene = carom.Scene()
    arm = scene.add_body(mass=1.0, inertia=(0.01,) * 3, position=(0.2, 0, 0))
    fore = scene.add_body(mass=0.7, inertia=(0.01,) * 3, position=(0.6, 0, 0))
    scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, arm, name="shoulder")
    scene.add_joint(carom.joints.Revolute((0.4, 0, 0), (0, 1, 0)), arm, fore, name="elbow")
    scene.add_force(carom.forces.JointForce("shoulder", 2.0), name="motor")
    scene.add_force(carom.forces.JointFriction("elbow", 50.0), name="brake")
    live = carom.Run(scene, step=0.01)
    live.advance(0.2)
    state = live.state
    q, rate = state["shoulder"].coordinate, state["shoulder"].rate
    a = (2 + scene.gravity[2] * -np.cos(q) * (1.0 * 0.2 + 0.7 * 0.6)) / (0.02 + 0.04 + 0.7 * 0.36)
    out, along = np.array([np.cos(q), 0, -np.sin(q)]), np.array([-np.sin(q), 0, -np.cos(q)])
    force = 0.7 * (0.6 * (a * along - rate**2 * out) - scene.gravity)
    assert np.abs(state["elbow"].force - force).max() < 1e-6
    assert abs(state["brake"].torque - (0.01 * a + 0.2 * force @ along)) < 1e-6


def test_a_state_has_the_whole_turns_that_its_run_counts():
    # a rotor on a clock spring: q = w/n sin(n t), n^2 = k/J; it is wound by almost two turns
    scene = carom.Scene(gravity=(0, 0, 0))
    rotor = scene.add_body(mass=1.0, inertia=(0.01,) * 3, angular_velocity=(0, 0, 12))
    scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 0, 1)), carom.GROUND, rotor, name="axle")
    scene.add_force(carom.forces.JointSpring("axle", 0.001), name="coil")
    live = carom.Run(scene, step=0.01)
    live.advance(1.0)
    n = np.sqrt(0.001 / 0.01)
    q, axle, coil = 12 / n * np.sin(n), live.state["axle"], live.state["coil"]
    assert abs(axle.coordinate - q) < 1e-6
    assert abs(axle.coordinates(degrees=True)[0] - np.degrees(q)) < 1e-4
    assert abs(coil.torque + 0.001 * q) < 1e-9
    assert coil.coordinate == axle.coordinate


def test_friction_by_a_law_is_that_of_the_run(tmp_path):
    """In slip it is the law at the rate, m a = m g + F as with a number; held it is up to the static bound."""
    law, h = carom.Friction(4.0, 2.0, speed=0.5), 1e-3
    run = carom.simulate(rod(law), 0.3, step=h)
    dry, rate = run["dry"], run["hinge"].rate
    np.testing.assert_allclose(dry.torque[5:], -law(rate[5:]), rtol=1e-12)
    a = (run["rod"].velocity[2:] - run["rod"].velocity[:-2]) / (2 * h)
    np.testing.assert_allclose(run["hinge"].force[6:-1], (2 * a + [0, 0, 2 * G])[5:], atol=1e-3)
    run.save(tmp_path / "run.nc")
    assert np.array_equal(carom.Solution.load(tmp_path / "run.nc")["dry"].torque, dry.torque)
    live = carom.Run(rod(carom.Friction(12.0, 2.0)), step=0.01)
    live.advance(0.1)
    assert live.state["dry"].torque == pytest.approx(-2 * G * 0.5, rel=1e-9)
