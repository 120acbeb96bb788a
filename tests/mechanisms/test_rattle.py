"""The symplectic methods: orders, symmetry, momenta, energy over a long time, singular positions, impacts."""

import numpy as np
import pytest
import test_heavy_top as heavy_top
from mechanism_scenes import G, chain, four_bar, matrix, orders, pendulum, run
from test_knife_edge import heading, sideways, sled, sled_place, sleigh

import carom
from carom import GROUND, Scene, forces, joints
from references import chaplygin

#: the energy of a symplectic step of order 2 goes to and fro by 1e-3 of it at these steps, and that is said
pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")

METHODS = {"rattle": 2.0, "rattle4": 4.0, "rattle6": 6.0}


def fallen(solution):
    """Steps that the explicit method took."""
    return solution.stats["explicit_steps"]


@pytest.mark.parametrize(
    ("method", "steps"),
    [("rattle", (1e-3, 5e-4)), ("rattle4", (1e-3, 5e-4)), ("rattle6", (2e-3, 1e-3))],
)
def test_order_on_the_heavy_top(method, steps):
    """Turns by 0.15 rad in a step of 1 ms, inertia far from equal: the map carries the gyroscopic part."""
    found = [heavy_top.errors(heavy_top.simulate(0.2, h, method)) for h in steps]
    np.testing.assert_allclose(orders(found), METHODS[method], rtol=0, atol=0.15)


@pytest.mark.parametrize(
    ("method", "steps"),
    [("rattle", (2e-3, 1e-3)), ("rattle4", (8e-3, 4e-3)), ("rattle6", (1.6e-2, 8e-3))],
)
@pytest.mark.parametrize("make", [lambda: chain(3), lambda: four_bar(angle=0.3)])
def test_order_of_chain_and_loop(make, method, steps):
    known = run(make(), 0.48, 2e-3, method="rk8").position[-1]  # to 1e-14: order 8
    found = [
        np.max(np.abs(run(make(), 0.48, h, method=method).position[-1] - known)) for h in steps
    ]
    assert orders(found)[0] > METHODS[method] - 0.3
    assert found[-1] < 1e-5


@pytest.mark.few(6)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("make", [pendulum, lambda: chain(3), four_bar, heavy_top.top])
def test_joints_hold_to_round_off(make, method):
    position, velocity = run(make(), 0.1, 1e-3, method=method, save_every=5).constraint_errors
    assert np.max(position) < 1e-13
    assert np.max(velocity) < 1e-11  # of 150 m/s of the top


@pytest.mark.parametrize("method", METHODS)
def test_pendulum_for_1000_seconds(method):
    """No trend in energy: 420 swings, released horizontal.

    The energy of a symplectic method goes up and down within each swing, by C h^p; means over 100 s stay.
    """
    s = carom.simulate(pendulum(), 1000.0, step=0.01, method=method)
    error = s.ledger.residual
    swing = error.max() - error.min()
    trend = 1000.0 * np.polyfit(s.t, error, 1)[0]
    # a fit over 420 swings sees 1/420 of one; and round-off of 10^5 steps, all of one sign
    assert abs(trend) < 1e-2 * swing + 1e5 * 1e-15 * G
    assert swing < {"rattle": 4e-3, "rattle4": 3e-7, "rattle6": 3e-10}[method]


def test_explicit_method_has_a_trend():
    """What the test above could see: 1.7e-4 J in 1000 s, all of its error."""
    s = carom.simulate(pendulum(), 100.0, step=0.01)
    error = s.ledger.residual
    assert abs(100.0 * np.polyfit(s.t, error, 1)[0]) > 0.8 * (error.max() - error.min())


def floating(state=None):
    """Three bodies of unequal moments, joined by a ball joint and a hinge, afloat; or in a given state."""
    scene = Scene(gravity=(0, 0, 0))
    if state is None:
        x = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0.2, 0]])
        Q, v, w = np.tile([1.0, 0, 0, 0], (3, 1)), np.zeros((3, 3)), np.zeros((3, 3))
        w[:] = [[1.0, 2.0, -1.5]]
        v[1] = np.cross(w[0], x[1] - x[0])
        w[2] = w[1] + [0, 0, 3.0]
        at = np.array([1.5, 0.0, 0.0])
        v[2] = v[1] + np.cross(w[1], at - x[1]) + np.cross(w[2], x[2] - at)
        state = x, Q, v + [0.3, 0, 0.1], w
    x, Q, v, w = state
    for k in range(3):
        scene.add_body(
            mass=1.0 + k, inertia=[0.1, 0.2, 0.25], position=x[k], orientation=Q[k], velocity=v[k],
            angular_velocity=w[k], name=f"b{k}",
        )  # fmt: skip
    R = matrix(Q[1])
    scene.add_joint(joints.Spherical(x[1] + R @ [-0.5, 0, 0]), scene["b0"], scene["b1"])
    hinge = joints.Revolute(x[1] + R @ [0.5, 0, 0], R @ [0, 0, 1])
    scene.add_joint(hinge, scene["b1"], scene["b2"])
    return scene


