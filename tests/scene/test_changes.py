"""Scenes that change: parts are replaced, taken away and copied, and solutions keep the scene of their run."""

import copy
import pickle

import numpy as np
import pytest

import carom
from carom import constraints, forces, joints
from carom.io.files.scene_parts import scene_from_text, scene_to_text


def machine():
    """Two bodies above a floor; the second hangs at a hinge with a spring, a motor and a stop."""
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    die = scene.add_body(carom.Box(0.2, 0.2, 0.2), mass=1, position=(1, 0, 1), name="die")
    arm = scene.add_body(carom.Sphere(0.1), mass=1, position=(2, 0, 1), name="arm")
    scene.add_contact(die, floor, friction=0.2)
    scene.add_contact(arm, floor)
    hinge = joints.Revolute(anchor=(2, 0, 2), axis=(0, 1, 0))
    hinge = scene.add_joint(hinge, carom.GROUND, arm, name="hinge")
    scene.add_force(forces.JointSpring(hinge, stiffness=3.0), name="spring")
    scene.add_constraint(constraints.Driver(hinge, rate=1.0), name="motor")
    scene.add_stop(hinge, upper=1.0, name="stop")
    return scene


def same_as(scene, other):
    """Whether two scenes have the same parts, values, references and pairs."""
    return scene_to_text(scene) == scene_to_text(other)


def test_parts_are_gone_through_and_found():
    scene = machine()
    names = ["die", "arm", "floor", "hinge", "spring", "motor", "stop", "die-floor", "arm-floor"]
    assert [part.name for part in scene] == names
    assert "die" in scene
    assert "floor-die" in scene
    assert scene["die"] in scene
    assert "dice" not in scene
    assert machine()["die"] not in scene
    assert 3 not in scene


def test_a_part_that_is_removed_leaves_the_scene_as_if_it_had_not_been_added():
    scene, other = machine(), carom.Scene()
    arm = scene["arm"]
    removed = scene.remove("die")
    assert [part.name for part in removed] == ["die", "die-floor"]
    other.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    other.add_body(carom.Sphere(0.1), mass=1, position=(2, 0, 1), name="arm")
    other.add_contact("arm", "floor")
    hinge = joints.Revolute(anchor=(2, 0, 2), axis=(0, 1, 0))
    hinge = other.add_joint(hinge, carom.GROUND, "arm", name="hinge")
    other.add_force(forces.JointSpring(hinge, stiffness=3.0), name="spring")
    other.add_constraint(constraints.Driver(hinge, rate=1.0), name="motor")
    other.add_stop(hinge, upper=1.0, name="stop")
    assert sorted(map(repr, scene)) == sorted(map(repr, other))
    assert scene.bodies[0].index == 0
    assert scene["hinge"].child is scene["arm"] is scene.bodies[0]
    assert scene["spring"].definition.joint is scene["motor"].definition.joint is scene["hinge"]
    assert scene["stop"].joint is scene["hinge"]
    assert scene.contacts[0].body is scene["arm"]
    assert arm in scene
    assert arm.index == 1


def test_what_refers_to_a_part_is_named_and_goes_with_it_when_told():
    scene = machine()
    with pytest.raises(
        ValueError, match=r"joint 'hinge', force 'spring', constraint 'motor', stop"
    ):
        scene.remove("arm")
    assert same_as(scene, machine())
    gone = scene.remove("arm", dependents=True)
    assert {part.name for part in gone} == {
        "arm", "hinge", "spring", "motor", "stop", "arm-floor",
    }  # fmt: skip
    assert [part.name for part in scene] == ["die", "floor", "die-floor"]
    with pytest.raises(ValueError, match="of another one, or one that was removed"):
        scene.add_contact(gone[0], "floor")
    scene.add_body(carom.Sphere(0.1), mass=1, position=(2, 0, 1), name="arm")
    scene.add_contact("arm", "floor")  # its pair is free again


def test_bodies_of_a_removed_joint_may_touch_again_and_ignored_ones_do_not():
    scene = carom.Scene()
    scene.set_contact_default(restitution=0, friction=0)
    for k, name in enumerate("abc"):
        scene.add_body(carom.Sphere(0.1), mass=1, position=(k, 0, 0), name=name)
    scene.ignore_contact("a", "c")
    scene.add_joint(joints.Spherical(anchor=(0.5, 0, 0)), "a", "b", name="pin")
    assert scene.contact_law("a", "b") is None
    assert len(scene.pairs_by_default()) == 1
    scene.remove("pin")
    assert scene.contact_law("a", "b") is not None
    assert scene.contact_law("a", "c") is None
    assert len(scene.pairs_by_default()) == 2
    scene.remove("c")
    scene.add_body(carom.Sphere(0.1), mass=1, position=(2, 0, 0), name="c")
    assert scene.contact_law("a", "c") is not None  # another body, with the same name
    again, _ = scene_from_text(scene_to_text(scene))
    assert len(again.pairs_by_default()) == 3


