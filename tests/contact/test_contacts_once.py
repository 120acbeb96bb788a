"""Contacts of scenes that are alike are compiled once; those of others are not mistaken for them."""

import numpy as np
import pytest

import carom
from carom.model import contacts
from carom.model.compile import compile_scene


def scene(
    shape=None, normal=(0, 0, 1), point=(0, 0, 0), gravity=(0, 0, -9.81), inertia=None, other=None,
    default=None, **law,
):  # fmt: skip
    made = carom.Scene(gravity=gravity)
    plane = made.add_half_space(point, normal)
    shape = shape or carom.Box(0.1, 0.2, 0.3)
    body = made.add_body(shape, mass=1.0, inertia=inertia, position=(0, 0, 2), velocity=(1, 0, 0))
    made.add_body(other or carom.Sphere(0.1), mass=1.0, position=(1, 0, 2))
    made.add_contact(body, plane, **{"restitution": 0.5, "friction": 0.2, **law})
    if default is not None:
        made.set_contact_default(restitution=default, friction=0.1)
    return made


CHANGES = {
    "shape": {"shape": carom.Box(0.1, 0.2, 0.4)}, "curved": {"shape": carom.Ellipsoid(0.1, 0.2, 0.3)},
    "normal": {"normal": (0, 0.6, 0.8)}, "point": {"point": (0, 0, -1)}, "gravity": {"gravity": (0, 0, -1)},
    "axes": {"inertia": [[2, 0.5, 0], [0.5, 3, 0], [0, 0, 4]]},
    "other": {"other": carom.Sphere(0.2), "default": 0.1},
    "default": {"default": 0.5}, "restitution": {"restitution": 0.1}, "friction": {"friction": 0.3},
    "held": {"friction_held": 0.5}, "law": {"impact_law": "stronge"}, "stiffness": {"stiffness": 2.0},
    "rolling": {"rolling_friction": 0.01}, "multiple": {"multiple": "sequential"},
}  # fmt: skip


OF_LAWS = {"restitution", "friction", "held", "law", "stiffness", "rolling", "multiple"}


def compiled(change, options=None):
    return compile_scene(scene(**change), options or carom.Options(), apart=True)


def assert_same(a, b):
    assert a._fields == b._fields
    for name, one, other in zip(a._fields, a, b):
        if isinstance(one, tuple):
            assert_same(one, other)
        elif isinstance(one, np.ndarray):
            assert np.array_equal(one, other), name


@pytest.mark.parametrize("name", CHANGES)
def test_other_contacts_are_others(name):
    fresh = []
    for change in ({}, CHANGES[name]):
        contacts._KNOWN.clear()
        fresh.append(compiled(change))
    assert len(contacts._KNOWN) == 1
    for alone, change in zip(fresh, ({}, CHANGES[name])):
        again = compiled(change)  # with both kept, one of them from its template
        assert_same(again.system, alone.system)
        assert_same(again.surfaces, alone.surfaces)
    # a contact has the number of its law, and is the same for others
    assert len(contacts._KNOWN) == (1 if name in OF_LAWS else 2)


@pytest.mark.parametrize("option", [{"layer_width": 1e-4}, {"penetration": 0.5}])
def test_options_of_rows_count(option):
    plain, other = compiled({}), compiled({}, carom.Options(**option))
    assert not np.array_equal(plain.system.contacts, other.system.contacts)


def test_a_run_does_not_write_to_what_is_kept():
    first = compiled({})
    first.system.laws.table["friction"], first.system.vertices[:] = 7.0, 7.0
    second = compiled({})
    assert second.system.laws.table.friction[0] == 0.2
    assert np.max(second.system.vertices) < 1.0


def test_names_are_those_of_the_scene():
    made = [scene(), scene()]
    pairs = [compile_scene(one, carom.Options(), apart=True).pairs for one in made]
    assert [table.laws[0] is one.contacts[0] for table, one in zip(pairs, made)] == [True, True]