def momenta(s):
    """Linear and angular momentum (T, 6) about the origin."""
    total = np.zeros((len(s.t), 6))
    for k in range(3):
        m, J = 1.0 + k, np.array([0.1, 0.2, 0.25])
        x, v, w = s.position[:, k], s.velocity[:, k], s.angular_velocity[:, k]
        R = np.array([matrix(q) for q in s.orientation[:, k]])
        spin = np.einsum("tij,j,tkj,tk->ti", R, J, R, w)
        total += np.hstack([m * v, m * np.cross(x, v) + spin])
    return total


@pytest.mark.parametrize("method", METHODS)
def test_momenta_of_a_floating_chain(method):
    s = carom.simulate(floating(), 5.0, step=0.01, method=method)
    p = momenta(s)
    # round-off of 500 steps of up to 9 parts, 1e-15 each, of momenta of 30 kg m2/s, 10 m from the origin
    assert np.max(np.abs(p - p[0])) < 1e-11
    assert max(np.max(e) for e in s.constraint_errors) < 1e-13


@pytest.mark.parametrize("method", METHODS)
def test_steps_are_undone_by_going_back(method):
    """From the end with velocities turned round, the same steps lead to the start."""
    there = carom.simulate(floating(), 0.5, step=0.02, method=method)
    end = (
        there.position[-1],
        there.orientation[-1],
        -there.velocity[-1],
        -there.angular_velocity[-1],
    )
    back = carom.simulate(floating(end), 0.5, step=0.02, method=method)
    np.testing.assert_allclose(back.position[-1], there.position[0], rtol=0, atol=1e-13)
    np.testing.assert_allclose(back.velocity[-1], -there.velocity[0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(
        back.angular_velocity[-1], -there.angular_velocity[0], rtol=0, atol=1e-12
    )
    # not so the explicit method, of which the error would be a part
    rk4 = carom.simulate(floating(), 0.5, step=0.02)
    end = (rk4.position[-1], rk4.orientation[-1], -rk4.velocity[-1], -rk4.angular_velocity[-1])
    again = carom.simulate(floating(end), 0.5, step=0.02)
    assert np.max(np.abs(again.position[-1] - rk4.position[0])) > 1e-10


def damped(angle=1.0):
    """A pendulum with a spring and a damper from its bob to the ground."""
    scene = pendulum("Revolute")
    scene.add_force(
        forces.Spring(5.0, (-1.0, 0.5, 0), (-0.5, 0, 0), damping=2.0, rest_length=0.3),
        scene["bob"],
    )  # fmt: skip
    return scene


@pytest.mark.parametrize(
    ("method", "steps"),
    [("rattle", (1e-2, 5e-3)), ("rattle4", (4e-2, 2e-2)), ("rattle6", (8e-2, 4e-2))],
)
def test_dampers_keep_the_order(method, steps):
    known = run(damped(), 0.8, 2e-3, method="rk8").position[-1]
    found = [
        np.max(np.abs(run(damped(), 0.8, h, method=method).position[-1] - known)) for h in steps
    ]
    assert orders(found)[0] > METHODS[method] - 0.4
    assert found[-1] < 1e-4


def test_work_of_dampers_is_in_the_ledger():
    errors = []
    for h in (1e-2, 5e-3):
        s = carom.simulate(damped(), 1.0, step=h, method="rattle")
        errors.append(np.max(np.abs(s.ledger.residual)))
    assert s.ledger.loads[-1] < -0.5
    np.testing.assert_allclose(orders(errors), 2.0, rtol=0, atol=0.2)


@pytest.mark.parametrize("method", METHODS)
def test_through_the_singular_position(method):
    """The bars of a parallelogram lie on one line: the step across it is the explicit method's."""
    s = run(four_bar(), 4.0, 0.005, method=method, save_every=1)
    assert np.max(s.constraint_errors[0]) < 1e-12
    assert 0 < fallen(s) < 10  # the four passages
    # of energies of 50 J
    assert (
        np.max(np.abs(s.ledger.residual))
        < {"rattle": 2e-2, "rattle4": 1e-6, "rattle6": 1e-7}[method]
    )


def test_far_from_it_no_step_is_explicit():
    assert fallen(run(four_bar(), 0.5, 0.005, method="rattle")) == 0


@pytest.mark.parametrize("method", METHODS)
def test_blade(method):
    """The knife edge is nonholonomic: symmetric, order kept, the blade does not slip at the ends of steps."""
    found = []
    for h in (0.04, 0.02):
        end = run(sled(), 4.0, h, method=method)
        found.append(np.max(np.abs(end.position[-1, 0] - sled_place(4.0))))
    assert orders(found)[0] > METHODS[method] - 0.2
    solution = carom.simulate(sleigh(), 4.0, step=0.02, method=method)
    assert np.max(np.abs(sideways(solution, 1.0))) < 1e-12
    assert heading(solution)[-1] == pytest.approx(
        chaplygin.heading(4.0), abs={"rattle": 1e-3, "rattle4": 1e-6, "rattle6": 1e-9}[method]
    )


def on_a_wall():
    """A double pendulum that swings against a wall."""
    scene = Scene()
    wall = scene.add_half_space(point=(-0.1, 0, 0), normal=(1, 0, 0))
    above = GROUND
    for k in range(2):
        ball = scene.add_body(carom.Sphere(0.05), mass=1.0, position=(0.5 * (k + 1), 0, 0))
        scene.add_joint(joints.Revolute((0.5 * k, 0, 0), (0, 1, 0)), above, ball)
        scene.add_contact(ball, wall, restitution=0.6, friction=0.2)
        above = ball
    return scene


@pytest.mark.parametrize("method", METHODS)
def test_impacts(method):
    """Located in the step, resolved to round-off: the ledger closes to the error of the free motion."""
    s = carom.simulate(on_a_wall(), 2.5, step=2e-3, method=method)
    known = carom.simulate(on_a_wall(), 2.5, step=2e-3, method="rk8")
    assert len(s.impacts) == len(known.impacts) >= 2
    tolerance = {"rattle": 1e-4, "rattle4": 1e-8, "rattle6": 1e-10}[method]
    np.testing.assert_allclose(s.impacts.time, known.impacts.time, rtol=0, atol=tolerance)
    scale = np.max(s.kinetic_energy)
    assert np.max(np.abs(s.ledger.residual)) < 10 * tolerance * scale
    assert s.ledger.impacts[-1] < -0.1


@pytest.mark.plain
def test_free_body_flies_by_the_closed_form():
    """No joint, no load: the same numbers as with the default method."""
    scene = Scene()
    scene.add_body(mass=1.0, inertia=[1, 2, 3], angular_velocity=(1, 2, 3), velocity=(1, 0, 5))
    one, two = (carom.simulate(scene, 0.2, step=0.02, method=m) for m in ("rk4", "rattle"))
    assert np.array_equal(one.orientation, two.orientation)
    assert np.array_equal(one.position, two.position)


@pytest.mark.plain
def test_a_turn_too_far_is_refused():
    """sin(h w) = h w has no solution for a step of more than a radian: a status, no wrong motion."""
    scene = Scene()
    scene.add_body(mass=1.0, inertia=[1] * 3, angular_velocity=(0, 0, 30))
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, scene.bodies[0])
    s = carom.simulate(scene, 0.5, step=0.05, method="rattle", throw=False)
    assert s.status is carom.Status.NO_CONVERGENCE


JOINTS = {
    "Prismatic": joints.Prismatic((1, 0, 0), (1, 1, 0)),
    "Cylindrical": joints.Cylindrical((1, 0, 0), (1, 1, 0)),
    "Universal": joints.Universal((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "Planar": joints.Planar((1, 0, 0), (0, 1, 1)),
    "PointOnLine": joints.PointOnLine((1, 0, 0), (1, 0, 0.3)),
    "PointOnPlane": joints.PointOnPlane((1, 0, 0), (0, 0.2, 1)),
    "Screw": joints.Screw((1, 0, 0), (0, 0, 1), 0.3),
    "Fixed": joints.Fixed(),
    "Distance": joints.Distance((1, 0, 0), (1.5, 0.2, 0)),
}


@pytest.mark.few(9)
@pytest.mark.parametrize(
    ("method", "steps"),
    [("rattle", (1e-2, 5e-3)), ("rattle4", (2e-2, 1e-2)), ("rattle6", (4e-2, 2e-2))],
)
@pytest.mark.parametrize("kind", JOINTS)
def test_order_with_each_joint(kind, method, steps):
    """Two bodies of unequal moments in space, on a ball joint, moving against each other."""

    def make():
        scene = Scene(gravity=(0.3, -2, -9.81))
        one = scene.add_body(mass=1, inertia=[0.1, 0.2, 0.3], position=(0.5, 0, 0))
        two = scene.add_body(mass=2, inertia=[0.2, 0.2, 0.1], position=(1.5, 0.2, 0))
        scene.add_joint(joints.Spherical((0, 0, 0)), GROUND, one)
        scene.add_joint(JOINTS[kind], one, two)
        return scene

    known = run(make(), 0.6, 1e-3, method="rk8").position[-1]
    runs = [carom.simulate(make(), 0.6, step=h, method=method) for h in steps]
    found = [np.max(np.abs(s.position[-1] - known)) for s in runs]
    np.testing.assert_allclose(orders(found), METHODS[method], rtol=0, atol=0.15)
    assert max(np.max(e) for e in runs[0].constraint_errors) < 1e-13


def test_while_a_contact_is_held_the_explicit_method_steps():
    """A pendulum that comes to lie on a table: held to its end, at rest, energy accounted for."""
    scene = Scene()
    table = scene.add_half_space(point=(0, 0, -0.5), normal=(0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.05), mass=1.0, position=(1.0, 0, 0))
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, ball)
    scene.add_contact(ball, table, restitution=0.3)
    s = carom.simulate(scene, 3.0, step=2e-3, method="rattle4")
    assert s.stats["holds"] == 1
    assert s.position[-1, 0, 2] == pytest.approx(-0.45, abs=1e-13)
    assert np.max(np.abs(s.ledger.residual)) < 1e-8
    assert np.max(np.abs(s.velocity[-1])) < 1e-12
