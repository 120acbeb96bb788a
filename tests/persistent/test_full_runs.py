"""Known problems as whole runs: rocking blocks, a puck on three legs, spinning balls, dice that strike flat."""

import numpy as np
import pytest

import carom

G = 9.81


def on_ground(shape, *, contact, **body):
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    part = scene.add_body(shape, **body)
    scene.add_contact(part, ground, **contact)
    return scene


@pytest.mark.parametrize(("half_width", "ratio"), [(0.05, 0.7), (0.02, 1 - 1.5 * 0.04 / 1.04)])
def test_rocking_block_loses_what_housner_says(half_width, ratio):
    # A block that falls back from a small tilt changes edges at w+/w- = 1 - 1.5 sin^2(alpha), tan(alpha) = b/h,
    # when neither edge slips or bounces; so its next tilt has (1 - cos) lower by the square of that.
    b, h, tilt = half_width, 0.1, 0.1
    c, s = np.cos(tilt), np.sin(tilt)
    pivot = np.array([-b * c + h * s, 0, -b * s - h * c])  # its left edge, from the centre
    scene = on_ground(
        carom.Box(2 * b, 0.1, 2 * h), mass=1.0, position=-pivot,
        orientation=(np.cos(tilt / 2), 0, -np.sin(tilt / 2), 0),
        contact={"restitution": 0.0, "friction": 10.0},
    )  # fmt: skip
    a = carom.simulate(scene, 0.5, step=1e-3)
    blow = a.impacts.time[0]
    before = a.evaluate(blow, side="left")[3][0, 1]
    after = a.evaluate(blow)[3][0, 1]
    assert after / before == pytest.approx(ratio, abs=1e-9)
    # from rest at the tilt: J w^2/2 = m g (rise of the centre), about the edge
    rise = abs(pivot[2]) - h
    inertia = 4 / 3 * (b**2 + h**2)
    assert before**2 == pytest.approx(2 * G * rise / inertia, rel=2e-5)


def puck(step, height):
    """Three legs at .05 m about the mass centre, which is at a height above their plane; the end of the run."""
    turn = 2 * np.pi / 3 * np.arange(3)
    legs = [(0.05 * np.cos(t), 0.05 * np.sin(t), 0) for t in turn]
    scene = on_ground(
        carom.Convex([*legs, (0, 0, 4 * height)]), mass=1.0,
        inertia=np.diag([0.0009, 0.0009, 0.0018]), position=(0, 0, height), velocity=(1, 0, 0),
        angular_velocity=(0, 0, 15), contact={"restitution": 0.0, "friction": 0.3},
    )  # fmt: skip
    s = carom.simulate(scene, 0.2, step=step)
    assert np.all(s.contact_mode == 1)
    q, v, w = s.orientation[-1, 0], s.velocity[-1, 0], s.angular_velocity[-1, 0]
    angle = 2 * np.arctan2(q[3], q[0])
    return np.array([*s.position[-1, 0, :2], angle, v[0], v[1], w[2]])


def test_a_puck_on_three_legs():
    # Its centre as good as in their plane each leg carries m g/3: m v' = -mu m g/3 sum e_i, J w' = -mu m g/3
    # sum r_i x e_i, integrated to 12 digits. The height of 1e-7 m changes 2e-7 of it,
    # the step less (order 4).
    exact = [0.151118974161, 0.000014067182, 2.295902646, 0.510325876786, 0.015089939846]
    np.testing.assert_allclose(puck(5e-4, 1e-7), [*exact, 8.17333425], rtol=0, atol=3e-6)


def test_a_higher_puck_at_order_4():
    best = puck(2.5e-4, 0.0075)
    errors = [np.max(np.abs(puck(step, 0.0075) - best)) for step in (0.01, 0.005, 0.0025)]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(rates > 3.8)
    assert errors[-1] < 1e-7


@pytest.mark.parametrize(
    ("e", "spin", "end"),
    [
        # bounces without end by t = sqrt(2 h/g) (1 + e)/(1 - e), then at rest
        (0.5, 0.0, (0.0, 0.0, 0.0)),
        # slips at the blow and on, until it rolls at .728 s
        (0.0, 50.0, (-0.871342861303543, -1.4285714285714288, 14.285714285714286)),
        # sticks at the blow
        (0.0, 10.0, (-0.19189916089196596, -0.28571428571428575, 2.8571428571428577)),
    ],
)
def test_a_spinning_ball_is_dropped(e, spin, end):
    # from .9 m, mu = .2: (x, v, w) at 1.5 s or 1.1 s, closed form
    scene = on_ground(
        carom.Sphere(0.1), mass=1.0, position=(0, 0, 1.0), angular_velocity=(0, -spin, 0),
        contact={"restitution": e, "friction": 0.2},
    )  # fmt: skip
    s = carom.simulate(scene, 1.5 if e else 1.1, step=0.01)
    found = (s.position[-1, 0, 0], s.velocity[-1, 0, 0], -s.angular_velocity[-1, 0, 1])
    np.testing.assert_allclose(found, end, rtol=0, atol=1e-9)
    assert s.impacts.time[0] == pytest.approx(0.4283529368781193, abs=1e-12)
    if e:
        held = s.events.time[s.events.kind == "held"][0]
        assert 1.2850588090386188 - 0.01 <= held <= 1.2850588090386188
        assert np.all(s.velocity[-1] == 0.0)
    if spin == 50.0:
        assert s.events.time[s.events.kind == "sticks"] == pytest.approx([0.72811999417504])


def flat_die(v, w, **contact):
    """The die of the paper on the ground, level, all corners touching."""
    scene = on_ground(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.01), velocity=v,
        angular_velocity=w, contact={"impact_law": "stronge", **contact},
    )  # fmt: skip
    return carom.simulate(scene, 1e-3, step=1e-3)


@pytest.mark.parametrize(
    ("v", "w", "e", "mu", "after", "spin"),
    [
        ((0, 0, -2), (0, 0, 0), 0.5, 0.2, (0, 0, 1), (0, 0, 0)),
        # four corners strike
        (
            (0.3, 0.1, -2), (3, 1, 5), 0.5, 0.05, (0.158987569, 0.055841910, 1.002983212),
            (0.796412609, -5.105332165, 1.146848659),
        ),
        (
            (0.3, 0.1, -2), (3, 1, 5), 0.5, 1.0, (-0.041779868, -0.007604862, 1.008351353),
            (0.76048621, -4.1779868, 0),
        ),
        # two corners touch, the die falls about them onto the two others
        ((0.1, 0, -0.1), (0, 10, 0), 0.5, 0.8, (-0.0125, 0, 0.0875), (0, -1.25, 0)),
        (
            (0.1, 0, -0.1), (0, 10, 0), 0.5, 0.2, (0.0696766788, 0, 0.0516166061),
            (0, -4.0093311022, 0),
        ),
    ],
)  # fmt: skip
def test_a_die_strikes_flat(v, w, e, mu, after, spin):
    s = flat_die(v, w, restitution=e, friction=mu)
    np.testing.assert_allclose(s.impacts.time, 0.0)
    found = s.evaluate(0.0)
    np.testing.assert_allclose(found[2][0], after, rtol=0, atol=2e-6)
    np.testing.assert_allclose(found[3][0], spin, rtol=0, atol=2e-4)
