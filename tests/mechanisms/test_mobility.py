"""Degrees of freedom, redundant rows, and initial velocities that are brought to the joints."""

import numpy as np
import pytest

import carom
from carom import GROUND, joints


def bar(scene, a, b, **given):
    a, b = np.array(a, dtype=float), np.array(b, dtype=float)
    return scene.add_body(
        mass=1.0, inertia=np.diag([0.01, 0.1, 0.1]), position=(a + b) / 2, **given
    )


def four_bar():
    """A parallelogram with parallel hinges: planar, 1 freedom; in space 3 of 20 rows are redundant."""
    scene = carom.Scene()
    corners = [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)]
    bars = [bar(scene, *corners[k : k + 2]) for k in range(3)]
    ends = [(GROUND, bars[0]), (bars[0], bars[1]), (bars[1], bars[2]), (bars[2], GROUND)]
    for name, corner, (p, c) in zip("abcd", corners, ends):
        p, c = (p, c) if c is not GROUND else (c, p)
        scene.add_joint(joints.Revolute(corner, (0, 1, 0)), p, c, name=name)
    return scene


def test_a_four_bar_in_space():
    found = four_bar().check()
    assert (found.bodies, found.rows, found.redundant) == (3, 20, 3)
    assert found.degrees_of_freedom == 1
    assert found.redundant_joints == ("a", "b", "c", "d")
    assert str(found).splitlines() == [
        "3 bodies, 20 constraint rows: 1 degrees of freedom", "3 redundant rows, among a, b, c, d",
    ]  # fmt: skip


def test_what_hangs_on_a_loop_is_not_redundant():
    scene = four_bar()
    tip = bar(scene, (1, 0, 1), (2, 0, 1))
    scene.add_joint(joints.Spherical((1, 0, 1)), scene.bodies[1], tip, name="tail")
    found = scene.check()
    assert (found.redundant, found.degrees_of_freedom) == (3, 4)
    assert "tail" not in found.redundant_joints


def test_a_loop_of_balls_has_no_redundancy():
    """Bodies a, b, each a ball joint to the ground and one between: 12 - 9 = 3 freedoms."""
    scene = carom.Scene()
    a, b = bar(scene, (0, 0, 0), (0, 0, 1)), bar(scene, (0, 0, 1), (1, 0, 0))
    for p, c, at in ((GROUND, a, (0, 0, 0)), (a, b, (0, 0, 1)), (GROUND, b, (1, 0, 0))):
        scene.add_joint(joints.Spherical(at), p, c)
    found = scene.check()
    assert (found.rows, found.redundant, found.degrees_of_freedom) == (9, 0, 3)
    assert found.redundant_joints == ()


def test_free_bodies_and_blades():
    scene = carom.Scene()
    sledge = bar(scene, (0, 0, 0), (1, 0, 0))
    assert scene.check().degrees_of_freedom == 6
    scene.add_joint(joints.KnifeEdge((0, 0, 0), (1, 0, 0)), GROUND, sledge)
    found = scene.check()
    assert (found.degrees_of_freedom, found.nonholonomic) == (5, 1)


def test_a_turn_counts_at_the_size_of_the_body():
    """A slider that turns at 2 rad/s: 2 m/s for each metre of its shape."""
    scene = carom.Scene()
    box = carom.Box(0.6, 0.8, 2.4)
    body = scene.add_body(box, mass=1.0, angular_velocity=(0, 0, 2.0))
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, body, name="rail")
    assert scene.check().velocity_errors["rail"] == pytest.approx(2.0 * box.size, rel=1e-12)


def test_initial_velocities_are_brought_to_the_joints():
    """A pendulum of one bar with v = (1, 0, 0) and no spin: w from the angular momentum about the pin.

    The least change in the kinetic metric keeps the momentum along what is free: I_pin w = m v l.
    """
    scene = carom.Scene(gravity=(0, 0, 0))
    rod = bar(scene, (0, 0, 0), (0, 0, -1), velocity=(1, 0, 0))
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, rod, name="pin")
    assert scene.check().velocity_errors["pin"] == pytest.approx(1.0)
    with pytest.raises(ValueError, match=r"Options\(project_start=True\)"):
        carom.simulate(scene, 0.01, step=0.01)
    s = carom.simulate(scene, 0.01, step=0.01, options=carom.Options(project_start=True))
    spin = -1.0 * 1.0 * 0.5 / (0.1 + 1.0 * 0.25)  # about +y: the rod hangs along -z
    assert s.angular_velocity[0, 0, 1] == pytest.approx(spin, rel=1e-12)
    assert s.velocity[0, 0, 0] == pytest.approx(-0.5 * spin, rel=1e-12)
    assert s.constraint_errors[1].max() < 1e-14