def test_a_part_that_is_replaced_keeps_its_place_and_what_refers_to_it():
    scene = machine()
    old, inertia = scene["die"], np.array(scene["die"].inertia)
    new = scene.replace("die", mass=3.0, velocity=(1, 2, 3))
    assert scene["die"] is scene.bodies[0] is scene["die-floor"].body is new
    assert np.allclose(new.inertia, 3.0 * inertia, rtol=1e-15, atol=0)  # in proportion to the mass
    assert np.array_equal(new.position, old.position)
    assert old.mass == 1.0
    assert scene.replace(old, shape=carom.Sphere(0.1)).inertia[0, 0] == pytest.approx(
        0.4 * 3 * 0.01
    )
    assert scene.replace("die", density=1000).mass == pytest.approx(4e3 / 3 * np.pi * 0.1**3)
    assert scene.replace("die", inertia=(1, 1, 1)).inertia[2, 2] == 1.0
    assert scene.replace("floor", point=(0, 0, -1)).point[2] == -1
    assert scene.replace("floor-die", friction=0.7).friction_held == 0.7  # follows friction
    assert scene.replace("spring", stiffness=9.0).definition.damping == 0.0
    assert scene.replace("hinge", axis=(0, 0, 2)).definition.axis.tolist() == [0, 0, 1]
    assert scene["spring"].definition.joint is scene["stop"].joint is scene["hinge"]
    assert scene.replace("stop", upper=None, lower=-1).side == 1.0
    slider = joints.Prismatic(axis=(1, 0, 0))
    assert scene.replace("hinge", definition=slider).definition is slider
    motor = constraints.Driver(scene["hinge"], rate=2.0)
    assert scene.replace("motor", definition=motor).definition.rate == 2.0
    by_name = forces.JointSpring("hinge", stiffness=4.0)
    assert scene.replace("spring", definition=by_name).definition.joint is scene["hinge"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: s.replace("die", pos=(0, 0, 0)), r"no argument pos=; it is called position="),
        (lambda s: s.replace("die", name="dice"), r"no argument name="),
        (lambda s: s.replace("spring", k=1), r"no argument k=; it is called stiffness="),
        (lambda s: s.replace("die", mass=-1), "mass must be finite and above 0"),
        (lambda s: s.replace("dye", mass=1), "called 'dye'; did you mean 'die'"),
        (lambda s: s.replace("die"), "replace needs a value, such as mass=..."),
        (lambda s: s.replace("die", shape=None), "body must have a shape for contact"),
        (lambda s: s.replace("hinge", definition=joints.Fixed()), "must have coordinates"),
        (lambda s: s.replace("spring", definition=forces.Force((0, 0, 1))), "must be a JointSpring"),
        (lambda s: s.replace("spring", definition=3), "must be a JointSpring, got 3"),
        (lambda s: s.replace("spring", definition=forces.JointSpring("hing", 1.0)), "you mean 'hinge'"),
        (lambda s: s.add_body(carom.Sphere(1), mass=1, name="die"), "replace=True puts the new part"),
        (lambda s: s.add_contact("die", "floor"), "replace=True with its name"),
        (lambda s: s.add_static(carom.Sphere(1), name="die", replace=True), "'die', a body"),
        (lambda s: s.add_static(carom.Sphere(1), replace=True), "name must be given with replace"),
    ],
)  # fmt: skip
def test_what_is_refused_leaves_the_scene_as_it_was(change, message):
    scene = machine()
    with pytest.raises((TypeError, ValueError), match=message):
        change(scene)
    assert same_as(scene, machine())


def test_a_cell_may_run_twice():
    def cell(scene):
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor", replace=True)
        wall = scene.add_static(carom.Box(1, 1, 1), position=(9, 0, 0), name="wall", replace=True)
        arm = scene.add_body(
            carom.Sphere(0.1), mass=1, position=(2, 0, 1), name="arm", replace=True
        )
        scene.add_contact(arm, floor, friction=0.2, replace=True)
        scene.add_contact(arm, wall, name="hit", replace=True)
        hinge = joints.Revolute(anchor=(2, 0, 2), axis=(0, 1, 0))
        hinge = scene.add_joint(hinge, carom.GROUND, arm, name="hinge", replace=True)
        scene.add_stop(hinge, upper=1.0, name="stop", replace=True)
        scene.add_force(forces.JointSpring(hinge, stiffness=3.0), name="spring", replace=True)
        motor = constraints.Driver(hinge, rate=1.0)
        scene.add_constraint(motor, name="motor", replace=True)
        return hinge

    once, twice = carom.Scene(), carom.Scene()
    cell(once), cell(twice)
    hinge = cell(twice)
    assert list(map(repr, once)) == list(map(repr, twice))
    scene = machine()
    scene.add_contact("die", "floor", friction=0.3, replace=True)
    assert [contact.name for contact in scene.contacts] == ["die-floor", "arm-floor"]
    assert same_as(scene_from_text(scene_to_text(scene))[0], scene)
    assert hinge is twice["hinge"] is twice["motor"].definition.joint
    assert twice.contacts[1].other is twice["wall"]
    again, _ = scene_from_text(scene_to_text(twice))
    assert same_as(again, twice)


