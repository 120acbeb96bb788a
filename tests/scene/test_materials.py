"""Materials, their rules, and which value of a contact counts."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.scene import ContactLaw, Material, Scene, Sphere

STEEL = Material(restitution=0.9, friction=0.16)
RUBBER = Material(restitution=0.4, friction=0.81, friction_held=1.0, stiffness=0.25)


def two(first=None, second=None, **default):
    scene = Scene()
    if default:
        scene.set_contact_default(**default)
    ball = scene.add_body(Sphere(1), mass=1, position=(0, 0, 5), material=first, name="ball")
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), material=second, name="ground")
    return scene, ball, ground


@pytest.mark.parametrize(
    ("rule", "restitution", "friction", "held"),
    [
        # of (0.9, 0.4), (0.16, 0.81), (0.16, 1.0)
        ("average", 0.65, 0.485, 0.58),
        ("min", 0.4, 0.16, 0.16),
        ("max", 0.9, 0.81, 1.0),
        ("product", 0.36, 0.1296, 0.16),
        ("geometric", 0.6, 0.36, 0.4),
    ],
)
def test_rules(rule, restitution, friction, held):
    for pair in ((STEEL, RUBBER), (RUBBER, STEEL)):
        scene, ball, ground = two(*pair, combine=rule)
        contact = scene.add_contact(ball, ground)
        assert contact.restitution == pytest.approx(restitution, rel=1e-15)
        assert contact.friction == pytest.approx(friction, rel=1e-15)
        assert contact.friction_held == pytest.approx(held, rel=1e-15)
        assert contact.stiffness == pytest.approx(2 / (1 / 1 + 1 / 0.25), rel=1e-15)


def test_rule_by_property():
    rules = {"friction": "geometric", "restitution": "max", "friction_held": "min"}
    scene, ball, ground = two(STEEL, RUBBER, combine=rules)
    contact = scene.add_contact(ball, ground)
    assert (contact.restitution, contact.friction_held) == (0.9, 0.16)
    assert contact.friction == pytest.approx(0.36, rel=1e-15)


def test_materials_without_a_rule_are_refused():
    scene, ball, ground = two(STEEL, RUBBER)
    with pytest.raises(ValueError, match="combine must be given, the rule for") as error:
        scene.add_contact(ball, ground)
    for part in ("restitution", "'ball' has 0.9", "'ground' has 0.4", 'combine="average"'):
        assert part in str(error.value)
    # What is given for the pair needs no rule, what is not still does.
    with pytest.raises(ValueError, match="the rule for friction"):
        scene.add_contact(ball, ground, restitution=0.5)
    contact = scene.add_contact(ball, ground, restitution=0.5, friction=0.3)
    assert (contact.restitution, contact.friction, contact.friction_held) == (0.5, 0.3, 0.3)


def test_equal_materials_need_no_rule():
    scene, ball, ground = two(STEEL, STEEL)
    contact = scene.add_contact(ball, ground)
    assert (contact.restitution, contact.friction) == (0.9, 0.16)


def test_material_on_one_side_only_is_refused():
    scene, ball, ground = two(STEEL, None, combine="average")
    with pytest.raises(ValueError, match="material must be given for both") as error:
        scene.add_contact(ball, ground)
    assert "'ball' has Material(" in str(error.value)
    assert "'ground' has none" in str(error.value)
    assert scene.add_contact(ball, ground, restitution=0.1, friction=0.2).friction == 0.2


def test_what_counts_before_what():
    # Given for the pair, then materials, then the default of the scene, then that of the library.
    scene, ball, ground = two(restitution=0.7, friction=0.2, impact_law="poisson")
    contact = scene.add_contact(ball, ground, friction=0.4)
    values = (contact.restitution, contact.friction, contact.friction_held, contact.impact_law)
    assert values == (0.7, 0.4, 0.4, "poisson")
    scene, ball, ground = two(STEEL, STEEL, restitution=0.7, impact_law="stronge")
    contact = scene.add_contact(ball, ground, friction_held=0.5)
    values = (contact.restitution, contact.friction, contact.friction_held, contact.impact_law)
    assert values == (0.9, 0.16, 0.5, "stronge")
    scene, ball, ground = two()
    contact = scene.add_contact(ball, ground)
    plain = ContactLaw()
    for name in ("restitution", "friction", "friction_held", "impact_law", "stiffness"):
        assert getattr(contact, name) == getattr(plain, name)
    assert (contact.restitution, contact.friction, contact.rolling_friction) == (0.5, 0.0, 0.0)


@given(
    st.sampled_from(["average", "min", "max", "geometric"]),
    st.floats(0, 1, allow_subnormal=False),
    st.floats(0, 3, allow_subnormal=False),
    st.floats(0, 1, allow_subnormal=False),
    st.floats(0, 3, allow_subnormal=False),
)
def test_a_rule_stays_between_the_two_and_does_not_mind_their_order(rule, e, mu, e2, mu2):
    laws = []
    for pair in ((Material(e, mu), Material(e2, mu2)), (Material(e2, mu2), Material(e, mu))):
        scene, ball, ground = two(*pair, combine=rule)
        laws.append(scene.contact_law(ball, ground))
    assert laws[0] == laws[1]
    slack = 1 + 1e-15  # rounding of roots and sums
    assert min(e, e2) / slack <= laws[0].restitution <= max(e, e2) * slack
    assert min(mu, mu2) / slack <= laws[0].friction <= max(mu, mu2) * slack


def test_words_show_what_is_not_plain():
    scene, ball, ground = two()
    contact = scene.add_contact(
        ball, ground, friction=0.2, friction_held=0.3, rolling_friction=1e-3
    )
    assert repr(contact) == (
        "Contact('ball-ground', restitution=0.5, friction=0.2, friction_held=0.3, impact_law='newton', "
        "rolling_friction=0.001)"
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"restitution": 1.1}, "restitution must be finite and at least 0 and at most 1, got 1.1"),
        ({"friction": -1}, "friction must be finite and at least 0, got -1"),
        ({"friction_held": math.nan}, "friction_held must be finite and at least 0, got nan"),
        ({"stiffness": 0}, "stiffness must be finite and above 0, got 0"),
        ({"rolling_friction": -1}, "rolling_friction must be finite and at least 0, got -1"),
        ({"pivoting_friction": "no"}, "pivoting_friction must be a number, got 'no'"),
    ],
)
def test_bad_values_are_refused(change, message):
    with pytest.raises(ValueError, match="must be") as error:
        Material(**{"restitution": 0.5, "friction": 0.5, **change})
    assert message in str(error.value)
    scene, ball, ground = two()
    for call in (lambda: scene.add_contact(ball, ground, **change), lambda: two(**change)):
        with pytest.raises(ValueError, match="must be") as error:
            call()
        assert message in str(error.value)


@pytest.mark.parametrize(
    ("combine", "message"),
    [
        (
            "mean",
            "combine must be one of 'average', 'geometric', 'max', 'min', 'product', got 'mean'",
        ),
        (3, "combine must be one of 'average', .* or a dict of these by property, got 3"),
        ({"frction": "max"}, "a key of combine must be one of .*did you mean 'friction'"),
        ({"friction": "most"}, r"combine\['friction'\] must be one of .*got 'most'"),
    ],
)
def test_bad_rules_are_refused(combine, message):
    with pytest.raises(ValueError, match=message):
        Scene().set_contact_default(combine=combine)


def test_wrong_material():
    with pytest.raises(TypeError, match="material must be a Material, got 'steel'"):
        Scene().add_body(Sphere(1), mass=1, material="steel")
    with pytest.raises(TypeError, match=r"material must be a Material, got 0\.3"):
        Scene().add_half_space((0, 0, 0), (0, 0, 1), material=0.3)
