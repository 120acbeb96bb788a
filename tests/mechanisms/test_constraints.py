"""Gears, motors, rolling, and rows of the user's own, against closed forms."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import carom
from carom import GROUND, constraints, forces, joints
from verified import agree, verifies

FITS = carom.Options(project_start=True)


def two_wheels():
    """Two flywheels on parallel axes, moments .2 and .5."""
    scene = carom.Scene(gravity=(0, 0, 0))
    a = scene.add_body(mass=1, inertia=(0.1, 0.1, 0.2), name="a")
    b = scene.add_body(mass=2, inertia=(0.3, 0.3, 0.5), position=(1, 0, 0), name="b")
    first = scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, a, name="first")
    second = scene.add_joint(joints.Revolute((1, 0, 0), (0, 0, 1)), GROUND, b, name="second")
    return scene, first, second


@verifies("constraints.Gear", r"$(I_1 + r^2 I_2)\,\ddot q = M$", "closed form")
def test_gears_share_a_torque():
    # (I_1 + r^2 I_2) q'' = T: constant, so that the speed is exact; the second wheel takes r I_2 q''
    scene, first, second = two_wheels()
    scene.add_constraint(constraints.Gear(first, second, ratio=-0.5), name="gear")
    scene.add_force(forces.Torque((0, 0, 3.0)), scene["a"])
    assert scene.check().degrees_of_freedom == 1
    solution = carom.simulate(scene, 1.0, step=0.02)
    inertia = 0.2 + 0.25 * 0.5
    (q, rate), (p, _) = solution.joint_coordinates(first), solution.joint_coordinates(second)
    agree(rate[-1, 0], 3.0 / inertia, rtol=1e-13)
    agree(p, -0.5 * q, atol=1e-13)
    # the multiplier acts on the second joint with the factor -1
    agree(solution.constraint_forces[:, 0], 0.5 * 0.5 * 3.0 / inertia, rtol=1e-12)
    agree(solution.ledger.residual[-1], 0.0, atol=1e-13 * solution.ledger.loads[-1])


@verifies(
    "constraints.Coupling",
    "$x = F t^2/2(m + I/r^2)$; a differential takes $M$ by halves",
    "closed form",
)
def test_a_rack_and_a_differential():
    # a rack of 2 kg driven by a wheel of radius .1: m r q'' from a force; a differential keeps the mean
    scene, first, second = two_wheels()
    rack = scene.add_body(mass=2, inertia=(1, 1, 1), position=(0, -1, 0))
    slide = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, rack)
    scene.add_constraint(constraints.Gear(first, slide, ratio=0.1))
    scene.add_force(forces.Force((1.0, 0, 0)), rack)
    solution = carom.simulate(scene, 1.0, step=0.05)
    expected = 0.5 / (2.0 + 0.2 / 0.01)  # x = F t^2 / (2 (m + I/r^2))
    # the turn of the wheel is of order 4: 3e-9
    agree(solution.position[-1, 2, 0], expected, rtol=1e-8)
    turn = solution.joint_coordinates(first)[0][-1, 0]
    agree(turn, 10 * solution.position[-1, 2, 0], rtol=1e-12)

    scene, first, second = two_wheels()
    third = scene.add_body(mass=1, inertia=(1, 1, 1.0), position=(2, 0, 0))
    cage = scene.add_joint(joints.Revolute((2, 0, 0), (0, 0, 1)), GROUND, third)
    scene.add_constraint(constraints.Coupling({first: 1.0, second: 1.0, cage: -2.0}))
    scene.add_force(forces.Torque((0, 0, 1.0)), third)
    solution = carom.simulate(scene, 1.0, step=0.05)
    w = solution.angular_velocity[-1, :, 2]
    # each side takes half of what the cage gives away: .2 w_1 = .5 w_2, and T = 1 on 1 + 4/(1/.2 + 1/.5)
    agree(w[2], 1.0 / (1.0 + 4.0 / 7.0), rtol=1e-12)
    agree(w[0] + w[1], 2.0 * w[2], rtol=1e-12)
    agree(0.2 * w[0], 0.5 * w[1], rtol=1e-12)


def swing(t):
    return np.sin(3.0 * t), 3.0 * np.cos(3.0 * t), -9.0 * np.sin(3.0 * t)


@verifies("constraints.Driver", r"$q = q(t)$, torque $(I_1 + r^2 I_2)\,\ddot q$", "closed form")
@pytest.mark.parametrize("method", ["rk4", "paper"])
@pytest.mark.parametrize(
    "motion",
    [swing, numba.njit(swing), CubicSpline([0.0, 0.5, 1.0], [0.0, 0.3, 1.0])],
    ids=["plain", "compiled", "spline"],
)
def test_a_motor_moves_as_it_is_told(motion, method):
    scene, first, second = two_wheels()
    scene.add_constraint(constraints.Gear(first, second, ratio=-0.5))
    scene.add_constraint(constraints.Driver(first, motion=motion), name="motor")
    solution = carom.simulate(scene, 1.0, step=0.05, method=method, options=FITS)
    q, rate = (a[:, 0] for a in solution.joint_coordinates(first))
    if isinstance(motion, CubicSpline):
        told = motion(solution.t), motion(solution.t, 1), motion(solution.t, 2)
    else:
        told = np.array([swing(t) for t in solution.t]).T
    agree(q, told[0], atol=1e-13)
    agree(rate, told[1], atol=1e-12)
    # its torque is (I_1 + r^2 I_2) q'' at any time, its work the kinetic energy
    agree(solution.constraint_forces[:, 1], 0.325 * told[2], atol=1e-11)
    energy = 0.5 * 0.325 * (rate[-1] ** 2 - rate[0] ** 2)
    agree(solution.ledger.loads[-1], energy, atol=1e-5 * abs(energy))


@verifies(
    "constraints.Driver",
    r"slider-crank: $x = r \cos\omega t + \sqrt{l^2 - r^2 \sin^2\omega t}$",
    "closed form",
)
def test_a_motor_of_constant_speed_turns_a_crank():
    # a slider-crank: x = r cos(wt) + sqrt(l^2 - r^2 sin^2(wt)), whatever the masses
    r, l, w = 0.1, 0.3, 5.0
    scene = carom.Scene()
    crank = scene.add_body(mass=0.5, inertia=(1e-3, 1e-3, 1e-3), position=(r / 2, 0, 0))
    rod = scene.add_body(mass=0.7, inertia=(5e-3, 5e-3, 5e-3), position=(r + l / 2, 0, 0))
    block = scene.add_body(mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(r + l, 0, 0))
    axis = (0, 1, 0)
    hinge = scene.add_joint(joints.Revolute((0, 0, 0), axis), GROUND, crank)
    scene.add_joint(joints.Revolute((r, 0, 0), axis), crank, rod)
    scene.add_joint(joints.Revolute((r + l, 0, 0), axis), rod, block)
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, block)
    scene.add_constraint(constraints.Driver(hinge, rate=w))
    solution = carom.simulate(scene, 2.0, step=0.005, options=FITS)
    turn = w * solution.t
    x = r * np.cos(turn) + np.sqrt(l**2 - (r * np.sin(turn)) ** 2)
    agree(solution.position[:, 2, 0], x, atol=1e-13)
    gained = solution.total_energy - solution.total_energy[0]
    agree(solution.ledger.loads, gained, atol=2e-8 * np.ptp(gained))


def test_a_motor_that_does_not_fit_the_start_is_refused():
    scene, first, _ = two_wheels()
    scene.add_constraint(constraints.Driver(first, rate=2.0), name="motor")
    with pytest.raises(ValueError, match=r"velocity violates 'motor' \(Driver\).* value by 2"):
        carom.simulate(scene, 1.0, step=0.1)
    scene, first, _ = two_wheels()
    scene.add_constraint(constraints.Driver(first, motion=lambda t: (0.3, 0.0, 0.0)), name="motor")
    with pytest.raises(ValueError, match=r"position violates 'motor' \(Driver\)"):
        carom.simulate(scene, 1.0, step=0.1)


@verifies(
    "joints.RollingSphere",
    r"$x = \tfrac{5}{14}\,g \sin\alpha\,t^2$, friction $\tfrac27 m g \sin\alpha$",
    "closed form",
)
def test_a_sphere_rolls_down_an_incline():
    # x = 5/14 g sin(a) t^2, friction 2/7 m g sin(a)
    a, g = 0.3, 9.81
    scene = carom.Scene(gravity=(g * np.sin(a), 0, -g * np.cos(a)))
    ball = scene.add_body(carom.Sphere(0.1), mass=2, position=(0, 0, 0.1))
    scene.add_joint(joints.RollingSphere(0.1), GROUND, ball)
    mobility = scene.check()
    assert (mobility.degrees_of_freedom, mobility.nonholonomic) == (3, 2)
    solution = carom.simulate(scene, 1.0, step=0.05)
    agree(solution.position[-1, 0, 0], 5 / 14 * g * np.sin(a), rtol=1e-12)
    force = solution.joint_reactions[-1, 0, :3]
    agree(force, [-2 / 7 * 2 * g * np.sin(a), 0, 2 * g * np.cos(a)], atol=1e-12)


def leaning_wheel():
    r, lean = 0.2, 0.2
    axis = np.array([np.cos(lean), 0.0, np.sin(lean)])
    spin = 8.0 * axis + np.array([0.0, 0.0, 1.0])
    down = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
    arm = -r * down / np.linalg.norm(down)
    turn = carom.geometry.quaternion.exp(np.array([0.0, np.pi / 2 - lean, 0.0]))
    scene = carom.Scene()
    wheel = scene.add_body(
        mass=1, inertia=(r * r / 4, r * r / 4, r * r / 2), position=(0, 0, r * np.cos(lean)),
        orientation=turn, velocity=-np.cross(spin, arm), angular_velocity=spin,
    )  # fmt: skip
    scene.add_joint(joints.RollingDisc(r, axis=axis), GROUND, wheel)
    return scene


def test_a_wheel_rolls_with_order_4():
    ends, errors = [], []
    for h in (0.02, 0.01, 0.005, 0.0025):  # below 0.3 rad a step, where it would be made in parts
        solution = carom.simulate(leaning_wheel(), 2.0, step=h)
        ends.append(solution.position[-1, 0])
        errors.append(np.max(np.abs(solution.total_energy - solution.total_energy[0])))
        assert max(np.max(e) for e in solution.constraint_errors) < 2e-14
    away = [np.linalg.norm(e - ends[-1]) for e in ends[:-1]]
    assert np.log2(away[0] / away[1]) == pytest.approx(4.0, abs=0.3)
    assert errors[-1] < 2e-8


@verifies("joints.RollingDisc", r"$z = r\sqrt{1 - a_z^2}$", "closed form")
def test_the_lowest_point_of_a_wheel_stays_on_the_plane():
    scene = leaning_wheel()
    solution = carom.simulate(scene, 0.5, step=0.005)
    z = solution.position[:, 0, 2]
    axis = carom.geometry.quaternion.rotate(solution.orientation[:, 0], np.array([0.0, 0.0, 1.0]))
    # the lowest point stays on the plane: z = r sqrt(1 - a_z^2)
    agree(z, 0.2 * np.sqrt(1.0 - axis[:, 2] ** 2), atol=1e-14)


def blade(t, poses):
    w, x, y, z = poses[0, 3], poses[0, 4], poses[0, 5], poses[0, 6]
    out = np.zeros((1, 7))
    out[0, 0], out[0, 1] = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z)
    out[0, 2] = 2 * (y * z + w * x)
    return out


@verifies(
    "constraints.Rows",
    r"sled on a slope: $y = \frac{g \sin\alpha}{2\omega^2}(\omega t - \tfrac12\sin 2\omega t)$",
    "closed form",
)
@pytest.mark.parametrize("row", [blade, numba.njit(blade)], ids=["plain", "compiled"])
def test_rows_of_the_user_are_a_knife_edge(row):
    # a sled on an incline: x = g s/(2 w^2) sin^2 wt, y = g s/(2 w^2) (wt - sin(2wt)/2)
    slope, w = 0.3, 1.5
    scene = carom.Scene(gravity=(9.81 * np.sin(slope), 0, 0))
    sled = scene.add_body(mass=1, inertia=(0.1, 0.2, 0.3), angular_velocity=(0, 0, w))
    scene.add_constraint(constraints.Rows(sled, row, rows=1))
    assert scene.check().nonholonomic == 1
    solution = carom.simulate(scene, 4.0, step=0.01)
    f = 9.81 * np.sin(slope) / (2 * w**2)
    expected = f * np.sin(4 * w) ** 2, f * (4 * w - 0.5 * np.sin(8 * w))
    agree(solution.position[-1, 0, :2], expected, atol=1e-8)


def test_holonomic_rows_are_returned_to():
    def row(t, poses):
        return np.array([[*poses[0, :3], 0, 0, 0, 0]])

    def on_sphere(t, poses):
        return [0.5 * (poses[0, :3] @ poses[0, :3] - 1.0)]

    ends = []
    for h in (0.02, 0.01, 0.005):
        scene = carom.Scene()
        bead = scene.add_body(mass=1, inertia=(1, 1, 1), position=(1, 0, 0), velocity=(0, 1, 0))
        scene.add_constraint(constraints.Rows(bead, row, rows=1, position=on_sphere))
        solution = carom.simulate(scene, 0.4, step=h)
        np.testing.assert_allclose(np.linalg.norm(solution.position[:, 0], axis=1), 1.0, atol=1e-13)
        ends.append(solution.total_energy[-1] - solution.total_energy[0])
    assert abs(ends[-1]) < 1e-8
    assert np.log2(ends[0] / ends[1]) > 3.7


def test_an_error_in_a_function_is_the_cause_of_the_stop():
    def fails(t, poses):
        if t > 0.25:
            raise RuntimeError("my own fault")
        return blade(t, poses)

    scene = carom.Scene(gravity=(1, 0, 0))
    sled = scene.add_body(mass=1, inertia=(1, 1, 1), angular_velocity=(0, 0, 1))
    scene.add_constraint(constraints.Rows(sled, fails, rows=1))
    said = "'constraint1' raised RuntimeError: my own fault at t"
    with pytest.raises(carom.SimulationError, match=said) as caught:
        carom.simulate(scene, 1.0, step=0.05)
    assert isinstance(caught.value.__cause__, RuntimeError)
    solution = caught.value.solution
    assert 0.2 <= solution.t[-1] <= 0.3
    assert np.all(np.isfinite(solution.position))


def test_bad_constraints_are_refused():
    scene, first, second = two_wheels()
    with pytest.raises(ValueError, match="ratio must not be 0"):
        constraints.Gear(first, second, 0.0)
    with pytest.raises(ValueError, match="coordinate must be below 1"):
        constraints.Driver(first, rate=1.0, coordinate=1)
    with pytest.raises(ValueError, match="rate or motion must be given"):
        constraints.Driver(first)
    with pytest.raises(TypeError, match="motion must be a function"):
        constraints.Driver(first, motion="fast")  # pyright: ignore[reportArgumentType]
    ball = scene.add_joint(joints.Spherical((0, 0, 0)), scene["a"], scene["b"])
    with pytest.raises(ValueError, match="coordinates of its own"):
        constraints.Coupling({ball: 1.0})
    with pytest.raises(ValueError, match=r"rows must be .* at most 6, got 7"):
        constraints.Rows(scene["a"], blade, rows=7)
    with pytest.raises(ValueError, match="each once"):
        constraints.Rows([scene["a"], scene["a"]], blade, rows=1)
    _, other, _ = two_wheels()
    with pytest.raises(ValueError, match="must belong to this scene"):
        scene.add_constraint(constraints.Driver(other, rate=1.0))
    with pytest.raises(ValueError, match="parallel to normal"):
        joints.RollingDisc(0.1, axis=(0, 0, 1))
