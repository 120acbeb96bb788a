"""Contacts of two bodies, contacts of all pairs, and starts inside each other."""

import math
import pickle

import numpy as np
import pytest

import carom
from carom.geometry import quaternion
from carom.scene import (
    GROUND,
    Box,
    Capsule,
    Compound,
    Convex,
    Cylinder,
    Disc,
    Ellipsoid,
    Material,
    Scene,
    Sphere,
    joints,
)
from carom.scene.contacts import initial_gap

TURN = quaternion.exp(np.array([0.3, -0.5, 1.1]))


def stacked(upper, lower, height, **contact):
    scene = Scene()
    below = scene.add_body(lower, mass=1, name="below")
    above = scene.add_body(upper, mass=1, position=(0, 0, height), name="above")
    return scene, scene.add_contact(above, below, **contact)


@pytest.mark.parametrize(
    ("upper", "lower", "height"),
    [
        (Sphere(0.5), Sphere(0.25), 0.75),
        (Box(1, 1, 1), Box(3, 3, 0.5), 0.75),
        (Box(1, 1, 1, radius=0.1), Cylinder(2, 0.5), 0.75),
        (Capsule(0.1, 0.8), Convex(Box(1, 1, 0.5).vertices), 0.75),
        (Ellipsoid(1, 2, 0.5), Disc(2), 0.5),
        (Compound([(Sphere(0.1), (0, 0, -0.4)), (Sphere(0.1), (0, 0, 0.4))]), Box(1, 1, 0.5), 0.75),
    ],
)
def test_gap_at_the_start(upper, lower, height):
    _, contact = stacked(upper, lower, height + 0.2)
    assert initial_gap(contact) == pytest.approx(0.2, abs=1e-14)
    stacked(upper, lower, height)  # touching is fine
    with pytest.raises(ValueError, match=r"contact 'above-below': position .* 0.001 m deep"):
        stacked(upper, lower, height - 1e-3)


def test_touching_far_from_the_origin_and_turned():
    scene, far = Scene(), np.array([1e3, -7e2, 3e2])
    first = scene.add_body(Box(1, 2, 3), mass=1, position=far, orientation=TURN)
    place = far + quaternion.rotate(TURN, np.array([0.1, 0.2, 3.0]))
    second = scene.add_body(Box(1, 2, 3), mass=1, position=place, orientation=TURN)
    # the last place of coordinates of 1e3 m is 1e-13 m
    assert abs(initial_gap(scene.add_contact(first, second))) < 1e-12


def test_values_and_handles():
    scene, contact = stacked(Sphere(1), Sphere(1), 3, restitution=1, friction=0.2, name="c")
    assert (contact.body.name, contact.other.name, contact.half_space) == ("above", "below", None)
    assert contact is scene["c"]
    assert scene.contacts == (contact,)
    again = pickle.loads(pickle.dumps(scene))
    assert again.contacts[0].other is again["below"]
    ground = scene.add_half_space((0, 0, -9), (0, 0, 1))
    assert scene.add_contact(scene["below"], ground).half_space is ground


def test_inside_says_how_deep_and_what_to_do():
    with pytest.raises(ValueError, match="deep") as error:
        stacked(Sphere(0.5), Box(1, 1, 1), 0.9)
    for part in ("'above'", "'below'", "0.1 m deep", "at least 0", "move the body", "[0. 0. 1.]"):
        assert part in str(error.value)


def test_a_body_with_itself_and_a_pair_twice():
    scene, _ = stacked(Sphere(1), Sphere(1), 3)
    above, below = scene["above"], scene["below"]
    with pytest.raises(ValueError, match=r"body and other must be two, got Body\('above'"):
        scene.add_contact(above, above)
    for pair in ((above, below), (below, above)):
        with pytest.raises(ValueError, match="must be given once, got a second contact of the two"):
            scene.add_contact(*pair, name="again")


