"""Parts of a scene by name, a contact in either order, sets of bodies that do not touch; what `carom` lists."""

import numpy as np
import pytest

import carom
from carom.io.files.scene_parts import scene_from_text, scene_to_text


def scene_of(names, **place):
    scene = carom.Scene()
    scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    for k, name in enumerate(names):
        scene.add_body(carom.Sphere(0.1), mass=1, position=(k, 0, 0.1), name=name, **place)
    return scene


@pytest.mark.parametrize("order", [("die", "ground"), ("ground", "die")])
@pytest.mark.parametrize("by_name", [True, False])
def test_a_contact_in_either_order(order, by_name):
    scene = scene_of(["die"])
    contact = scene.add_contact(
        *(order if by_name else map(scene.__getitem__, order)), friction=0.1
    )
    assert contact.name == "die-ground"
    assert (contact.body, contact.other) == (scene["die"], scene["ground"])
    assert scene["die-ground"] is contact
    assert scene["ground-die"] is contact


def test_joints_forces_and_stops_by_name():
    scene = scene_of(["a", "b"])
    hinge = scene.add_joint(carom.joints.Revolute((0.5, 0, 0.1), (0, 1, 0)), "a", "b", name="hinge")
    assert (hinge.parent, hinge.child) == (scene["a"], scene["b"])
    assert scene.add_force(carom.forces.Torque((0, 1, 0)), "a", "b").child is scene["b"]
    alone = scene.add_force(carom.forces.Force((0, 1, 0)), "b")
    assert (alone.parent, alone.child) == (carom.GROUND, scene["b"])
    assert scene.add_stop("hinge", lower=-1).joint is hinge
    scene.set_contact_default(restitution=0.5, friction=0.1)
    assert scene.contact_law("ground", "a") == scene.contact_law(scene["a"], scene["ground"])


def touching(scene):
    found = scene.pairs_by_default()
    names = [body.name for body in scene.bodies]
    return {
        frozenset((names[b], names[o] if o >= 0 else "ground"))
        for b, o in zip(found.body, found.other)
    }


def test_sets_of_bodies_that_do_not_touch():
    scene = scene_of("abcde")
    scene.set_contact_default(restitution=0.5, friction=0.1)
    everything = touching(scene)
    assert len(everything) == 15
    scene.ignore_contact(["a", "b", scene["c"]])
    inside = {frozenset(pair) for pair in ("ab", "ac", "bc")}
    assert touching(scene) == everything - inside
    scene.ignore_contact(["a", "d"], ["d", "ground"])
    between = {frozenset(pair) for pair in (("a", "d"), ("a", "ground"), ("d", "ground"))}
    assert touching(scene) == everything - inside - between


def test_bodies_that_are_ignored_pass_through_each_other():
    # Two balls of equal mass, head on and elastic, exchange velocities; ignored they keep them.
    def final(ignored):
        scene = carom.Scene(gravity=(0, 0, 0))
        for x, v in ((0.0, 1.0), (1.0, 0.0)):
            scene.add_body(carom.Sphere(0.1), mass=1, position=(x, 0, 0), velocity=(v, 0, 0))
        scene.set_contact_default(restitution=1.0, friction=0.0)
        if ignored:
            scene.ignore_contact(scene.bodies)
        return carom.simulate(scene, 2.0, step=0.1).velocity[-1, :, 0]

    np.testing.assert_allclose(final(True), (1.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(final(False), (0.0, 1.0), atol=1e-15)


def test_carom_lists_what_is_public_and_nothing_else():
    assert set(dir(carom)) == {*carom.__all__, "__version__"}
    for name in dir(carom):
        assert getattr(carom, name) is not None
    assert len(set(carom.__all__)) == len(carom.__all__)


def hinged():
    """Return a scene of two rods on hinges."""
    scene = carom.Scene()
    for k, name in enumerate(("left", "right")):
        scene.add_body(mass=1.0, inertia=(1, 1, 1), position=(k, 0, 0), name=name)
        hinge = carom.joints.Revolute((k, 0, 0), (0, 0, 1))
        scene.add_joint(hinge, carom.GROUND, name, name=f"{name} hinge")
    return scene


BY_NAME = {
    "JointForce": lambda: carom.forces.JointForce("left hinge", 1.0),
    "JointSpring": lambda: carom.forces.JointSpring("left hinge", 1.0),
    "JointFriction": lambda: carom.forces.JointFriction("left hinge", 1.0),
    "Drive": lambda: carom.forces.Drive("left hinge", 1.0, rate=2.0),
    "JointInertia": lambda: carom.forces.JointInertia("left hinge", 1.0),
    "UserForce": lambda: carom.forces.UserForce("left", lambda t, x: [[0] * 6]),
    "Driver": lambda: carom.constraints.Driver("left hinge", rate=0.0),
    "Gear": lambda: carom.constraints.Gear("left hinge", "right hinge", 2.0),
    "Coupling": lambda: carom.constraints.Coupling({"left hinge": 1.0, ("right hinge", 0): 2.0}),
    "Rows": lambda: carom.constraints.Rows(["left", "right"], lambda t, x: [[0] * 13], 1),
}


@pytest.mark.parametrize("kind", BY_NAME)
def test_a_definition_may_name_its_parts(kind):
    """The part of the scene has the objects; the definition itself can be added to another scene."""
    definition = BY_NAME[kind]()
    for scene in (hinged(), hinged()):
        add = scene.add_force if hasattr(carom.forces, kind) else scene.add_constraint
        made = add(definition).definition
        assert type(made) is type(definition)
        parts = [term[0] for term in made.terms] if hasattr(made, "terms") else []
        parts += [made.joint] if hasattr(made, "joint") else list(getattr(made, "bodies", ()))
        assert parts[0] in (scene["left hinge"], scene["left"])
        assert all(scene[part.name] is part for part in parts)
    empty = carom.Scene()
    empty.add_body(mass=1.0, inertia=(1, 1, 1), name="left hing")
    add = empty.add_force if hasattr(carom.forces, kind) else empty.add_constraint
    with pytest.raises(ValueError, match=r"of the definition must be .* none called 'left"):
        add(definition)


def test_a_name_that_does_not_fit_is_refused():
    scene = hinged()
    with pytest.raises(TypeError, match="joint of the definition must be a Joint, got Body"):
        scene.add_force(carom.forces.JointForce("left", 1.0))
    with pytest.raises(ValueError, match="coordinate must be below 1"):
        scene.add_constraint(carom.constraints.Driver("left hinge", rate=1.0, coordinate=1))
    twice = {"left hinge": 1.0, scene["left hinge"]: 2.0}
    with pytest.raises(ValueError, match="each joint of the definition must be given once"):
        scene.add_constraint(carom.constraints.Coupling(twice))
    with pytest.raises(ValueError, match="first and second must be two joints"):
        carom.constraints.Gear("a", "a", 1.0)


@pytest.mark.parametrize("kind", ["JointForce", "Gear"])
def test_a_file_has_parts_not_names(kind):
    scene = hinged()
    add = scene.add_force if kind == "JointForce" else scene.add_constraint
    add(BY_NAME[kind]())
    text = scene_to_text(scene)
    assert scene_from_text(text)[0].joints[0].name == "left hinge"
    last = text.rindex('{"part": "left hinge"}')
    made_up = text[:last] + text[last:].replace('{"part": "left hinge"}', '"left hinge"', 1)
    with pytest.raises((ValueError, TypeError)):
        scene_from_text(made_up)
