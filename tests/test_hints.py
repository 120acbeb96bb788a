"""Names from other libraries: what stands for each in the table of hints exists, and messages say it."""

import importlib
import re
from types import SimpleNamespace

import numpy as np
import pytest

import carom
from carom import hints
from carom.results.drawn import KINDS
from carom.results.state import SystemState

OWNERS = {
    "Scene": carom.Scene,
    "Run": carom.Run,
    "Solution": carom.Solution,
    "SystemState": SystemState,
    "Ensemble": carom.Ensemble,
    "BodyState": carom.results.BodyState,
    "JointView": carom.results.JointView,
    "plot": SimpleNamespace(**dict.fromkeys(KINDS, None)),
}
ENTRIES = [
    (owner, name, ours)
    for owner, table in hints.MEMBERS.items()
    for ours, names in table.items()
    for name in names.split()
]


def owner_of(name):
    """Return a class or module of the table."""
    if name in OWNERS:
        return OWNERS[name]
    return getattr(carom, name.partition(".")[2]) if "." in name else importlib.import_module(name)


def test_a_name_from_elsewhere_is_answered():
    for owner, name, ours in ENTRIES:
        case, holder = f"{owner}.{name}", owner_of(owner)
        own = [
            *dir(holder),
            *(getattr(carom.Solution, "__annotations__", ()) if owner == "Solution" else ()),
        ]
        assert name not in own, case  # a hint for what exists would never be shown
        assert hints.of_member(owner, name) == ours, case
        if ours.isidentifier():
            assert hasattr(holder, ours), case
        if "carom" in owner:
            with pytest.raises(AttributeError, match=re.escape(ours)):
                getattr(holder, name)


def named_in(sentence):
    """Return what a sentence names: words with ``carom.`` before them, methods of scenes and of solutions."""
    for word in re.findall(r"\bcarom\.[\w.]*\w", sentence):
        yield carom, word.partition(".")[2]
    for word in re.findall(r"\b(?:add_\w+|set_contact_default)\b", sentence):
        yield carom.Scene, word
    for word in re.findall(r"\bsolution\.(\w+)", sentence):
        yield carom.Solution, word
    for word in re.findall(r"\bscene\.(\w+)", sentence):
        yield carom.Scene, word


SENTENCES = {ours for _, _, ours in ENTRIES} | set(hints.PLACES)
SENTENCES |= {said for table in hints.ARGUMENTS.values() for said in table}


def test_what_a_sentence_names_exists():
    for ours in SENTENCES:
        if ours.isidentifier():
            continue
        for holder, names in named_in(ours):
            for name in names.split("."):
                if name == "scene" and holder is carom.Solution:
                    break  # a field
                holder = getattr(holder, name)
        assert len(ours) > 10


def test_no_name_stands_for_itself_or_twice_in_a_table():
    for ours, others in hints.VALUES.items():
        assert ours not in others.split()
        assert len(set(others.split())) == len(others.split())
    for table in hints.ARGUMENTS.values():
        names = [name for names in table.values() for name in names.split()]
        assert len(set(names)) == len(names)
    for owner, table in hints.MEMBERS.items():
        names = [hints._plain(name) for names in table.values() for name in names.split()]
        assert len(set(names)) == len(names), owner


