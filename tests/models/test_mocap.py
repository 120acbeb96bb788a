"""Mocap bodies that move as the user says."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

import carom

TRAY = """<mujoco><worldbody><geom name="floor" type="plane" size="5 5 .1"/>
<body name="tray" mocap="true" pos="0 0 .5"><geom type="box" size=".3 .3 .02"/></body>
<body name="box" pos=".1 0 .62"><freejoint/><geom type="box" size=".1 .1 .1" mass="2"/></body>
</worldbody></mujoco>"""
HAND = """<mujoco><worldbody><body name="hand" mocap="true" pos="0 0 2"><geom size=".1" pos=".3 0 0"/></body>
<body name="bob" pos="0 0 1"><freejoint/><geom size=".1" mass="2" contype="0" conaffinity="0"/></body>
</worldbody><equality><connect body1="hand" body2="bob" anchor="0 0 0"/></equality></mujoco>"""


def swing(a, w):
    return lambda t: (a * (1 - np.cos(w * t)), a * w * np.sin(w * t), a * w * w * np.cos(w * t))


def even(rate):
    return lambda t: (rate * t, rate, 0.0)


def test_a_tray_carries_a_box():
    """The box does not move on the tray: it would stick to it with friction of .44 = .1/(g/(2 pi)^2 - .02)."""
    across, lift = swing(0.1, 2.0 * np.pi), swing(0.02, 2.0 * np.pi)
    model = carom.load_model(TRAY, mocap={"tray": [across, None, lift]}, restitution=0, friction=1)
    assert not model.report.of("tray")
    s = carom.simulate(model.scene, 1.0)
    t = s.t
    expected = np.stack([across(t)[0], 0.0 * t, 0.5 + lift(t)[0]], axis=1)
    np.testing.assert_allclose(
        s["tray"].position, expected, atol=1e-13
    )  # drivers hold to round-off
    apart = s["box"].position - s["tray"].position
    np.testing.assert_allclose(apart, np.broadcast_to(apart[0], apart.shape), atol=1e-12)


def test_turns_follow_each_other():
    """R = R_x R_y R_z about the origin of the body, .3 m from its geom and so from its mass centre."""
    rates = (0.3, -0.8, 1.7)
    model = carom.load_model(HAND, mocap={"hand": [None] * 3 + [even(one) for one in rates]})
    s = carom.simulate(model.scene, 1.0)
    turned = Rotation.from_euler("XYZ", rates)
    found = Rotation.from_quat(s["hand"].orientation[-1], scalar_first=True)
    assert (found * turned.inv()).magnitude() < 1e-12
    np.testing.assert_allclose(
        s["hand"].position[-1] - [0, 0, 2], turned.apply([0.3, 0, 0]), atol=1e-12
    )


def test_a_recorded_motion_moves_a_load():
    """The bob hangs .5 m/s^2 / g off the plumb line below a hand that accelerates evenly."""
    t = np.linspace(0.0, 1.0, 6)
    even_acceleration = CubicSpline(t, 0.25 * t**2)  # a parabola, to round-off
    a, g = 0.5, 9.81
    z = np.array([-a, 0.0, -g]) / np.hypot(a, g)
    text = HAND.replace('pos="0 0 1"', f'pos="{z[0]} 0 {2 + z[2]}"')
    model = carom.load_model(text, mocap={"hand": [even_acceleration]})
    s = carom.simulate(model.scene, 1.0, options=carom.Options(project_start=True))
    hand = s["hand"].position - [0.3, 0, 0]
    np.testing.assert_allclose(s["bob"].position - hand, np.broadcast_to(z, hand.shape), atol=1e-9)


@pytest.mark.parametrize(
    ("mocap", "message"),
    [
        ({"box": [even(1)]}, "names of mocap bodies of the model .'tray'.*got 'box'"),
        ({"tray": [None, None]}, "one to 6 motions"),
        ({"tray": [even(1)] * 7}, "one to 6 motions"),
        ({"tray": even(1)}, "a sequence of motions"),
        ({"tray": [1.0]}, "must be a function, got 1.0"),
        ("tray", "mocap must be a Mapping"),
    ],
)
def test_wrong_motions(mocap, message):
    with pytest.raises((ValueError, TypeError), match=message):
        carom.load_model(TRAY, mocap=mocap)
