"""The pages of the API have every public name once, and every public member of each class."""

import importlib
import inspect
import re
import sys
from pathlib import Path

import numpy as np
import pytest

import carom

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))
pages = importlib.import_module("api_pages")
sys.path.remove(str(ROOT / "docs"))

NAMES = [
    name
    for page in sorted((ROOT / "docs/api").glob("*.rst"))
    for name in re.findall(r"^   (carom\.[\w.]+)$", page.read_text(encoding="utf-8"), re.M)
]
CLASSES = [name for name in NAMES if inspect.isclass(pages.find(name))]
LISTED = re.compile(r"^\.\. (?:auto\w+|py:attribute):: (carom\.[\w.]+)$", re.M)


def test_each_name_is_there_once():
    assert len(NAMES) > 150
    assert len(set(NAMES)) == len(NAMES)
    found = [pages.find(name) for name in NAMES]
    assert len({id(one) for one in found}) == len(found)  # nor under two names


def test_all_that_is_public_is_there():
    public = []
    for name in carom.__all__:
        one = getattr(carom, name)
        inside = [f"{name}.{part}" for part in getattr(one, "__all__", ())]
        public += inside if inspect.ismodule(one) else [name]
    known = {id(pages.find(name)) for name in NAMES}
    assert [name for name in public if id(pages.find(f"carom.{name}")) not in known] == []


def test_dir_of_a_module_is_what_is_public():
    """What `dir` and the tabulator key show is on the pages, or a module of which something is."""
    known = {id(pages.find(one)) for one in NAMES} | {
        id(pages.find(one.rpartition(".")[0])) for one in NAMES
    }
    for name in [n for n in carom.__all__ if inspect.ismodule(getattr(carom, n))]:
        shown = [one for one in dir(getattr(carom, name)) if not one.startswith("__")]
        assert shown, name
        new = [one for one in shown if id(getattr(getattr(carom, name), one)) not in known]
        assert new == [], name


def listed(name: str) -> set[str]:
    """Return the members on the page of a class, and the arguments that its signature shows."""
    shown = {
        m.removeprefix(f"{name}.") for m in LISTED.findall(pages.class_page(name)) if m != name
    }
    cls = pages.find(name)
    return shown | (set() if pages.handed_back(cls) else set(inspect.signature(cls).parameters))


def public(one, cls) -> set[str]:
    """Return the public names of `dir`, but for those of Python's own classes."""
    own = [base for base in cls.__mro__ if base.__module__.startswith("carom")]
    fields = {name for base in own for name in inspect.get_annotations(base)}
    foreign = {n for base in cls.__mro__ if base not in own for n in vars(base)} - fields
    return {n for n in dir(one) if not n.startswith("_")} - foreign


def test_page_of_a_class_has_all_its_members():
    missing = {name: public(cls := pages.find(name), cls) - listed(name) for name in CLASSES}
    assert not {name: members for name, members in missing.items() if members}


def falling_box():
    """Yield one object of most classes that a run hands back."""
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    box = scene.add_body(carom.Box(1, 1, 1), mass=1.0, position=(0, 0, 0.6))
    rod = scene.add_body(mass=1.0, inertia=(1, 1, 1), position=(5, 0, 5))
    joint = scene.add_joint(carom.joints.Revolute((5, 0, 6), (0, 1, 0)), carom.GROUND, rod)
    contact = scene.add_contact(box, floor, restitution=0.5)
    stop = scene.add_stop(joint, upper=1.0)
    solution = carom.simulate(scene, duration=0.3, step=0.01)
    yield from (scene, floor, box, joint, joint.definition, contact, stop, scene.check())
    yield from (solution, solution.impacts, solution.impacts[0], solution.events, solution.ledger)
    yield from (solution.contacts, solution.forces, solution.pairs, solution.status, box.shape)
    yield from (carom.Options(), carom.Material(0.5, 0.1), carom.GROUND)
    yield carom.resolve_impact(np.eye(3), (-1.0, 0.0, 0.0), 0.1, 0.5)
    yield carom.impact_layer(np.eye(3), (-1, 0, 0), 0.1, 0.5, penetration=0.2, width=1e-3)


def test_page_has_all_that_an_object_has():
    """Attributes that only objects have (fields without a default) are on the pages too, and no others."""
    by_class = {pages.find(name): name for name in CLASSES}
    for one in falling_box():
        name = by_class[type(one)]
        arguments = set() if pages.handed_back(type(one)) else set(pages.arguments_of(type(one)))
        assert public(one, type(one)) - listed(name) == set(), name
        assert listed(name) - arguments - public(one, type(one)) == set(), name


def test_page_of_a_class_shows_nothing_private():
    for name in CLASSES:
        assert not re.search(r"\._|from_run", pages.class_page(name)), name
        if not pages.handed_back(pages.find(name)):
            given = inspect.signature(pages.find(name)).parameters
            assert not [p for p in given if p[0] == "_"], name


def test_a_member_without_a_topic_is_found_out(monkeypatch):
    monkeypatch.setattr(carom.Scene, "new_method", lambda self: None, raising=False)
    with pytest.raises(ValueError, match=r"topics of carom.Scene .* differ by \['new_method'\]"):
        pages.by_topic("carom.Scene")