def test_a_joint_that_is_replaced_may_join_a_later_body():
    scene = machine()
    scene.add_body(carom.Sphere(0.1), mass=1, position=(3, 0, 1), name="late")
    pin = joints.Revolute(anchor=(2, 0, 1), axis=(0, 1, 0))
    scene.add_joint(pin, "arm", "late", name="hinge", replace=True)
    scene.remove("die")  # all bodies get other numbers
    assert scene["hinge"].child is scene["late"]
    assert scene["hinge"].parent is scene["arm"]
    assert scene["spring"].definition.joint is scene["hinge"]


def test_a_copy_is_of_its_own():
    scene = machine()
    for made in (
        scene.copy(),
        copy.copy(scene),
        copy.deepcopy(scene),
        pickle.loads(pickle.dumps(scene)),
    ):
        assert same_as(made, scene)
        made.replace("die", mass=7)
        made.gravity = (0, 0, -1.62)
        made.remove("arm", dependents=True)
        assert same_as(scene, machine())
        assert made.gravity[2] == -1.62
    made = scene.copy()
    made.replace(scene["die"], mass=7)  # a part of one stands for that of the other
    assert made["die"].mass == 7
    assert scene["die"].mass == 1


def test_a_value_of_a_part_cannot_be_set_and_says_how_to_change_it():
    with pytest.raises(AttributeError, match=r"scene\.replace\(name, \.\.\.\)"):
        machine()["die"].mass = 2.0


def test_a_solution_keeps_the_scene_of_its_run():
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.5), name="ball")
    scene.add_contact("ball", "floor", restitution=0.5)
    first = carom.simulate(scene, 1.0, step=0.01)
    again = carom.simulate(scene, 1.0, step=0.01)
    assert first.scene is again.scene is not scene  # one copy while it does not change
    x, text = first.evaluate(0.555)[0].copy(), scene_to_text(scene)
    scene.replace("ball", mass=2, position=(0, 0, 3), shape=carom.Sphere(0.2))
    scene.replace("ball-floor", restitution=1.0)
    scene.gravity = (0, 0, -1)
    scene.add_body(carom.Sphere(0.1), mass=1, position=(5, 0, 3), name="other")
    scene.add_contact("other", "floor", restitution=0.5)
    second = carom.simulate(scene, 1.0, step=0.01)
    scene.remove("ball")
    assert scene_to_text(first.scene) == text
    assert first.scene["ball"].mass == 1
    assert np.array_equal(first.evaluate(0.555)[0], x)
    assert np.array_equal(again.evaluate(0.555)[0], x)
    assert first.impacts.time[0] == pytest.approx((0.8 / 9.81) ** 0.5, rel=1e-14)
    assert len(second.impacts) == 0
    assert second["other"].position[0, 0] == 5
    with pytest.raises(ValueError, match=r"change a copy of it: scene\.copy\(\)"):
        first.scene.remove("ball")
    with pytest.raises(ValueError, match=r"scene\.copy\(\)"):
        first.scene.gravity = (0, 0, 0)
    changed = first.scene.copy()
    changed.replace("ball", position=(0, 0, 0.9))
    assert carom.simulate(changed, 1.0, step=0.01).impacts.time[0] == pytest.approx(
        (1.6 / 9.81) ** 0.5
    )


def test_what_add_joint_returned_is_the_joint_in_each_solution():
    scene = carom.Scene()
    arm = scene.add_body(carom.Box(0.1, 0.1, 1), mass=1, position=(0, 0, -0.5), name="arm")
    hinge = joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
    hinge = scene.add_joint(hinge, carom.GROUND, arm, name="hinge")
    first = carom.simulate(scene, 0.1, step=0.01)
    scene.replace("arm", angular_velocity=(0, 1, 0), velocity=(-0.5, 0, 0))
    second = carom.simulate(scene, 0.1, step=0.01)
    assert scene["hinge"] is not hinge  # its child is another one
    assert first.joint_coordinates(hinge)[1][0, 0] == 0.0
    assert second.joint_coordinates(hinge)[1][0, 0] == pytest.approx(1.0, rel=1e-14)
    assert second.joint_coordinates(scene["hinge"])[1][0, 0] == pytest.approx(1.0, rel=1e-14)
    pickled = pickle.loads(pickle.dumps(second.scene))
    with pytest.raises(ValueError, match=r"scene\.copy\(\)"):
        pickled.remove("hinge")