def test_body_without_shape():
    scene = Scene()
    bare = scene.add_body(mass=1, inertia=(1, 1, 1), name="bare")
    ball = scene.add_body(Sphere(1), mass=1)
    for pair in ((bare, ball), (ball, bare)):
        with pytest.raises(
            ValueError, match=r"body must have a shape for contact, got Body\('bare'"
        ):
            scene.add_contact(*pair)


def heap(**default):
    scene = Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    for k in range(4):
        scene.add_body(Sphere(0.5), mass=1, position=(0, 0, 0.5 + k), name=f"ball{k}")
    scene.set_contact_default(**default)
    return scene, ground


def test_all_pairs():
    scene, ground = heap(friction=0.3)
    first, second, third, last = scene.bodies
    scene.add_joint(joints.Spherical((0, 0, 1)), first, second)
    scene.ignore_contact(third, first)
    own = scene.add_contact(last, ground, friction=0.9)
    assert scene.contact_default.friction == 0.3
    assert scene.contact_law(first, ground).friction == 0.3
    assert scene.contact_law(last, second).friction == 0.3
    for pair in ((first, second), (second, first), (first, third), (last, ground), (last, last)):
        assert scene.contact_law(*pair) is None
    assert own.friction == 0.9
    scene.set_contact_default(all_pairs=False)
    assert scene.contact_default is None
    assert scene.contact_law(first, ground) is None


def test_all_pairs_are_looked_at_before_a_run():
    scene, _ = heap()
    scene.add_body(Box(1, 1, 1), mass=1, position=(0.95, 0, 0.5), name="box")
    with pytest.raises(ValueError, match=r"'box' and 'ball0'|'ball0' and 'box'") as error:
        scene.validate()
    assert "0.05 m deep" in str(error.value)
    scene, _ = heap()
    scene.add_body(Sphere(0.5), mass=1, position=(9, 0, 0.4), name="low")
    with pytest.raises(ValueError, match=r"'low' and 'ground': .* 0\.1 m deep"):
        scene.validate()


def test_joined_and_ignored_pairs_may_overlap():
    scene = Scene()
    first = scene.add_body(Sphere(1), mass=1)
    second = scene.add_body(Sphere(1), mass=1, position=(1, 0, 0))
    third = scene.add_body(Sphere(1), mass=1, position=(-1.5, 0, 0))
    scene.add_joint(joints.Fixed(), first, second)
    scene.set_contact_default()
    with pytest.raises(ValueError, match="m deep"):
        scene.validate()
    scene.ignore_contact(first, third)
    scene.validate()
    assert scene.contact_law(second, third) is not None


def test_all_pairs_with_materials_that_no_rule_combines():
    scene, _ = heap()
    for k, e in enumerate((0.1, 0.2)):
        place = (9 + 3 * k, 0, 5)
        scene.add_body(Sphere(1), mass=1, position=place, material=Material(e, 0), name=f"m{k}")
    with pytest.raises(ValueError, match=r"material must be given for both|combine must be given"):
        scene.validate()


def test_simulate_says_what_it_does_not_do_yet():
    scene, _ = stacked(Sphere(1), Sphere(1), 3)
    with pytest.raises(ValueError, match='impact_location must be "locate"'):
        carom.simulate(scene, 1.0, step=0.1, impact_location="project")
    for shape in (Cylinder(1, 1), Ellipsoid(1, 1, 1), Disc(1)):
        scene = Scene()
        ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
        scene.add_contact(scene.add_body(shape, mass=1, position=(0, 0, 3)), ground)
        with pytest.raises(ValueError, match=r'must be "locate" if shapes are curved'):
            carom.simulate(scene, 1.0, step=0.1, impact_location="work")


def test_joint_to_the_ground_is_no_pair_of_bodies():
    scene, _ = heap()
    scene.add_joint(joints.Spherical((0, 0, 9)), GROUND, scene.bodies[0])
    assert scene.contact_law(scene.bodies[0], scene.bodies[2]) is not None
    assert math.isfinite(scene.contact_default.restitution)