@pytest.fixture(scope="module")
def run():
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.5), name="ball")
    scene.add_contact("ball", "floor", restitution=0.5)
    return carom.simulate(scene, 0.1, step=0.01)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (
            lambda s: s.to_csv("run.csv"),
            r"Solution has no attribute 'to_csv'; tables are written by",
        ),
        (lambda s: s.collisions, "did you mean 'impacts'"),
        (lambda s: s.animate(), r"a film is made by carom\.film"),
        (lambda s: s.to_dataframe(), "did you mean 'to_pandas'"),
        (lambda s: s.sol(0.1), "did you mean 'evaluate'"),
        (lambda s: s.qpos, "coordinates of a joint are joint_coordinates"),
        (lambda s: s.positoin, "did you mean 'position'"),
        (lambda s: s.evaluate(time=0.1), "evaluate has no argument time=; it is called t="),
        (lambda s: s.save(filename="run.nc"), "save has no argument filename=; it is called path="),
        (
            lambda s: carom.Solution.load(file="run.nc"),
            "load has no argument file=; it is called path=",
        ),
        (lambda s: s.joint_coordinates(name="pin"), "it has joint"),
        (
            lambda s: s.scene.add_cable(1),
            r"a cord that goes slack is add_joint\(carom\.joints\.Tether",
        ),
        (lambda s: s.scene.add_conveyor(1), "surface_velocity="),
        (lambda s: s.plot("reactions"), "did you mean 'joints'"),
        (
            lambda s: carom.simulate(s.scene, 1.0, step=None),
            '"auto", which is the default, got None',
        ),
    ],
)
def test_a_solution_says_what_it_has(run, ask, words):
    with pytest.raises((AttributeError, TypeError, ValueError), match=words):
        ask(run)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: carom.view(file="run.nc"), "view has no argument file=; it has solution"),
        (lambda: carom.films.still(time=0.1), "still has no argument time=; it is called t="),
        (lambda: carom.solve_contacts(mu=0.1), "it is called friction="),
        (lambda: carom.sensitivities(param="die.mass"), "sensitivities has no argument param="),
        (lambda: carom.Scene().ignore_contact(a="die"), "ignore_contact has no argument a="),
        (lambda: carom.GeneralizedSystem(M=1), "GeneralizedSystem has no argument M="),
        (
            lambda: carom.joints.Revolute((0, 0, 0), (0, 0, 1), friction=0.1),
            r"forces\.JointFriction\(joint",
        ),
        (
            lambda: carom.joints.Prismatic((0, 0, 1), limits=(0, 1)),
            r"scene\.add_stop\(joint, lower=",
        ),
        (
            lambda: carom.joints.Revolute((0, 0, 0), (0, 0, 1), clearance=1),
            r"carom\.joints\.Clearance",
        ),
        (
            lambda: carom.film(resolution=(9, 9)),
            r"width and height in pixels are size=\(1280, 720\)",
        ),
        (lambda: carom.simulate(limits=1), r"scene\.add_stop\(joint"),
    ],
)
def test_a_function_says_which_argument_is_meant(call, words):
    with pytest.raises(TypeError, match=words):
        call()


def test_an_ensemble_says_what_it_has(run):
    made = carom.ensemble(run.scene, 0.1, step=0.05, vary={"ball.mass": np.array([1.0, 2.0])})
    for name, words in (("to_csv", "tables are written by"), ("statu", "did you mean 'status'")):
        with pytest.raises(AttributeError, match=words):
            getattr(made, name)
    assert not hasattr(made, "_private")


@pytest.mark.parametrize(
    ("argument", "value", "call"),
    [
        ("impact_law", "moreau", lambda value: carom.Options(multiple=value)),
        ("impact_law", "Poisson", lambda value: carom.Options(multiple=value)),
        ("impact_law", "moreu", lambda value: carom.Options(multiple=value)),
        (
            "multiple",
            "sequential",
            lambda value: carom.Scene().set_contact_default(impact_law=value),
        ),
    ],
)
def test_a_value_of_another_argument_is_said_to_be_that(argument, value, call):
    with pytest.raises(ValueError, match=rf"{argument}='\w{{6,}}'\)$"):
        call(value)


def test_words_of_other_arguments_are_their_values():
    for argument, table in hints.WORDS.items():
        for said, words in table.items():
            (other,) = re.findall(r"(\w+)=\{", said)
            assert other in {"multiple", "impact_law"} - {argument}
            for word in words.split():
                if other == "multiple":
                    carom.Options(multiple=word)
                else:
                    carom.Scene().set_contact_default(impact_law=word)
