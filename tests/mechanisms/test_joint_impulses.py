"""Impulses of joints in impacts: closed forms, the balance of momentum, redundancy, stops, rotors, files."""

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints

SPIN = 1.0


def rod_that_strikes(height, hinges=(0.0,), rotor=0.0, restitution=1.0):
    """A rod of 1 kg and 1 m on a hinge at the origin along y strikes a small pin at `height` below it."""
    scene = carom.Scene(gravity=(0, 0, 0))
    turn = carom.euler("y", 90)  # the rod hangs along -z, and its tip moves along -x
    scene.add_body(
        carom.Box(1, 1e-3, 1e-3), mass=1.0, inertia=(1e-3, 1 / 12, 1 / 12), position=(0, 0, -0.5),
        orientation=turn, velocity=(-0.5 * SPIN, 0, 0), angular_velocity=(0, SPIN, 0), name="rod",
    )  # fmt: skip
    for k, y in enumerate(hinges):
        hinge = joints.Revolute((0, y, 0), (0, 1, 0))
        scene.add_joint(hinge, GROUND, "rod", name=f"hinge {k}")
    if rotor:
        scene.add_force(forces.JointInertia("hinge 0", rotor))
    scene.add_static(carom.Sphere(1e-3), position=(-0.01, 0, -height), name="pin")
    scene.add_contact("rod", "pin", restitution=restitution)
    return scene


@pytest.mark.parametrize("height", [0.4, 2 / 3, 0.9])
@pytest.mark.parametrize("rotor", [0.0, 0.2])
def test_a_rod_on_a_hinge(height, rotor):
    """(J + I) dw = P h with dw = 2 w, and the hinge takes R = m dv - P: none at the centre of percussion."""
    run = carom.simulate(rod_that_strikes(height, rotor=rotor), 0.05)
    assert len(run.impacts) == 1
    (row,) = run.joint_impulses
    there = run.impacts[0]
    arm = np.cross(there.point, there.normal)[1]
    blow = 2 * SPIN * (1 / 3 + rotor) / abs(arm)
    assert there.impulse[0] == pytest.approx(blow, rel=1e-9)
    centre = run.evaluate(there.time)[0][0]
    change = np.cross([0, -2 * SPIN, 0], centre)
    np.testing.assert_allclose(row.impulse, change - blow * there.normal, rtol=0, atol=1e-8)
    if height == 2 / 3 and not rotor:  # the rod has turned by 0.014 at the impact
        assert np.linalg.norm(row.impulse) < 0.02 * blow
    assert np.linalg.norm(row.angular_impulse) < 1e-12  # all of it is in the plane of the hinge
    assert (row.name, row.impact, row.time) == ("hinge 0", 0, there.time)
    assert np.array_equal(run["hinge 0"].impulses.impulse[0], row.impulse)


def test_the_view_of_a_joint_as_table_and_plot():
    run = carom.simulate(rod_that_strikes(0.9), 0.05)
    table, view = run["hinge 0"].to_pandas(degrees=True), run.joint("hinge 0")
    whole = run.to_pandas(degrees=True).joints["hinge 0"]
    assert table.columns.tolist() == whole.columns.tolist()
    np.testing.assert_array_equal(table.to_numpy(), whole.to_numpy())
    np.testing.assert_array_equal(table.index, run.t)
    axes = view.plot(panel="forces")
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), np.linalg.norm(view.force, axis=1))
    assert run.contact("rod-pin").name == "rod-pin"
    with pytest.raises(ValueError, match="name must be that of a body, got 'hinge 0'"):
        run.body("hinge 0")


def test_two_hinges_share_it():
    """Hinges beside each other are redundant: the least norm divides the impulse into equal parts."""
    one = carom.simulate(rod_that_strikes(0.9), 0.05).joint_impulses[0]
    both = carom.simulate(rod_that_strikes(0.9, hinges=(-0.1, 0.1)), 0.05).joint_impulses
    assert both.name.tolist() == ["hinge 0", "hinge 1"]
    np.testing.assert_allclose(both.impulse, [0.5 * one.impulse] * 2, rtol=1e-9, atol=1e-12)


