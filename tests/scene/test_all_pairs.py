"""The contacts of all pairs as arrays: how many, in which order, by which law, with whose vertices."""

from itertools import combinations, product

import numpy as np
import pytest

from carom.geometry import quaternion
from carom.model.compile import compile_scene
from carom.model.contact_kinds import has_vertices, is_found
from carom.options import Options
from carom.scene import Box, Capsule, Compound, Cylinder, Material, Scene, Sphere, joints

TURN = quaternion.exp(np.array([0.3, -0.5, 1.1]))
L_SHAPE = Compound([(Box(0.2, 0.2, 0.6), (0, 0, 0)), (Box(0.4, 0.2, 0.2), (0.3, 0, 0.2), TURN)])
BOLT = Compound([(Cylinder(0.1, 0.4), (0, 0, 0)), (Box(0.3, 0.3, 0.1), (0, 0, 0.25))])


def in_a_row(shapes, planes=2, materials=(None,)):
    scene = Scene()
    for k, shape in enumerate(shapes):
        surface = materials[k % len(materials)]
        scene.add_body(shape, mass=1, position=(2.0 * k, 0, 0), orientation=TURN, material=surface)
    for h in range(planes):
        surface = materials[h % len(materials)]
        scene.add_half_space((0, 0, -2 - h), (0, 0, 1), material=surface)
    return scene


def compiled(scene):
    """Return contacts, vertices, and the rotations from principal to body axes."""
    found = compile_scene(scene, Options())
    return found.system.contacts, found.system.vertices, found.to_principal


def chosen(contacts, which):
    return contacts[which].view(np.recarray)


def test_two_hundred_spheres():
    # 200 . 5 rows with half-spaces and 200 . 199 / 2 of two bodies. Vertices: one a row with a half-space,
    # and one a sphere, which all its contacts with others share.
    scene = in_a_row([Sphere(0.5)] * 200, planes=5)
    scene.set_contact_default(friction=0.3)
    contacts, vertices, _ = compiled(scene)
    assert (len(contacts), vertices.shape) == (1000 + 19900, (1200, 3))
    flat = chosen(contacts, has_vertices(contacts))
    np.testing.assert_array_equal(flat.body, np.repeat(np.arange(200), 5))
    np.testing.assert_array_equal(flat.first, np.arange(1000))
    np.testing.assert_array_equal(flat.last, np.arange(1, 1001))
    pair = chosen(contacts, is_found(contacts))
    order = np.array(list(combinations(range(200), 2)))
    np.testing.assert_array_equal(np.stack([pair.body, pair.other], axis=1), order)
    for first, last, body in (
        (pair.first, pair.last, pair.body),
        (pair.other_first, pair.other_last, pair.other),
    ):
        np.testing.assert_array_equal(first, 1000 + body)
        np.testing.assert_array_equal(last, 1001 + body)
    np.testing.assert_array_equal(contacts.number, np.arange(20900))
    laws = compile_scene(scene, Options()).system.laws
    assert np.all(laws.table.friction[contacts.law] == 0.3)


def test_a_row_for_each_two_pieces_and_the_vertices_of_both():
    shapes = [L_SHAPE, Capsule(0.1, 0.5), BOLT, Box(0.2, 0.3, 0.4)]
    scene = in_a_row(shapes, planes=0)
    scene.set_contact_default()
    contacts, vertices, to_principal = compiled(scene)
    expected = [
        (number, (i, a), (j, b))
        for number, (i, j) in enumerate(combinations(range(4), 2))
        for a, b in product(range(len(shapes[i].pieces)), range(len(shapes[j].pieces)))
    ]
    assert len(contacts) == len(expected) == 2 + 4 + 2 + 2 + 1 + 2
    first_solid = np.cumsum([0, *(len(shape.pieces) for shape in shapes)])
    for row, (number, *sides) in zip(contacts, expected):
        (i, a), (j, b) = sides
        assert (row.number, row.body, row.other) == (number, i, j)
        assert (row.solid, row.other_solid) == (first_solid[i] + a, first_solid[j] + b)
        for (k, piece), first, last in zip(
            sides, (row.first, row.other_first), (row.last, row.other_last)
        ):
            corners = shapes[k].pieces[piece].corners
            corners = np.zeros((0, 3)) if corners is None else corners
            seen = quaternion.rotate(to_principal[k], vertices[first:last])
            np.testing.assert_allclose(seen, corners, rtol=0, atol=1e-15)


