"""All numbers and words of a scene are varied by name; each run is that of a scene that was made so."""

import numpy as np
import pytest

import carom
from ensembles.ensemble_scenes import die, two_balls
from ensembles.test_ensemble import agrees

HOW = {
    "step": 5e-3,
    "options": carom.Options(project_start=True),
}  # the motor turns the wheel at once


def swing(
    stiffness=50.0, anchor=(0, 0, 0), upper=0.5, radius=0.1, rate=2.0, law="newton", rest=None
):
    """A pendulum on a spring that strikes a stop, and a motor that turns a wheel."""
    scene = carom.Scene()
    rod = scene.add_body(carom.Sphere(radius), mass=1.0, position=(0.5, 0, 0), name="rod")
    wheel = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(5, 0, 0), name="wheel")
    hinge = scene.add_joint(
        carom.joints.Revolute(anchor, (0, 1, 0)), carom.GROUND, rod, name="hinge"
    )
    axle = carom.joints.Revolute((5, 0, 0), (0, 0, 1))
    axle = scene.add_joint(axle, carom.GROUND, wheel, name="axle")
    scene.add_constraint(carom.constraints.Driver(axle, rate=rate), name="motor")
    spring = carom.forces.Spring(stiffness, (0.5, 0, 1), (0.5, 0, 0), rest_length=rest)
    scene.add_force(spring, carom.GROUND, rod, name="spring")
    scene.add_stop(hinge, upper=upper, restitution=0.5, impact_law=law, name="stop")
    return scene


@pytest.mark.parametrize(
    ("name", "values", "argument"),
    [
        ("spring.stiffness", [10.0, 30.0], "stiffness"),
        ("spring.rest_length", [0.8, 1.1], "rest"),
        ("hinge.anchor", [(0.1, 0, 0), (0.2, 0, 0)], "anchor"),
        ("stop.upper", [0.1, 0.2], "upper"),
        ("stop.impact_law", ["poisson", "stronge"], "law"),
        ("motor.rate", [1.0, 3.0], "rate"),
        ("rod.radius", [0.2, 0.3], "radius"),
    ],
)
def test_a_part_of_each_kind(name, values, argument):
    """Not close: each run is, to the last bit, that of a scene that was made with the value."""
    e = carom.ensemble(swing(), 0.4, vary={name: values}, executor="serial", **HOW)
    assert e.counts() == {"success": 2}
    for k, value in enumerate(values):
        made = carom.simulate(swing(**{argument: value}), 0.4, **HOW)
        assert np.array_equal(e.position[k], made.position[-1])
        assert np.array_equal(e.angular_velocity[k], made.angular_velocity[-1])
    # laws of restitution differ with friction alone
    same = np.array_equal(e.orientation[0], e.orientation[1])
    assert same == (argument == "law")


def test_what_follows_a_size_or_an_end():
    e = carom.ensemble(
        swing(), 0.01, executor="serial", **HOW,
        vary={"rod.radius": [0.2], "spring.anchor_parent": [(0.5, 0, 2)], "rod.mass": [3.0]},
    )  # fmt: skip
    scene = e.solution(0).scene
    np.testing.assert_allclose(scene["rod"].inertia, 0.4 * 3.0 * 0.2**2 * np.eye(3), rtol=1e-14)
    assert scene["spring"].definition.rest_length == 2.0
    kept = carom.ensemble(
        swing(rest=0.7), 0.01, executor="serial", **HOW,
        vary={"spring.anchor_parent.z": [2.0], "rod.radius": [0.2], "rod.inertia": [(1, 1, 1)]},
    )  # fmt: skip
    scene = kept.solution(0).scene
    assert scene["spring"].definition.rest_length == 0.7
    assert np.array_equal(scene["rod"].inertia, np.eye(3))


def test_one_component_and_all_contacts():
    """Of gravity and of a velocity; restitution of all contacts, but for one that has its own."""
    vary = {"gravity.z": [-5.0, -9.0], "low.velocity.x": [0.1, 0.2], "restitution": [0.2, 0.6]}
    vary["high-low.restitution"] = [0.9, 0.9]
    e = carom.ensemble(two_balls(), 0.2, step=2e-3, vary=vary, executor="serial")
    assert all(agrees(e, k) for k in range(2))
    scene = e.solution(1).scene
    assert scene.gravity.tolist() == [0, 0, -9.0]
    assert scene["low"].velocity.tolist() == [0.2, 0, 0]
    assert [contact.restitution for contact in scene.contacts] == [0.6, 0.6, 0.9]


def test_words_for_a_function_that_makes_the_scene():
    def thrown(law, friction):
        assert isinstance(law, str)
        return die(friction)

    vary = {"law": ["newton"], "friction": [0.1]}
    e = carom.ensemble(thrown, 0.02, step=5e-3, vary=vary, executor="serial")
    assert e.counts() == {"success": 1}


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({"spring.stifness": [1.0]}, "did you mean 'spring.stiffness'"),
        ({"spring.zeta": [1.0]}, "'spring' has stiffness, anchor_parent, .*, rest_length, damping"),
        (
            {"spring.stiffness": [1.0, -1.0]},
            r"vary\['spring.stiffness'\] in run 1: stiffness must be .*at least 0",
        ),
        (
            {"stop.impact_law": ["newton", "stronger"]},
            "in run 1: impact_law must be one of .* did you mean 'stronge'",
        ),
        ({"stop.impact_law": [1.0]}, "impact_law must be one of"),
        ({"rod.velocity": ["fast"]}, "velocity must be numbers of shape .*got .*'fast'"),
        ({"rod.radius": ["wide"]}, "radius must be"),
        ({"rod.velocity": [(0, 0, 0)], "rod.velocity.x": [1.0]}, "or its components"),
        ({"hinge.axis": [(0, 0, 0)]}, "axis must not be the zero vector"),
        ({"friction": [0.1]}, "all contacts of add_contact, got a scene with none"),
        ({"rod.velocity.q": [0.1]}, "names in vary must be"),
        ({"gravity.z": ["down"]}, "must be numbers, got 'down'"),
    ],
)
def test_what_a_scene_does_not_take(vary, words):
    with pytest.raises(ValueError, match=words):
        carom.ensemble(swing(), 0.1, vary=vary, **HOW)


def test_a_run_with_parts_that_do_not_fit_is_refused_alone():
    vary = {"high.radius": [0.05, 0.5]}
    e = carom.ensemble(two_balls(), 0.05, step=5e-3, vary=vary, executor="serial")
    assert e.counts() == {"refused": 1, "success": 1}
    assert "deep into" in e.failures[1]
