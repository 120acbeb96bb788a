"""The symplectic methods with gears, motors, rolling and rows of the user's own: order, constraints, energy."""

import numpy as np
import pytest
from mechanism_scenes import about, orders, run

import carom
from carom import GROUND, Scene, constraints, forces, joints

#: the energy of a symplectic step goes to and fro by 1e-3 of it at these steps, and that is said
pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")

METHODS = {"rattle": 2.0, "rattle4": 4.0, "rattle6": 6.0}
STEPS = {"rattle": (1e-2, 5e-3), "rattle4": (2e-2, 1e-2), "rattle6": (4e-2, 2e-2)}


def two_rods(parent_is_first):
    """Two rods on hinges, the second on the first or on the ground; and their joints."""
    scene = Scene()
    one = scene.add_body(mass=1, inertia=[0.1, 0.2, 0.3], position=(0.5, 0, 0))
    two = scene.add_body(mass=2, inertia=[0.2, 0.3, 0.1], position=(1.5, 0, 0))
    first = scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, one)
    above = one if parent_is_first else GROUND
    second = scene.add_joint(joints.Revolute((1, 0, 0), (0, 1, 0)), above, two)
    return scene, first, second


def geared():
    scene, first, second = two_rods(False)
    scene.add_constraint(constraints.Gear(first, second, -2.0))
    return scene


def motion(t):
    return np.sin(2 * t) ** 2, 2 * np.sin(4 * t), 8 * np.cos(4 * t)


def driven():
    """A motor at the first hinge: rheonomic, it does work."""
    scene, first, _ = two_rods(True)
    scene.add_constraint(constraints.Driver(first, motion=motion))
    return scene


def disc():
    """A leaning disc that rolls in a curve."""
    lean, radius, w = 0.3, 0.5, np.array([0.3, 2.0, 1.0])
    axis = np.array([0.0, np.cos(lean), np.sin(lean)])
    up = np.array([0.0, -np.sin(lean), np.cos(lean)])
    scene = Scene()
    body = scene.add_body(
        mass=1.0, inertia=[0.0625, 0.125, 0.0625], position=(0, 0, radius * np.cos(lean)),
        orientation=about((1, 0, 0), lean), velocity=np.cross(w, radius * up), angular_velocity=w,
    )  # fmt: skip
    scene.add_joint(joints.RollingDisc(radius, axis), GROUND, body)
    return scene


def ball_on_a_turntable():
    """The plane itself turns, by what the ball does to it."""
    scene, radius, turn = Scene(gravity=(1, 0, -9)), 0.2, np.array([0, 0, 1.5])
    table = scene.add_body(mass=1.0, inertia=[0.3] * 3, angular_velocity=turn)
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, table)
    w = np.array([0.5, 0.2, 1.0])
    ball = scene.add_body(
        mass=1.0, inertia=[0.016, 0.017, 0.018], position=(0.5, 0, radius), angular_velocity=w,
        velocity=np.cross(turn, [0.5, 0, 0]) + np.cross(w, [0, 0, radius]),
    )  # fmt: skip
    scene.add_joint(joints.RollingSphere(radius), table, ball)
    return scene


def rows_of_the_users():
    """A blade that is pushed sideways as 0.1 sin t: nonholonomic and rheonomic."""
    scene = Scene(gravity=(1, 0, 0))
    body = scene.add_body(mass=1.0, inertia=[1] * 3, angular_velocity=(0, 0, 1.5))

    def function(t, poses):
        w, x, y, z = poses[0, 3:]
        across = (2 * (x * y - w * z), 1 - 2 * (x**2 + z**2), 2 * (y * z + w * x))
        return np.array([[*across, 0, 0, 0, 0.1 * np.sin(t)]])

    scene.add_constraint(constraints.Rows([body], function, 1))
    return scene


MAKE = [geared, driven, disc, ball_on_a_turntable, rows_of_the_users]


@pytest.mark.few(5)
@pytest.mark.parametrize("make", MAKE)
@pytest.mark.parametrize("method", METHODS)
def test_order_and_constraints(make, method):
    known = run(make(), 0.6, 1e-3, method="rk8").position[-1]
    runs = [carom.simulate(make(), 0.6, step=h, method=method) for h in STEPS[method]]
    found = [np.max(np.abs(s.position[-1] - known)) for s in runs]
    np.testing.assert_allclose(orders(found), METHODS[method], rtol=0, atol=0.4)
    assert max(np.max(e) for e in runs[0].constraint_errors) < 1e-13
    assert runs[0].stats["explicit_steps"] == 0
    # what motors give is in the ledger: its residual is the error of the method
    errors = [np.max(np.abs(s.ledger.residual)) for s in runs]
    assert orders(errors)[0] > METHODS[method] - 0.35


def test_motor_works():
    s = carom.simulate(driven(), 0.6, step=5e-3, method="rattle4")
    turned = s.joint_coordinates(s.scene.joints[0])[0][:, 0]
    np.testing.assert_allclose(turned, np.sin(2 * s.t) ** 2, rtol=0, atol=1e-13)
    assert s.ledger.loads[-1] < -5.0  # against gravity, on the way down


@pytest.mark.parametrize("make", MAKE)
def test_steps_of_varying_length(make):
    known = run(make(), 0.6, 1e-3, method="rk8").position[-1]
    s = carom.simulate(make(), 0.6, step="auto", rtol=1e-8)
    assert np.max(np.abs(s.position[-1] - known)) < 1e-8


@pytest.mark.plain
@pytest.mark.parametrize("method", [*METHODS, "paper", "paper-ode"])
def test_dry_friction_is_refused(method):
    scene, first, _ = two_rods(True)
    scene.add_force(forces.JointFriction(first, 1.0))
    with pytest.raises(ValueError, match=r"method must be .* if joints have dry friction, got '"):
        carom.simulate(scene, 1.0, step=0.01, method=method)