def test_each_contact_with_a_half_space_has_vertices_of_its_own():
    # The two boxes of the L are one hull of 16 vertices; of the bolt the box alone has any; the capsule has 2.
    # A persistent contact is known by its vertex.
    scene = in_a_row([L_SHAPE, BOLT, Capsule(0.1, 0.5)])
    scene.set_contact_default()
    contacts, _, _ = compiled(scene)
    flat, pair = chosen(contacts, has_vertices(contacts)), chosen(contacts, contacts.other >= 0)
    np.testing.assert_array_equal(flat.last - flat.first, [16, 16, 8, 8, 2, 2])
    np.testing.assert_array_equal(flat.first, np.cumsum([0, 16, 16, 8, 8, 2]))
    curved = chosen(contacts, is_found(contacts) & (contacts.other < 0))
    np.testing.assert_array_equal(curved.body, [1, 1])  # the shaft of the bolt
    np.testing.assert_array_equal(curved.last, curved.first)
    assert np.min(pair.first) >= 52
    assert np.min(pair.other_first) >= 52


@pytest.mark.parametrize("rule", ["max", "product"])
def test_the_law_of_each_pair(rule):
    materials = (
        Material(0.1, 0.2, friction_held=0.15),
        Material(0.5, 0.3, stiffness=3.0, pivoting_friction=0.01),
        Material(0.9, 0.7, rolling_friction=0.02),
    )
    scene = in_a_row([Sphere(0.5)] * 7, planes=4, materials=materials)
    scene.set_contact_default(impact_law="stronge", combine=rule)
    bodies, planes = scene.bodies, scene.half_spaces
    own = scene.add_contact(bodies[5], bodies[2], restitution=0.77)
    scene.ignore_contact(bodies[3], planes[1])
    scene.ignore_contact(bodies[6], bodies[4])
    scene.add_joint(joints.Spherical((1, 0, 0)), bodies[1], bodies[0])
    pairs = [(own.body, own.other), *product(bodies, planes), *combinations(bodies, 2)]
    laws = [own, *(scene.contact_law(*pair) for pair in pairs[1:])]
    kept = [(pair, law) for pair, law in zip(pairs, laws) if law is not None]
    assert len(kept) == 1 + 28 + 21 - 4
    system = compile_scene(scene, Options()).system
    assert len(system.contacts) == len(kept)
    for row, ((body, other), law) in zip(system.contacts, kept):
        assert (row.body, row.other) == (body.index, -1 if other in planes else other.index)
        if other in planes:
            assert row.offset == -2 - other.index
        strikes, persistent = system.laws.table[row.law]
        assert (strikes.friction, persistent.friction) == (law.friction, law.friction_held)
        for one in (strikes, persistent):
            assert (one.restitution, one.stiffness) == (law.restitution, law.stiffness)
            assert tuple(one.turning) == (law.rolling_friction, law.pivoting_friction)
            assert one.impact_law == 2


def test_a_pair_without_a_law_is_named_wherever_it_is():
    # The first of all pairs whose materials differ, though they are far apart.
    scene = in_a_row([Sphere(0.5)] * 4, planes=1, materials=[Material(0.5, 0.3)])
    scene.add_body(Sphere(0.5), mass=1, position=(99, 0, 0), material=Material(0.4, 0.3), name="x")
    scene.set_contact_default()
    for refuse in (scene.validate, lambda: compiled(scene)):
        with pytest.raises(ValueError, match=r"'x' has 0\.4, 'half_space1' has 0\.5"):
            refuse()