def chain_that_falls():
    """Three rods in a chain, not in a plane, whose last one falls on a floor with friction."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    for k in range(3):
        scene.add_body(
            carom.Capsule(0.02, 0.2), mass=1.0 + k, position=(0.3 * k, 0.05 * k, 0.3 + 0.1 * k),
            orientation=carom.euler("y", 90), angular_velocity=(0, 0, 0), name=f"rod {k}",
        )  # fmt: skip
    for k in range(2):
        at = (0.3 * k + 0.15, 0.05 * k + 0.025, 0.35 + 0.1 * k)
        kind = joints.Spherical(at) if k else joints.Revolute(at, (1, 1, 0))
        scene.add_joint(kind, f"rod {k}", f"rod {k + 1}", name=f"pin {k}")
    scene.set_contact_default(restitution=0.5, friction=0.4)
    return scene


def test_momenta_of_each_body_balance():
    """The change of the momenta of each body is that by the contact and by the joints, at each impact."""
    run = carom.simulate(chain_that_falls(), 0.35)
    table, impacts = run.joint_impulses, run.impacts
    assert len(impacts) >= 2
    for k in range(len(impacts)):
        if impacts.together[k] > 1:
            continue
        t, sides = (
            impacts.time[k],
            [run.evaluate(impacts.time[k], side) for side in ("left", "right")],
        )
        change = 1.0 * (sides[1][2] - sides[0][2]) * np.array([[1.0], [2.0], [3.0]])
        given = np.zeros((3, 3))
        axes = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
        given[int(impacts.body[k][-1])] += impacts.impulse[k] @ axes
        for row in table[table.time == t]:
            joint = run.scene.joints[row.joint]
            given[joint.child.index] += row.impulse
            given[joint.parent.index] -= row.impulse
        np.testing.assert_allclose(change, given, rtol=0, atol=1e-9)
        ball = table[(table.time == t) & (table.name == "pin 1")]
        np.testing.assert_allclose(
            ball.angular_impulse, 0.0, atol=1e-10
        )  # a ball joint turns freely


def test_a_stop_is_carried_by_the_hinge():
    """A door of 3 kg, its centre 0.4 m from the hinge, strikes a stop: R = m dv, and dv = -(1 + e) w d."""
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(
        carom.Box(0.8, 0.04, 2), mass=3.0, position=(0.4, 0, 0), velocity=(0, 0.4, 0),
        angular_velocity=(0, 0, 1), name="door",
    )  # fmt: skip
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 0, 1)), GROUND, "door", name="hinge")
    scene.add_stop("hinge", upper=0.1, restitution=0.5, name="stop")
    run = carom.simulate(scene, 0.2)
    (row,) = run["hinge"].impulses
    ahead = np.array([-np.sin(0.1), np.cos(0.1), 0])
    np.testing.assert_allclose(row.impulse, -3.0 * 0.4 * 1.5 * ahead, rtol=0, atol=1e-8)
    np.testing.assert_allclose(row.angular_impulse, 0.0, atol=1e-9)


def test_a_file_has_the_same(tmp_path):
    run = carom.simulate(chain_that_falls(), 0.35)
    run.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert "joint_impulses" in vars(loaded)
    for one in (loaded.joint_impulses, loaded["pin 1"].impulses):
        assert one.name.dtype.kind == "U"
    for name in ("time", "impact", "joint", "impulse", "angular_impulse", "name"):
        assert np.array_equal(
            getattr(loaded.joint_impulses, name), getattr(run.joint_impulses, name)
        )
    del vars(loaded)["joint_impulses"]
    assert np.array_equal(loaded.joint_impulses.impulse, run.joint_impulses.impulse)


def test_without_joints_or_impacts_it_is_empty():
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1, name="ball")
    assert len(carom.simulate(scene, 0.01).joint_impulses) == 0
