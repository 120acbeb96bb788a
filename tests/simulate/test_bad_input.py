"""Bad input to `simulate` and `Options`: the argument, the value and what is allowed, before a run."""

import math

import numpy as np
import pytest

import carom
from simulate.scenes import ball

NAN, INF = math.nan, math.inf


@pytest.mark.plain
@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"duration": 0}, ValueError, r"duration must be finite and above 0 \[s\], got 0"),
        ({"duration": -1.0}, ValueError, r"duration must be .* above 0 .* got -1.0"),
        ({"duration": NAN}, ValueError, r"duration must be finite .* got nan"),
        ({"duration": INF}, ValueError, r"duration must be finite .* got inf"),
        ({"duration": "1 s"}, ValueError, r"duration must be a number \[s\], got '1 s'"),
        ({"duration": None}, ValueError, r"duration must be a number .* got None"),
        ({"step": 0.0}, ValueError, r"step must be finite and above 0 \[s\], got 0.0"),
        ({"step": -1e-3}, ValueError, r"step must be .* above 0 .* got -0.001"),
        ({"step": NAN}, ValueError, r"step must be finite .* got nan"),
        ({"step": 1e-13}, ValueError, r"step must be above duration / 1e12 = 1e-12 s, got 1e-13"),
        ({"method": "rk45"}, ValueError, r"method must be one of .* got 'rk45'; did you mean 'rk5'"),
        ({"method": "papr"}, ValueError, r"got 'papr'; did you mean 'paper'"),
        (
            {"method": 4}, ValueError,
            r"method must be one of 'implicit', 'paper', 'paper-ode', 'rattle', 'rattle4', 'rattle6', "
            r"'rk4', 'rk5', 'rk8', got 4",
        ),
        ({"method": ["rk4"]}, ValueError, r"method must be one of .* got \['rk4'\]"),
        (
            {"impact_location": "localte"}, ValueError,
            r"impact_location must be one of 'locate', 'project', 'work', got 'localte'; did you "
            r"mean 'locate'",
        ),
        ({"save_every": 0}, ValueError, r"save_every must be .*at least 1, got 0"),
        ({"save_every": 1.5}, ValueError, r"save_every must be a whole number, got 1.5"),
        ({"save_every": True}, ValueError, r"save_every must be a whole number, got True"),
        ({"options": {"hold": True}}, TypeError, r"options must be carom.Options, got dict"),
        ({"scene": None}, TypeError, r"scene must be a carom.Scene or a carom.GeneralizedSystem, got"),
        ({"progress": "yes"}, TypeError, r"progress must be True, False or a function, got 'yes'"),
        ({"progress": 3}, TypeError, r"progress must be True, False or a function, got 3"),
        ({"throw": "no"}, TypeError, r"throw must be True or False, got 'no'"),
    ],
)  # fmt: skip
def test_simulate(arguments, error, message):
    known = {"scene": ball(), "duration": 1.0, "step": 0.1}
    with pytest.raises(error, match=message):
        carom.simulate(**{**known, **arguments})


@pytest.mark.plain
@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("layer_width", 0.0, r"layer_width must be finite and above 0 \[m\], got 0.0"),
        ("layer_width", -1e-5, "got -1e-05"),
        ("layer_width", NAN, "got nan"),
        ("penetration", 0.0, r"penetration must be finite and above 0 and below 1, got 0.0"),
        ("penetration", 1.0, "penetration must be .* below 1, got 1.0"),
        ("penetration", NAN, "got nan"),
        ("layer_steps", 0, "layer_steps must be .* at least 1, got 0"),
        ("layer_steps", 2.0, "layer_steps must be a whole number, got 2.0"),
        ("add_layer_time", 1, "add_layer_time must be True or False, got 1"),
        ("gap_tolerance", 0.0, "gap_tolerance must be .* above 0 and below 1, got 0.0"),
        ("gap_tolerance", NAN, "gap_tolerance must be finite .* got nan"),
        ("tie_tolerance", -1e-9, "tie_tolerance must be .* above 0 .* got -1e-09"),
        ("constraint_tolerance", 1.0, "constraint_tolerance must be .* below 1, got 1.0"),
        ("drop_tolerance", INF, "drop_tolerance must be finite .* got inf"),
        ("hold", "yes", "hold must be True or False, got 'yes'"),
        ("augmentation", 0.0, "augmentation must be .* above 0"),
        ("natural_frequency", -1.0, "natural_frequency must be .* at least 0, got -1.0"),
        ("damping_ratio", NAN, "damping_ratio must be finite .* got nan"),
        ("residual_tolerance", 0.0, "residual_tolerance must be .* above 0"),
        ("max_iterations", 0, "max_iterations must be .* at least 1, got 0"),
        ("max_impacts_per_step", -5, "max_impacts_per_step must be .* at least 1, got -5"),
        ("max_cuts", 0.5, "max_cuts must be a whole number, got 0.5"),
    ],
)
def test_options(name, value, message):
    with pytest.raises(ValueError, match=message):
        carom.Options(**{name: value})


def test_unknown_option():
    with pytest.raises(TypeError, match="layer_widht"):
        carom.Options(layer_widht=1e-5)


def test_options_are_frozen_and_listed():
    options = carom.Options(penetration=0.3)
    with pytest.raises(AttributeError):
        options.penetration = 0.4
    assert options.as_dict()["penetration"] == 0.3
    assert options == carom.Options(penetration=0.3)


def test_velocity_that_breaks_a_joint():
    # Named: the body, the joint and by how much; nothing has run.
    scene = carom.Scene()
    bob = scene.add_body(mass=1, inertia=(1, 1, 1), position=(1, 0, 0), velocity=(0.5, 0, 0))
    scene.add_joint(carom.joints.Spherical(anchor=(0, 0, 0)), carom.GROUND, bob, name="pivot")
    with pytest.raises(ValueError, match=r"velocity of 'body1' violates joint 'pivot'.* 0.5"):
        carom.simulate(scene, 1.0, step=0.01)


def test_body_inside_the_half_space():
    # Refused as it is added (and again before a run).
    with pytest.raises(ValueError, match=r"0.02 m deep into 'half_space1'"):
        ball(height=-0.02)


def test_an_empty_scene():
    with pytest.raises(ValueError, match="scene must have at least one body"):
        carom.simulate(carom.Scene(), 1.0, step=0.1)


def test_a_body_without_contacts():
    # Nothing to refuse: it falls, x = -g t^2/2.
    scene = carom.Scene()
    scene.add_body(mass=1, inertia=(1, 1, 1))
    a = carom.simulate(scene, 1.0, step=0.1)
    assert len(a.impacts) == 0
    assert a.contact_mode.shape == (11, 0)
    np.testing.assert_allclose(a.position[-1, 0, 2], -9.81 / 2, rtol=1e-14)
