"""Parts of a scene by name, a contact in either order, sets of bodies that do not touch; what `carom` lists."""

import numpy as np
import pytest

import carom


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
